"""Polygons to triangles: fans where that is right, ears where it is not."""

from dataclasses import dataclass

import numpy as np

from .vectors import cross, lengths

_FLAT = 1e-12  # twice the area over the longest edge squared, below which a triangle counts as degenerate
_CHUNK = 1 << 16  # faces handled at a time, so that temporaries stay in the cache


@dataclass(frozen=True, eq=False)
class Triangles:
    """Triangles of polygons.

    Attributes:
        corners: positions in faceVertexIndices, shape [m, 3], int64.
        faces: source face of each triangle, shape [m], int64.
        degenerate: faces of which nothing is left.
    """

    corners: np.ndarray
    faces: np.ndarray
    degenerate: np.ndarray


def triangulate(points: np.ndarray, counts: np.ndarray, indices: np.ndarray, faces: np.ndarray) -> Triangles:
    """Triangulate the polygons ``faces`` (ascending) of a mesh.

    ``points`` [n, 3]; ``counts`` [f] corners of every face, each 3 or more for the faces asked for; ``indices``
    [sum(counts)] point indices. Convex faces become fans, quadrilaterals are cut at their reflex corner, other concave
    faces are clipped ear by ear in the plane of their area vector. Winding is kept; triangles without area are left
    out.
    """
    starts = np.concatenate(([0], np.cumsum(counts)[:-1]))
    corners, owners = [np.zeros((0, 3), np.int64)], [np.zeros(0, np.int64)]
    for n in np.unique(counts[faces]):
        alike = faces[counts[faces] == n]
        for first in range(0, len(alike), _CHUNK):
            some = alike[first : first + _CHUNK]
            positions = starts[some][:, None] + np.arange(n)
            local = _fans(points[indices[positions]])
            picked = np.take_along_axis(positions[:, None, :], local, axis=2).reshape(-1, 3)
            keep = _has_area(points[indices[picked]])
            corners.append(picked[keep])
            owners.append(np.repeat(some, n - 2)[keep])
    every, owner = np.concatenate(corners), np.concatenate(owners)
    if (owner[1:] < owner[:-1]).any():
        order = np.argsort(owner, kind="stable")
        every, owner = every[order], owner[order]
    left = np.zeros(len(counts), bool)
    left[owner] = True
    return Triangles(every, owner, faces[~left[faces]])


def _has_area(triangles: np.ndarray) -> np.ndarray:
    """Whether triangles [m, 3, 3] have an area worth the name."""
    a, b, c = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0], triangles[:, 2] - triangles[:, 1]
    longest = np.maximum(np.maximum((a * a).sum(1), (b * b).sum(1)), (c * c).sum(1))
    return lengths(cross(a, b)) > _FLAT * longest


def _fans(polygons: np.ndarray) -> np.ndarray:
    """Corner numbers [f, n - 2, 3] of the triangles of polygons [f, n, 3]."""
    count, n = polygons.shape[:2]
    steps = np.arange(1, n - 1)
    fan = np.stack([np.zeros_like(steps), steps, steps + 1], axis=1)
    local = np.broadcast_to(fan, (count, n - 2, 3))
    if n == 3:
        return local
    spokes = polygons[:, 1:] - polygons[:, :1]
    area = cross(spokes[:, :-1], spokes[:, 1:]).sum(1)
    edges = np.roll(polygons, -1, axis=1) - polygons
    turns = (cross(np.roll(edges, 1, axis=1), edges) * area[:, None]).sum(-1)
    reflex = turns < -_FLAT * (area * area).sum(-1)[:, None]
    bent = reflex.any(1)
    if not bent.any():
        return local
    local = local.copy()
    if n == 4:
        local[bent] = (local[bent] + reflex[bent].argmax(1)[:, None, None]) % 4
    else:
        for i in np.flatnonzero(bent):
            local[i] = clip_ears(_flatten(polygons[i], area[i]))
    return local


def _flatten(polygon: np.ndarray, area: np.ndarray) -> np.ndarray:
    """Coordinates [n, 2] in the plane across ``area``, counter-clockwise."""
    n = area / max(float(np.linalg.norm(area)), 1e-300)
    helper = np.eye(3)[np.abs(n).argmin()]
    u = np.cross(helper, n)
    u /= max(float(np.linalg.norm(u)), 1e-300)
    return (polygon - polygon[0]) @ np.stack([u, np.cross(n, u)], axis=1)


def clip_ears(polygon: np.ndarray) -> np.ndarray:
    """Triangles [n - 2, 3] (corner numbers) of a simple polygon [n, 2] given counter-clockwise.

    Repeated corners (bridges to holes) are allowed. A polygon that crosses itself still gives n - 2 triangles.
    """
    left = list(range(len(polygon)))
    found = []
    at = 0
    tried = 0
    while len(left) > 3:
        at %= len(left)
        i, j, k = left[at - 1], left[at], left[(at + 1) % len(left)]
        if tried >= len(left) or _is_ear(polygon, left, i, j, k):
            found.append((i, j, k))
            left.pop(at)
            at -= 1
            tried = 0
        else:
            at += 1
            tried += 1
    found.append((left[0], left[1], left[2]))
    return np.array(found, np.int64)


def _is_ear(polygon: np.ndarray, left: list[int], i: int, j: int, k: int) -> bool:
    """Whether triangle (i, j, k) lies inside: it turns left and holds no other corner that is not one of its own."""
    a, b, c = polygon[i], polygon[j], polygon[k]
    if _turn(a, b, c) <= 0:
        return False
    p = polygon[left]
    inside = (_turn(a, b, p) >= 0) & (_turn(b, c, p) >= 0) & (_turn(c, a, p) >= 0)
    own = (p == a).all(1) | (p == b).all(1) | (p == c).all(1)
    return not (inside & ~own).any()


def _turn(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
    return (b[0] - a[0]) * (p[..., 1] - a[1]) - (b[1] - a[1]) * (p[..., 0] - a[0])
