"""Explicit scratches are drawn where they lie."""

import numpy as np

from scratchwarp.scene import Curves
from scratchwarp.viewers import curves


def record(points, counts, space):
    n = len(points)
    return Curves("/scratches", np.array(points, float), np.array(counts), np.full(n, 20.0), np.full(n, 5.0), space)


def test_uv_scratches_lie_on_the_surface_and_are_cut_at_its_edge(make_scene, make_layer):
    """uv (0.25, 0.75) of the square [-1, 1]^2 is (-0.5, 0.5, 0); points beyond the uv square are left out."""
    points = [[0.25, 0.75, 0], [0.5, 0.5, 0], [0.9, 0.1, 0], [1.5, 0.1, 0], [0.1, 0.2, 0], [0.2, 0.2, 0]]
    drawn = record(points, [4, 2], "uv")
    scene = make_scene((make_layer(distribution="curves", curves=(0,)),), (drawn,))
    lines = curves.polylines(scene, drawn, 0)
    assert [len(line) for line in lines] == [3, 2]
    # VTK keeps points in float32 here: 1e-6 on coordinates up to 1
    assert np.abs(lines[0] - [[-0.5, 0.5, 0], [0, 0, 0], [0.8, -0.8, 0]]).max() < 1e-6
    assert np.abs(lines[1] - [[-0.8, -0.6, 0], [-0.6, -0.6, 0]]).max() < 1e-6


def test_object_scratches_are_drawn_as_they_are(make_scene, make_layer):
    """Positions of space object are world metres already."""
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0.5, 0], [0.5, 0.5, 0]]
    drawn = record(points, [2, 3], "object")
    scene = make_scene((make_layer(distribution="curves", curves=(0,)),), (drawn,))
    lines = curves.polylines(scene, drawn, 0)
    assert [line.tolist() for line in lines] == [points[:2], points[2:]]


def test_scratches_that_diffract_follow_the_surface_in_the_colours_of_their_directions(make_scene, make_layer):
    """Points between where a line is long; red along x, green along y."""
    drawn = record([[0.1, 0.5, 0], [0.9, 0.5, 0], [0.5, 0.2, 0], [0.5, 0.21, 0], [0.5, 0.22, 0]], [2, 3], "uv")
    fine = curves.refined(drawn, 0.1)
    assert fine.counts.tolist() == [9, 3] and len(fine.widths) == 12
    assert np.allclose(fine.points[:9, 0], np.linspace(0.1, 0.9, 9)) and np.array_equal(
        fine.points[9:], drawn.points[2:]
    )
    lines = curves.polylines(make_scene((make_layer(distribution="curves", curves=(0,)),), (fine,)), fine, 0)
    assert np.allclose(curves.direction_colors(lines), [[1, 0, 0]] * 9 + [[0, 1, 0]] * 3, atol=1e-4)
