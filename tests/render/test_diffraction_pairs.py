"""Close scratches that interfere, against the library's coherent sum (Velinov 2018 Eq. 1 with all cross terms)."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import diffraction
from scratchwarp.kernels import kernel_key
from scratchwarp.reflectance.diffraction.color import spectral_samples
from scratchwarp.scene import Curves, DistantLight, SphereLight, Wave

from . import scenes
from .test_diffraction import LUMINANCE, SIGMA, render, straight_down, waves

FINE = np.arange(380.25, 780.0, 0.25)
_, WEIGHTS = spectral_samples(FINE)
UP = np.array([0.0, 0.0, 1.0])


def strokes(offsets, widths, depths, turns=0.0, azimuth=0.0, length=0.004):
    """Straight scratches ``offsets`` micrometres aside of the middle of the view, 1 m below the camera."""
    offsets = np.asarray(offsets, float)
    turns = azimuth + np.broadcast_to(turns, offsets.shape)
    aside = 1e-6 * offsets[:, None] * np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    along = 0.5 * length * np.stack([np.cos(turns), np.sin(turns), 0.0 * turns], axis=1)
    points = np.stack([aside - along, aside + along], axis=1).reshape(-1, 3) - [0, 0, 1.0]
    sizes = [np.repeat(np.broadcast_to(x, offsets.shape), 2) for x in (widths, depths)]
    return Curves("/c", points, np.full(len(offsets), 2), *sizes)


def material(**wave):
    return waves(wave=Wave(coherence_radius=SIGMA, summation="coherent", **wave))


def seen(omega_i, curves, pixel=1e-6, **wave):
    """Scratches' radiance over irradiance in the middle of the view for a footprint of ``pixel`` metres."""
    light = DistantLight(path="/l", radiance=np.ones(3), direction=-omega_i)
    film = render(material(**wave), light, (curves,), size=2, camera=straight_down(2 * pixel))
    return film["scratches"].astype(float).mean((0, 1)) / omega_i[2]


def known(omega_i, offsets, widths, depths, azimuths, at=FINE):
    """The same by the library, together, at each wavelength."""
    rows = zip(*np.broadcast_arrays(offsets, widths, depths, azimuths), strict=True)
    parts = [diffraction.Scratch(w, d, a, o, SIGMA) for o, w, d, a in rows]
    return diffraction.brdf_coherent(omega_i, UP, parts, at, base=False)


def across(xi2, azimuth):
    """A direction whose sum with the normal is ``xi2`` across scratches and 0 along them."""
    return np.array([-xi2 * np.sin(azimuth), xi2 * np.cos(azimuth), np.sqrt(1.0 - xi2**2)])


CASES = [
    ([-6.0, 9.0], [3.0, 2.0], [1.0, 0.7], 0.0),
    ([-20.0, 5.0, 14.0], [3.0, 2.5, 4.0], [0.9, 1.6, 0.3], 0.0),
    ([-6.0, 9.0], [3.0, 2.0], [1.0, 0.7], [0.0, 2e-3]),
]


@pytest.mark.parametrize("xi2", [0.03, 0.2, -0.2])
@pytest.mark.parametrize("offsets, widths, depths, turns", CASES)
def test_close_scratches_against_the_library(offsets, widths, depths, turns, xi2):
    """64 wavelengths, over whose share of the spectrum the fringes are integrated and all else is constant: 2 % of the
    sum of each by itself."""
    azimuth = 0.4
    omega_i = across(xi2, azimuth)
    azimuths = azimuth + np.broadcast_to(turns, len(offsets))
    got = seen(omega_i, strokes(offsets, widths, depths, turns, azimuth), samples=64) @ LUMINANCE
    expected = known(omega_i, offsets, widths, depths, azimuths) @ WEIGHTS @ LUMINANCE
    rows = zip(offsets, widths, depths, azimuths, strict=True)
    alone = sum(known(omega_i, *([x] for x in one)) @ WEIGHTS @ LUMINANCE for one in rows)
    assert got == pytest.approx(expected, abs=0.02 * alone)
    # and the phases of different depths matter: mirrored, the pair looks different
    if xi2 == 0.2 and len(offsets) == 2 and turns == 0.0:
        assert abs(expected - alone) > 0.1 * alone


def test_orders_of_a_grating_of_curves():
    """145 scratches 5 um apart at one wavelength: bright at m lambda / period, dark half an order away, as bright as
    the library says. The line's Gaussian changes by 2 sigma^2 k^2 xi d_xi = 2e-3 over the 2 nm of rounding positions
    of float32; the footprint keeps lines within 3.2 deviations (1.4e-3): 1 %."""
    pitch, width, depth, wave = 5.0, 1.0, 0.1, 550.0
    lines = pitch * (np.arange(145) - 72)
    curves = strokes(lines, width, depth)
    one = {"samples": 1, "wavelength_range": (wave - 0.01, wave + 0.01)}
    peaks = []
    for order in (1, 2, 3):
        values = []
        for xi2 in order * 1e-3 * wave / pitch + np.array([-2.4e-3, 0.0, 2.4e-3, 0.055]):
            got = seen(across(xi2, 0.0), curves, **one) @ LUMINANCE
            expected = known(across(xi2, 0.0), lines, width, depth, 0.0, np.array([wave]))[0]
            # of one wavelength: its weight is 1
            values.append((got, expected))
        (low, _), (peak, theirs), (high, _), (dark, _) = values
        assert peak == pytest.approx(theirs, rel=0.01)
        assert max(low, high) < 0.2 * peak and abs(dark) < 1e-4 * peak
        peaks.append(peak)
    assert peaks[0] > peaks[1] > peaks[2]


