"""Scratches cut to triangles: nothing is lost, pieces lie in their triangles and meet at their edges."""

import numpy as np
import pytest
import warp as wp

from scratchwarp.scene import Curves, Layer, Profile
from scratchwarp.scratches import segments
from scratchwarp.scratches.generate import SAMPLE, random_scratches
from scratchwarp.scratches.segments import Stroke, build, stretches, surroundings

RADIUS = 0.05


def ball(rings=40, sides=80):
    """Corners [m, 3, 3] of a ball."""
    v, u = np.meshgrid(np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, sides + 1), indexing="ij")
    u[:, -1] = 0.0
    p = RADIUS * np.stack([np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)], -1)
    a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
    made = np.concatenate([np.stack(x, -2).reshape(-1, 3, 3) for x in ((a, b, c), (a, c, d))])
    area = np.linalg.norm(np.cross(made[:, 1] - made[:, 0], made[:, 2] - made[:, 0]), axis=1)
    return made[area > 1e-12].astype(np.float32)


def laid(corners, curves, uvs=None, **options):
    """The pieces of one set on a mesh."""
    m = len(corners)
    points = wp.array(corners.reshape(-1, 3), dtype=wp.vec3, device="cpu")
    mesh = wp.Mesh(points, wp.array(np.arange(3 * m, dtype=np.int32), dtype=int, device="cpu"))
    uv = np.zeros((3 * m, 2), np.float32) if uvs is None else uvs.reshape(-1, 2).astype(np.float32)
    gradients = [
        wp.array(np.tile(axis, (m, 1)).astype(np.float32), dtype=wp.vec3, device="cpu") for axis in np.eye(3)[:2]
    ]
    flat = wp.array(uv, dtype=wp.vec2, device="cpu")
    made = build([Stroke(curves, 3, np.ones(m, bool))], points, flat, *gradients, mesh, **options)
    return made, made.segments.numpy()[: made.count]


def ends_of(rows, corners):
    """World ends [n, 2, 3] of pieces."""
    a, b, c = (corners[rows["triangle"], k].astype(float) for k in range(3))
    x = (b - a) / np.linalg.norm(b - a, axis=1, keepdims=True)
    n = np.cross(b - a, c - a)
    y = np.cross(n / np.linalg.norm(n, axis=1, keepdims=True), x)
    at = [rows["middle"] + side * rows["half"] for side in (-1, 1)]
    return np.stack([a + p[:, :1] * x + p[:, 1:] * y for p in at], 1)


def arc(turn=2.5, points=60):
    """One great circle's arc on the ball."""
    at = np.linspace(0.2, 0.2 + turn, points)
    first, second = np.array([0.6, 0.0, 0.8]), np.array([0.0, 1.0, 0.0])
    line = RADIUS * (np.cos(at)[:, None] * first + np.sin(at)[:, None] * second)
    return Curves("/c", line, np.array([points]), np.full(points, 3.0), np.full(points, 1.0))


def test_pieces_meet_and_lose_nothing():
    """Chords of a ball of 80 sides are 1 - cos(pi / 80) = 8e-4 shorter than the arc at most, and every end of a piece
    but two is the end of another: to the rounding of float32 corners (3e-9 m) at edges, to a micrometre where the arc
    runs through a corner of the mesh."""
    corners = ball()
    made, rows = laid(corners, arc())
    length = 2.0 * np.linalg.norm(rows["half"], axis=1)
    assert length.sum() == pytest.approx(2.5 * RADIUS, rel=2e-3)
    assert (rows["layer"] == 3).all() and rows.dtype.itemsize <= 64
    ends = ends_of(rows[length > 1e-7], corners).reshape(-1, 3)
    apart = np.linalg.norm(ends[:, None] - ends[None], axis=-1) + np.eye(len(ends))
    assert (apart.min(1) > 1e-6).sum() == 2
    starts = made.starts.numpy()
    assert (np.diff(rows["triangle"]) >= 0).all() and starts[-1] == made.count


def test_pieces_turn_like_the_scratch():
    """A polyline of a circle in a plane: each piece's own direction runs from -half to +half of what it turns."""
    square = np.array([[[-1, -1, 0], [1, -1, 0], [1, 1, 0]], [[-1, -1, 0], [1, 1, 0], [-1, 1, 0]]], np.float32)
    at = np.linspace(0.0, 1.0, 21)
    circle = 0.5 * np.stack([np.cos(at), np.sin(at), 0 * at], -1)
    _, rows = laid(square, Curves("/c", circle, np.array([21]), np.full(21, 3.0), np.full(21, 1.0)))
    turned = 2.0 * np.linalg.norm(rows["half"], axis=1) / 0.5
    np.testing.assert_allclose(rows["turn_b"] - rows["turn_a"], turned, rtol=0.02)


