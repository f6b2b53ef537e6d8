"""Importance sampling of stencil models: chi-square, energy, agreement of weight, value and density."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from scratchwarp import stencils

from .brute_force import direction
from .models import MODELS, ONE, TWO

LOWEST_P = 1e-4
CASES = {**MODELS, "retro": replace(TWO, retro=True), "sharp": ONE.edit(0, alpha=80.0, kd=0.0)}
BINS, SUB = 10, 40


def _grid():
    z, phi = np.meshgrid(
        (np.arange(BINS * SUB) + 0.5) / (BINS * SUB),
        ((np.arange(BINS * SUB) + 0.5) / (BINS * SUB) * 2 - 1) * np.pi,
        indexing="ij",
    )
    return direction(np.arccos(z), phi), 2 * np.pi / (BINS * SUB) ** 2


def _uniform(count, seed=1):
    return np.random.default_rng(seed).random((count, 3))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("theta", [0.0, 0.6, 1.3])
def test_chi_square(name, theta):
    model, wo = CASES[name], direction(theta, 0.9)
    s = stencils.sample(model, wo, _uniform(100_000))
    wi, cell = _grid()
    density = stencils.pdf(model, wi, wo).astype(float)
    expected = 1e5 * cell * density.reshape(BINS, SUB, BINS, SUB).sum(axis=(1, 3)).ravel()
    w = s.omega_i[s.pdf > 0]
    counts = np.histogram2d(w[:, 2], np.arctan2(w[:, 1], w[:, 0]), BINS, [[0, 1], [-np.pi, np.pi]])[0].ravel()
    keep = expected > 50
    assert keep.sum() > 20
    # midpoints leave up to 2 % in cells that a ridge crosses: that much is allowed on top of the noise
    excess = np.maximum(np.abs(counts - expected)[keep] - 0.02 * expected[keep], 0.0)
    assert stats.chi2.sf(np.sum(excess**2 / expected[keep]), keep.sum()) > LOWEST_P
    assert expected.sum() == pytest.approx(np.count_nonzero(s.pdf), rel=0.02)


@pytest.mark.parametrize("name", CASES)
def test_samples_integrate_the_model(name):
    """The mean weight is the directional albedo, by midpoints over the hemisphere, and its variance is small."""
    model, wo = CASES[name], direction(0.7, 0.9)
    wi, cell = _grid()
    value = stencils.evaluate(model, wi, wo, energy_conserving=True).astype(float)
    albedo = np.sum(value * wi[..., 2:], axis=(0, 1)) * cell
    s = stencils.sample(model, wo, _uniform(50_000), energy_conserving=True)
    error = s.weight.std(axis=0) / np.sqrt(50_000)
    # five standard errors, and 0.5 % for the midpoints
    assert np.all(np.abs(s.weight.mean(axis=0) - albedo) < 5 * error + 0.005 * albedo)
    assert np.all(s.weight.std(axis=0) < 2.5 * albedo)  # by cosine-weighted directions the sharp one has 8


def test_weight_times_density_is_the_value():
    wo = direction(0.5, 2.0)
    s = stencils.sample(TWO, wo, _uniform(5000))
    alive = s.pdf > 0
    value = stencils.evaluate(TWO, s.omega_i[alive], wo) * s.omega_i[alive, 2:]
    # float32: the half vector of the sampled direction is off by 1e-7, exponents up to 20
    np.testing.assert_allclose(s.weight[alive] * s.pdf[alive, None], value, rtol=1e-3, atol=1e-6)
    np.testing.assert_allclose(s.pdf[alive], stencils.pdf(TWO, s.omega_i[alive], wo), rtol=1e-3)


def test_a_black_model_is_sampled_by_the_cosine():
    black = ONE.edit(0, kd=0.0, ks=0.0)
    s = stencils.sample(replace(black, background=0.0), direction(0.4, 0.0), _uniform(100))
    np.testing.assert_allclose(s.pdf, s.omega_i[:, 2] / np.pi, rtol=1e-5)
    assert not np.any(s.weight)


def test_nothing_from_below_and_bad_numbers():
    assert not np.any(stencils.sample(TWO, -direction(0.4, 0.3), _uniform(10)).weight)
    with pytest.raises(ValueError, match="u must lie in"):
        stencils.sample(TWO, (0, 0, 1), (0.5, 1.0, 0.2))
