"""Grooves that repeat, one record for a set of them: the same as when each is laid out."""

import numpy as np
import pytest

from scratchwarp import grooves

from .test_footprints import RIM, V, stacked

STEP = np.array([0.9, 0.4])


@pytest.mark.parametrize("profile", [V, RIM], ids=["v", "rim"])
def test_repeated_grooves_are_those_laid_out(profile):
    """Two sets that cross; the sums run in another order of pieces."""
    ends = np.array([[-40.0, 10.0], [40.0, -10.0]])
    other = np.array([[-9.0, -40.0], [-11.0, 40.0]])
    sets = [(ends - 20 * STEP, STEP, 41), (other, np.array([1.7, 0.0]), 13)]
    few = grooves.Pattern([p for p, _, _ in sets], profile, repeats=[(*step, n) for _, step, n in sets])
    many = grooves.Pattern([p + k * step for p, step, n in sets for k in range(n)], profile)
    assert few.memory + few.grid.memory < 0.05 * (many.memory + many.grid.memory)
    scene = stacked(12)
    shown = [grooves.radiance(g, *scene, grooves.GGX(0.4), slices=7) for g in (few, many)]
    np.testing.assert_allclose(shown[0], shown[1], rtol=1e-7)


def test_repeats_name_what_is_wrong():
    with pytest.raises(ValueError, match="repeats must have shape"):
        grooves.Pattern([[[0, 0], [1, 0]]], V, repeats=[[0, 1, 3], [0, 1, 3]])
