"""Footprints: closed forms, the device and SciPy's quadrature."""

import numpy as np
import pytest
from scipy import integrate

from scratchwarp import diffraction

footprint, coverage = diffraction.footprint, diffraction.coverage
METHODS = ("gaussian", "paper", "exact")
SIGMA = 60.0
CORE = np.pi * SIGMA**2


def _mean(a1, a2, angle, offset, width):
    """Mean of e^{-(s_b / width)^2} over an ellipse, in polar coordinates of the ellipse."""

    def inner(t):
        reach = a1 * np.cos(t) * np.sin(angle) + a2 * np.sin(t) * np.cos(angle)
        return integrate.quad(lambda r: 2.0 * r * np.exp(-(((r * reach - offset) / width) ** 2)), 0.0, 1.0)[0]

    return integrate.quad(inner, 0.0, 2.0 * np.pi, limit=200)[0] / (2.0 * np.pi)


@pytest.mark.parametrize("a1", [3.0, 50.0, 400.0])
@pytest.mark.parametrize("angle", [0.0, 0.4, np.pi / 2])
def test_exact_against_scipy(a1, angle):
    for offset in (0.0, -45.0, 120.0):
        mean = _mean(a1, 70.0, angle, offset, SIGMA)
        np.testing.assert_allclose(footprint(a1, 70.0, angle, offset, method="exact"), 2.0 * CORE * mean, rtol=1e-7)
        density = 2.0 * np.sqrt(2.0 * np.pi) * SIGMA / CORE * _mean(a1, 70.0, angle, offset, np.sqrt(2.0) * SIGMA)
        np.testing.assert_allclose(coverage(a1, 70.0, angle, offset, 2.0, method="exact"), density, rtol=1e-7)


def test_ratios_to_exact():
    # A_P / A_C: 0.1, 1, 3.16, 10, 100; a scratch through the middle of a round footprint
    ratio = np.array([0.1, 1.0, 3.16, 10.0, 100.0])
    a = SIGMA * np.sqrt(ratio)
    exact = footprint(a, a, 0.0, 0.0, method="exact")
    np.testing.assert_allclose(footprint(a, a, 0.0, 0.0, method="gaussian") / exact, [1.0, 1.02, 1.08, 1.175, 1.24],
                               rtol=4e-3)  # fmt: skip
    np.testing.assert_allclose(footprint(a, a, 0.0, 0.0, method="paper") / exact, [1.16, 1.33, 1.10, 1.027, 1.003],
                               rtol=4e-3)  # fmt: skip
    exact = coverage(a, a, 0.0, 0.0, 0.1, method="exact")
    np.testing.assert_allclose(coverage(a, a, 0.0, 0.0, 0.1, method="paper") / exact, [5.11, 1.80, 1.25, 1.059, 1.005],
                               rtol=5e-3)  # fmt: skip


@pytest.mark.parametrize("method", METHODS)
def test_means_over_offsets(method):
    # of |eta_s|^2: 2 A_C sigma sqrt(pi); of the density: 2 W
    offset = np.linspace(-1500.0, 1500.0, 30001)
    for a1, a2, angle in ((20.0, 20.0, 0.0), (60.0, 60.0, 0.0), (300.0, 90.0, 0.7)):
        total = np.trapezoid(footprint(a1, a2, angle, offset, method=method), offset)
        np.testing.assert_allclose(total, 2.0 * CORE * SIGMA * np.sqrt(np.pi), rtol=1e-4)
        total = np.trapezoid(coverage(a1, a2, angle, offset, 1.5, method=method), offset)
        np.testing.assert_allclose(total, 2.0 * 1.5, rtol=3e-4)  # square roots at the ends of the ellipse


def test_gaussian_is_the_integral_over_a_gaussian_footprint():
    rng = np.random.default_rng(1)
    x, y = rng.standard_normal((2, 400_000))
    for a1, a2, angle, offset in ((80.0, 30.0, 0.3, 20.0), (10.0, 200.0, 1.2, -50.0)):
        across = 0.5 * a1 * x * np.sin(angle) + 0.5 * a2 * y * np.cos(angle)
        mean = np.mean(np.exp(-(((across - offset) / SIGMA) ** 2)))
        np.testing.assert_allclose(footprint(a1, a2, angle, offset), 2.0 * CORE * mean, rtol=4e-3)  # 4 / sqrt(4e5)


@pytest.mark.parametrize("method", METHODS)
def test_points_and_lines_for_footprints(method):
    for offset in (0.0, 30.0):
        point = footprint(0.0, 0.0, 0.0, offset, method=method)
        np.testing.assert_allclose(point, 2.0 * CORE * np.exp(-((offset / SIGMA) ** 2)), rtol=1e-12)
    # edge-on footprints: a2 -> 0 with a limit
    thin = [footprint(80.0, a2, 0.5, 10.0, method=method) for a2 in (0.0, 1e-9)]
    np.testing.assert_allclose(*thin, rtol=1e-6)
    assert np.isfinite(coverage(80.0, 0.0, 0.5, 10.0, 3.0, method=method))
    assert footprint(5.0, 5.0, 0.0, 1e6, method=method) == 0.0 == coverage(5.0, 5.0, 0.0, 1e6, 3.0, method=method)
    assert np.isfinite(footprint(1e9, 1e-9, 1e-9, 0.3, method=method))


def test_hard_values():
    # next to the edge, of a float32: h = 60, s_b = 59.9999; 2 W l / A_P
    edge = np.float32(59.9999)
    np.testing.assert_allclose(coverage(60.0, 60.0, 0.0, edge, 1.0, method="paper") * np.pi * 1800.0, 0.2182, rtol=2e-4)
    # a 6 um scratch under a footprint of 5 um: 2 W l / A_P is 1.53, the density 0.080
    assert coverage(5.0, 5.0, 0.0, 0.0, 6.0, method="paper") == 1.0
    for method in ("gaussian", "exact"):
        np.testing.assert_allclose(coverage(5.0, 5.0, 0.0, 0.0, 6.0, method=method), 0.080, atol=5e-4)
    assert coverage(5.0, 5.0, 0.0, 0.0, 600.0, method="exact") == 1.0


def test_symmetries_and_shapes():
    a1, angle, offset = np.array([[10.0], [300.0]]), np.array([0.0, 0.8, 2.0]), 25.0
    for method in METHODS:
        value = footprint(a1, 90.0, angle, offset, 40.0, method)
        assert value.shape == (2, 3) and value.dtype == np.float64
        np.testing.assert_allclose(footprint(a1, 90.0, angle, -offset, 40.0, method), value, rtol=1e-12)
        np.testing.assert_allclose(footprint(90.0, a1, angle + np.pi / 2, offset, 40.0, method), value, rtol=1e-9)
        scaled = footprint(3 * a1, 270.0, angle, 75.0, 120.0, method)
        np.testing.assert_allclose(scaled, 9.0 * value, rtol=1e-12)
