"""Differences of images against their closed forms."""

import numpy as np
import pytest

from scratchwarp.study import differences

RAMP = np.linspace(0.0, 2.0, 5 * 7 * 3, dtype=np.float32).reshape(5, 7, 3)


def test_relative_mse_of_an_offset():
    a = np.full((4, 4, 3), 0.3, np.float32)
    assert differences.relative_mse(a, a + np.float32(0.1)) == pytest.approx(0.01 / (0.09 + 0.01), rel=1e-5)
    assert differences.relative_mse(RAMP, RAMP) == 0.0


def test_boosted():
    assert np.allclose(differences.boosted(RAMP, RAMP * 0.5, 4.0), 2.0 * RAMP, atol=1e-6)


@pytest.mark.parametrize("scale", [0.4, 3.0])
def test_flip_is_zero_for_the_same_and_grows(scale):
    pytest.importorskip("flip_evaluator")
    a = scale * RAMP
    shown, mean = differences.flip(a, a)
    assert mean == 0.0 and shown.shape == a.shape
    assert 0.0 < differences.flip(a, 0.9 * a)[1] < differences.flip(a, 0.5 * a)[1] <= 1.0


def test_faults():
    with pytest.raises(ValueError, match=r"\[5, 7, 3\] and \[4, 7, 3\]"):
        differences.relative_mse(RAMP, RAMP[:4])
    bad = RAMP.copy()
    bad[2, 3, 1] = np.nan
    with pytest.raises(ValueError, match="second image is not finite at pixel x 3, y 2"):
        differences.relative_mse(RAMP, bad)
