"""Shapes of the demo stages: outside is outside, uv are not mirrored and true to scale where they promise it."""

import numpy as np
import pytest

from scratchwarp.pipelines import demo_shapes as shapes


def ring(count):
    turn = np.arange(count) * 2 * np.pi / count
    return np.stack([np.cos(turn), -np.sin(turn)], axis=-1)


def half_circle(count):
    turn = np.linspace(0, np.pi, count)
    outline = np.stack([np.sin(turn), -np.cos(turn)], axis=-1)
    outline[[0, -1], 0] = 0.0
    return outline


SHAPES = {
    "lathe": lambda: shapes.lathe([half_circle(24)], 24),
    "sphere": lambda: shapes.sphere(2.0, (0.1, 0.5, 1.0), 16, 32),
    "tile": lambda: shapes.tile(ring(6), 0.4, 0.05),
    "sheet": lambda: shapes.sheet(lambda u, v: np.stack([u, v, 0.2 * u * v], axis=-1), 6, 5),
    "extruded": lambda: shapes.extruded([(1, 0), (0, 0), (-1, 0.2), (-1.6, 1)], 3.0),
    "tube": lambda: shapes.tube(shapes.smooth([(0, 0, 0), (1, 1, 0), (2, 1, 1)], 20), 0.1, 12),
}


def triangles(shape):
    """Fans of all faces: corner indices [m, 3]."""
    starts = np.cumsum(np.concatenate([[0], shape.counts[:-1]]))
    fans = [
        [shape.indices[s], shape.indices[s + i], shape.indices[s + i + 1]]
        for s, count in zip(starts, shape.counts, strict=True)
        for i in range(1, count - 1)
    ]
    return np.array(fans)


@pytest.mark.parametrize("name", SHAPES)
def test_faces_look_where_their_normals_do_and_uv_are_not_mirrored(name):
    """Counter-clockwise from outside, in space and in uv; no face without area; unit normals."""
    shape = SHAPES[name]()
    corner = triangles(shape)
    p, st = shape.points[corner], shape.uv[corner]
    facing = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    assert (np.linalg.norm(facing, axis=1) > 1e-6).all()
    assert (np.einsum("ij,ikj->ik", facing, shape.normals[corner]) > 0).all()
    a, b = st[:, 1] - st[:, 0], st[:, 2] - st[:, 0]
    assert (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0).all()
    assert np.allclose(np.linalg.norm(shape.normals, axis=1), 1.0, atol=1e-9)


@pytest.mark.parametrize(("name", "area"), [("lathe", 4 * np.pi), ("sphere", 16 * np.pi)])
def test_round_shapes_close(name, area):
    """Every edge is shared by two faces where points coincide, and the area is nearly that of the ball."""
    shape = SHAPES[name]()
    corner = triangles(shape)
    p = shape.points[corner]
    total = 0.5 * np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1).sum()
    assert 0.96 * area < total < area  # a polyhedron inside the ball; 16 to 24 rings lose under 4 %
    _, weld = np.unique(shape.points.round(9), axis=0, return_inverse=True)
    edges = np.sort(weld.ravel()[np.stack([corner, np.roll(corner, -1, axis=1)], axis=-1)].reshape(-1, 2), axis=1)
    _, shared = np.unique(edges, axis=0, return_counts=True)
    assert (shared == 2).all()


def test_u_runs_around_a_lathe_and_is_true_to_scale_at_its_widest():
    """dP/du is horizontal everywhere; along the equator one u is the way around, which one v is, too."""
    shape = SHAPES["lathe"]()
    corner = triangles(shape)
    p, st = shape.points[corner], shape.uv[corner]
    steps = np.stack([st[:, 1] - st[:, 0], st[:, 2] - st[:, 0]], axis=1)
    slopes = np.linalg.solve(steps, np.stack([p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]], axis=1))
    assert np.abs(slopes[:, 0, 1]).max() < 1e-9
    middle = np.abs(p[:, :, 1]).max(1) < 0.15
    # chords of 24 segments are 0.3 % shorter than arcs
    assert np.allclose(np.linalg.norm(slopes[middle], axis=2), 2 * np.pi, rtol=0.02)


def test_sphere_uv_measure_distance_from_the_front():
    """A point at an angle t from the front lies t / (2 pi) from the middle of the uv square."""
    front = np.array([0.1, 0.5, 1.0])
    shape = SHAPES["sphere"]()
    angle = np.arccos(np.clip(shape.points @ front / np.linalg.norm(front) / 2.0, -1, 1))
    assert np.allclose(np.linalg.norm(shape.uv - 0.5, axis=1), angle / (2 * np.pi), atol=1e-7)


def test_tiles_measure_their_top_in_their_own_square():
    """On the top, u is x and v is -z over the square of twice the reach."""
    shape = shapes.tile(2.0 * ring(6), 0.4, 0.1)
    top = np.arange(6)
    assert np.allclose(shape.uv[top], 0.5 + shape.points[top][:, [0, 2]] * (1, -1) / 4.0)
    assert np.allclose(shape.points[top][:, 1], 0.0) and shape.points[:, 1].min() == -0.4


def test_smooth_passes_through_its_points():
    """Catmull-Rom interpolates: 7 samples over 4 points meet every one of them."""
    given = np.array([[0, 0], [1, 2], [2, 1], [4, 4]], float)
    assert np.allclose(shapes.smooth(given, 7)[::2], given)


def test_rosettes_stay_inside_their_circle():
    """Every point within radius 1."""
    lines = shapes.rosette(8, 50)
    assert lines.shape == (8, 50, 2) and np.linalg.norm(lines, axis=-1).max() < 1.0
