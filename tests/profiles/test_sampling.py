"""Directions drawn from a table against the density it claims."""

import numpy as np
import pytest
from scipy import stats

from scratchwarp import profiles

PHI_O = np.radians([-81.0, -44.5, -3.0, 0.0, 27.3, 88.0])


@pytest.fixture(scope="module", params=[*profiles.shape_names(), "undercut"])
def table(request):
    """A table of each shape."""
    if request.param == "undercut":
        points = [[0, 0], [0.3, 0.1], [0.1, -0.4], [0.9, -0.5], [0.7, 0.05], [1, 0]]
        return profiles.simulate(profiles.Profile(points), resolution=64, rays=128)
    return profiles.simulate(profiles.shape(request.param, depth=0.6), resolution=64, rays=128)


def test_samples_follow_the_density(table):
    """Chi-square over cells that cut each bin in three: 1e5 samples, significance 1e-4 for each of 6 directions and 9
    shapes."""
    count = 100_000
    # edges that are no bin edges, so that a bias inside bins or at their edges shows
    edges = np.sort(
        np.concatenate(
            [-np.pi / 2 + np.pi / 64 * np.arange(65)]
            + [-np.pi / 2 + np.pi / 64 * (np.arange(64) + shift) for shift in (0.31, 0.77)]
        )
    )
    fine = np.linspace(0, 1, 17)
    for k, phi_o in enumerate(PHI_O):
        u = np.random.default_rng(100 + k).random(count)
        phi_i, density = table.sample(phi_o, u)
        np.testing.assert_allclose(density, table.pdf(phi_o, phi_i), rtol=2e-3, atol=1e-4)
        observed = np.histogram(phi_i, edges)[0]
        inside = edges[:-1, None] + np.diff(edges)[:, None] * (fine * 0.9998 + 0.0001)
        expected = count * np.diff(edges) * np.trapezoid(table.pdf(phi_o, inside), fine, axis=1)
        assert expected.sum() == pytest.approx(count, rel=2e-3)
        assert observed[expected == 0.0].sum() == 0
        kept = expected > 5.0
        rest = count - observed[kept].sum(), max(count - expected[kept].sum(), 1e-9)
        chi2 = ((observed[kept] - expected[kept]) ** 2 / expected[kept]).sum()
        if rest[1] > 5.0:
            chi2 += (rest[0] - rest[1]) ** 2 / rest[1]
        assert stats.chi2.sf(chi2, max(kept.sum() - 1, 1)) > 1e-4


def test_density_integrates_to_one_and_follows_the_mirror(table):
    """Per radian of phi_i: proportional to mirror * cos(phi_i) along each row."""
    phi = np.linspace(-np.pi / 2, np.pi / 2, 64 * 40 + 1)
    middle = 0.5 * (phi[1:] + phi[:-1])
    for phi_o in PHI_O:
        density = table.pdf(phi_o, middle)
        assert density.sum() * np.diff(phi)[0] == pytest.approx(1.0, abs=2e-3)
        row = table.mirror[int((phi_o + np.pi / 2) / np.pi * 64)]
        wanted = row.repeat(40) * np.cos(middle)
        # away from the two samples beside each bin edge, where float32 may choose either bin
        inner = (np.arange(len(middle)) % 40 > 0) & (np.arange(len(middle)) % 40 < 39)
        np.testing.assert_allclose((density / density.max())[inner], (wanted / wanted.max())[inner], atol=2e-3)


def test_ends_of_the_unit_interval(table):
    """u = 0 and the largest float below 1 give directions inside the range with a density above 0."""
    phi_i, density = table.sample(PHI_O[:, None], [0.0, 0.5, np.nextafter(1.0, 0.0)])
    assert phi_i.shape == (6, 3)
    assert np.all(np.abs(phi_i) <= np.pi / 2 + 1e-6) and np.all(np.isfinite(density))
    assert np.all(density >= 0.0)


def test_arguments_are_checked(table):
    """Each message names the argument and its value."""
    with pytest.raises(ValueError, match="u must"):
        table.sample(0.0, 1.0)
    with pytest.raises(ValueError, match="phi_o"):
        table.sample(2.0, 0.5)
    with pytest.raises(ValueError, match="phi_i"):
        table.pdf(0.0, -3.0)


def test_rows_without_energy_are_uniform():
    """An isolated bump can leave exit directions dark; sampling them still gives a density that integrates to 1."""
    cdf = profiles.table.cumulative(np.zeros((8, 8), np.float32), profiles.table.bin_weights(8))
    weights = profiles.table.bin_weights(8)
    np.testing.assert_allclose(np.diff(cdf, axis=1), np.tile(weights / weights.sum(), (8, 1)))
