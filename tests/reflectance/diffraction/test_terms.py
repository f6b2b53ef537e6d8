"""The integrated sinc^2 and the error function of the ends, on the device, against SciPy."""

import numpy as np
import warp as wp
from scipy import special

from scratchwarp.reflectance.diffraction import lobe_tables

from . import brute_force, fit_lobe
from .probe_kernels import error_kernel, lobe_kernel


def _run(kernel, values, dtype):
    out = wp.zeros(len(values), dtype=wp.vec4d, device="cpu")
    inputs = [wp.array(values, dtype=dtype, device="cpu")]
    wp.launch(kernel, len(values), inputs=inputs, outputs=[out], device="cpu")
    return out.numpy()


def _lobe(x):
    return _run(lobe_kernel, np.asarray(x, float) / (2.0 * np.pi), wp.float64)


def test_coefficients_are_those_of_the_fit():
    for shipped, (powers, error) in zip(
        (lobe_tables.INNER, lobe_tables.ONE_MINUS_XF, lobe_tables.XXG), fit_lobe.fit(), strict=True
    ):
        # least squares repeats to rounding times its conditioning
        np.testing.assert_allclose(shipped, powers, rtol=1e-5, atol=1e-9)
        assert error < 2e-9


def test_integrated_lobe_against_scipy():
    x = np.concatenate((np.linspace(0.0, 40.0, 4001), np.geomspace(40.0, 3e3, 500), [1e-30, 1e-8, 7.999999, 8.000001]))
    x = np.concatenate((-x, x))
    _, half, rest, _ = _lobe(x).T
    # fit error 1.3e-9 / 8^3 = 2.5e-12 at the worst place
    np.testing.assert_allclose(half * np.pi / 2 + rest, brute_force.big_m(x), atol=3e-12)
    assert np.all((half * np.pi / 2 + rest)[: len(x) // 2] == -(half * np.pi / 2 + rest)[len(x) // 2 :])  # odd
    # complement of pi / 2: relative, where SciPy's own difference still has the digits
    far = (x > 8.0) & (x < 200.0)
    np.testing.assert_allclose(-rest[far], np.pi / 2 - brute_force.big_m(x[far]), rtol=1e-10)


def test_integrated_lobe_grows():
    x = np.linspace(0.0, 300.0, 30001)
    _, half, rest, paper = _lobe(x).T
    # slope 0 at x = 2 pi n: there rounding may take 1e-15, the seam at 8 3e-12
    assert np.diff(half * np.pi / 2 + rest).min() > -3e-12
    falling = np.mean(np.diff(paper)[100:6000] < 0.0)
    assert 0.1 < falling < 0.3  # notes: 18 % of [1, 60]


def test_equation_29_is_as_bad_as_known():
    x = np.linspace(0.01, 200.0, 200001)
    paper = _lobe(x)[:, 3]
    error = paper - brute_force.big_m(x)
    worst = np.argmax(np.abs(error))
    np.testing.assert_allclose([abs(error[worst]), x[worst]], [0.0510, 3.56], rtol=3e-3)
    np.testing.assert_allclose(abs(error[x > 199.0]).mean() * 199.5, 0.339, rtol=0.05)  # and terms of 1 / x^2
    assert np.all(np.isfinite(_lobe([1e19, 1e30, -1e200, 0.0])[:, 3]))


def test_hard_arguments():
    # (1 - cos x) / x^2 / 1 at 1e-3 and the rest: M(x) -> x / 2; zeros of sinc at whole cycles, 1 at 0
    value = _lobe([0.0, 1e-3, 1e-200, 200 * np.pi, 2e3 * np.pi])
    np.testing.assert_allclose(value[:3, 2], [0.0, 5.0e-4 - 1e-9 / 72, 5e-201], rtol=1e-10)
    np.testing.assert_allclose(value[:, 0], [1.0, 1.0 - 1e-6 / 24, 1.0, 0.0, 0.0], atol=1e-13)
    # 94 [1.9, 1.90002]: the difference of two M
    a, b = _lobe(94.0 * np.array([1.9, 1.90002]))[:, 2]
    x = np.linspace(1.9, 1.90002, 9) * 94.0
    exact = np.trapezoid((1.0 - np.cos(x)) / x**2, x)
    np.testing.assert_allclose(b - a, exact, rtol=1e-7)


def test_faddeeva_and_damped_erf_against_scipy():
    rng = np.random.default_rng(3)
    z = np.stack((rng.normal(0.0, 20.0, 400), np.abs(rng.normal(0.0, 8.0, 400)), rng.normal(0.0, 3.0, 400)), axis=1)
    value = _run(error_kernel, z, wp.vec3d)
    w = special.wofz(z[:, 0] + 1j * z[:, 1])
    np.testing.assert_allclose(value[:, 0] + 1j * value[:, 1], w, atol=1e-12)
    z = rng.normal(0.0, 1.5, (400, 3))
    value = _run(error_kernel, z, wp.vec3d)
    y = z[:, 2]
    exact = np.exp(-y * y) * (special.erf(z[:, 1] + 1j * y) - special.erf(z[:, 0] + 1j * y))
    np.testing.assert_allclose(value[:, 2] + 1j * value[:, 3], exact, atol=1e-12)


def test_ends_where_the_naive_product_is_zero_times_infinity():
    y = 40.0  # e^{-1600}
    ends = [[-0.6, 0.7, y], [-np.inf, 0.7, y], [-np.inf, np.inf, y], [-np.inf, np.inf, 0.5], [3.0, 3.0, 2.0]]
    value = _run(error_kernel, np.array(ends), wp.vec3d)[:, 2:]
    tail = [-np.exp(-x * x - 2j * x * y) * special.wofz(-y + 1j * x) for x in (0.7, 0.6)]
    expected = [tail[0] + np.conj(tail[1]), tail[0], 0.0, 2.0 * np.exp(-0.25), 0.0]
    np.testing.assert_allclose(value @ [1.0, 1j], expected, atol=1e-13)
