"""Which way scratches run: along dP/du at angle 0, counter-clockwise from there seen from outside, however uv and
instances are mirrored.

``test_grooves_mitsuba`` pins the plain case to real geometry. Here a plane of mirror grooves under a sky with three
different colours along the axes answers with one colour for each direction of its scratches; a table bin of 0.7 degrees
and noise leave 0.2 % of it.
"""

from dataclasses import replace

import numpy as np
import pytest

from scratchwarp.scene import Camera, DomeLight, Instance, Profile, Texture

from . import scenes

ANGLE = 0.5


def sky():
    polar, longitude = np.meshgrid(
        np.pi * (np.arange(64) + 0.5) / 64, np.pi * (1 - (np.arange(128) + 0.5) / 64), indexing="ij"
    )
    x, z = np.sin(polar) * np.sin(longitude), np.sin(polar) * np.cos(longitude)
    colors = np.stack([0.5 + 0.4 * x, 0.5 + 0.4 * np.cos(polar), 0.5 + 0.4 * x * z, np.ones_like(x)], -1)
    return Texture("sky", colors)


def from_above(tilt=0.5, width=1e-3, turn=0.9):
    """Orthographic camera that leans away from +z by ``tilt`` towards azimuth ``turn``."""
    back = np.array([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    right = np.cross((0.0, 1.0, 0.0), back)
    right /= np.linalg.norm(right)
    m = np.eye(4)
    m[:3] = np.stack([right, np.cross(back, right), back, 3 * back], 1)
    return Camera(
        path="/cam", transform=m, projection="orthographic", horizontal_aperture=width, vertical_aperture=width
    )


def color(mesh=None, linear=None, cam=None, size=8, **layer):
    shape = Profile(path="/mat/profile", shape=layer.pop("shape", "vGroove"), parameters=layer.pop("parameters", ()))
    fields = {"distribution": "linear", "width": 20.0, "pitch": 20.0, "depth": 7.0, "profile": shape, "angle": ANGLE}
    placed = Instance(path="/plane", mesh=0, transform=np.eye(4), materials=(0,))
    if linear is not None:
        m = np.eye(4)
        m[:3, :3] = linear
        placed = replace(placed, transform=m)
    dome = DomeLight(path="/sky", radiance=(1, 1, 1), texture=0)
    world = scenes.scene(
        [mesh or scenes.plane(0.1)], [scenes.scratched(**fields | layer)], [dome], [placed], cam or from_above(),
        textures=(sky(),),
    )  # fmt: skip
    film = scenes.shoot(world, width=size, height=size, spp=256)
    assert film.stats["invalid_samples"] == 0
    return film["color"] if cam else film["color"].mean((0, 1), dtype=float)


def mapped(change):
    plane = scenes.plane(0.1)
    return replace(plane, uvs={"st": change(plane.uvs["st"])})


# name -> (plane, linear part of its instance, by how much the pattern turns)
QUARTER = np.pi / 2
MAPPINGS = {
    "u mirrored": (mapped(lambda st: st * (-1, 1)), None, 0.0),
    "v mirrored": (mapped(lambda st: st * (1, -1)), None, 0.0),
    "swapped": (mapped(lambda st: st[..., ::-1]), None, QUARTER),
    "turned": (mapped(lambda st: np.stack([st[..., 1], -st[..., 0]], -1)), None, QUARTER),
    "stretched": (mapped(lambda st: st * (3, 0.5)), None, 0.0),
    "instance mirrored in x": (None, np.diag([-1.0, 1, 1]), 0.0),
    "instance mirrored in y": (None, np.diag([1.0, -1, 1]), 0.0),
    "instance stretched": (None, np.diag([3.0, 0.7, 1]), 0.0),
    "instance turned": (None, np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]), QUARTER),
    "tangents": (replace(scenes.plane(0.1), tangents=np.tile([0.0, 1, 0], (2, 3, 1))), None, QUARTER),
    "mirrored tangents": (
        replace(scenes.plane(0.1), tangents=np.tile([0.0, 1, 0], (2, 3, 1))), np.diag([1.0, -1, 1]), QUARTER,
    ),
    "no uv": (replace(scenes.plane(0.1), uvs={}), None, 0.0),
}  # fmt: skip


@pytest.mark.parametrize("distribution", ["linear", "worley"])
@pytest.mark.parametrize("name", MAPPINGS)
def test_mirrored_mappings(name, distribution):
    mesh, linear, turn = MAPPINGS[name]
    layer = {"distribution": distribution}
    if distribution == "worley":
        layer |= {"coverage": 1.0, "length": 500.0}
    expected = color(angle=ANGLE + turn, **layer)
    other = color(angle=-ANGLE + turn, **layer)
    assert np.abs(other / expected - 1).max() > 0.02
    np.testing.assert_allclose(color(mesh, linear, **layer), expected, rtol=2e-3)


def test_half_a_turn_mirrors_the_profile():
    """A skewed profile's x runs along v: turned by 180 degrees it is its own mirror image, not itself."""
    skewed = {"parameters": (("apex", 0.2),)}
    plain, turned = color(**skewed), color(angle=ANGLE + np.pi, **skewed)
    assert np.abs(turned / plain - 1).max() > 0.02
    mirrored = color(angle=ANGLE, parameters=(("apex", 0.8),))
    np.testing.assert_allclose(turned, mirrored, rtol=2e-3)


@pytest.mark.parametrize("distribution", ["concentric", "spiral"])
def test_rings_run_across_the_radius(distribution):
    size, width = 9, 0.09
    cam = from_above(width=width)
    rings = color(mesh=scenes.plane(0.2), cam=cam, size=size, distribution=distribution, angle=0.0)
    c = np.arange(size) - size // 2
    x, y = np.meshgrid(c, -c)
    # pixel (x, y) of the image to the plane: along the view
    right, up, back = cam.transform[:3, 0], cam.transform[:3, 1], cam.transform[:3, 2]
    p = (x[..., None] * right + y[..., None] * up) * width / size
    p = p - back * (p[..., 2:] / back[2])
    for row, column in [(0, 4), (4, 8), (8, 4), (4, 0), (0, 0), (0, 8), (8, 8), (8, 0), (1, 7)]:
        azimuth = np.arctan2(p[row, column, 1], p[row, column, 0])
        expected = color(angle=azimuth + QUARTER)
        # over a pixel the azimuth runs through 1 / 4 rad; its second order is left, (1 / 4)^2 / 24 of a gradient of 1
        np.testing.assert_allclose(rings[row, column], expected, rtol=0.015)
