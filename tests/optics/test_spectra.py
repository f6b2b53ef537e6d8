"""Colorimetry: published white points, furnace under any illuminant, blackbodies, and the figures against their
source."""

import os
from pathlib import Path

import numpy as np
import pytest

from scratchwarp.optics import spectra

SHARED = Path(os.environ.get("SCRATCHWARP_SHARED", Path(__file__).parents[2].parent / "shared"))


def test_matrix_has_the_published_luminances():
    np.testing.assert_allclose(spectra.RGB_TO_XYZ[1], [0.212639, 0.715169, 0.072192], atol=1e-6)
    np.testing.assert_allclose(spectra.RGB_TO_XYZ @ np.ones(3), [0.950456, 1.0, 1.089058], atol=1e-6)
    np.testing.assert_allclose(spectra.rgb_to_xyz(spectra.xyz_to_rgb([0.3, 0.4, 0.5])), [0.3, 0.4, 0.5], atol=1e-14)


@pytest.mark.parametrize(("name", "xy"), [("D65", (0.31272, 0.32903)), ("E", (1 / 3, 1 / 3))])
def test_illuminant_chromaticity(name, xy):
    xyz = spectra.illuminant(name) @ spectra.CMF
    # sums at 5 nm leave the chromaticity of E 5e-5 from the exact 1/3
    np.testing.assert_allclose(xyz[:2] / xyz.sum(), xy, atol=7e-5)


@pytest.mark.parametrize("name", ["D65", "E"])
def test_a_perfect_reflector_is_white_and_grey_is_grey(name):
    np.testing.assert_allclose(spectra.spectrum_to_rgb([400.0, 700.0], [1.0, 1.0], name), 1.0, atol=1e-12)
    np.testing.assert_allclose(spectra.spectrum_to_rgb([500.0], [[0.25], [0.5]], name), [[0.25] * 3, [0.5] * 3])


def test_spectral_colours_fall_where_they_should():
    red = spectra.spectrum_to_rgb([590.0, 610.0, 620.0], [0.0, 0.5, 1.0])
    blue = spectra.spectrum_to_rgb([450.0, 470.0, 480.0], [1.0, 0.5, 0.0])
    assert red[0] > 5 * abs(red[1:]).max() and blue[2] > 3 * abs(blue[:2]).max()


def test_blackbody():
    # Planck's law on the 1 nm grid, written plainly, as chromaticity: 2856 K is illuminant A, (0.44758, 0.40745)
    xyz = spectra.rgb_to_xyz(spectra.blackbody_rgb([2856.0, 6500.0]))
    np.testing.assert_allclose(xyz[:, 1], 1.0, atol=1e-12)
    np.testing.assert_allclose(xyz[0, :2] / xyz[0].sum(), (0.44758, 0.40745), atol=1e-4)
    assert np.all(spectra.blackbody_rgb([500.0, 1000.0, 1e5]) >= 0.0)
    assert spectra.blackbody_rgb(np.full((2, 3), 5000.0)).shape == (2, 3, 3)


def test_blackbody_agrees_with_the_lights_of_usd():
    lux = pytest.importorskip("pxr.UsdLux")
    for kelvin in (2000.0, 2700.0, 4000.0, 6500.0, 10000.0):
        # that function is a fit; 1e-3 is what it holds within Rec.709, above 1900 K
        expected = np.array(lux.BlackbodyTemperatureAsRgb(kelvin))
        np.testing.assert_allclose(spectra.blackbody_rgb(kelvin), expected, atol=1e-3)


def test_bad_input_is_refused_by_name():
    for name, call in {
        "wavelengths": lambda: spectra.spectrum_to_rgb([500.0, 400.0], [1.0, 1.0]),
        "values": lambda: spectra.spectrum_to_rgb([400.0, 500.0], [1.0, 1.0, 1.0]),
        "illuminant": lambda: spectra.spectrum_to_rgb([400.0], [1.0], "F11"),
        "kelvin": lambda: spectra.blackbody_rgb(0.0),
    }.items():
        with pytest.raises(ValueError, match=name):
            call()


def test_five_nanometre_table_against_the_one_nanometre_figures():
    path = SHARED / "data" / "cmf" / "cie1931_2deg_1nm.csv"
    if not path.exists():
        pytest.skip(f"no colour matching functions at {path}")
    table = np.loadtxt(path, delimiter=",")
    # cubic interpolation between 5 nm nodes; z rises from 0.8 to 1.4 in 10 nm, where linear is off by 0.016
    np.testing.assert_allclose(spectra.cmf(table[:, 0]), table[:, 1:4], atol=0.003)
    np.testing.assert_allclose(spectra.cmf(table[::5, 0]), table[::5, 1:4], rtol=1e-6)
