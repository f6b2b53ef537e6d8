"""Grooves that repeat, one record for a set of them: the same as when each is laid out."""

import numpy as np
import pytest

from scratchwarp import grooves, optics
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


@pytest.mark.parametrize("rings", [False, True], ids=["lines", "rings"])
def test_more_than_there_is_room_for(rings):
    """Grooves 250 times as wide as they are apart: those nearest stand for all, and their floor of small right angles
    sends light back up."""
    if rings:
        made = grooves.Pattern([[[0.0, 0.0], [1.0, 0.0]]], V, rings=[(0.004, 5000)])
    else:
        made = grooves.Pattern([[[-10.0, -50.0], [-10.0, 50.0]]], V, repeats=[(0.004, 0.0, 5000)])
    small = ([6.0, 0.0], [1e-2, 0.0], [0.0, 1e-2])
    gold = optics.Conductor((0.14, 0.37, 1.44), (4.4, 2.77, 1.95))
    ends = grooves.trace(made, *small, [0.0, 0.0, 1.0], gold, samples=64)
    assert ends.left.all() and np.isfinite(ends.position).all()
    assert (ends.met == 2).mean() > 0.9
    np.testing.assert_allclose(ends.direction[ends.met == 2], [[0.0, 0.0, 1.0]] * int((ends.met == 2).sum()), atol=1e-3)


def test_no_grooves_do_not_repeat():
    assert grooves.Pattern([], [], repeats=[], rings=[]).count == 0
