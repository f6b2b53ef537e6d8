"""Reflectance of single scratches and of fields of them: formula, device, and the field integrated on a grid."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from scratchwarp import diffraction, profiles

from . import brute_force
from .brute_force import pair, unit

Scratch = diffraction.Scratch


def _random(count, seed=2):
    rng = np.random.default_rng(seed)
    xi1, xi2 = rng.normal(0.0, 1.5e-3, count), rng.uniform(-1.2, 1.2, count)
    s = Scratch(rng.uniform(0.3, 8.0, count), rng.uniform(0.0, 8.0, count), 0.0, rng.normal(0.0, 40.0, count))
    return s, xi1, xi2, rng.uniform(380.0, 780.0, count)


@pytest.mark.parametrize("phase", ["small-angle", "angle-dependent"])
def test_formula(phase):
    s, xi1, xi2, wavelength = _random(500)
    w = pair(xi1, xi2)
    g = 2.0 * w[:, 2] if phase == "angle-dependent" else 2.0
    # xi comes back from unit vectors with 1e-16, times sigma k = 1e3 squared and xi_1
    expected = brute_force.brdf(s, wavelength, xi1, xi2, g)
    np.testing.assert_allclose(diffraction.brdf(w, w, s, wavelength, phase), expected, rtol=1e-9, atol=1e-13)


def test_float32_input_is_taken_at_its_word():
    s, xi1, xi2, wavelength = _random(500)
    w, wavelength = pair(xi1, xi2).astype(np.float32), wavelength.astype(np.float32)
    xi = 2.0 * unit(w)[:, :2]
    expected = brute_force.brdf(s, wavelength.astype(float), *xi.T)
    np.testing.assert_allclose(diffraction.brdf(w, w, s, wavelength), expected, rtol=1e-9, atol=1e-13)
    # and moves the result by sigma k (rounding of xi_1): 6e-8 times 1e3, times 2 x up to 5
    np.testing.assert_allclose(expected, brute_force.brdf(s, wavelength.astype(float), xi1, xi2), rtol=2e-3, atol=1e-7)


# The Gaussian is taken as constant over the width: (W / sigma)^2 / 24 of the amplitude and its neighbours' slopes
GRID = {"rtol": 4e-3, "atol": 4e-5}
VIEWS = unit([[0.0, 0.0, 1.0], [0.012, 0.1, 1.0], [-0.02, -0.31, 0.9], [0.0, 0.055, 1.0]])
LIGHTS = unit([[0.004, 0.02, 1.0], [-0.015, 0.12, 1.0], [0.018, 0.05, 0.9], [0.01, -0.4, 1.0]])


def _slot(w, d, offset):
    return lambda v: np.where(np.abs(v - offset) < 0.5 * w, -d, 0.0)


def _v_groove(v):
    return -0.5 * np.clip(np.minimum((v + 0.8) / 0.48, (0.8 - v) / 1.12), 0.0, None)


@pytest.mark.parametrize(
    ("scratch", "slot"),
    [
        (dict(width=0.96, depth=0.31, offset=2.0), (-np.inf, np.inf, _slot(0.96, 0.31, 2.0))),
        (dict(width=0.96, depth=0.31, offset=-2.0, ends=(-4, 9)), (-4.0, 9.0, _slot(0.96, 0.31, -2.0))),
        (dict(width=0.96, depth=0.31, ends=(5.0, np.inf)), (5.0, np.inf, _slot(0.96, 0.31, 0.0))),
        (
            dict(width=1.6, depth=0.5, profile=profiles.Profile([[0.0, 0.0], [0.3, -0.5], [1.0, 0.0]])),
            (-np.inf, np.inf, _v_groove),
        ),
    ],
    ids=["endless", "two ends", "one end", "v groove"],
)
@pytest.mark.parametrize("phase", ["small-angle", "angle-dependent"])
def test_field_on_a_grid(scratch, slot, phase):
    s = Scratch(**scratch, azimuth=0.4, coherence_radius=12.0)
    c, d = np.cos(0.4), np.sin(0.4)
    wi, wo = (w @ np.array([[c, d, 0], [-d, c, 0], [0, 0, 1]]) for w in (LIGHTS, VIEWS))
    dependent = phase == "angle-dependent"
    field = brute_force.field_brdf([(0.4, *slot)], 12.0, 550.0, wi, wo, 0.0, dependent=dependent)
    value = diffraction.brdf(wi, wo, s, 550.0, phase)
    np.testing.assert_allclose(value, field, **GRID)
    alone = diffraction.brdf_coherent(wi, wo, [s], 550.0, phase, base=False)
    np.testing.assert_allclose(alone, value, rtol=1e-12)
    # the mirror around it, interference and all: Eq. 1
    whole = brute_force.field_brdf([(0.4, *slot)], 12.0, 550.0, wi, wo, 1.0, dependent=dependent)
    np.testing.assert_allclose(diffraction.brdf_coherent(wi, wo, [s], 550.0, phase), whole, **GRID)


def test_crossing_azimuths_on_a_grid():
    scratches = [
        Scratch(0.96, 0.31, 0.0, 2.0, 12.0, ends=(1.0, 30.0)),
        Scratch(1.2, 0.2, 1.9, 3.0, 12.0, ends=(-8.0, 7.0)),
    ]
    slots = [(0.0, 1.0, 30.0, _slot(0.96, 0.31, 2.0)), (1.9, -8.0, 7.0, _slot(1.2, 0.2, 3.0))]
    field = brute_force.field_brdf(slots, 12.0, 450.0, LIGHTS, VIEWS, 1.0)
    np.testing.assert_allclose(diffraction.brdf_coherent(LIGHTS, VIEWS, scratches, 450.0), field, rtol=5e-3, atol=3e-4)
    # the order of the sum cannot matter
    backwards = diffraction.brdf_coherent(LIGHTS, VIEWS, scratches[::-1], 450.0)
    np.testing.assert_allclose(backwards, diffraction.brdf_coherent(LIGHTS, VIEWS, scratches, 450.0), rtol=1e-10)


def test_two_ends_far_apart_are_none_and_pieces_add_up():
    s = Scratch(azimuth=0.7, offset=20.0)
    w = pair(np.array([1e-3, 0.0, -2e-3]), 0.2)
    c, d = np.cos(0.7), np.sin(0.7)
    turned = np.stack((w[:, 0] * c - w[:, 1] * d, w[:, 0] * d + w[:, 1] * c, w[:, 2]), axis=-1)
    long = Scratch(azimuth=0.7, offset=20.0, ends=(-600.0, 600.0))
    np.testing.assert_allclose(diffraction.brdf(turned, turned, long, 550.0),
                               diffraction.brdf(turned, turned, s, 550.0), rtol=1e-9)  # fmt: skip
    pieces = [Scratch(azimuth=0.7, offset=20.0, ends=e) for e in ((-np.inf, -30.0), (-30.0, 17.0), (np.inf, 17.0))]
    np.testing.assert_allclose(diffraction.brdf_coherent(turned, turned, pieces, 550.0),
                               diffraction.brdf_coherent(turned, turned, [s], 550.0), rtol=1e-9)  # fmt: skip


def test_tail_of_an_end():
    # sigma 60, ends -50 and 60, xi_1 = 0.05 at 400 nm: |eta| = 1.20862, where the endless limit has 0
    s = Scratch(width=1.0, depth=0.1, ends=(-50.0, 60.0))
    w = pair(0.05, 0.0)
    f = diffraction.brdf(w, w, s, 400.0)
    eta = np.sqrt(f * np.pi * 60.0**2 * 0.4**2 / brute_force.depth_power(0.1, 400.0))
    np.testing.assert_allclose(eta, 1.20862, rtol=1e-5)
    assert diffraction.brdf(w, w, Scratch(width=1.0, depth=0.1), 400.0) < 1e-300


def test_hard_values():
    straight = pair(0.0, 0.0)
    one = {"width": 1.0, "coherence_radius": 60.0}
    scale = 2.0 / 0.4**2  # (W / lambda)^2 sinc^2 |eta|^2 / A_C
    # 4 pi D / lambda 2e-4 beyond whole turns: 2 - 2 cos is 0 in float32
    d = 0.4 * (3.0 + 1e-4 / np.pi) / 2.0
    np.testing.assert_allclose(diffraction.brdf(straight, straight, Scratch(depth=d, **one), 400.0), scale * 4e-8,
                               rtol=1e-6)  # fmt: skip
    value = diffraction.brdf(straight, straight, Scratch(depth=6.1, **one), 380.0)
    np.testing.assert_allclose(value, 2.0 / 0.38**2 * 0.421719, rtol=2e-6)
    w = pair(0.02, 0.0)
    value = diffraction.brdf(w, w, Scratch(depth=0.1, **one), 400.0)
    np.testing.assert_allclose(value, scale * 4.9e-155 * 4.0, rtol=0.02)
    # xi_2 = 0 and W xi_2 below every normal number; W xi_2 = 3 wavelengths exactly
    tiny = pair(0.0, np.array([0.0, 1e-320, 1e-30]))
    np.testing.assert_allclose(diffraction.brdf(tiny, tiny, Scratch(depth=0.1, **one), 400.0), scale * 4.0, rtol=1e-12)
    dark = pair(0.0, 1.2)
    assert diffraction.brdf(dark, dark, Scratch(depth=0.1, **one), 400.0) < 1e-25 * scale
    assert diffraction.brdf(straight, straight, Scratch(width=0.0), 400.0) == 0.0
    assert np.isfinite(diffraction.brdf(straight, straight, Scratch(1e6, 1e6, 0.0, 1e9, 1e-3), 400.0))


def test_horizon():
    below, level, up = unit([0.3, 0.1, -0.2]), [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]
    for wi, wo in ((below, up), (up, below), (level, up), (up, level), (below, below)):
        assert diffraction.brdf(wi, wo, Scratch(), 550.0) == 0.0
        assert diffraction.brdf_coherent(wi, wo, [Scratch()], 550.0) == 0.0


numbers = {"allow_nan": False}


@settings(max_examples=40, deadline=None)
@given(st.floats(0.3, 7.0), st.floats(0.0, 7.0), st.floats(-4.0, 4.0), st.floats(-90.0, 90.0), st.floats(380.0, 780.0),
       st.integers(0, 10**6))  # fmt: skip
def test_invariances(width, depth, azimuth, offset, wavelength, seed):
    rng = np.random.default_rng(seed)
    wo = unit(rng.normal(size=3) * [1, 1, 0] + [0, 0, 0.7])
    c, s = np.cos(azimuth), np.sin(azimuth)
    xi1, q = rng.normal(0.0, 1e-3), rng.uniform(-0.9, 0.9)
    u = xi1 - (wo[0] * c + wo[1] * s)
    v = q * np.sqrt(1.0 - u * u)
    wi = np.array([u * c - v * s, u * s + v * c, np.sqrt(1.0 - u * u - v * v)])
    scratch = Scratch(width, depth, azimuth, offset, ends=(-70.0, 35.0))
    for phase in ("small-angle", "angle-dependent"):
        f = diffraction.brdf(wi, wo, scratch, wavelength, phase)
        same = {"rtol": 1e-7, "atol": 1e-12}
        np.testing.assert_allclose(diffraction.brdf(wo, wi, scratch, wavelength, phase), f, **same)
        # all lengths and the wavelength together
        scaled = Scratch(2 * width, 2 * depth, azimuth, 2 * offset, 120.0, (-140.0, 70.0))
        np.testing.assert_allclose(diffraction.brdf(wi, wo, scaled, 2 * wavelength, phase), f, **same)
        # half a turn: u and v change sign, so do places along and across
        turned = Scratch(width, depth, azimuth + np.pi, -offset, ends=(70.0, -35.0))
        np.testing.assert_allclose(diffraction.brdf(wi, wo, turned, wavelength, phase), f, **same)
        assert f >= 0.0
    again = Scratch(width, depth, azimuth, 60.0)
    middle = Scratch(width, depth, azimuth, 0.0)
    np.testing.assert_allclose(diffraction.brdf(wi, wo, again, wavelength),
                               np.exp(-1.0) * diffraction.brdf(wi, wo, middle, wavelength), **same)  # fmt: skip
    invisible = Scratch(width, 3 * wavelength / 2e3, azimuth, offset)
    assert diffraction.brdf(wi, wo, invisible, wavelength) <= 1e-20 * (width / wavelength * 1e3) ** 2


def test_a_rectangle_by_its_outline():
    s, xi1, xi2, wavelength = _random(100)
    w = pair(xi1, xi2)
    outline = Scratch(s.width, s.depth, 0.0, s.offset, profile=profiles.shape("rectangle", depth=2.0))
    for phase in ("small-angle", "angle-dependent"):
        np.testing.assert_allclose(diffraction.brdf(w, w, outline, wavelength, phase),
                                   diffraction.brdf(w, w, s, wavelength, phase), rtol=1e-9, atol=1e-12)  # fmt: skip


@pytest.mark.parametrize(
    "profile",
    [
        profiles.shape("quartic"),
        profiles.shape("sine"),
        profiles.Profile([[0, 0], [2, -1], [3, -3], [7, 0.5], [8, 0]], isolated=True),
    ],
    ids=["quartic", "sine", "points"],
)
def test_parseval_of_outlines(profile):
    # the integral of |P|^2 over all xi_2 is lambda times that of |1 - e^{-i k g h}|^2 over v; slow tails from kinks
    wave, s = 0.5, Scratch(6.0, 0.9, profile=profile, coherence_radius=60.0)
    xi2 = np.linspace(-1.999, 1.999, 20001)
    w = pair(np.zeros_like(xi2), xi2)
    power = diffraction.brdf(w, w, s, 500.0) * wave**2 / 2.0
    line = profile.polyline(64)
    x = (np.arange(200000) + 0.5) / 200000 * profile.period + line[0, 0]
    h = np.interp(x, line[:, 0], line[:, 1]) / -line[:, 1].min() * 0.9
    field = np.mean(np.abs(1.0 - np.exp(-4j * np.pi * h / wave)) ** 2) * 6.0
    np.testing.assert_allclose(np.trapezoid(power, xi2) / wave, field, rtol=0.01)


def test_proportions_of_a_profile_and_what_is_under_an_overhang():
    w = pair(0.0, np.linspace(-1.0, 1.0, 21))
    groove = profiles.Profile([[10.0, 0.0], [12.0, -1.0], [14.0, 0.0]])
    own = diffraction.brdf(w, w, Scratch(3.0, None, profile=groove), 500.0)
    np.testing.assert_allclose(diffraction.brdf(w, w, Scratch(3.0, 0.75, profile=groove), 500.0), own, rtol=1e-12)
    undercut = profiles.Profile([[0, 0], [3, 0], [1, -1], [5, -1], [5, 0], [6, 0]])
    seen = profiles.Profile([[0, 0], [3, 0], [3, -1], [5, -1], [5, 0], [6, 0]])
    values = [diffraction.brdf(w, w, Scratch(6.0, 1.0, profile=p), 500.0) for p in (undercut, seen)]
    np.testing.assert_allclose(*values, rtol=1e-12)
    assert np.all(diffraction.brdf(w, w, Scratch(profile=profiles.shape("flat")), 500.0) == 0.0)


def test_spread_depths_and_rough_floors_are_means():
    rng = np.random.default_rng(0)
    w = pair(0.0, 0.1)
    depths = 1.2 + 0.05 * rng.standard_normal(200_000)
    mean = np.mean(brute_force.depth_power(depths, 550.0)) / brute_force.depth_power(1.2, 550.0)
    plain = diffraction.brdf(w, w, Scratch(), 550.0)
    spread = diffraction.brdf(w, w, Scratch(depth_spread=0.05), 550.0)
    np.testing.assert_allclose(spread / plain, mean, rtol=0.01)  # 1 / sqrt(200000) of values around their mean
    # a rough floor: the mean field
    field = np.abs(1.0 - np.mean(np.exp(4j * np.pi * depths / 0.55))) ** 2
    rough = diffraction.brdf(w, w, Scratch(roughness=0.05), 550.0)
    np.testing.assert_allclose(rough / plain, field / brute_force.depth_power(1.2, 550.0), rtol=0.01)
    coherent = diffraction.brdf_coherent(w, w, [Scratch(roughness=0.05)], 550.0, base=False)
    np.testing.assert_allclose(coherent, rough, rtol=1e-12)


def test_a_grating_shows_its_orders():
    # 145 lines, period 5 um, 550 nm: orders at m 0.11, heights (2 pi s^2 W / period)^2 sinc^2 |D|^2 / (A_C lambda^2),
    # full width at half maximum 2 sqrt(ln 2) / (s k) = 2.43e-3
    lines = [Scratch(1.5, 0.17, 0.0, 5.0 * (i - 72)) for i in range(145)]
    at = np.arange(-0.46, 0.46, 5e-5)
    w = pair(0.0, at)
    f = diffraction.brdf_coherent(w, w, lines, 550.0, base=False)
    order = np.arange(-4, 5)
    for m in order[order != 0]:
        near = np.abs(at - 0.11 * m) < 0.02
        peak = np.argmax(np.where(near, f, 0.0))
        assert abs(at[peak] - 0.11 * m) <= 5.1e-5
        height = (2 * np.pi * 3600.0 * 1.5 / 5.0 * np.sinc(1.5 * 0.11 * m / 0.55)) ** 2
        height *= brute_force.depth_power(0.17, 550.0) / (np.pi * 3600.0 * 0.55**2)
        np.testing.assert_allclose(f[peak], height, rtol=2e-3)
        np.testing.assert_allclose(np.sum(f[near] > 0.5 * f[peak]) * 5e-5, 2.43e-3, atol=1.5e-4)
    # incoherently there are none, but the same light
    alone = sum(diffraction.brdf(w, w, line, 550.0) for line in lines)
    smooth = at[:, None] - 0.11 * np.round(at / 0.11)[:, None]
    assert np.ptp(alone[np.abs(smooth[:, 0]) < 0.03]) < f.max()
    np.testing.assert_allclose(np.mean(alone), np.mean(f), rtol=0.02)


def test_energy_of_mirror_and_scratches_is_that_of_the_mirror():
    # Parseval: the whole field reflects everything, less what falls beyond the horizon; |D|^2 = 4, 2 and 0
    k = 2.0 * np.pi / 0.55
    xi2 = np.unique(np.concatenate([np.linspace(-1, 1, 8001), np.linspace(-0.008, 0.008, 401)]))
    xi1 = np.linspace(-6.0, 6.0, 61) / (60.0 * k)
    a, b = np.meshgrid(xi1, xi2, indexing="ij")
    inside = np.hypot(a, b) < 1.0
    wi = np.stack((a, b, np.sqrt(np.maximum(1.0 - a**2 - b**2, 0.0))), axis=-1)
    wi[~inside] = 0.0, 0.0, -1.0
    beyond = 1.0 - 2.0 * brute_force.big_m(k * 4.0) / np.pi  # share of the lobe below the horizon
    for depth in (0.55 / 4, 0.55 / 8, 0.55 / 2):
        f = diffraction.brdf_coherent(wi, [0.0, 0.0, 1.0], [Scratch(4.0, depth)], 550.0)
        total = np.trapezoid(np.trapezoid(f, xi2, axis=1), xi1)
        lost = 4.0 / (np.sqrt(np.pi) * 60.0) * brute_force.depth_power(depth, 550.0) * beyond
        # the Gaussian is constant over the width: (W / sigma)^2 / 12 of the scratch's share
        np.testing.assert_allclose(total, 1.0 - lost, atol=2e-4)


def test_leading_dimensions_broadcast():
    wi, wo = unit(np.ones((3, 1, 3))), unit(np.ones((4, 3)) * [-1, -1, 1])
    s = Scratch(width=np.linspace(1, 2, 4), ends=(-np.ones((5, 1, 1)), 3.0))
    f = diffraction.brdf(wi, wo, s, [[400.0], [500.0], [600.0]])
    assert f.shape == (5, 3, 4) and f.dtype == np.float64
    one = diffraction.brdf(unit([1, 1, 1]), unit([-1, -1, 1]), Scratch(width=1.0, ends=(-1.0, 3.0)), 500.0)
    assert one.shape == () and one == f[2, 1, 0]
    both = diffraction.brdf_coherent(wi, wo, [s, Scratch()], 500.0)
    assert both.shape == (5, 3, 4)
    assert diffraction.brdf_coherent(wi, wo, [], 500.0).shape == (3, 4)
    assert diffraction.brdf(np.zeros((0, 3)), wo[0], Scratch(), 500.0).shape == (0,)
