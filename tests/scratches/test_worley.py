"""Worley coverage: the mean formula, the device function, and a brute force that shares no code with either."""

import numpy as np
import pytest
import warp as wp

from scratchwarp.scratches import worley
from scratchwarp.scratches.layer_device import LayerData
from scratchwarp.scratches.worley_device import chord_coverage, count_bits, few_cells, interval_bits
from scratchwarp.scratches.worley_device import worley as noise

wp.set_module_options({"enable_backward": False})


@wp.kernel
def chords(
    p: wp.array(dtype=wp.vec2),
    cell: wp.array(dtype=wp.vec2i),
    a: wp.vec2,
    radius: float,
    variation: float,
    out: wp.array(dtype=float),
):
    i = wp.tid()
    phase = wp.randf(wp.rand_init(7, i))
    out[i] = chord_coverage(p[i], a, cell[i][0], cell[i][1], radius, variation, wp.uint32(77), phase, 0.0).fraction


@wp.kernel
def short_ways(
    p: wp.array(dtype=wp.vec2),
    a: wp.array(dtype=wp.vec2),
    radius: float,
    variation: float,
    out: wp.array2d(dtype=float),
):
    i = wp.tid()
    phase = wp.randf(wp.rand_init(7, i))
    out[i, 0] = few_cells(p[i], a[i], i, 3 * i, radius, variation, wp.uint32(77), phase)
    out[i, 1] = chord_coverage(p[i], a[i], i, 3 * i, radius, variation, wp.uint32(77), phase, 0.0).fraction


@wp.kernel
def bits(t0: wp.array(dtype=float), t1: wp.array(dtype=float), phase: float, out: wp.array(dtype=int)):
    i = wp.tid()
    out[i] = count_bits(interval_bits(t0[i], t1[i], phase))


def run_chords(n, a, radius, variation=0.0, seed=0):
    rng = np.random.default_rng(seed)
    p = wp.array(rng.random((n, 2)).astype(np.float32), dtype=wp.vec2, device="cpu")
    cells = wp.array(rng.integers(-100000, 100000, (n, 2)).astype(np.int32), dtype=wp.vec2i, device="cpu")
    out = wp.zeros(n, dtype=float, device="cpu")
    wp.launch(chords, dim=n, inputs=[p, cells, wp.vec2(*a), radius, variation, out], device="cpu")
    return out.numpy()


@pytest.mark.parametrize("radius", [0.05, 0.3, 0.6, 1.0])
def test_mean_matches_brute_force(radius):
    """Jittered points thrown with NumPy, nearest distance by exhaustion: 5 sigma of the binomial."""
    rng = np.random.default_rng(1)
    n = 40000
    x = rng.random((n, 2))
    grid = np.array([(i, j) for i in range(-2, 3) for j in range(-2, 3)])
    points = grid + rng.random((n, 25, 2))
    hit = (((points - x[:, None]) ** 2).sum(-1).min(1) <= radius**2).mean()
    expected = worley.coverage(radius)
    assert abs(hit - expected) < 5 * np.sqrt(expected * (1 - expected) / n) + 1e-4


@pytest.mark.parametrize("variation", [0.0, 0.4])
def test_short_footprints_are_covered_as_any_other(variation):
    """Both ways round the ends of an interval on their own: one of 64 points each, two where disks join."""
    rng = np.random.default_rng(3)
    n, radius = 20000, 0.18
    a = rng.uniform(-1, 1, (n, 2)) * 10 ** rng.uniform(-3, 0, (n, 1))
    out = wp.zeros((n, 2), dtype=float, device="cpu")
    p = wp.array(rng.random((n, 2)), dtype=wp.vec2, device="cpu")
    wp.launch(short_ways, n, inputs=[p, wp.array(a, dtype=wp.vec2, device="cpu"), radius, variation, out], device="cpu")
    few, any_length = out.numpy().T
    short = few >= 0
    fits = (np.abs(a) / 2 + radius * (1 + variation) <= 0.5).all(1)
    assert fits.mean() > 0.4 and (short == fits).all()
    off = np.abs(few - any_length)[short]
    assert off.max() <= 2.01 / 64 and (off == 0).mean() > 0.999
    assert (any_length[short] > 0).mean() > 0.05


@pytest.mark.parametrize("a", [(0.0, 0.0), (0.001, 0.7), (5.0, 0.2), (3.0, -11.0)])
@pytest.mark.parametrize("variation", [0.0, 0.5])
def test_device_mean_is_preserved_for_every_footprint(a, variation):
    """One sample's variance is at most a (1 - a), so n samples lie within 5 sqrt(a (1 - a) / n)."""
    n = 40000
    expected = worley.coverage(0.35, variation)
    got = run_chords(n, a, 0.35, variation).mean()
    assert abs(got - expected) < 5 * np.sqrt(expected * (1 - expected) / n) + 1e-4


