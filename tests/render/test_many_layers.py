"""Many layers, dense ones, and scratches seen along themselves: finite, no more light than arrives, no seams."""

from dataclasses import replace

import numpy as np
import pytest

from scratchwarp.scene import DistantLight, Layer, Material, PreviewSurface, Profile

from . import scenes

BLACK = PreviewSurface(diffuse_color=(0.0, 0.0, 0.0), ior=1.0)
VEE = Profile(path="/mat/vee", shape="vGroove")


def layers(count, **fields):
    """Lossless layers, each turned and seeded by its number."""
    fields = {"width": 50.0, "depth": 20.0, "length": 5000.0, "coverage": 0.1, "fresnel": "mirror", **fields}
    turns = np.arange(count) * np.pi / count
    return tuple(
        Layer(name=f"l{i}", prim="/mat", profile=VEE, angle=float(a), seed=i, **fields) for i, a in enumerate(turns)
    )


def shoot(mesh, surface, own, lights=None, cam=None, at=(0, 0, -6), **settings):
    material = Material("/mat", surface, own)
    placed = [scenes.place(at=at)]
    film = scenes.shoot(scenes.scene([mesh], [material], lights or [scenes.dome()], placed, cam), **settings)
    assert film.stats["invalid_samples"] == 0 and np.isfinite(film["color"]).all()
    return film


@pytest.mark.parametrize(
    "fields",
    [
        {"coverage": 0.02},
        {"coverage": 0.9},  # sums to 58
        {"coverage": 1.0},
        {"distribution": "linear", "pitch": 60.0},
        {"coverage": 0.1, "width": 2000.0, "length": 60000.0, "depth_variation": 0.5},
    ],
)
def test_sixty_four_layers_lose_and_gain_nothing(fields):
    """A furnace: mirrors that tables normalise to 1e-3."""
    film = shoot(scenes.sphere(), scenes.white_metal(), layers(64, **fields), width=16, height=16, spp=8)
    np.testing.assert_allclose(film["color"], 1.0, atol=3e-3)


def test_the_order_of_layers_changes_no_mean():
    """Two layers that cover nearly all, one of them black: each has its share whichever is cut first."""
    one, two = layers(2, coverage=0.9)
    dark = replace(two, material="diffuse", diffuse_color=(0.0, 0.0, 0.0))
    # far below a pixel: 1 - (1 - 0.9)^2 covered, half of it by each
    found = [shoot(scenes.plane(4.0), BLACK, own, spp=64)["color"].mean() for own in ((one, dark), (dark, one))]
    assert found == pytest.approx([0.495, 0.495], abs=0.006)


@pytest.mark.parametrize("angle", [0.0, np.pi / 2, 0.3])
@pytest.mark.parametrize("height", [1e-1, 1e-3, 1e-6])
def test_scratches_seen_end_on_at_grazing_angles(angle, height):
    """A floor seen from ``height`` above it, scratches along, across and askew of the view; theta reaches pi / 2 to the
    last bit. No more light than the sky's leaves it; a sun on the horizon stays finite."""
    own = tuple(replace(x, angle=angle) for x in layers(1, coverage=1.0))
    floor = scenes.plane(100.0, axis="y")
    film = shoot(floor, BLACK, own, at=(0, -height, 0), width=16, height=16, spp=8)
    seen = film["primId"] >= 0
    assert seen.any()
    np.testing.assert_allclose(film["color"][seen & (film["alpha"] == 1.0)], 1.0, atol=3e-3)
    for direction in ((0, -1e-7, 1.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)):
        sun = DistantLight(path="/sun", radiance=(1, 1, 1), direction=direction)
        assert shoot(floor, BLACK, own, [sun], at=(0, -height, 0), width=8, height=8)["color"].min() >= 0.0


@pytest.mark.parametrize("space", ["surface", "uv"])
@pytest.mark.parametrize("mesh", ["sphere", "cone"])
def test_curved_surfaces_are_covered_as_flat_ones(mesh, space):
    """Mirror scratches on black ground under a sky of 1: the image is what they cover, all round a body whose mapping
    stretches without bounds at its poles, and across the seam where u returns to 0."""
    size = {"width": 40.0, "length": 2000.0, "depth": 10.0}
    if space == "uv":
        size = {name: 1e-6 * v for name, v in size.items()}
    own = layers(1, coverage=0.4, space=space, curvature=0.5, **size)
    body = scenes.sphere(96, 192) if mesh == "sphere" else scenes.cone(192)
    # from behind: the seam runs down the middle of the image
    for linear in (np.eye(3), np.diag([-1.0, 1.0, -1.0]), np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])):
        placed = [scenes.place(at=(0, 0, -6), linear=linear)]
        world = scenes.scene([body], [Material("/mat", scenes.lambert(0.0), own)], [scenes.dome()], placed)
        world = replace(world, lights=(replace(scenes.dome(), camera_visible=False),))
        film = scenes.shoot(world, spp=64)
        whole = (film["alpha"] == 1.0) & (film["primId"] >= 0)
        image = film["color"][..., 0]
        assert image[whole].mean() == pytest.approx(0.4, abs=0.006)
        # no pixel stands out: a sample sees scratches of one cell at least, 64 of them average
        assert np.abs(image[whole] - 0.4).max() < 0.3
        columns = np.array([image[:, k][whole[:, k]].mean() for k in range(32) if whole[:, k].sum() > 12])
        assert np.ptp(columns) < 0.05
