"""A layer covers as much of the image as its author asked for, from afar and close by, whatever its pattern.

Mirror scratches on black ground under a dome of radiance 1: a pixel is the covered part of it. Patterns of scratches
far below a pixel fall into their mean (1e-3 for the threshold of the noise), resolved ones vary with how many of them
the plane holds: 2 m / (30 widths by one width) is 4 of 10 % for scratches of 40 mm.
"""

import numpy as np
import pytest

from scratchwarp.scene import PreviewSurface

from . import scenes

BLACK = PreviewSurface(diffuse_color=(0.0, 0.0, 0.0), ior=1.0)


def covered(distribution, coverage, wide, **settings):
    fields = {"width": wide, "depth": 0.3 * wide, "length": 30 * wide, "pitch": wide / coverage}
    material = scenes.scratched(BLACK, distribution=distribution, coverage=coverage, angle=0.4, **fields)
    placed = [scenes.place(at=(0, 0, -6))]
    # nothing but the plane is seen
    world = scenes.scene([scenes.plane(2.0)], [material], [scenes.dome()], placed, scenes.camera(15.0))
    film = scenes.shoot(world, **settings)
    assert film["alpha"].min() == 1.0 and film.stats["invalid_samples"] == 0
    return film["color"].mean(dtype=float)


@pytest.mark.parametrize(("width", "allowed"), [(50.0, 1.5e-3), (1000.0, 3e-3), (40000.0, 0.05)])
@pytest.mark.parametrize("distribution", ["worley", "random", "linear", "concentric", "spiral", "crosshatch"])
def test_coverage_is_what_was_asked_for(distribution, width, allowed):
    for coverage in (0.1, 0.5, 0.9, 0.99):
        # both sets of a crosshatch cover width / pitch, and cross
        wanted = 1 - (1 - coverage) ** 2 if distribution == "crosshatch" else coverage
        assert covered(distribution, coverage, width) == pytest.approx(wanted, abs=allowed)


@pytest.mark.parametrize("distribution", ["worley", "random", "crosshatch"])
def test_coverage_does_not_depend_on_pixels_and_samples(distribution):
    """Scratches of 3 mm on pixels from 12 cm to 1 cm, a sample's footprint down to 0.6 mm."""
    found = [
        covered(distribution, 0.4, 3000.0, width=size, height=size, spp=spp)
        for size, spp in ((16, 4), (16, 256), (64, 4), (192, 4))
    ]
    assert np.ptp(found) < 0.012 and min(found) > 0.3, found


def test_random_scratches_cross_at_any_distance_alike():
    """From afar the sum of the sets' shares, 12 (1 - 0.5^(1/12)) = 0.67, would count crossings twice."""
    near, far = covered("random", 0.5, 10000.0, width=192, height=192), covered("random", 0.5, 20.0)
    assert far == pytest.approx(0.5, abs=2e-3) and near == pytest.approx(far, abs=0.03)


@pytest.mark.parametrize("space", ["surface", "uv"])
def test_density_counts_scratches(space):
    """Ellipses of 20 um by 1 mm, four a square millimetre: each adds pi / 4 of its box, few of them overlap."""
    size, density = np.array([20.0, 1000.0]), 4.0
    if space == "uv":  # the plane, 2 m wide, is the uv square
        size, density = size / 2e6, density * 4e6
    fields = {"width": size[0], "depth": 0.3 * size[0], "length": size[1], "density": density, "space": space}
    material = scenes.scratched(BLACK, **fields)
    placed = [scenes.place(at=(0, 0, -6))]
    world = scenes.scene([scenes.plane(2.0)], [material], [scenes.dome()], placed, scenes.camera(15.0))
    share = np.pi / 4 * 4 * 0.02 * 1.0
    assert scenes.shoot(world)["color"].mean() == pytest.approx(share, rel=0.05)


@pytest.mark.parametrize(("coverage", "union", "added"), [(0.3, 0.51, 0.6), (0.7, 0.91, 1.0)])
def test_coverages_add_up_where_the_paper_is_asked_for(coverage, union, added):
    """Raymond 2016 Eq. 4: the sum of the layers' coverages, normalised above 1."""
    assert covered("crosshatch", coverage, 50.0) == pytest.approx(union, abs=1.5e-3)
    effects = {**scenes.EVERYTHING, "scratches.sumCoverage": True}
    assert covered("crosshatch", coverage, 50.0, effects=effects) == pytest.approx(added, abs=1.5e-3)