def test_corners_stay_corners():
    line = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0]], float)
    s, count = stretches(Curves("/c", line, np.array([3]), np.full(3, 3.0), np.full(3, 1.0)), 0)
    assert count == 2
    np.testing.assert_allclose(s.along_b.numpy()[0], [1, 0, 0], atol=1e-7)
    np.testing.assert_allclose(s.along_a.numpy()[1], [0, 1, 0], atol=1e-7)


def test_surroundings_hold_the_neighbours():
    corners = ball(8, 12)
    starts, around, reach = surroundings(corners)
    for t in (0, len(corners) // 2):
        own = set(around[starts[t] : starts[t + 1]].tolist())
        shared = (corners[:, :, None] == corners[t][None, None]).all(-1).any((1, 2))
        assert own == set(np.flatnonzero(shared).tolist())
    assert (reach > 0.0).all()


def test_random_scratches_cover_what_was_asked_for():
    """n scratches of area A over area S cover 1 - e^{-n A / S}; the number is Poisson: 4 standard deviations."""
    layer = Layer("fine", "/mat", Profile("/p"), distribution="random", width=4.0, length=400.0, coverage=0.3)
    made = random_scratches(layer, (0.0, 0.0), (1.0, 1.0), (20000.0, 20000.0))
    expected = -np.log(0.7) * 20400.0**2 / (4.0 * 400.0)
    assert abs(len(made.counts) - expected) < 4 * np.sqrt(expected)
    run = (made.points[1::2] - made.points[::2])[:, :2] * 20000.0
    np.testing.assert_allclose(np.linalg.norm(run, axis=1), 400.0, rtol=1e-9)
    with pytest.raises(ValueError, match="more than"):
        random_scratches(layer, (0.0, 0.0), (1.0, 1.0), (2e7, 2e7))
    with pytest.raises(ValueError, match="9 corners each are more than"):  # where they follow a field
        random_scratches(layer, (0.0, 0.0), (1.0, 1.0), (1.45e5, 1.45e5), lambda uv: np.ones_like(uv))


def test_some_of_very_many_scratches_are_laid_first():
    """They are those that all of them hold, evenly; what is not wanted is not laid."""
    layer = Layer("fine", "/mat", Profile("/p"), distribution="random", width=4.0, length=400.0, density=2e3, depth=0.5)
    seen = []
    made = random_scratches(layer, (0, 0), (1, 1), (6e3, 6e3), look=lambda few, every: seen.append((few, every)))
    few, every = seen[0]
    step = every // SAMPLE
    assert every == len(made.counts) > 16 * SAMPLE and len(seen) == 1
    np.testing.assert_array_equal(few.points, made.points.reshape(every, 2, 3)[::step].reshape(-1, 3))
    np.testing.assert_array_equal(few.depths, 0.5)

    def stop(few, every):
        raise ValueError("enough")

    asked = []
    with pytest.raises(ValueError, match="enough"):
        random_scratches(
            layer, (0, 0), (1, 1), (6e3, 6e3), lambda uv: asked.append(len(uv)) or np.ones_like(uv), look=stop
        )
    assert max(asked) < 2 * SAMPLE


MANY = Curves(
    path="/m",
    points=np.random.default_rng(5).random((200, 3)) * [1.0, 1.0, 0.0],
    counts=[2, 3, 7, 8] * 10,
    widths=np.linspace(1.0, 3.0, 200),
    depths=np.linspace(2.0, 1.0, 200),
    space="uv",
)


def test_portions_change_nothing(monkeypatch):
    corners = ball(8, 12)
    uvs = np.random.default_rng(6).random((len(corners), 3, 2))
    steps = []
    made, rows = laid(corners, MANY, uvs, progress=lambda *x: steps.append(x))
    assert {total for _, total in steps} == {160} and steps[-1] == (160, 160) and steps == sorted(steps)
    monkeypatch.setattr(segments, "PORTION", 9)
    monkeypatch.setattr(segments, "STRETCHES", 13)
    again, cut = laid(corners, MANY, uvs)
    np.testing.assert_array_equal(rows, cut)
    np.testing.assert_array_equal(made.starts.numpy(), again.starts.numpy())


def test_too_many_pieces_are_said(monkeypatch):
    """Before they are made."""
    monkeypatch.setattr(segments, "MOST_PIECES", 30)
    with pytest.raises(ValueError, match="/m: .* cut into .* pieces .* more than 30; make the scratches fewer"):
        laid(ball(8, 12), MANY, np.random.default_rng(6).random((len(ball(8, 12)), 3, 2)))


def test_far_too_many_pieces_are_foreseen(monkeypatch):
    """A part of the scratches tells; all of them are not even made straight."""
    monkeypatch.setattr(segments, "MOST_PIECES", 30)
    monkeypatch.setattr(segments, "SAMPLE", 2)
    with pytest.raises(ValueError, match="/m: its 40 scratches would be cut into about .* pieces .* more than 30"):
        laid(ball(8, 12), MANY, np.random.default_rng(6).random((len(ball(8, 12)), 3, 2)))
