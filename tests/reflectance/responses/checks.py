"""What holds for every response, asked from NumPy."""

import numpy as np
from scipy import stats

from scratchwarp.reflectance.responses import query

LOWEST_P = 1e-4


def directions(theta, phi):
    return np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), -1)


def hemisphere(n):
    """Midpoints uniform in z and phi, and their solid angle."""
    z, phi = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n * 2 * np.pi - np.pi, indexing="ij")
    return directions(np.arccos(z), phi), 2 * np.pi / n**2


def chi_square(response, where, slack=0.01):
    """Drawn directions have the density that is said, and weight times density is the value.

    ``slack``: what the midpoint rule leaves in a cell of narrow lobes, allowed on top of the noise.
    """
    wo, bins, sub = directions(0.6, 0.7), 8, 50
    wi, weight, pdf = query.sample(response, wo, np.random.default_rng(5).random((60_000, 3)), **where)
    grid, cell = hemisphere(bins * sub)
    density = query.evaluate(response, grid, wo, **where)[1].astype(float)
    expected = 6e4 * cell * density.reshape(bins, sub, bins, sub).sum(axis=(1, 3)).ravel()
    w = wi[pdf > 0]
    counts = np.histogram2d(w[:, 2], np.arctan2(w[:, 1], w[:, 0]), bins, [[0, 1], [-np.pi, np.pi]])[0].ravel()
    keep = expected > 50
    excess = np.maximum(np.abs(counts - expected)[keep] - slack * expected[keep], 0.0)
    assert keep.sum() > 8
    assert stats.chi2.sf(np.sum(excess**2 / expected[keep]), keep.sum()) > LOWEST_P
    value, again = query.evaluate(response, w, wo, **where)
    # float32: a half vector is off by 1e-7, the slope of log D at most 300 a radian; tables have edges
    off = np.abs(pdf[pdf > 0] - again) > 3e-3 * again
    assert off.mean() < 1e-3
    np.testing.assert_allclose((weight[pdf > 0] * again[:, None])[~off], (value * w[:, 2:])[~off], rtol=5e-3, atol=1e-6)


def furnace(response, where, bounded=True):
    """No view reflects more than came, where that is promised."""
    for theta in (0.0, 0.8, 1.4, 1.55):
        u = np.random.default_rng(6).random((20_000, 3))
        weight = query.sample(response, directions(theta, 2.0), u, **where)[1]
        assert np.isfinite(weight).all() and (weight >= 0).all()
        mean = weight.mean(0, dtype=float)
        assert not bounded or (mean <= 1.0 + 4 * weight.std(0) / np.sqrt(20_000)).all()
        assert theta > 0.0 or mean.max() > 0.05


def reciprocity(response, where):
    """Light and view may be exchanged."""
    rng = np.random.default_rng(7)
    wi, wo = (directions(np.arccos(rng.uniform(0.05, 1, 500)), rng.uniform(-3, 3, 500)) for _ in range(2))
    there, back = (query.evaluate(response, a, b, **where)[0] for a, b in ((wi, wo), (wo, wi)))
    np.testing.assert_allclose(there, back, rtol=2e-3, atol=1e-6)
    assert there.max() > 0.0
