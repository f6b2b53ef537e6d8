"""Shapes of the demo stages: surfaces of revolution, spheres, tiles, sheets, tubes and engraved rosettes.

Every shape carries points, normals and uv at its vertices; a hard edge is two rows of vertices at the same points.
Faces are counter-clockwise seen from outside and uv are not mirrored (dP/du x dP/dv points outwards). Lengths are in
whatever unit the stage uses; +Y is up.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike


@dataclass(frozen=True, eq=False)
class Shape:
    """A polygon mesh: points, normals [n, 3] and uv [n, 2] of the vertices, vertex counts [f] and indices [sum]."""

    points: np.ndarray
    normals: np.ndarray
    uv: np.ndarray
    counts: np.ndarray
    indices: np.ndarray

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> "Shape":
        """The shape, shifted."""
        return Shape(self.points + np.array([x, y, z]), self.normals, self.uv, self.counts, self.indices)

    def z_up(self) -> "Shape":
        """The shape for a stage with +Z up: what was +Y is +Z, what was -Z is +Y."""
        turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
        return Shape(self.points @ turn, self.normals @ turn, self.uv, self.counts, self.indices)


def joined(shapes: Sequence[Shape]) -> Shape:
    """One shape of several, without welding."""
    starts = np.cumsum([0] + [len(s.points) for s in shapes[:-1]])
    return Shape(
        points=np.concatenate([s.points for s in shapes]),
        normals=np.concatenate([s.normals for s in shapes]),
        uv=np.concatenate([s.uv for s in shapes]),
        counts=np.concatenate([s.counts for s in shapes]),
        indices=np.concatenate([s.indices + start for s, start in zip(shapes, starts, strict=True)]),
    )


def grid(points: np.ndarray, normals: np.ndarray, uv: np.ndarray) -> Shape:
    """Quads over an array of vertices [rows, columns, 3]; columns run along u, rows along v.

    A quad whose lower or upper edge has shrunk to a point (a pole) becomes a triangle.
    """
    rows, columns = points.shape[:2]
    corner = np.arange(rows * columns).reshape(rows, columns)
    quads = np.stack([corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]], axis=-1).reshape(-1, 4)
    flat = points.reshape(-1, 3)
    gap = np.linalg.norm(flat[quads] - flat[np.roll(quads, -1, axis=1)], axis=-1)
    tiny = 1e-9 * max(float(np.ptp(flat, axis=0).max()), 1e-30)
    keep = np.stack([np.ones(len(quads), bool), gap[:, 0] > tiny, np.ones(len(quads), bool), gap[:, 2] > tiny], axis=1)
    counts = keep.sum(axis=1)
    solid = counts >= 3
    return Shape(flat, normals.reshape(-1, 3), uv.reshape(-1, 2), counts[solid], quads[solid][keep[solid]])


def smooth(points: ArrayLike, count: int) -> np.ndarray:
    """``count`` points [count, d] along a Catmull-Rom curve through ``points`` [n, d], evenly spaced in parameter."""
    p = np.asarray(points, np.float64)
    p = np.concatenate([2 * p[:1] - p[1:2], p, 2 * p[-1:] - p[-2:-1]])
    t = np.linspace(0, len(p) - 3, count)
    i = np.minimum(t.astype(int), len(p) - 4)
    t = (t - i)[:, None]
    a, b, c, d = p[i], p[i + 1], p[i + 2], p[i + 3]
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))


def lathe(pieces: Sequence[ArrayLike], segments: int = 96) -> Shape:
    """A surface of revolution about +Y with u around the axis, so that a layer's angle 0 runs around it.

    ``pieces`` are outlines [n, 2] of (radius, height), followed upwards along the outside; each is smooth, and hard
    edges lie between them. The seam is at the back (-Z). v is the length along the outline in units of the longest
    way around, so that uv are true to scale where the shape is widest.
    """
    outlines = [np.asarray(piece, np.float64) for piece in pieces]
    around = 2 * np.pi * max(float(outline[:, 0].max()) for outline in outlines)
    u = np.linspace(0, 1, segments + 1)
    turn = np.stack([np.sin((u - 0.5) * 2 * np.pi), np.cos((u - 0.5) * 2 * np.pi)], axis=-1)
    turn[-1] = turn[0]
    shapes, start = [], 0.0
    for outline in outlines:
        length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(outline, axis=0), axis=1))])
        slope = np.gradient(outline, length, axis=0)
        slope /= np.linalg.norm(slope, axis=1, keepdims=True)
        slope[outline[:, 0] == 0] = (slope[outline[:, 0] == 0] * (1, 0)) / np.abs(slope[outline[:, 0] == 0][:, :1])
        points = np.empty((len(outline), segments + 1, 3))
        normals = np.empty_like(points)
        points[..., [0, 2]] = outline[:, None, :1] * turn
        points[..., 1] = outline[:, None, 1]
        normals[..., [0, 2]] = slope[:, None, 1:] * turn
        normals[..., 1] = -slope[:, None, 0]
        v = np.broadcast_to((start + length[:, None]) / around, points.shape[:2])
        shapes.append(grid(points, normals, np.stack([np.broadcast_to(u, v.shape), v], axis=-1)))
        start += length[-1]
    return joined(shapes)


def sphere(radius: float, front: ArrayLike = (0.0, 0.0, 1.0), rings: int = 48, segments: int = 96) -> Shape:
    """A sphere with azimuthal uv about ``front``: true to scale there, stretched only at the far side.

    The uv square spans 2 pi radius; distances from its middle are true everywhere.
    """
    axis = np.asarray(front, np.float64) / np.linalg.norm(np.asarray(front, np.float64))
    right = np.cross((0.0, 1.0, 0.0), axis)
    right /= np.linalg.norm(right)
    up = np.cross(axis, right)
    theta = np.linspace(np.pi, 0, rings + 1)[:, None]
    phi = np.linspace(0, 2 * np.pi, segments + 1)
    sine, cosine = np.sin(theta), np.cos(theta)
    sine[[0, -1]], cosine[[0, -1]] = 0.0, ((-1.0,), (1.0,))
    ring = np.cos(phi)[:, None] * right + np.sin(phi)[:, None] * up
    ring[-1] = ring[0]
    normals = sine[..., None] * ring + cosine[..., None] * axis
    uv = 0.5 + theta[..., None] / (2 * np.pi) * np.stack([np.cos(phi), np.sin(phi)], axis=-1)
    return grid(radius * normals, normals, uv)


def tile(corners: ArrayLike, height: float, bevel: float) -> Shape:
    """A slab over a convex polygon [k, 2] of (x, z) about the origin, top at y = 0, with a bevelled edge.

    ``corners`` run counter-clockwise seen from above. On the top u is +x and v is -z over the square around the
    polygon, middle (0.5, 0.5); bevel and sides continue it outwards, each in its own direction.
    """
    outer = np.asarray(corners, np.float64)
    reach = np.linalg.norm(outer, axis=1).max()
    inner = outer * (1 - bevel / reach)
    k = len(outer)

    def at(flat: np.ndarray, y: float) -> np.ndarray:
        return np.stack([flat[:, 0], np.full(len(flat), y), flat[:, 1]], axis=-1)

    top, edge, foot = at(inner, 0.0), at(outer, -bevel), at(outer, -height)
    faces = [(top, 0.5 + inner * (1, -1) / (2 * reach))]
    for lower, upper in ((foot, edge), (edge, top)):
        for i in range(k):
            quad = np.array([lower[i], lower[(i + 1) % k], upper[(i + 1) % k], upper[i]])
            along = quad[1] - quad[0]
            along /= np.linalg.norm(along)
            rise = quad[3] - quad[0]
            rise = rise - along * (rise @ along)
            rise /= np.linalg.norm(rise)
            flat = np.stack([(quad - quad[0]) @ along, (quad - quad[0]) @ rise], axis=-1)
            faces.append((quad, flat / (2 * reach)))
    points = np.concatenate([p for p, _ in faces])
    normals = []
    for p, _ in faces:
        normal = np.cross(p[1] - p[0], p[2] - p[0])
        normals.append(np.broadcast_to(normal / np.linalg.norm(normal), p.shape))
    counts = np.array([len(p) for p, _ in faces])
    uvs = np.concatenate([uv for _, uv in faces])
    return Shape(points, np.concatenate(normals), uvs, counts, np.arange(len(points)))


def sheet(place: Callable[[np.ndarray, np.ndarray], np.ndarray], columns: int, rows: int) -> Shape:
    """A patch: ``place(u, v)`` gives positions [..., 3] for u, v in [0, 1]; normals by central differences."""
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    h = 1e-5
    normals = np.cross(place(u + h, v) - place(u - h, v), place(u, v + h) - place(u, v - h))
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return grid(place(u, v), normals, np.stack([u, v], axis=-1))


def extruded(outline: ArrayLike, width: float) -> Shape:
    """A smooth outline [n, 2] of (z, y), followed from the front to the back, drawn out along x: a studio backdrop."""
    line = np.asarray(outline, np.float64)
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    slope = np.gradient(line, length, axis=0)
    slope /= np.linalg.norm(slope, axis=1, keepdims=True)
    points = np.zeros((len(line), 2, 3))
    points[:, 0, 0], points[:, 1, 0] = -width / 2, width / 2
    points[..., 2], points[..., 1] = line[:, None, 0], line[:, None, 1]
    normals = np.zeros_like(points)
    normals[..., 1], normals[..., 2] = -slope[:, None, 0], slope[:, None, 1]
    uv = np.stack([points[..., 0] / width + 0.5, np.repeat(length[:, None] / width, 2, axis=1)], axis=-1)
    return grid(points, normals, uv)


def tube(path: ArrayLike, radii: ArrayLike, segments: int = 32) -> Shape:
    """A round tube along ``path`` [n, 3] with ``radii`` [n], open at both ends; u runs around it, v along it."""
    p = np.asarray(path, np.float64)
    r = np.broadcast_to(np.asarray(radii, np.float64), (len(p),))
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
    along = np.gradient(p, length, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    side = np.cross(along[0], (0.3, 0.5, 0.8))
    frames = np.empty((len(p), 2, 3))
    for i, t in enumerate(along):  # parallel transport: the frame turns only as much as the path bends
        side = side - t * (side @ t)
        side = side / np.linalg.norm(side)
        frames[i] = side, np.cross(t, side)
    turn = np.linspace(0, 2 * np.pi, segments + 1)
    ring = np.cos(turn)[None, :, None] * frames[:, None, 0] + np.sin(turn)[None, :, None] * frames[:, None, 1]
    ring[:, -1] = ring[:, 0]
    widen = np.gradient(r, length)[:, None, None] * along[:, None]
    normals = (ring - widen) / np.linalg.norm(ring - widen, axis=-1, keepdims=True)
    around = 2 * np.pi * r.max()
    u, v = np.meshgrid(np.linspace(0, 1, segments + 1), length / around)
    return grid(p[:, None] + r[:, None, None] * ring, normals, np.stack([u, v], axis=-1))


def rosette(lines: int, samples: int, petals: int = 12) -> np.ndarray:
    """A guilloche as engraved on watch dials: closed curves [lines, samples, 2] inside the unit circle."""
    t = np.linspace(0, 2 * np.pi, samples)
    shift = np.linspace(0, 2 * np.pi / petals, lines, endpoint=False)[:, None]
    radius = 0.62 + 0.3 * np.cos(petals * (t + shift)) * np.cos(0.5 * petals * shift)
    return np.stack([radius * np.cos(t), radius * np.sin(t)], axis=-1)
