"""Arguments that defeat naive forms in float32: the renderer's functions there, and the right values."""

import numpy as np
import pytest
import warp as wp

from .brute_force import big_m, unit
from .float32_kernels import cap_kernel, response_kernel


def responses(*rows):
    """sinc^2, integral, integral of Eq. 29 and |D|^2 of rows (x, y, z)."""
    given = wp.array(np.pad(np.atleast_2d(np.array(rows, np.float32)), ((0, 0), (0, 1))), dtype=wp.vec4, device="cpu")
    out = wp.zeros(len(given), dtype=wp.vec4, device="cpu")
    wp.launch(response_kernel, len(given), inputs=[given], outputs=[out], device="cpu")
    return out.numpy().astype(float)


def intervals(axis, angle, u):
    """psi from, to, from, to of caps."""
    axis = np.atleast_2d(np.array(axis, np.float32))
    n = max(len(axis), np.size(u))
    given = [np.broadcast_to(axis, (n, 3)), np.broadcast_to(angle, n), np.broadcast_to(u, n)]
    kinds = (wp.vec3, float, float)
    arrays = [
        wp.array(np.ascontiguousarray(x, np.float32), dtype=k, device="cpu") for x, k in zip(given, kinds, strict=True)
    ]
    out = wp.zeros(n, dtype=wp.vec4, device="cpu")
    wp.launch(cap_kernel, n, inputs=arrays, outputs=[out], device="cpu")
    return out.numpy().astype(float)


def test_sinc_at_zero_below_every_normal_number_and_at_whole_cycles():
    value = responses((0, 0, 0), (1e-40, 0, 0), (1e-3, 0, 0), (500, 0, 0), (-3, 0, 0))[:, 0]
    np.testing.assert_allclose(value[:3], [1.0, 1.0, 1.0 - np.pi**2 * 1e-6 / 3], rtol=1e-6)
    assert np.all(value[3:] == 0.0)  # W = 100, q = 2, lambda 0.4: 500 cycles, 4e-9 if the phase is not reduced


def test_integrals_from_zero_and_of_short_intervals():
    # x = 1e-3: M = 5.0e-4, where (1 - cos x) / x is 4.6 % off; W 6 um, lambda 0.4 um over [1.9, 1.90002]: 1.1756e-7
    rows = [(1, 0, 1e-3 / (2 * np.pi)), (1, 0, 0), (15, 1.9, 1.90002), (15, -2, 2), (0, -1, 1)]
    value = responses(*rows)[:, 1]
    assert value[0] * np.pi == pytest.approx(5.0e-4, rel=1e-5)
    assert value[1] == 0.0
    # half a unit in the last place of either end: 0.6 % of the interval
    assert value[2] * 15 * np.pi == pytest.approx(1.1756e-7, rel=1e-2)
    assert value[3] * 15 * np.pi == pytest.approx(2 * big_m(60 * np.pi), rel=1e-6)
    assert value[4] == pytest.approx(2.0, rel=1e-6)  # no width: sinc is 1


def test_the_printed_integral_stays_finite():
    # x beyond 1.8e19 squares to infinity, tanh by exponentials of 100 is infinity over infinity
    value = responses((1e19, -2.0, 2.0), (16.0, 0.0, 1.0), (6 / 0.4, 0.148, 0.158))[:, 2]
    assert np.all(np.isfinite(value)) and value[1] > 0.0
    # [0.148, 0.158], 0.4 um, W = 6: Eq. 29 has 6.9e-5 of what is 5.7e-3; the exact one is right in float32
    k = 2 * np.pi / 0.4 * 6.0
    exact = big_m(k * 0.158) - big_m(k * 0.148)
    assert exact == pytest.approx(5.7e-3, rel=0.02)
    both = responses((15.0, 0.148, 0.158))[0] * 15.0 * np.pi
    assert both[1] == pytest.approx(exact, rel=2e-4)
    assert abs(both[2]) < 0.05 * exact


