"""Metals: the colours people know, the three-channel fit, and the figures against their source."""

import os
import re
from pathlib import Path

import numpy as np
import pytest

from scratchwarp.optics import metals

SHARED = Path(os.environ.get("SCRATCHWARP_SHARED", Path(__file__).parents[2].parent / "shared"))

FILES = {
    "aluminium": "Al_nk_Rakic-BB.yml",
    "brass": "alloy_Cu-Zn_nk_Querry-Cu70Zn30.yml",
    "copper": "Cu_nk_Johnson.yml",
    "gold": "Au_nk_Johnson.yml",
    "iron": "Fe_nk_Johnson.yml",
    "silver": "Ag_nk_Johnson.yml",
}


@pytest.mark.parametrize("name", metals.NAMES)
def test_three_channels_show_the_colour_of_the_spectrum(name):
    conductor = metals.conductor(name)
    spectral = metals.reflectance_rgb(name)
    np.testing.assert_allclose(conductor.reflectance(1.0), np.minimum(spectral, 0.999), atol=1e-9)
    # off normal the fit has one free number a channel: within 0.01, apart from gold's red, which Rec.709 cannot hold
    for cosine in (0.7, 0.3, 0.1):
        expected = np.minimum(metals.reflectance_rgb(name, cosine), 1.0)
        np.testing.assert_allclose(conductor.reflectance(cosine), expected, atol=0.01)


def test_colours_are_the_known_ones():
    colour = {name: metals.reflectance_rgb(name) for name in metals.NAMES}
    assert np.ptp(colour["silver"]) < 0.02 and colour["silver"].min() > 0.95
    assert np.all(np.abs(colour["aluminium"] - 0.915) < 0.02)
    assert np.ptp(colour["iron"]) < 0.05 and 0.45 < colour["iron"].mean() < 0.6
    for warm in ("gold", "copper", "brass"):
        assert colour[warm][0] > colour[warm][1] > colour[warm][2]
    assert colour["copper"][1] < colour["gold"][1]  # copper is redder


def test_returned_arrays_are_the_callers_own():
    metals.rgb("iron")[0][:] = 0.0
    assert np.all(metals.rgb("iron")[0] > 1.0)


def test_unknown_metal_is_refused_with_the_known_ones():
    with pytest.raises(ValueError, match="name must be one of.*silver.*unobtainium"):
        metals.rgb("unobtainium")


@pytest.mark.parametrize("name", metals.NAMES)
def test_table_against_the_published_points(name):
    path = SHARED / "data" / "ior" / FILES[name]
    if not path.exists():
        pytest.skip(f"no refractive indices at {path}")
    rows = [line.split() for line in path.read_text().splitlines() if re.fullmatch(r"\s+([\d.eE+-]+\s*){3}", line)]
    points = np.array(rows, float)
    points = points[(points[:, 0] > 0.38) & (points[:, 0] < 0.78)]
    n, k = metals.index(name, points[:, 0] * 1000.0)
    # four digits, and resampling at 10 nm cuts the corners of a polyline with nodes some 20 nm apart (gold's n bends
    # most)
    np.testing.assert_allclose(n, points[:, 1], atol=0.04)
    np.testing.assert_allclose(k, points[:, 2], atol=0.04)
