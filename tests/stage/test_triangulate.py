"""Polygons to triangles."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from scratchwarp.stage.triangulate import clip_ears, triangulate


def shoelace(polygon):
    x, y = polygon[:, 0], polygon[:, 1]
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2


def areas(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return ((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])) / 2


def cut(polygon):
    points = np.column_stack([polygon, np.zeros(len(polygon))])
    n = len(polygon)
    return triangulate(points, np.array([n]), np.arange(n), np.array([0])).corners


@given(st.lists(st.floats(0.2, 1.0), min_size=4, max_size=24))
@settings(max_examples=60, deadline=None)
def test_star_shaped_polygons_are_covered_once(radii):
    """All triangles wind like the polygon and their areas add up to its own: they cover it and do not overlap."""
    turn = np.arange(len(radii)) * 2 * np.pi / len(radii)
    polygon = np.array(radii)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    got = areas(polygon, cut(polygon))
    assert (got >= 0).all()
    # Rounding of sums of up to 24 products of numbers below 1.
    np.testing.assert_allclose(got.sum(), shoelace(polygon), atol=1e-12)


@pytest.mark.parametrize("reflex", range(4))
def test_concave_quadrilaterals_are_cut_at_their_reflex_corner(reflex):
    dart = np.roll(np.array([[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]]), reflex, axis=0)
    dart = dart if shoelace(dart) > 0 else dart[::-1]
    got = areas(dart, cut(dart))
    assert len(got) == 2 and (got > 0).all()
    np.testing.assert_allclose(got.sum(), shoelace(dart))


def test_a_comb_in_space_keeps_its_winding_and_area():
    teeth = np.array(
        [[0, 0], [9, 0], [9, 3], [8, 1], [7, 3], [6, 1], [5, 3], [4, 1], [3, 3], [2, 1], [1, 3], [0, 3]], float
    )
    # Any rotation: columns of an orthonormal frame.
    frame = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    points = teeth @ frame[:, :2].T + [100.0, -50.0, 20.0]
    triangles = triangulate(points, np.array([12]), np.arange(12), np.array([0])).corners
    p = points[triangles]
    cross = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    normal = np.cross(frame[:, 0], frame[:, 1])
    assert ((cross @ normal) > 0).all()
    np.testing.assert_allclose((cross @ normal).sum() / 2, shoelace(teeth), rtol=1e-10)


def test_a_bridge_to_a_hole_may_repeat_corners():
    outer = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
    inner = [[1, 1], [1, 3], [3, 3], [3, 1], [1, 1]]
    polygon = np.array(outer + inner, float)
    got = areas(polygon, clip_ears(polygon))
    assert (got >= 0).all()
    np.testing.assert_allclose(got.sum(), 16 - 4)


def test_mixed_faces_keep_their_order_and_drop_what_has_no_area():
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]], float)
    counts = np.array([4, 3, 3, 3])
    indices = np.array([0, 1, 2, 3, 1, 4, 2, 0, 1, 4, 0, 0, 1])
    result = triangulate(points, counts, indices, np.arange(4))
    assert result.faces.tolist() == [0, 0, 1]
    assert result.degenerate.tolist() == [2, 3]
    assert indices[result.corners[2]].tolist() == [1, 4, 2]