def test_depths_of_nearly_whole_turns_and_of_many():
    # 4 pi D / lambda is 2e-4 beyond three turns: 2 - 2 cos gives 0; rounding D moves the phase by 2e-6
    value = responses((0, 0.4 * (3.0 + 1e-4 / np.pi) / 2.0, 0.4), (0, 6.1, 0.38), (0, 0.55, 0.55), (0, 0.0, 0.4))[:, 3]
    assert value[0] == pytest.approx(4e-8, rel=0.1)
    assert value[1] == pytest.approx(0.421719, rel=1e-4)
    assert value[2] < 1e-12 and value[3] == 0.0


def test_small_and_tangent_caps():
    # half angle 1e-4: acos of sqrt(1 - R^2 / d^2) is 0 there
    for angle in (1e-4, 1e-3, 1e-2):
        axis = unit([0.3, 0.4, 0.8])
        found = intervals(axis, angle, np.float32(axis[0]))[0]
        wanted = 2.0 * np.arcsin(np.sin(angle / 2) / np.hypot(axis[1], axis[2]))
        assert 0.5 * (found[1] - found[0]) == pytest.approx(wanted, rel=2e-3)
    # a line that touches the cap: from 0.19996 to 0.20004 in xi_2, or nothing; no NaN
    along = 0.18678126 * np.cos(0.4) + 0.29611074 * np.sin(0.4)
    found = intervals([0.0, 0.0, 1.0], np.arctan(0.3), [-along, -along - 1e-7, -along + 1e-7])
    assert np.all(np.isfinite(found)) and np.abs(found).max() < 1e-3


def test_lights_along_the_scratch_and_slices_beyond_the_sphere():
    # rho = 0, |u| = 1 and a little more, a light around the horizon, one that takes all of a slice
    u = np.array([-1.0, -1.0 - 1e-7, 0.9999, 1.0, 1.0 + 1e-7, 0.5, 0.0])
    for axis in ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], unit([1.0, 1e-6, 1e-6]), [0.0, 1.0, 0.0], unit([0.0, 1.0, -0.1])):
        for angle in (1e-5, 0.3, 3.1):
            found = intervals(axis, angle, u)
            assert np.all(np.isfinite(found))
            for low, high in (found[:, :2].T, found[:, 2:].T):
                lit = high > low
                assert np.all(np.abs(np.concatenate([low[lit], high[lit]])) <= 0.5 * np.pi + 1e-6)
    np.testing.assert_allclose(intervals([1.0, 0.0, 0.0], 0.3, [0.99, 0.9])[:, :2], [[-np.pi / 2, np.pi / 2], [0, 0]])


def test_small_lights_everywhere():
    """3000 caps of 1e-4 to 1e-1: the naive arc cosine is up to 500 % off in float32, this 0.3 %."""
    rng = np.random.default_rng(0)
    axis = unit(rng.normal(size=(3000, 3))).astype(np.float32)
    axis = axis[np.abs(axis[:, 0]) < 0.95]
    angle = (10.0 ** rng.uniform(-4, -1, len(axis))).astype(np.float32)
    u = (axis[:, 0] + 0.6 * angle * rng.uniform(-1, 1, len(axis)) * np.hypot(axis[:, 1], axis[:, 2])).astype(np.float32)
    found = intervals(axis, angle, u)
    a, p, w = angle.astype(float), axis.astype(float), u.astype(float)
    p /= np.linalg.norm(p, axis=1, keepdims=True)
    half = np.arccos((np.cos(a) - w * p[:, 0]) / (np.sqrt(1 - w * w) * np.hypot(p[:, 1], p[:, 2])))
    whole = np.abs(np.arctan2(p[:, 1], p[:, 2])) + half < 0.5 * np.pi
    error = np.abs(0.5 * (found[:, 1] - found[:, 0]) / half - 1)[whole]
    # the axis is rounded to 6e-8, which is 6e-4 of the smallest radius
    assert whole.sum() > 1000 and np.quantile(error, 0.99) < 3e-3 and error.max() < 2e-2
