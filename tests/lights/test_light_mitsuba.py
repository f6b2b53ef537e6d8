"""Irradiance of every kind of light against Mitsuba 3: a diffuse plane seen from straight above."""

import numpy as np
import pytest

from scratchwarp import lights
from scratchwarp.scene import Shaping

from .light_cases import (
    ORIGIN,
    UP,
    corners_of,
    cylinder,
    disk,
    distant,
    dome,
    gradient,
    packed_dome,
    packed_mesh,
    rect,
    sphere,
)

mi = pytest.importorskip("mitsuba")

RADIANCE = np.array([4.0, 2.0, 1.0])
AREA = {"type": "area", "radiance": {"type": "rgb", "value": RADIANCE.tolist()}}


def rgb(values):
    return {"type": "rgb", "value": [float(v) for v in values]}


def columns(x, y, z, origin):
    matrix = np.eye(4)
    matrix[:3] = np.stack([x, y, z, origin], 1)
    return mi.ScalarTransform4f(matrix)


def flat(kind, light):
    """A rectangle or disk: Mitsuba's spans [-1, 1]^2 or the unit disk and shines along +z."""
    x = columns(-np.array(light.ex), light.ey, light.normal, light.center)
    return {"type": kind, "to_world": x, "emitter": AREA}


def image():
    pixels = gradient(256, 512)
    pixels[..., :3] = 0.2 + 0.5 * np.cos(2 * np.pi * (np.arange(512) + 0.5) / 512)[None, :, None] ** 2
    pixels[..., 1] += (np.arange(256) + 0.5)[:, None] / 256
    return pixels


def scenes(ply):
    """Name -> (our light, Mitsuba's); ``ply``: file to write a mesh to."""
    common = dict(radiance=RADIANCE)
    tube = cylinder(**common)
    mesh = mi.Mesh("quad", 4, 2)
    params = mi.traverse(mesh)
    params["vertex_positions"] = np.array(corners_of(rect()), np.float32).ravel()
    params["faces"] = np.array([0, 2, 1, 0, 3, 2], np.uint32)
    params.update()
    mesh.write_ply(ply)
    direction = np.array([0.3, 0.2, -1.0]) / np.linalg.norm([0.3, 0.2, -1.0])
    pixels = image()
    turned = packed_dome(pixels, rotation=np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]))
    return {
        "sphere": (sphere(**common), {"type": "sphere", "center": [0.3, 0.4, 1.0], "radius": 0.5, "emitter": AREA}),
        "point": (
            sphere(radius=0.0, **common),
            {"type": "point", "position": [0.3, 0.4, 1.0], "intensity": rgb(RADIANCE)},
        ),
        "rect": (rect(**common), flat("rectangle", rect())),
        "near_rect": (rect(center=(0.1, 0.2, 0.05), **common), flat("rectangle", rect(center=(0.1, 0.2, 0.05)))),
        "disk": (disk(**common), flat("disk", disk())),
        "cylinder": (
            tube,
            {
                "type": "cylinder",
                "p0": (tube.center - tube.axis).tolist(),
                "p1": (tube.center + tube.axis).tolist(),
                "radius": tube.radius,
                "emitter": AREA,
            },
        ),
        "mesh": (packed_mesh(radiance=RADIANCE), {"type": "ply", "filename": ply, "emitter": AREA}),
        "parallel": (
            distant(angle=0.0, direction=direction, **common),
            {"type": "directional", "direction": direction.tolist(), "irradiance": rgb(RADIANCE)},
        ),
        # a distant light of 30 degrees is a far sphere of that angular diameter
        "distant": (
            distant(angle=np.pi / 6, direction=direction, **common),
            {
                "type": "sphere",
                "center": (-1000.0 * direction).tolist(),
                "radius": float(1000.0 * np.sin(np.pi / 12)),
                "emitter": AREA,
            },
        ),
        "dome": (dome(**common), {"type": "constant", "radiance": rgb(RADIANCE)}),
        # pole +Z; Mitsuba's pole is +Y, as ours is in the dome's frame
        "image": (
            turned,
            {
                "type": "envmap",
                "bitmap": mi.Bitmap(np.ascontiguousarray(pixels[..., :3])),
                "to_world": mi.ScalarTransform4f().rotate([1, 0, 0], 90),
            },
        ),
        "spot": (
            sphere(
                radius=0.0,
                center=(0.1, 0.0, 1.0),
                shaping=Shaping(cone_angle=0.5),
                **common,
            ),
            {"type": "point", "position": [0.1, 0.0, 1.0], "intensity": rgb(RADIANCE)},
        ),
    }


NAMES = (
    "sphere", "point", "rect", "near_rect", "disk", "cylinder", "mesh", "parallel", "distant", "dome", "image", "spot",
)  # fmt: skip


@pytest.fixture(scope="module")
def pairs(tmp_path_factory):
    mi.set_variant("scalar_rgb")
    ply = str(tmp_path_factory.mktemp("mitsuba") / "quad.ply")
    return {name: (ours, mi.load_dict(plane(theirs))) for name, (ours, theirs) in scenes(ply).items()}


def plane(emitter):
    """A white plane at z = 0, of which an orthographic camera sees 2 mm."""
    look = mi.ScalarTransform4f().look_at(origin=[0, 0, 1e-2], target=[0, 0, 0], up=[0, 1, 0])
    return {
        "type": "scene",
        "integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 1},
        "plane": {
            "type": "rectangle",
            "to_world": mi.ScalarTransform4f().scale([1e-2, 1e-2, 1]),
            "bsdf": {"type": "diffuse", "reflectance": rgb([1, 1, 1])},
        },
        "light": emitter,
        "sensor": {
            "type": "orthographic",
            "to_world": look @ mi.ScalarTransform4f().scale([1e-3, 1e-3, 1]),
            "near_clip": 1e-4,
            "film": {
                "type": "hdrfilm",
                "width": 16,
                "height": 16,
                "rfilter": {"type": "box"},
                "component_format": "float32",
            },
            "sampler": {"type": "multijitter", "sample_count": 1024},
        },
    }


@pytest.mark.parametrize("name", NAMES)
def test_irradiance_matches_mitsuba(pairs, name):
    ours, scene = pairs[name]
    pixels = np.array(mi.render(scene, seed=1))[..., :3].reshape(-1, 3).astype(float) * np.pi
    theirs, noise = pixels.mean(0), pixels.std(0) / np.sqrt(len(pixels))
    found = lights.irradiance(ours, ORIGIN, UP, samples=1 << 15)
    assert (noise < 5e-4 * theirs).all(), "Mitsuba's own noise leaves nothing to compare"
    # Mitsuba puts the first and last rows of an image on the poles, we half a texel from them: 1 / 256 of the gradient
    allowed = 3e-3 if name == "image" else 5e-4
    np.testing.assert_array_less(np.abs(found / theirs - 1), allowed + 4 * noise / theirs)
