"""Grooves laid out one by one in a render: against their own mean over each pixel's footprint."""

import numpy as np

import scratchwarp as sw
from scratchwarp.reflectance import grooves
from scratchwarp.scene import DistantLight

from . import scenes

TO_LIGHT = np.array([0.5, -0.3, 0.8]) / np.linalg.norm([0.5, -0.3, 0.8])
ANGLE = 0.3
UM = 1e6


def sheet(lights, surface=None, **fields):
    """A square of 2 m, 6 m before the camera, with V grooves 10 cm wide every 20 cm."""
    fields = {"width": 0.1 * UM, "depth": 0.05 * UM, "pitch": 0.2 * UM, "angle": ANGLE, "fresnel": "exact", **fields}
    fields = {"model": "groove", "distribution": "linear", **fields}
    return scenes.scene([scenes.plane(2.0)], [scenes.scratched(surface or scenes.lambert(0.8), **fields)], lights)


def lamp():
    """A distant light without extent, irradiance 1 across it."""
    return DistantLight(path="/lamp", radiance=np.ones(3), direction=-TO_LIGHT, angle=0.0)


def shoot(world, **settings):
    """16 x 16 pixels, one sample in the middle of each."""
    effects = {"grooves.interreflection": False, **settings.pop("effects", {})}
    asked = {"width": 16, "height": 16, "spp": 1, "filter": "box", "filter_width": 1e-6, "integrator": "direct"}
    plan = sw.make_plan(world, sw.Settings(effects=effects, **{**asked, **settings}))
    return sw.render(world, plan)


def test_pixels_are_means_over_their_footprints():
    """Rounding of float32 alone: 1e-3, most of it in places near the grooves' edges."""
    film = shoot(sheet([lamp()]))
    inner = (slice(3, 13), slice(3, 13))
    along, across = np.array([np.cos(ANGLE), np.sin(ANGLE)]), np.array([-np.sin(ANGLE), np.cos(ANGLE)])
    middles = 0.2 * np.arange(-40, 60) + 0.05
    paths = [np.stack([-8 * along + m * across, 8 * along + m * across]) for m in middles]
    pattern = grooves.Pattern(paths, [[-0.05, 0.0], [0.0, -0.05], [0.05, 0.0]])
    p = film["P"][inner].astype(float)
    o = -p / np.linalg.norm(p, axis=-1, keepdims=True)
    half = 6 * 20 / 50 / 16 / np.sqrt(np.pi)  # of an ellipse as large as the pixel

    def on_plane(edge):
        return (edge - (edge[2] / o[..., 2:]) * o)[..., :2]

    axes = [on_plane(np.array(e)) for e in ([half, 0.0, 0.0], [0.0, -half, 0.0])]
    expected = grooves.radiance(pattern, p[..., :2] + 1.0, *axes, o, TO_LIGHT, grooves.Diffuse(0.8))
    np.testing.assert_allclose(film["color"][inner][..., 0], expected, rtol=1e-3)
