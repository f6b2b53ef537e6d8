"""Diffuse ball and floor under every light, from a stage in centimetres, against Mitsuba 3.

Mitsuba's scenes are written from UsdLux's rules in stage units (radiance has no length in it), not from our Scene. The
mean of each object agrees within 0.5 %; its noise, below 0.1 % because both sample in strata, is inside that. Every
pixel agrees within 0.5 % plus 4 standard deviations, estimated as if samples were independent.
"""

import numpy as np
import pytest
from pxr import UsdLux

from .ball_stage import APERTURE, pair, placed
from .mitsuba_reference import agreement, area, deviations, matrix, mi, rgb


def light(kind, body, apis=""):
    return f'def {kind} "light" {apis}\n{{{body}\n}}\n'


def flat(m, half_x, half_y):
    """Mitsuba's rectangle or disk spans [-1, 1] and shines along +z; UsdLux's along -Z."""
    return matrix(m @ np.diag([-half_x, half_y, -1.0, 1.0]))


def kelvin(temperature):
    """UsdLux's blackbody colour, white at 6500 K as the schema says."""
    white = np.array(UsdLux.BlackbodyTemperatureAsRgb(6500.0))
    return np.array(UsdLux.BlackbodyTemperatureAsRgb(temperature)) / white


def sky(polar, longitude):
    """A smooth sky with a broad sun: radiance at angles from +Y and from +Z towards +X."""
    y, x, z = np.cos(polar), np.sin(polar) * np.sin(longitude), np.sin(polar) * np.cos(longitude)
    sun = np.exp(6 * (x * 0.6 + y * 0.64 + z * 0.48 - 1))
    return np.stack([0.3 + 0.2 * x + 2.0 * sun, 0.3 + 0.2 * y + 1.5 * sun, 0.4 + 0.3 * z + sun], -1)


def distant_sharp(path):
    text, m = placed(rotate=(-50, 30, 0))
    body = f"{text}\n float inputs:angle = 0\n float inputs:intensity = 2\n float inputs:exposure = 0.5"
    body += "\n color3f inputs:color = (1, 0.5, 0.25)"
    # intensity is irradiance where the light fills no angle
    irradiance = 2 * 2**0.5 * np.array([1, 0.5, 0.25])
    direction = m[:3, :3] @ (0, 0, -1)
    return light("DistantLight", body), {
        "type": "directional", "direction": direction.tolist(), "irradiance": rgb(irradiance),
    }  # fmt: skip


def far_sphere(m, degrees, radiance):
    """A distant light of full angle ``degrees`` as a far sphere; its parallax is below 5e-4."""
    center = -2e4 * (m[:3, :3] @ (0, 0, -1))
    radius = 2e4 * np.sin(np.radians(degrees / 2))
    return {"type": "sphere", "center": center.tolist(), "radius": radius, "emitter": area(radiance)}


def distant_wide(path):
    text, m = placed(rotate=(-40, -20, 0))
    body = f"{text}\n float inputs:angle = 30\n float inputs:intensity = 3\n bool inputs:normalize = 1"
    # normalised, intensity is irradiance again: L = E / (pi sin^2 of the half angle)
    return light("DistantLight", body), far_sphere(m, 30, 3 / (np.pi * np.sin(np.radians(15)) ** 2))


def distant_plain(path):
    text, m = placed(rotate=(-60, 80, 0))
    body = f"{text}\n float inputs:angle = 10\n float inputs:intensity = 40"
    return light("DistantLight", body), far_sphere(m, 10, 40.0)


def sphere_normalized(path):
    text, m = placed((2, 3, 1.5), (10, 20, 30), (1.5, 1.5, 1.5))
    body = f"{text}\n float inputs:radius = 0.5\n float inputs:intensity = 60\n bool inputs:normalize = 1"
    body += "\n bool inputs:enableColorTemperature = 1\n float inputs:colorTemperature = 3200"
    radiance = 60 / (4 * np.pi * 0.75**2) * kelvin(3200)
    return light("SphereLight", body), {
        "type": "sphere", "center": [2, 3, 1.5], "radius": 0.75, "emitter": area(radiance),
    }  # fmt: skip


def sphere_in_sight(path):
    text, _ = placed((-1.6, 0.7, 0.6))
    body = f"{text}\n float inputs:radius = 0.3\n float inputs:intensity = 8\n color3f inputs:color = (1, 1, 0.5)"
    return light("SphereLight", body), {
        "type": "sphere", "center": [-1.6, 0.7, 0.6], "radius": 0.3, "emitter": area([8, 8, 4]),
    }  # fmt: skip


def point(path):
    text, _ = placed((-1.5, 2.5, 1.0), scale=(2, 2, 2))
    body = f"{text}\n float inputs:radius = 0.25\n float inputs:intensity = 40\n bool treatAsPoint = 1"
    # radius 0.5 in the world: the intensity of its lit disk
    return light("SphereLight", body), {
        "type": "point", "position": [-1.5, 2.5, 1.0], "intensity": rgb(40 * np.pi * 0.5**2),
    }  # fmt: skip


def rect(path):
    text, m = placed((-1, 2.8, 1.5), (-70, -20, 15), (1, 1.5, 2))
    body = f"{text}\n float inputs:width = 1.4\n float inputs:height = 0.8\n float inputs:exposure = 3"
    body += "\n color3f inputs:color = (0.5, 1, 0.8)"
    return light("RectLight", body), {
        "type": "rectangle", "to_world": flat(m, 0.7, 0.4), "emitter": area([4, 8, 6.4]),
    }  # fmt: skip


