"""Profiles that change along a path, in steps."""

import numpy as np
import pytest

from scratchwarp.scratches.perturb import profile_runs

CORNERED = np.array([[0.0, 0.0], [400.0, 0.0], [400.0, 300.0], [900.0, 300.0]])


def test_runs_are_the_path_from_end_to_end():
    """Each begins where the last one ended, amid a stretch; corners lie within runs, once each."""
    scales = np.array([[1.0, 1.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0]])
    runs = profile_runs(CORNERED, scales, 100.0, 8, np.random.default_rng(2))
    assert len(runs) > 100
    for (a, sizes, _), (b, following, _) in zip(runs[:-1], runs[1:], strict=True):
        np.testing.assert_allclose(a[-1], b[0], atol=1e-9)
        np.testing.assert_allclose(sizes[-1], following[0], atol=1e-9)
        assert np.linalg.norm(CORNERED - a[-1], axis=1).min() > 1.0
    whole = np.concatenate([runs[0][0], *[p[1:] for p, _, _ in runs[1:]]])
    assert sum((whole == corner).all(1).sum() for corner in CORNERED) == 4
    assert np.linalg.norm(np.diff(whole, axis=0), axis=1).sum() == pytest.approx(1200.0)


def test_profiles_are_spread_evenly():
    """Over 40 paths of 12 waves each level takes an eighth of the length; neighbours are one level apart."""
    shares = np.zeros(8)
    for seed in range(40):
        runs = profile_runs(CORNERED, None, 100.0, 8, np.random.default_rng(seed))
        levels = [round(part * 8 - 0.5) for _, _, part in runs]
        assert set(np.abs(np.diff(levels))) == {1}
        for (points, _, _), level in zip(runs, levels, strict=True):
            shares[level] += np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    np.testing.assert_allclose(shares / shares.sum(), 1 / 8, atol=0.012)


def test_too_many_runs_are_refused():
    with pytest.raises(ValueError, match="too many runs"):
        profile_runs(CORNERED, None, 1e-4, 8, np.random.default_rng(0))
