"""Grooves laid out one by one in a render: against their own mean over each pixel's footprint."""

from dataclasses import replace

import numpy as np

import scratchwarp as sw
from scratchwarp.reflectance import grooves
from scratchwarp.scene import Curves, DistantLight

from . import scenes

TO_LIGHT = np.array([0.5, -0.3, 0.8]) / np.linalg.norm([0.5, -0.3, 0.8])
ANGLE = 0.3
UM = 1e6
INNER = (slice(3, 13), slice(3, 13))


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
    along, across = np.array([np.cos(ANGLE), np.sin(ANGLE)]), np.array([-np.sin(ANGLE), np.cos(ANGLE)])
    middles = 0.2 * np.arange(-40, 60) + 0.05
    paths = [np.stack([-8 * along + m * across, 8 * along + m * across]) for m in middles]
    pattern = grooves.Pattern(paths, [[-0.05, 0.0], [0.0, -0.05], [0.05, 0.0]])
    np.testing.assert_allclose(film["color"][INNER][..., 0], expected(film, pattern), rtol=1e-3)


def test_grooves_whose_sizes_change():
    """Curves with widths and depths of their own at each point; four lines a sample leave 1 %."""
    rng = np.random.default_rng(3)
    count, points = 7, 6
    at = np.stack(np.broadcast_arrays(np.linspace(-0.1, 1.1, points), np.linspace(0.1, 0.9, count)[:, None]), -1)
    at = at + rng.uniform(-0.05, 0.05, at.shape) * (0.0, 1.0)
    wide, deep = rng.uniform(0.06, 0.14, (count, points)), rng.uniform(0.02, 0.05, (count, points))
    uv = np.concatenate([at, np.zeros((*at.shape[:2], 1))], -1).reshape(-1, 3)
    counts = np.full(count, points, np.int32)
    curves = Curves("/c", uv, counts, UM * wide.ravel(), UM * deep.ravel(), space="uv")
    world = replace(sheet([lamp()], distribution="curves", curves=(0,)), curves=(curves,))
    film = shoot(world, knobs={"grooves.lines": 64})
    sizes = [np.stack([w, d], 1) for w, d in zip(wide, deep, strict=True)]
    pattern = grooves.Pattern(list(2.0 * at), [[-0.5, 0.0], [0.0, -1.0], [0.5, 0.0]], scales=sizes)
    np.testing.assert_allclose(film["color"][INNER][..., 0], expected(film, pattern), rtol=1e-2)


def expected(film, pattern):
    """The mean over each pixel's footprint by the library."""
    p = film["P"][INNER].astype(float)
    o = -p / np.linalg.norm(p, axis=-1, keepdims=True)
    half = 6 * 20 / 50 / 16 / np.sqrt(np.pi)  # of an ellipse as large as the pixel

    def on_plane(edge):
        return (edge - (edge[2] / o[..., 2:]) * o)[..., :2]

    axes = [on_plane(np.array(e)) for e in ([half, 0.0, 0.0], [0.0, -half, 0.0])]
    return grooves.radiance(pattern, p[..., :2] + 1.0, *axes, o, TO_LIGHT, grooves.Diffuse(0.8))
