"""What the report of a fit shows: where a value lies in the picture, and numbers that libraries agree on."""

import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from scratchwarp import measured
from scratchwarp.study import fit_metrics, fit_pictures


def test_a_value_lies_where_the_paper_puts_it():
    """Light at 15 it from the top, view at 15 iv from the left; inside a block by azimuth."""
    values = np.zeros((288, 288, 3))
    values[48 * 2 + 7, 48 * 4 + 30] = (1.0, 0.5, 0.25)
    pixels = fit_pictures.unfolded(values, 1.0, scale=2)
    assert pixels.shape == (583, 583, 3)
    rows, columns = np.nonzero(pixels[..., 0] > 0.5)
    # a line before every block
    assert set(rows) == {3 + 2 * (48 * 2 + 7), 4 + 2 * (48 * 2 + 7)}
    assert set(columns) == {5 + 2 * (48 * 4 + 30), 6 + 2 * (48 * 4 + 30)}
    np.testing.assert_allclose(pixels[rows[0], columns[0]], (1.0, 0.5, 0.25))
    off = fit_pictures.difference(values, 0.9 * values, 1.0)
    np.testing.assert_allclose(off[rows[0], columns[0], 0], 0.3, rtol=1e-6)


def test_the_chart_is_drawing_every_curve():
    values = np.random.default_rng(0).random((288, 288, 3))
    chart = ElementTree.fromstring(fit_pictures.slice_chart({"one": values, "half": 0.5 * values}))
    first, second = (
        np.array([point.split(",") for point in line.get("points").split()], float)
        for line in chart.iter("{http://www.w3.org/2000/svg}polyline")
    )
    assert len(first) == 49 and np.allclose(first[:, 0], second[:, 0])
    # heights above the axis at 260, of which a coordinate has one decimal
    np.testing.assert_allclose(260 - first[:, 1], 2 * (260 - second[:, 1]), atol=0.2)
    np.testing.assert_allclose(first[0, 1], first[-1, 1])


def test_metrics_with_and_without_the_library(monkeypatch):
    """scikit-image or our own: the same numbers."""
    rng = np.random.default_rng(1)
    a = rng.random((40, 40, 3))
    b = np.abs(a + 0.05 * rng.standard_normal(a.shape))
    found = fit_metrics.metrics(a, b)
    for name, value in measured.compare(a, b).items():
        assert found[name] == pytest.approx(value, rel=1e-9)
    assert fit_metrics.metrics(0 * a, 0 * a)["rmse"] == 0.0
    monkeypatch.setitem(sys.modules, "skimage", None)
    assert fit_metrics.source() == "scratchwarp" and fit_metrics.metrics(a, b) == measured.compare(a, b)


def test_rivals_get_as_many_numbers():
    for name in measured.RIVALS:
        lobes = measured.lobes_for(name, 24)
        each = len(measured.fit_rival(np.zeros((288, 288, 3)), name).lobes[0]) + 3
        assert 3 + each * lobes >= 24 > 3 + each * (lobes - 1)
    with pytest.raises(ValueError, match="phong"):
        measured.lobes_for("phong", 3)
