"""Cross-sections of fewer facets."""

import numpy as np
import pytest

from scratchwarp import profiles

X = np.linspace(0.0, 1.0, 65)
ROUND = np.stack([X, -np.sqrt(np.maximum(0.25 - (X - 0.5) ** 2, 0.0))], 1)


def distance(p, line):
    """From a point to a polyline, by many points on it."""
    t = np.linspace(0.0, 1.0, 400)[:, None, None]
    return np.linalg.norm((1 - t) * line[:-1] + t * line[1:] - p, axis=-1).min()


@pytest.mark.parametrize(("slack", "most"), [(0.02, 8), (0.005, 14), (0.001, 32)])
def test_no_point_is_farther_off_than_allowed(slack, most):
    made = profiles.simplified(ROUND, slack)
    assert 3 < len(made) <= most and (made[[0, -1]] == ROUND[[0, -1]]).all()
    assert max(distance(p, made) for p in ROUND) <= slack + 1e-4
    assert {tuple(p) for p in made} <= {tuple(p) for p in ROUND}


def test_what_may_not_be_left_out_stays():
    """No slack, straight runs alone, the rims' feet on the plane, an overhang."""
    assert (profiles.simplified(ROUND, 0.0) == ROUND).all()
    rim = np.array([[0, 0], [0.1, 0.01], [0.2, 0], [0.5, -0.3], [0.8, 0], [0.9, 0.01], [1, 0]], float)
    assert (profiles.simplified(rim, 0.05)[:, 1] == [0, 0, -0.3, 0, 0]).all()
    dovetail = np.array([[0, 0], [-0.2, -0.4], [0.5, -0.4], [1.2, -0.4], [1, 0]])
    assert (profiles.simplified(dovetail, 1e-6) == dovetail[[0, 1, 3, 4]]).all()