def test_footprints_integrate_the_field():
    """A footprint of 200 um over two scratches against the mean of small ones across it, weighted by its Gaussian of
    twice the second moments of the pixel: 1 %."""
    offsets, widths, depths, pixel = [-11.0, 14.0], [3.0, 2.0], [1.0, 0.7], 2e-4
    omega_i = across(0.15, 0.0)
    light = DistantLight(path="/l", radiance=np.ones(3), direction=-omega_i)
    curves = (strokes(offsets, widths, depths),)
    film = render(material(samples=32), light, curves, size=2, camera=straight_down(2 * pixel))
    deviation = pixel * 1e6 / np.sqrt(6.0)
    moved = np.linspace(-4.0, 4.0, 81) * deviation
    weight = np.exp(-0.5 * (moved / deviation) ** 2)
    at, weights = spectral_samples(128)
    for row in range(2):
        for column in range(2):
            from_here = np.subtract(offsets, 1e6 * film["P"][row, column, 1])
            each = [known(omega_i, from_here - x, widths, depths, 0.0, at) @ weights @ LUMINANCE for x in moved]
            expected = np.dot(each, weight) / weight.sum() * omega_i[2]
            assert film["scratches"][row, column] @ LUMINANCE == pytest.approx(expected, rel=0.01)


def test_small_light_blurs_the_fringes():
    """A sphere over which the fringes of two scratches 30 um apart go by twice, against the mean over its directions
    by the library: 3 % as for the light alone."""
    offsets, widths, depths, radius = [-15.0, 15.0], [3.0, 3.0], [1.0, 1.0], 0.012
    center = across(0.2, 0.0)
    light = SphereLight(path="/l", radiance=np.ones(3), center=center - [0, 0, 1.0], radius=radius)
    curves = (strokes(offsets, widths, depths),)
    film = render(material(samples=32), light, curves, size=2, camera=straight_down(2e-6))
    got = film["scratches"].astype(float).mean((0, 1)) @ LUMINANCE
    at, weights = spectral_samples(128)
    # directions of the cap by (xi_1, xi_2): d omega = d xi_1 d xi_2 / cos
    n = 160
    grid = radius * ((np.arange(n) + 0.5) / n * 2.0 - 1.0)
    s, t = np.meshgrid(grid, grid, indexing="ij")
    tangent, other = np.array([1.0, 0, 0]), np.cross(center, [1.0, 0, 0])
    w = center + s[..., None] * tangent + t[..., None] * other
    w = (w / np.linalg.norm(w, axis=-1, keepdims=True))[(s**2 + t**2) < radius**2]
    f = known(w[:, None], offsets, widths, depths, 0.0, at) @ weights @ LUMINANCE
    expected = (f * w[:, 2]).sum() * (grid[1] - grid[0]) ** 2
    assert got == pytest.approx(expected, rel=0.03)


def test_never_negative():
    """Many scratches at small and large angles, as bundles and crossing, in every pixel: what rounding leaves below
    zero is a thousandth of the mean at most, before and after gamut mapping alike."""
    rng = np.random.default_rng(5)
    count = 40
    curves = strokes(rng.uniform(-150, 150, count), rng.uniform(1, 5, count), rng.uniform(0.2, 3, count),
                     rng.choice([0.0, 1e-3, 0.02, 0.3], count) * rng.normal(size=count), 0.3)  # fmt: skip
    light = DistantLight(path="/l", radiance=np.ones(3), direction=-across(0.11, 0.3))
    film = render(material(samples=16), light, (curves,), size=8, camera=straight_down(3e-4))
    y = film["scratches"].astype(float) @ LUMINANCE
    assert y.min() >= -1e-3 * y.mean() and y.mean() > 0.0
    assert np.isfinite(film["color"]).all()


def test_pairs_are_compiled_only_when_asked_for():
    light = DistantLight(path="/l", radiance=np.ones(3), direction=np.array([0, 0, -1.0]))
    for coherent in (True, False):
        made = waves(wave=Wave(SIGMA, summation="coherent" if coherent else "incoherent"))
        world = scenes.scene([scenes.plane(0.02)], [made], [light], curves=(strokes([0.0], 3.0, 1.0),))
        plan = sw.make_plan(world, sw.Settings(width=4, height=4))
        assert plan.on("diffraction.pairs") == coherent
        assert kernel_key(world, plan).glint_pairs == coherent
        assert not [w for w in plan.warnings if "coheren" in w]