def test_chord_equals_the_mean_of_points_along_it():
    """The interval bits of a chord are the 64 point samples on it: compare with point footprints, same phase 0."""
    n = 200
    rng = np.random.default_rng(3)
    p = rng.random((n, 2)).astype(np.float32)
    cells = rng.integers(-1000, 1000, (n, 2)).astype(np.int32)
    a = np.array([0.8, 2.5], np.float32)

    @wp.kernel(module="unique")
    def at_zero_phase(
        p: wp.array(dtype=wp.vec2), cell: wp.array(dtype=wp.vec2i), a: wp.vec2, out: wp.array(dtype=float)
    ):
        i = wp.tid()
        out[i] = chord_coverage(p[i], a, cell[i][0], cell[i][1], 0.35, 0.0, wp.uint32(77), 0.5, 0.0).fraction

    def launch(points, cell, axis):
        out = wp.zeros(len(points), dtype=float, device="cpu")
        inputs = [
            wp.array(points, dtype=wp.vec2, device="cpu"),
            wp.array(cell, dtype=wp.vec2i, device="cpu"),
            wp.vec2(*axis),
            out,
        ]
        wp.launch(at_zero_phase, dim=len(points), inputs=inputs, device="cpu")
        return out.numpy()

    chord = launch(p, cells, a)
    t = (np.arange(64) + 0.5) / 64 - 0.5
    every = (p[:, None] + t[:, None].astype(np.float32) * a).reshape(-1, 2)
    points = launch(every, np.repeat(cells, 64, axis=0), (0.0, 0.0)).reshape(n, 64).mean(1)
    # rounding moves an interval's end past at most one sample of a few ends
    assert np.abs(chord - points).max() <= 2 / 64
    assert np.abs(chord - points).mean() < 1e-3


def test_bits_count_the_samples_of_an_interval():
    t0 = np.array([0.0, 0.1, -3.0, 0.5, 0.9], np.float32)
    t1 = np.array([1.0, 0.2, 5.0, 0.4, 0.95], np.float32)
    out = wp.zeros(5, dtype=int, device="cpu")
    wp.launch(
        bits,
        dim=5,
        inputs=[wp.array(t0, dtype=float, device="cpu"), wp.array(t1, dtype=float, device="cpu"), 0.5, out],
        device="cpu",
    )
    at = (np.arange(64) + 0.5) / 64
    assert out.numpy().tolist() == [int(((at >= a) & (at <= b)).sum()) for a, b in zip(t0, t1, strict=True)]


@pytest.mark.parametrize("wanted", [0.001, 0.1, 0.5, 0.9, 0.999])
def test_threshold_inverts_coverage(wanted):
    assert worley.coverage(worley.threshold(wanted)) == pytest.approx(wanted, abs=1e-6)


@wp.kernel
def pattern(layer: LayerData, q: wp.array(dtype=wp.vec2d), out: wp.array(dtype=float)):
    i = wp.tid()
    one = wp.vec2d(wp.float64(1.0), wp.float64(1.0))
    nought = wp.vec2(0.0, 0.0)
    out[i] = noise(layer, q[i], one, nought, nought, 0.5).alpha


def test_a_hundred_repeats_show_no_tiles():
    """Units of 1 mm, scratches of 20 by 400 um, coverage at 40,000 points of 10 x 10 units and at the same points whole
    units further: 4800 scratches there make correlations of 1 / sqrt(4800) = 0.015, the points 0.005. Within a
    scratch's size the correlation is high, so the test can see one."""
    d = LayerData()
    d.cos_a, d.sin_a = 1.0, 0.0
    d.radius = worley.threshold(0.3)
    d.inv_length, d.inv_width = 2 * d.radius / 400.0, 2 * d.radius / 20.0
    d.mean, d.seed = 0.3, 1234
    rng = np.random.default_rng(0)
    n = 40000
    inside = rng.random((n, 2)) * 10000.0

    def covered(shift):
        out = wp.zeros(n, dtype=float, device="cpu")
        points = wp.array(inside + shift, dtype=wp.vec2d, device="cpu")
        wp.launch(pattern, dim=n, inputs=[d, points, out], device="cpu")
        return out.numpy() - 0.3

    first = covered((0.0, 0.0))
    variance = (first**2).mean()
    assert (first * covered((10.0, 0.0))).mean() / variance > 0.7
    for shift in ((1, 0), (0, 1), (1, 1), (7, 13), (99, 0), (0, 99), (50, 99), (-3, 2), (1e6, 1e6)):
        assert abs((first * covered(np.array(shift) * 1000.0)).mean()) / variance < 0.08
    # 10 cm along a line of scratches: some 250 of them, 4.3 sigma over all distances
    inside = np.stack([np.arange(n) * 2.5, np.full(n, 123.0)], 1)
    values = covered((0.0, 0.0))
    power = np.abs(np.fft.rfft(values - values.mean())) ** 2
    correlation = np.fft.irfft(power)
    assert np.abs(correlation[1600 : n // 2]).max() < 0.35 * correlation[0]