def rect_normalized(path):
    text, m = placed((2.5, 1.2, 0.5), (0, 80, 0), (2, 1, 1))
    body = f"{text}\n float inputs:width = 0.5\n float inputs:height = 2\n float inputs:intensity = 30"
    body += "\n bool inputs:normalize = 1"
    return light("RectLight", body), {
        "type": "rectangle", "to_world": flat(m, 0.25, 1.0), "emitter": area(30 / (1.0 * 2.0)),
    }  # fmt: skip


def disk(path):
    text, m = placed((0.5, 3, 0), (-90, 0, 20), (1.5, 1, 1))
    body = f"{text}\n float inputs:radius = 0.8\n float inputs:intensity = 20\n bool inputs:normalize = 1"
    return light("DiskLight", body), {
        "type": "disk", "to_world": flat(m, 0.8, 0.8), "emitter": area(20 / (np.pi * 1.2 * 0.8)),
    }  # fmt: skip


def cylinder(path):
    text, m = placed((-0.5, 2.6, 1.2), (0, 30, 20), (1.2, 1.2, 1.2))
    body = f"{text}\n float inputs:length = 2\n float inputs:radius = 0.2\n float inputs:intensity = 6"
    ends = [(m @ (x, 0, 0, 1))[:3].tolist() for x in (-1, 1)]
    return light("CylinderLight", body), {
        "type": "cylinder", "p0": ends[0], "p1": ends[1], "radius": 0.24, "emitter": area(6.0),
    }  # fmt: skip


def dome_even(path):
    body = "\n float inputs:intensity = 0.8\n float inputs:exposure = -1\n bool inputs:enableColorTemperature = 1"
    body += "\n float inputs:colorTemperature = 9000"
    return light("DomeLight", body), {"type": "constant", "radiance": rgb(0.4 * kelvin(9000))}


def dome_image(path):
    rows, columns = 128, 256
    longitude = np.pi - 2 * np.pi * (np.arange(columns) + 0.5) / columns
    pixels = sky(*np.meshgrid(np.pi * (np.arange(rows) + 0.5) / rows, longitude, indexing="ij"))
    mi.Bitmap(pixels.astype(np.float32)).write(str(path / "sky.exr"))
    text, m = placed((3, 4, 5), (30, 50, 0))
    body = f"{text}\n asset inputs:texture:file = @sky.exr@\n float inputs:intensity = 1.5"
    # Mitsuba's first and last rows lie on the poles
    theirs = sky(*np.meshgrid(np.pi * np.arange(rows) / (rows - 1), longitude, indexing="ij"))
    turn = np.eye(4)
    turn[:3, :3] = m[:3, :3]
    bitmap = mi.Bitmap(theirs.astype(np.float32))
    return light("DomeLight", body), {"type": "envmap", "bitmap": bitmap, "scale": 1.5, "to_world": matrix(turn)}


def mesh(path):
    text, m = placed((1.5, 2.2, 2), (60, 15, 0), (1, 0.5, 1))
    body = (
        text
        + """
    uniform token subdivisionScheme = "none"
    point3f[] points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 3, 2, 1]
    float inputs:intensity = 24
    bool inputs:normalize = 1"""
    )
    return light("Mesh", body, '(prepend apiSchemas = ["MeshLightAPI"])'), {
        "type": "rectangle", "to_world": flat(m, 1, 1), "emitter": area(24 / 2.0),
    }  # fmt: skip


CASES = (
    distant_sharp, distant_wide, distant_plain, sphere_normalized, sphere_in_sight, point, rect, rect_normalized, disk,
    cylinder, dome_even, dome_image, mesh,
)  # fmt: skip


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.__name__)
def test_lights(tmp_path, case):
    text, light = case(tmp_path)
    # twice as wide as high: expandAperture widens the aperture to 30 x 15, a pixel is 15 / 22, a fifth of it 3 / 22
    camera = APERTURE + "float horizontalApertureOffset = 3\n float verticalApertureOffset = 1.5"
    ours, theirs, variance = pair(tmp_path, text, light, (-12, 18, -6, 9), 3 / 22, (44, 22), camera)
    sight = ours["emission"].max(-1) > 0
    if case is sphere_in_sight:
        # our lights do not hide what is behind them: the floor, 4 % of the light's radiance
        assert sight.sum() > 15
        np.testing.assert_allclose(ours["emission"][sight], theirs[sight], atol=0.05 * 8)
    plain = ~sight | case.__name__.startswith("dome")
    for prim in (0, 1):
        region = (ours["primId"] == prim) & (ours["alpha"] == 1.0) & plain
        off, _ = agreement(ours, theirs, variance, region)
        assert region.sum() > 80 and off < 5e-3
    assert deviations(ours, theirs, variance)[plain].max() < 4.0


@pytest.mark.parametrize("case", [rect, dome_even], ids=lambda c: c.__name__)
def test_light_between_ball_and_floor(tmp_path, case):
    text, light = case(tmp_path)
    ours, theirs, variance = pair(tmp_path, text, light, (-10, 10, -7.5, 7.5), 0.25, (40, 30), spp=512, bounces=3)
    for prim in (0, 1):
        region = (ours["primId"] == prim) & (ours["alpha"] == 1.0)
        off, _ = agreement(ours, theirs, variance, region)
        assert region.sum() > 80 and off < 5e-3
    assert deviations(ours, theirs, variance).max() < 4.0
