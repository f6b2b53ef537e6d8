"""The record and the named shapes: what is refused, and what the shapes are."""

import numpy as np
import pytest

from scratchwarp import profiles
from scratchwarp.profiles.profile import normalised


@pytest.mark.parametrize(
    "points",
    [
        [[0, 0]],
        [[0, 0], [0, 1]],
        [[1, 0], [0, 0]],
        [[0, 0], [0.5, np.nan], [1, 0]],
        [[0, 0], [1.5, -1], [1, 0]],
        [[0, 0], [-0.1, -1], [1, 0]],
        [0, 1, 2],
        [[0, 0, 0], [1, 0, 0]],
        [[0, 0], [0.6, 0.0], [0.6, -0.5], [0.3, 0.2], [1, 0]],
    ],
)
def test_impossible_outlines_are_refused(points):
    """One point, no width, reversed, NaN, past an end, wrong shapes, crossing itself: ValueError naming points."""
    with pytest.raises(ValueError, match="points"):
        profiles.Profile(points)


def test_records_are_frozen():
    """Neither the field nor the array can be changed, and the caller's array is left alone."""
    points = np.array([[0.0, 0.0], [1.0, 0.0]])
    profile = profiles.Profile(points)
    points[1, 0] = 5.0
    assert profile.period == 1.0
    with pytest.raises(ValueError):
        profile.points[0, 0] = 1.0
    with pytest.raises(AttributeError):
        profile.isolated = True


@pytest.mark.parametrize(
    "name,height",
    [
        ("quartic", lambda x: -((1 - (2 * x - 1) ** 2) ** 2)),
        ("sine", lambda x: 0.5 * (np.cos(2 * np.pi * x) - 1)),
        ("round", lambda x: -np.sqrt(1 - (2 * x - 1) ** 2)),
    ],
)
def test_smooth_shapes_follow_their_formula(name, height):
    """Arcs stay within 1e-4 of the formula (64 arcs: third derivative times h^3 / 100 at most)."""
    line = profiles.shape(name, depth=0.7).polyline(16)
    x = np.linspace(0.02, 0.98, 301)
    np.testing.assert_allclose(np.interp(x, line[:, 0], line[:, 1]), 0.7 * height(x), atol=1e-4)


@pytest.mark.parametrize("name", profiles.shape_names())
@pytest.mark.parametrize("rim", [0.0, 0.3])
def test_shapes_span_their_width_and_depth(name, rim):
    """x from 0 to 1, z from -depth to rim * depth, symmetric by default; depth 0 is flat ground."""
    line = profiles.shape(name, depth=0.4, rim=rim).polyline(8)
    assert line[0].tolist() == [0.0, 0.0] and line[-1].tolist() == pytest.approx([1.0, 0.0], abs=1e-12)
    assert line[:, 1].min() == pytest.approx(0.0 if name == "flat" else -0.4, abs=1e-3)
    assert line[:, 1].max() == pytest.approx(0.4 * rim, abs=1e-3)
    assert profiles.shape(name, depth=0.4, rim=rim).symmetric
    assert np.all(profiles.shape(name, depth=0.0).points[:, 1] == 0.0)


def test_parameters_of_shapes():
    """Apex, floor and sigma; unknown ones and values out of range are named."""
    assert profiles.shape("vGroove", depth=1.0, apex=0.2).points.tolist() == [[0, 0], [0.2, -1], [1, 0]]
    assert not profiles.shape("vGroove", apex=0.2).symmetric
    assert profiles.shape("trapezoid", floor=0.2, apex=0.25).points[1:3, 0].tolist() == pytest.approx([0.2, 0.4])
    for arguments, word in (
        ({"name": "spiral"}, "name"),
        ({"name": "vGroove", "floor": 0.5}, "floor"),
        ({"name": "trapezoid", "floor": 1.5}, "floor"),
        ({"name": "gaussian", "sigma": 0.0}, "sigma"),
        ({"name": "quartic", "segments": 2.5}, "segments"),
        ({"name": "flat", "depth": -1.0}, "depth"),
        ({"name": "sine", "rim": np.nan}, "rim"),
        ({"name": "sine", "rim": 0.1, "rim_width": 0.6}, "rim_width"),
    ):
        with pytest.raises(ValueError, match=word):
            profiles.shape(**arguments)


def test_base_line_is_the_highest_point_or_the_ground():
    """Periodic: the highest point, humps of arcs included. Alone: never below the ground, and walls reach up to it."""
    assert profiles.shape("quartic", rim=0.5).top == pytest.approx(0.25, abs=1e-4)
    sunk = [[0, -0.2], [0.5, -0.5], [1, -0.2]]
    assert profiles.Profile(sunk).top == -0.2
    alone = profiles.Profile(sunk, isolated=True)
    assert alone.top == 0.0
    vertices, _ = normalised(alone)
    assert vertices.tolist() == [[0, 0], [0, -0.2], [0.5, -0.5], [1, -0.2], [1, 0]]


def test_identity_covers_everything_that_matters():
    """The token tells points, arcs and isolation apart, and nothing else."""
    points = [[0, 0], [0.5, -0.5], [1, 0]]
    tokens = {
        profiles.Profile(points).token,
        profiles.Profile(points, isolated=True).token,
        profiles.Profile(points, controls=[[0.25, -0.3], [0.75, -0.3]]).token,
        profiles.Profile([[0, 0], [0.5, -0.5000001], [1, 0]]).token,
    }
    assert len(tokens) == 4
    assert profiles.Profile(points).token == profiles.Profile(np.array(points)).token
