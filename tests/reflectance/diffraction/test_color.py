"""Colours of single scratches and the energy that is left for their base."""

import numpy as np
import pytest

from scratchwarp import diffraction
from scratchwarp.optics import spectra

rgb, balance = diffraction.rgb, diffraction.balance


def _dense(width, depth, xi2, wavelength):
    """Sum over wavelengths of the formula, the observer's table interpolated, white adapted to D65."""
    wave = wavelength * 1e-3
    w, d, xi = (np.asarray(v, float)[..., None] for v in (width, depth, xi2))
    f = 2.0 * (w / wave) ** 2 * np.sinc(w * xi / wave) ** 2 * 4.0 * np.sin(2.0 * np.pi * d / wave) ** 2
    observer = spectra.cmf(wavelength)
    xyz = f @ (observer / observer.sum(axis=0))
    return spectra.xyz_to_rgb(spectra.adapt(xyz, np.ones(3), spectra.rgb_to_xyz(np.ones(3))))


def _random(count=300):
    rng = np.random.default_rng(2)
    return rng.uniform(0.8, 6.0, count), rng.uniform(0.8, 6.0, count), rng.uniform(-1.0, 1.0, count)


def _error(value, exact):
    return np.linalg.norm(value - exact, axis=-1) / np.linalg.norm(exact, axis=-1)


def test_exact_against_dense_sum():
    case = _random()
    exact = _dense(*case, 360.0 + 470.0 * (np.arange(4000) + 0.5) / 4000)
    # cubic Hermite, step 1/64 um, fringes down to 0.36 um: (2 pi / 23)^4 / 384 = 1.5e-5 of the largest term
    assert _error(rgb(*case), exact).max() < 5e-5


def test_sampled_wavelengths():
    case = _random()
    exact = rgb(*case)
    for count, median, most in ((24, 3e-3, 0.1), (32, 1e-3, 4e-3), (48, 5e-4, 2e-3)):
        error = _error(rgb(*case, wavelengths=count), exact)
        assert np.median(error) < median and np.quantile(error, 0.95) < most
    listed = rgb(*case, wavelengths=np.linspace(361.0, 829.0, 1500))
    assert _error(listed, exact).max() < 1e-3
    # three wavelengths are a caricature: 0.77 in the median, 1.23 at 95 %
    error = _error(rgb(*case, wavelengths="rgb"), exact)
    np.testing.assert_allclose([np.median(error), np.quantile(error, 0.95)], [0.77, 1.23], atol=0.12)
    w, d, xi = case
    k = 2e3 * np.pi / np.array(diffraction.color.RGB_WAVELENGTHS)
    three = 2 * (w[:, None] * k / (2 * np.pi) * np.sinc(w[:, None] * xi[:, None] * k / (2 * np.pi))) ** 2
    three *= 4 * np.sin(k * d[:, None]) ** 2
    np.testing.assert_allclose(rgb(*case, wavelengths="rgb"), three, rtol=1e-7, atol=1e-12)


def test_saturated_colours_keep_their_negative_parts():
    value = rgb(np.linspace(0.8, 6.0, 50)[:, None], 0.3, np.linspace(0.05, 1.0, 60))
    assert value.min() < 0.0 and value.shape == (50, 60, 3)


def test_towards_the_mirror_direction():
    # xi_2 -> 0: 2 W^2 / lambda^2 |D|^2, even in xi_2, continuous over the change of formula at W xi_2 = 0.1
    w, d = 3.0, 1.1
    exact = _dense(w, d, [0.0, 1e-9, 0.02], 360.0 + 470.0 * (np.arange(4000) + 0.5) / 4000)
    np.testing.assert_allclose(rgb(w, d, [0.0, 1e-9, 0.02]), exact, rtol=1e-4)
    np.testing.assert_allclose(rgb(w, d, [0.3, 1e-320]), rgb(w, d, [-0.3, 0.0]), rtol=1e-12)
    seam = 0.1 / w * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    np.testing.assert_allclose(*rgb(w, d, seam), rtol=2e-4)
    assert np.all(rgb(0.0, 1.0, 0.1) == 0.0) and np.abs(rgb(2.0, 0.0, 0.1)).max() < 1e-9
    # beyond the length over which white light is coherent the fringes are gone
    deep = rgb(2.0, [200.0, 1e4], 0.1)
    np.testing.assert_allclose(deep[0], deep[1], rtol=1e-6)
    assert np.all(np.isfinite(rgb(1e4, 1e4, 2.0)))


def test_white_is_white():
    # flat spectra: weights of every sampling sum to (1, 1, 1)
    from scratchwarp.reflectance.diffraction.color import spectral_samples

    for wavelengths in (1, 5, 32, [550.0], [400.0, 500.0, 700.0], "rgb"):
        _, weights = spectral_samples(wavelengths)
        np.testing.assert_allclose(weights.sum(axis=0), 1.0, atol=1e-12)


@pytest.mark.parametrize("dense", [True, False])
def test_no_density_or_depth_makes_light(dense):
    visible = np.concatenate(([0.0, 1e-12, 1e-5, 1.0 + 1e-9], np.geomspace(1e-6, 1e6, 400))).reshape(2, -1)
    base, factor = balance(visible, dense)
    assert base.shape == visible.shape
    assert np.all(base >= 0.0) and np.all(factor > 0.0) and np.all(factor <= 1.0)
    assert np.all(base + factor * visible <= 1.0 + 1e-12)
    # what scratches redirect is what the base loses, to first order; without any, nothing
    thin = visible < 1e-3
    np.testing.assert_allclose(base[thin], 1.0 - visible[thin], atol=5e-7)
    np.testing.assert_allclose((base + factor * visible)[visible < 1.0], 1.0, rtol=1e-9)
    assert balance(0.0, dense)[0] == 1.0


def test_the_base_loses_what_the_cross_term_takes():
    # integral over xi of -2 Re(B* S) / (A_C lambda^2) = -a |D|^2, a the Gaussian's share of area: Eq. 6, from |B - S|^2
    k = 2.0 * np.pi / 0.55
    xi1, xi2 = np.linspace(-6, 6, 121) / (60.0 * k), np.linspace(-6, 6, 121) / (60.0 * k)
    a, b = np.meshgrid(xi1, xi2, indexing="ij")
    wi = np.stack((a, b, np.sqrt(1.0 - a**2 - b**2)), axis=-1)
    up = [0.0, 0.0, 1.0]
    for depth in (0.1, 0.1375, 0.2):
        s = diffraction.Scratch(1.5, depth)
        whole = diffraction.brdf_coherent(wi, up, [s], 550.0)
        cross = whole - diffraction.brdf_coherent(wi, up, [], 550.0) - diffraction.brdf(wi, up, s, 550.0)
        total = np.trapezoid(np.trapezoid(cross, xi2, axis=1), xi1)
        power = 4.0 * np.sin(2.0 * np.pi * depth / 0.55) ** 2
        share = 1.5 / (np.sqrt(np.pi) * 60.0)
        # (W / sigma)^2 / 12 for the Gaussian constant over the width
        np.testing.assert_allclose(total, -share * power, rtol=2e-3)
        base, factor = balance(share * power)
        np.testing.assert_allclose(1.0 + total, base, atol=(share * power) ** 2)
