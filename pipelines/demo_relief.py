"""Grooved plates as true geometry: the triangles that the groove stages do without.

Plates lie in the plane z = 0 with z up while they are made; ``plate`` turns them +Y up, x along u and y along v. The
sections are those of a groove path: x to the left of the path's direction, from its middle.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np

from .demo_shapes import Shape

Face = np.ndarray  # [k, 3], counter-clockwise seen from outside
Boxed = tuple[np.ndarray, tuple[float, ...]]
TINY = 1e-12  # of an area: smaller pieces of it are dropped


@dataclass(frozen=True, eq=False)
class Cut:
    """A straight groove that digs in: ``start``, ``end`` [2] in the plate, ``section`` [n, 2] of (x, z), z <= 0 and x
    ascending; both ends are vertical walls."""

    start: np.ndarray
    end: np.ndarray
    section: np.ndarray


@dataclass(frozen=True, eq=False)
class Slab:
    """One flat facet: the polygon [k, 2] that it covers, and z = gradient . p + offset over it."""

    polygon: np.ndarray
    gradient: np.ndarray
    offset: float
    owner: int

    def height(self, p: np.ndarray) -> np.ndarray:
        """z at ``p`` [..., 2]."""
        return p @ self.gradient + self.offset


def ruled(side: float, section: np.ndarray, pitch: float, shift: float = 0.0) -> Shape:
    """A square plate of ``side`` about the origin with grooves along +x, ``pitch`` apart, one of them at y = ``shift``.

    ``section`` [n, 2] may stand out and overhang. Along y the plate ends with the last whole groove.
    """
    reach = 0.5 * side
    count, shift = int(reach / pitch), shift % pitch
    line = np.concatenate([section + (k * pitch + shift, 0.0) for k in range(-count, count)])
    line = line[np.concatenate([[True], np.any(np.abs(np.diff(line, axis=0)) > 1e-12, axis=1)])]
    faces = []
    for (ya, za), (yb, zb) in pairwise(line):
        faces.append(np.array([(-reach, ya, za), (reach, ya, za), (reach, yb, zb), (-reach, yb, zb)]))
    return plate(faces, side)


def crossed(side: float, cuts: Sequence[Cut]) -> Shape:
    """A square plate of ``side`` about the origin with grooves that cross: the lowest of their heights, exactly.

    Facets are cut where one groove gets below another, so every polygon is flat and every crease an edge.
    """
    square = 0.5 * side * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    slabs = [slab for i, cut in enumerate(cuts) for slab in _slabs(cut, i)]
    ground = Slab(square, np.zeros(2), 0.0, -1)
    faces = []
    for slab in [ground, *slabs]:
        regions = [_boxed(_inside(slab.polygon, square))]
        for other in slabs:
            if other.owner != slab.owner and _meet(slab.polygon, other.polygon):
                low = _boxed(_lower(other, slab))
                regions = [rest for region in regions for rest in _without(region, low)]
        for region, _ in regions:
            if _area(region) > TINY * side * side:
                faces.append(np.column_stack([region, slab.height(region)]))
    faces += [wall for i, cut in enumerate(cuts) for wall in _walls(cut, i, slabs, side)]
    return plate(faces, side)


def plate(faces: Sequence[Face], side: float) -> Shape:
    """Flat faces [k, 3] over the square of ``side`` about the origin as a shape, +Y up, u along x and v along -z."""
    points, normals, counts = np.concatenate(faces), [], []
    for face in faces:
        turned = np.roll(face, -1, axis=0)
        normal = 0.5 * np.cross(face - face[0], turned - face[0]).sum(axis=0)
        normals.append(np.broadcast_to(normal / np.linalg.norm(normal), face.shape))
        counts.append(len(face))
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    uv = 0.5 + points[:, :2] / side
    return Shape(points @ turn, np.concatenate(normals) @ turn, uv, np.array(counts), np.arange(len(points)))


def _frame(cut: Cut) -> tuple[np.ndarray, np.ndarray]:
    along = (cut.end - cut.start) / np.linalg.norm(cut.end - cut.start)
    return along, np.array([-along[1], along[0]])


def _edges(cut: Cut) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    return ((a, b) for a, b in pairwise(cut.section) if b[0] > a[0])


def _slabs(cut: Cut, owner: int) -> Iterator[Slab]:
    _, across = _frame(cut)
    for (xa, za), (xb, zb) in _edges(cut):
        corners = [cut.start + xa * across, cut.end + xa * across, cut.end + xb * across, cut.start + xb * across]
        gradient = (zb - za) / (xb - xa) * across
        yield Slab(np.array(corners), gradient, float(za - gradient @ corners[0]), owner)


def _half(polygon: np.ndarray, normal: np.ndarray, limit: float) -> np.ndarray:
    """The part of a convex polygon where normal . p <= limit."""
    if len(polygon) == 0:
        return polygon
    over = polygon @ normal - limit
    kept = []
    for k in range(len(polygon)):
        j = (k + 1) % len(polygon)
        if over[k] <= 0.0:
            kept.append(polygon[k])
        if over[k] * over[j] < 0.0:
            kept.append(polygon[k] + over[k] / (over[k] - over[j]) * (polygon[j] - polygon[k]))
    return np.array(kept) if len(kept) > 2 else np.zeros((0, 2))


def _sides(polygon: np.ndarray) -> Iterator[tuple[np.ndarray, float]]:
    """Outward normals and limits of a convex polygon, counter-clockwise."""
    for p, q in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        normal = np.array([q[1] - p[1], p[0] - q[0]])
        if np.any(normal != 0.0):
            yield normal, float(normal @ p)


def _inside(polygon: np.ndarray, other: np.ndarray) -> np.ndarray:
    for normal, limit in _sides(other):
        polygon = _half(polygon, normal, limit)
        if len(polygon) == 0:
            break
    return polygon


def _boxed(polygon: np.ndarray) -> Boxed:
    """A polygon with its bounds (least x, least y, most x, most y); an empty one meets nothing."""
    if len(polygon) == 0:
        return polygon, (np.inf, np.inf, -np.inf, -np.inf)
    return polygon, (*polygon.min(0).tolist(), *polygon.max(0).tolist())


def _without(region: Boxed, cut: Boxed) -> list[Boxed]:
    """What is left of a convex polygon, in convex pieces."""
    (polygon, (a, b, c, d)), (other, (e, f, g, h)) = region, cut
    if a >= g or e >= c or b >= h or f >= d or _area(_inside(polygon, other)) <= TINY * _area(polygon):
        return [region] if len(polygon) else []
    pieces = []
    for normal, limit in _sides(other):
        outside = _half(polygon, -normal, -limit)
        if len(outside):
            pieces.append(_boxed(outside))
        polygon = _half(polygon, normal, limit)
    return pieces


def _lower(slab: Slab, than: Slab) -> np.ndarray:
    """Where a slab lies below another; of two that are level the later owner counts as the lower one."""
    gradient, offset = slab.gradient - than.gradient, than.offset - slab.offset
    if np.abs(gradient).max() < 1e-12:
        below = offset > 0.0 or (offset == 0.0 and slab.owner > than.owner)
        return slab.polygon if below else np.zeros((0, 2))
    return _half(slab.polygon, gradient, offset)


def _meet(a: np.ndarray, b: np.ndarray) -> bool:
    if len(a) == 0 or len(b) == 0:
        return False
    return bool(np.all(a.min(0) < b.max(0)) and np.all(b.min(0) < a.max(0)))


def _area(polygon: np.ndarray) -> float:
    if len(polygon) < 3:
        return 0.0
    a, b = polygon[1:-1] - polygon[0], polygon[2:] - polygon[0]
    return 0.5 * float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))


def _walls(cut: Cut, owner: int, slabs: Sequence[Slab], side: float) -> Iterator[Face]:
    """The vertical walls at the two ends of a groove, cut out where others are lower."""
    _, across = _frame(cut)
    x, z = cut.section[:, 0], cut.section[:, 1]
    own = [(float(zb - za) / (xb - xa), za - (zb - za) / (xb - xa) * xa) for (xa, za), (xb, zb) in _edges(cut)]
    for point, at_end in ((cut.start, False), (cut.end, True)):
        if np.any(np.abs(point) > 0.5 * side):
            continue
        near = []  # where the end line is on other grooves, and their heights there, slope x + offset
        for slab in slabs:
            span = _span(slab.polygon, point, across) if slab.owner != owner else None
            if span is not None:
                near.append((span, (float(slab.gradient @ across), float(slab.height(point)))))
        lines = [(0.0, 0.0), *own, *[line for _, line in near]]
        level = [(d - b) / (a - c) for (a, b), (c, d) in combinations(lines, 2) if abs(a - c) > 1e-12]
        breaks = np.unique(np.clip(np.concatenate([x, level, *[span for span, _ in near]]), x[0], x[-1]))
        for at in map(np.array, pairwise(breaks)):
            if at[1] - at[0] < 1e-9 * side:
                continue
            over = [line for span, line in near if span[0] < at.mean() < span[1]]
            top = np.min([np.zeros(2), *[slope * at + offset for slope, offset in over]], axis=0)
            low = np.minimum(top, np.interp(at, x, z))
            foot = point + at[:, None] * across
            face = np.array([[*foot[0], low[0]], [*foot[1], low[1]], [*foot[1], top[1]], [*foot[0], top[0]]])
            face = face[np.linalg.norm(face - np.roll(face, 1, axis=0), axis=1) > 1e-9 * side]
            if len(face) > 2:
                yield face[::-1] if at_end else face


def _span(polygon: np.ndarray, point: np.ndarray, across: np.ndarray) -> np.ndarray | None:
    """Where the line point + x across enters and leaves a convex polygon: [2], or None."""
    low, high = -np.inf, np.inf
    for normal, limit in _sides(polygon):
        speed, room = float(normal @ across), limit - float(normal @ point)
        if abs(speed) < 1e-15:
            if room < 0.0:
                return None
        elif speed > 0.0:
            high = min(high, room / speed)
        else:
            low = max(low, room / speed)
    return np.array([low, high]) if low < high else None
