"""Sobol points, pixel filters and warps of the unit square against what defines them."""

import numpy as np
import pytest
import warp as wp
from scipy import stats

from scratchwarp.optics import filters_device as fd
from scratchwarp.optics import sampling_device as sd
from scratchwarp.optics import sobol_device as so

wp.set_module_options({"enable_backward": False})

LOWEST_P = 1e-4  # fixed seeds: a right sampler fails one test in ten thousand once, when written, and never again


@wp.kernel
def _pairs(first: int, seed: wp.uint32, out: wp.array2d(dtype=wp.vec2)):
    p, i = wp.tid()
    out[p, i] = sd.sobol_2d(wp.uint32(first + i), p, seed)


@wp.kernel
def _lines(seed: wp.uint32, out: wp.array2d(dtype=float)):
    p, i = wp.tid()
    out[p, i] = sd.sobol_1d(wp.uint32(i), p, seed)


@wp.kernel
def _seeds(index: wp.uint32, pair: int, out: wp.array(dtype=wp.vec2)):
    i = wp.tid()
    out[i] = sd.sobol_2d(index, pair, sd.pixel_seed(i % 256, i // 256, wp.uint32(7)))


@wp.kernel
def _pascal(out: wp.array(dtype=wp.uint32)):
    i = wp.tid()
    out[i] = so.pascal_bits(so.reverse_bits(wp.uint32(i)))


@wp.kernel
def _filters(u: wp.array(dtype=float), out: wp.array(dtype=wp.vec3)):
    i = wp.tid()
    p = wp.vec2(u[i], u[i])
    out[i] = wp.vec3(sd.filter_offset_box(p, 2.0)[0], sd.filter_offset_gaussian(p, 3.0)[1],
                     sd.filter_offset_blackman_harris(p, 1.0)[0])  # fmt: skip


@wp.kernel
def _warps(seed: wp.uint32, cap: float, disk: wp.array(dtype=wp.vec2), hemi: wp.array(dtype=wp.vec3),
           cone: wp.array(dtype=wp.vec3)):  # fmt: skip
    i = wp.tid()
    key = seed + wp.uint32(2 * i)
    u = wp.vec2(sd.unit_float(sd.pcg_hash(key)), sd.unit_float(sd.pcg_hash(key + wp.uint32(1))))
    disk[i] = sd.sample_concentric_disk(u)
    hemi[i] = sd.sample_cosine_hemisphere(u)
    cone[i] = sd.sample_cone(u, cap)


def _sobol(pairs, count, first=0, seed=3):
    out = wp.zeros((pairs, count), dtype=wp.vec2, device="cpu")
    wp.launch(_pairs, (pairs, count), inputs=[first, wp.uint32(seed)], outputs=[out], device="cpu")
    return out.numpy().astype(float)


@pytest.mark.parametrize("first_block", [0, 5])
def test_each_pair_is_a_0_2_sequence(first_block):
    for m in range(11):
        count = 1 << m
        points = _sobol(6, count, first=first_block * count)
        assert points.min() >= 0.0 and points.max() < 1.0
        for a in range(m + 1):
            cell = (points[..., 0] * (1 << a)).astype(int) << (m - a) | (points[..., 1] * (1 << (m - a))).astype(int)
            assert all(len(set(row)) == count for row in cell), (m, a)


def test_one_dimensional_streams_are_stratified():
    for m in range(11):
        out = wp.zeros((5, 1 << m), dtype=float, device="cpu")
        wp.launch(_lines, (5, 1 << m), inputs=[wp.uint32(9)], outputs=[out], device="cpu")
        assert all(sorted(row) == list(range(1 << m)) for row in (out.numpy() * (1 << m)).astype(int))


def test_second_coordinate_is_pascals_triangle():
    # direction numbers of the second Sobol dimension: v_1 = 1/2, v_{j+1} = v_j xor (v_j >> 1)
    out = wp.zeros(512, dtype=wp.uint32, device="cpu")
    wp.launch(_pascal, 512, outputs=[out], device="cpu")
    expected = []
    for index in range(512):
        value, direction = 0, 1 << 31
        for bit in range(9):
            if index >> bit & 1:
                value ^= direction
            direction ^= direction >> 1
        expected.append(value)
    assert out.numpy().tolist() == expected


def test_the_same_point_over_all_pixels_is_uniform():
    for index, pair in ((0, 0), (1, 0), (37, 5)):
        out = wp.zeros(65536, dtype=wp.vec2, device="cpu")
        wp.launch(_seeds, 65536, inputs=[wp.uint32(index), pair], outputs=[out], device="cpu")
        histogram, _, _ = np.histogram2d(*out.numpy().T, bins=16, range=[[0, 1], [0, 1]])
        assert stats.chisquare(histogram.ravel()).pvalue > LOWEST_P


def test_different_pairs_are_independent():
    # over pixels, where the draws are independent (within one pixel both coordinates are stratified: not multinomial)
    draws = {}
    for pair in (0, 1, 6):
        out = wp.zeros(65536, dtype=wp.vec2, device="cpu")
        wp.launch(_seeds, 65536, inputs=[wp.uint32(5), pair], outputs=[out], device="cpu")
        draws[pair] = out.numpy()
    for p, q in ((0, 1), (1, 6)):
        histogram, _, _ = np.histogram2d(draws[p][:, 0], draws[q][:, 1], bins=16, range=[[0, 1], [0, 1]])
        assert stats.chisquare(histogram.ravel()).pvalue > LOWEST_P


def test_points_depend_on_their_key_alone():
    whole = _sobol(3, 64)
    np.testing.assert_array_equal(_sobol(3, 32, first=32), whole[:, 32:])
    assert not np.any(np.all(whole == _sobol(3, 64, seed=4), axis=-1))


def test_scrambled_points_integrate_better_than_random_ones():
    # smooth integrand of mean 0: at 1024 points the root mean square of random sampling is 0.5 / 32 = 0.016
    errors = [np.mean(np.prod(np.sin(2 * np.pi * _sobol(1, 1024, seed=s)[0] + 0.3), axis=1)) for s in range(20)]
    assert np.sqrt(np.mean(np.square(errors))) < 0.002


def test_filters_invert_their_distribution():
    u = ((np.arange(4096) + 0.5) / 4096).astype(np.float32)
    out = wp.zeros(len(u), dtype=wp.vec3, device="cpu")
    wp.launch(_filters, len(u), inputs=[wp.array(u, device="cpu")], outputs=[out], device="cpu")
    box, gauss, window = out.numpy().astype(float).T
    np.testing.assert_allclose(box, 2.0 * u - 1.0, atol=1e-6)
    # width 3 is sigma 0.5 cut at 3 sigma
    np.testing.assert_allclose(stats.truncnorm.cdf(gauss / 0.5, -3, 3), u, atol=1e-6)
    # the CDF of the window by the midpoint rule, not by its sines
    fine = (np.arange(200000) + 0.5) / 200000 - 0.5
    weight = sum(a * np.cos(2 * np.pi * j * fine) for j, a in enumerate((0.35875, 0.48829, 0.14128, 0.01168)))
    cdf = np.cumsum(weight) / weight.sum()
    np.testing.assert_allclose(np.interp(window, fine + 0.5 / 200000, cdf), u, atol=2e-6)
    assert np.all(np.diff(window) > 0)


def test_filters_are_finite_at_the_ends():
    u = np.array([0.0, 1.0 - 2.0**-24], np.float32)
    out = wp.zeros(2, dtype=wp.vec3, device="cpu")
    wp.launch(_filters, 2, inputs=[wp.array(u, device="cpu")], outputs=[out], device="cpu")
    ends = np.abs(out.numpy())
    assert np.all(ends <= [1.0, 1.5, 0.5]) and np.all(ends > [0.99, 1.4, 0.48])
    assert fd.filter_offset_gaussian is sd.filter_offset_gaussian


@pytest.mark.parametrize("cap", [2.0, 0.3, 1e-5])
def test_warps_have_the_density_they_say(cap):
    n = 200_000
    disk = wp.zeros(n, dtype=wp.vec2, device="cpu")
    hemi, cone = (wp.zeros(n, dtype=wp.vec3, device="cpu") for _ in range(2))
    wp.launch(_warps, n, inputs=[wp.uint32(11), cap], outputs=[disk, hemi, cone], device="cpu")
    disk, hemi, cone = (a.numpy().astype(float) for a in (disk, hemi, cone))
    for flat in (np.sum(disk**2, axis=1), np.sum(hemi[:, :2] ** 2, axis=1)):  # both uniform in the squared radius
        assert stats.chisquare(np.histogram(flat, 32, (0, 1))[0]).pvalue > LOWEST_P
    for azimuth in (np.arctan2(disk[:, 1], disk[:, 0]), np.arctan2(cone[:, 1], cone[:, 0])):
        assert stats.chisquare(np.histogram(azimuth, 32, (-np.pi, np.pi))[0]).pvalue > LOWEST_P
    # uniform in 1 - cos, which the radius gives without loss near the axis
    radius2 = np.sum(cone[:, :2] ** 2, axis=1)
    drop = np.where(cone[:, 2] > 0.5, radius2 / (1.0 + np.sqrt(np.maximum(1.0 - radius2, 0.0))), 1.0 - cone[:, 2])
    assert stats.chisquare(np.histogram(drop, 32, (0, cap * 1.000001))[0]).pvalue > LOWEST_P
    np.testing.assert_allclose(np.linalg.norm(cone, axis=1), 1.0, atol=3e-7)
    np.testing.assert_allclose(np.linalg.norm(hemi, axis=1), 1.0, atol=3e-7)
