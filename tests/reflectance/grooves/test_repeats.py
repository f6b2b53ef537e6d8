"""Grooves that repeat, one record for a set of them: the same as when each is laid out."""

import numpy as np
import pytest

from scratchwarp import grooves
from scratchwarp.scene import Layer, Profile
from scratchwarp.scratches.paths import lay_out, repeated

from .test_footprints import RIM, V, stacked

STEP = np.array([0.9, 0.4])


@pytest.mark.parametrize("profile", [V, RIM], ids=["v", "rim"])
def test_repeated_grooves_are_those_laid_out(profile):
    """Two sets that cross; the sums run in another order of pieces."""
    ends = np.array([[-40.0, 10.0], [40.0, -10.0]])
    other = np.array([[-9.0, -40.0], [-11.0, 40.0]])
    sets = [(ends - 40 * STEP, STEP, 81), (other - (17.0, 0.0), np.array([1.7, 0.0]), 33)]
    few = grooves.Pattern([p for p, _, _ in sets], profile, repeats=[(*step, n) for _, step, n in sets])
    many = grooves.Pattern([p + k * step for p, step, n in sets for k in range(n)], profile)
    assert few.memory + few.grid.memory < 0.05 * (many.memory + many.grid.memory)
    scene = stacked(12)
    shown = [grooves.radiance(g, *scene, grooves.GGX(0.4), slices=7) for g in (few, many)]
    np.testing.assert_allclose(shown[0], shown[1], rtol=1e-7)


def test_rings_are_those_laid_out():
    """Chord for chord: the paths that ``lay_out`` draws, and no piece of them; elsewhere a path in the grid."""
    layer = Layer(
        "turned", "/mat", Profile("/p"), distribution="concentric", width=1.0, depth=0.5, pitch=1.3, center=(0.2, -0.1)
    )
    box = np.array([-30.0, -20.0]), np.array([30.0, 20.0]), np.array([1.0, 1.0])
    [(path, step, count)] = repeated(layer, *box)
    drawn = [p.points for p in lay_out(layer, *box)]
    saw = np.array([[-0.5, 0.0], [-0.4, -0.5], [0.5, 0.0]])
    line = np.array([[-40.0, -3.0], [40.0, 3.0]])
    scene = stacked(12)
    # what crosses is taken in another order, and lines over a footprint run in another direction: 1,023 of them agree
    for more, slices, near in (([], 7, 1e-9), ([line], 1023, 1e-4)):
        rings = [(float(step[0]), count), *(None for _ in more)]
        few = grooves.Pattern([path.points, *more], saw, rings=rings)
        many = grooves.Pattern([*drawn, *more], saw)
        assert few.memory + few.grid.memory < 0.05 * (many.memory + many.grid.memory)
        for far in (0.0, 14.0):
            moved = (scene[0] + far, *scene[1:])
            shown = [grooves.radiance(g, *moved, grooves.GGX(0.4), slices=slices) for g in (few, many)]
            np.testing.assert_allclose(shown[0], shown[1], rtol=near)


def test_repeats_name_what_is_wrong():
    with pytest.raises(ValueError, match="repeats must have shape"):
        grooves.Pattern([[[0, 0], [1, 0]]], V, repeats=[[0, 1, 3], [0, 1, 3]])
