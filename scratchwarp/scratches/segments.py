"""Explicit scratches on a mesh: polylines -> pieces, each in the plane of one triangle, in the order of triangles."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import warp as wp

from ..scene import Curves
from .segments_device import Segment
from .segments_kernels import Facets, Stretches, bounds, cut_in_uv, cut_on_surface

Array = np.ndarray[Any, Any]

# Sharper bends than this [rad] are corners of the scratch; gentler ones are a smooth scratch drawn by a polyline.
CORNER = 0.6
# Points of polylines that are looked at at once.
PORTION = 1 << 15
# Straight parts of polylines that are cut at once.
STRETCHES = 1 << 18
# Polylines of very many that are cut to tell how many pieces all of them are, before they are laid out.
SAMPLE = 1 << 12
# More pieces than this would take more than about 5 GB while they are made.
MOST_PIECES = 24_000_000


@dataclass(frozen=True, eq=False)
class Stroke:
    """One set of scratches to lay on the surface.

    Attributes:
        curves: the polylines. layer: number that its pieces carry.
        taken: triangles that it may lie on, shape [m], bool.
    """

    curves: Curves
    layer: int
    taken: Array


@dataclass(frozen=True, eq=False)
class SegmentSet:
    """All pieces on the device.

    Attributes:
        segments: array of ``Segment``, sorted by triangle. starts: of each triangle's pieces, shape [m + 1], int32.
        count: of pieces. bvh: hierarchy over their world boxes, None where there is none.
    """

    segments: Any
    starts: Any
    count: int
    bvh: wp.Bvh | None


def corner_numbers(points: Array) -> Array:
    """A number for each corner of triangles ``[m, 3, 3]`` float32, the same where they are in the same place."""
    bits = (points.reshape(-1, 3) + np.float32(0.0)).view(np.uint32).astype(np.uint64)
    keys = bits[:, 0] * np.uint64(0x9E3779B97F4A7C15) ^ bits[:, 1] * np.uint64(0xC2B2AE3D27D4EB4F)
    keys = (keys ^ (keys >> np.uint64(29))) + bits[:, 2] * np.uint64(0x165667B19E3779F9)
    _, corner = np.unique(keys, return_inverse=True)
    return corner.reshape(-1, 3).astype(np.int64)


def surroundings(points: Array) -> tuple[Array, Array, Array]:
    """(starts [m + 1], triangles, reach [m]): for each triangle those that share a corner with it, and itself; how
    far [m] beyond its edges they reach at least (their least height)."""
    p = np.ascontiguousarray(points, np.float32)
    m = len(p)
    corner = corner_numbers(p)
    order = np.argsort(corner.ravel(), kind="stable")
    owner = (order // 3).astype(np.int64)
    first = np.searchsorted(corner.ravel()[order], np.arange(corner.max(initial=0) + 2))
    # every pair of triangles at every corner
    size = np.diff(first)
    fan = size[corner]  # [m, 3]
    total = fan.ravel()
    left = np.repeat(np.arange(m).repeat(3), total)
    begin = np.repeat(first[:-1][corner.ravel()], total)
    step = np.arange(len(left)) - np.repeat(np.cumsum(total) - total, total)
    right = owner[begin + step]
    pairs = np.unique(left * m + right)
    left, right = pairs // m, pairs % m
    starts = np.searchsorted(left, np.arange(m + 1)).astype(np.int32)
    along = np.roll(p, -1, axis=1).astype(np.float64) - p
    double = np.linalg.norm(np.cross(along[:, 0], along[:, 1]), axis=1)
    height = double / np.maximum(np.linalg.norm(along, axis=-1).max(1), 1e-300)
    reach = np.minimum.reduceat(height[right], starts[:-1]) if len(right) else np.zeros(0)
    return starts, right.astype(np.int32), reach.astype(np.float32)


def edge_normals(points: Array) -> Array:
    """Inward normals of the planes that bound triangles: through each edge and the mean of the normals beside it.

    ``points``: corners ``[m, 3, 3]``. Result ``[m, 3, 3]``, of edge k from corner k to k + 1. Neighbours share the
    plane, so that nothing near the surface is lost or counted twice between them.
    """
    m = len(points)
    p = np.ascontiguousarray(points, np.float32)
    corner = corner_numbers(p)
    exact = p.astype(np.float64)
    along = np.roll(exact, -1, axis=1) - exact
    normal = np.cross(along[:, 0], -along[:, 2])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    following = np.roll(corner, -1, axis=1)
    edge = np.minimum(corner, following) * (3 * m + 1) + np.maximum(corner, following)
    _, group = np.unique(edge.ravel(), return_inverse=True)
    group = group.ravel()
    spread = np.repeat(normal, 3, axis=0)
    total = np.stack([np.bincount(group, spread[:, k]) for k in range(3)], 1)[group].reshape(m, 3, 3)
    # two sides of a sheet of no thickness cancel: cut those square
    flat = np.linalg.norm(total, axis=-1) < 0.2
    total[flat] = np.repeat(normal[:, None], 3, axis=1)[flat]
    inward = np.cross(total, along)
    size = np.linalg.norm(inward, axis=-1, keepdims=True)
    return np.divide(inward, size, out=np.zeros_like(inward), where=size > 0).astype(np.float32)


def stretches(
    curves: Curves, layer: int, device: str = "cpu", progress: Callable[[int], None] | None = None
) -> tuple[Stretches, int]:
    """The straight parts of polylines with the directions that a smooth scratch has at their ends, and how many.

    ``progress``: called with the number of polylines that were just looked at.
    """
    counts = np.asarray(curves.counts, np.int64)
    most = int(np.maximum(counts - 1, 0).sum())
    ends = np.empty((2, most, 3))
    along = np.empty((2, most, 3), np.float32)
    sizes = np.empty((2, most), np.float32)
    n = 0
    # a few at a time: what is in between stays in the processor's cache
    for first, last, point in _portions(counts):
        own = slice(point, point + int(counts[first:last].sum()))
        part = _straight(curves.points[own], counts[first:last], curves.widths[own], curves.depths[own])
        k = len(part[0])
        for into, values in zip((*ends, *along, *sizes), part, strict=True):
            into[n : n + k] = values
        n += k
        if progress is not None:
            progress(last - first)
    sizes[0] *= -1.0 if curves.width_unit == "uv" else 1.0
    sizes[1] *= -1.0 if curves.depth_unit == "uv" else 1.0
    s: Any = Stretches()
    s.a, s.b = (wp.array(x[:n], dtype=wp.vec3d, device=device, copy=False) for x in ends)
    s.along_a, s.along_b = (wp.array(x[:n], dtype=wp.vec3, device=device, copy=False) for x in along)
    s.width, s.depth = (wp.array(x[:n], dtype=float, device=device, copy=False) for x in sizes)
    s.layer = layer
    return s, n


def _portions(counts: Array) -> Iterator[tuple[int, int, int]]:
    """(first, last + 1, first point) of polylines ``PORTION`` points at a time, or one at a time where it has more."""
    after = np.cumsum(counts)
    first = 0
    while first < len(counts):
        point = int(after[first] - counts[first])
        last = max(int(np.searchsorted(after, point + PORTION, side="right")), first + 1)
        yield first, last, point
        first = last


def _straight(points: Array, counts: Array, widths: Array, depths: Array) -> tuple[Array, ...]:
    """Ends, directions there, width and depth of the straight parts of some polylines."""
    points = np.asarray(points, np.float64)
    last = np.zeros(len(points), bool)
    last[np.cumsum(counts) - 1] = True
    start = np.flatnonzero(~last)
    run = np.zeros_like(points)
    run[start] = points[start + 1] - points[start]
    size = np.linalg.norm(run, axis=1, keepdims=True)
    unit = np.divide(run, size, out=np.zeros_like(run), where=size > 0)
    # direction at each point: between those of the stretches that meet there, unless they meet in a corner
    before = np.zeros_like(unit)
    before[start + 1] = unit[start]
    inner = ~last & (np.abs(before).max(1) > 0) & (np.abs(unit).max(1) > 0)
    smooth = inner & ((before * unit).sum(1) > np.cos(CORNER))
    # a bend is shared in proportion to the other stretch, as on a circle through three points
    reach = np.zeros_like(size)
    reach[start + 1] = size[start]
    mean = before * size + unit * reach
    mean /= np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-300)
    at_start, at_end = unit[start].copy(), unit[start].copy()
    at_start[smooth[start]] = mean[start][smooth[start]]
    at_end[smooth[start + 1]] = mean[start + 1][smooth[start + 1]]
    # where a curve begins or ends it goes on turning as it does at the other end of that stretch
    opening, closing = ~smooth[start] & smooth[start + 1], smooth[start] & ~smooth[start + 1]
    reflect = 2.0 * (at_end * unit[start]).sum(1, keepdims=True) * unit[start] - at_end
    at_start[opening] = reflect[opening]
    reflect = 2.0 * (at_start * unit[start]).sum(1, keepdims=True) * unit[start] - at_start
    at_end[closing] = reflect[closing]

    width = 0.5 * (widths[start] + widths[start + 1])
    depth = 0.5 * (depths[start] + depths[start + 1])
    keep = (size[start, 0] > 0) & (width != 0)
    made = (points[start], points[start + 1], at_start, at_end, width, depth)
    return tuple(values[keep] for values in made)


def build(
    strokes: Sequence[Stroke],
    points: Any,
    uvs: Any,
    dpdu: Any,
    dpdv: Any,
    mesh: wp.Mesh,
    with_bvh: bool = True,
    device: str = "cpu",
    progress: Callable[[int, int], None] | None = None,
    groups: Callable[[Array], Array] | None = None,
) -> SegmentSet:
    """Lay scratches on triangles and cut them there.

    Scratches in space are projected onto the surface where it is near: as near as their ends and middle are, so that a
    stretch that ends off the surface by more than half of its length is left out. Those in uv follow the mapping.

    Args:
        points, uvs: corners of all triangles, dpdu, dpdv: of each triangle (arrays of ``kernels.geometry``).
        mesh: over the same triangles. with_bvh: whether to build a hierarchy over the pieces.
        progress: called with (done, total) as work proceeds. groups: from the layer number of each piece to the group
        of the hierarchy that it is in; None: there are no groups.

    Raises ValueError where that would be more than ``MOST_PIECES`` pieces.
    """
    corners = points.numpy().reshape(-1, 3, 3)
    f, slack = _facets(strokes, points, uvs, dpdu, dpdv, device)
    # each scratch is made straight, cut twice (to count and to keep), and placed in the hierarchy
    left, total = [0], 4 * sum(len(s.curves.counts) for s in strokes)

    def done(number: int) -> None:
        left[0] += number
        if progress is not None:
            progress(left[0], total)

    parts: list[Array] = []
    for s in strokes:
        parts.append(_cut(s, f, mesh, slack, device, sum(map(len, parts)), done))
    row_type: Any = Segment
    parts = parts or [np.zeros(0, row_type.numpy_dtype())]
    rows = np.concatenate(parts) if len(parts) > 1 else parts[0]
    rows = rows[np.argsort(rows["triangle"], kind="stable")]
    starts = np.searchsorted(rows["triangle"], np.arange(len(corners) + 1)).astype(np.int32)
    count = len(rows)
    held = rows if count else np.zeros(1, row_type.numpy_dtype())
    segments: Any = wp.array(held, dtype=Segment, device=device, copy=False)
    del parts
    hierarchy = None
    if with_bvh and count:
        lower: Any = wp.empty(count, dtype=wp.vec3, device=device)
        upper: Any = wp.empty(count, dtype=wp.vec3, device=device)
        wp.launch(bounds, count, inputs=[segments, points], outputs=[lower, upper], device=device)
        dealt: Any = wp.array(groups(held["layer"]), dtype=int, device=device) if groups is not None else None
        hierarchy = wp.Bvh(lower, upper, groups=dealt)
    done(total - left[0])
    return SegmentSet(segments, wp.array(starts, dtype=int, device=device), count, hierarchy)


def _facets(strokes: Sequence[Stroke], points: Any, uvs: Any, dpdu: Any, dpdv: Any, device: str) -> tuple[Any, float]:
    """What strokes are cut at, and what rounding moves a point on the surface [m]."""
    corners = points.numpy().reshape(-1, 3, 3)
    f: Any = Facets()
    f.points, f.uvs, f.dpdu, f.dpdv = points, uvs, dpdu, dpdv
    on_surface = any(s.curves.space == "object" for s in strokes)
    inward = edge_normals(corners) if on_surface else np.zeros((1, 3, 3), np.float32)
    f.edges = wp.array(inward.reshape(-1, 3), dtype=wp.vec3, device=device)
    return f, 4e-6 * float(np.abs(corners).max(initial=0.0)) + 1e-9


def _cut(
    stroke: Stroke, f: Any, mesh: wp.Mesh, slack: float, device: str, before: int, done: Callable[[int], None]
) -> Array:
    if len(stroke.curves.counts) > 16 * SAMPLE and stroke.taken.any():
        _foreseen(stroke, f, mesh, slack, device)
    s, n = stretches(stroke.curves, stroke.layer, device, done)
    row_type: Any = Segment
    if n == 0 or not stroke.taken.any():
        return np.zeros(0, row_type.numpy_dtype())
    counts: Any = wp.zeros(n, dtype=int, device=device)
    kernel, given, _held = _cutter(stroke, f, mesh, slack, device)

    def pass_over(starts: Any, out: Any, found: Callable[[int], None]) -> None:
        for first in range(0, n, STRETCHES):
            last = min(first + STRETCHES, n)
            some: Any = _some(s, first, last)
            begin = starts[first:last] if starts.shape[0] else starts
            wp.launch(kernel, last - first, inputs=[some, *given, begin, counts[first:last], out], device=device)
            found(last)
            done(len(stroke.curves.counts) * last // n - len(stroke.curves.counts) * first // n)

    def few_enough(last: int) -> None:
        pieces = before + int(counts[:last].numpy().sum(dtype=np.int64))
        if pieces > MOST_PIECES:
            raise ValueError(
                f"{stroke.curves.path}: the first {last} of {n} straight parts of its scratches are cut into {pieces} "
                f"pieces by the triangles that they cross, more than {MOST_PIECES}; make the scratches fewer or "
                "shorter, or set the layer's model to table"
            )

    none: Any = wp.empty(0, dtype=int, device=device)
    nothing: Any = wp.empty(0, dtype=Segment, device=device)
    pass_over(none, nothing, few_enough)
    after = np.cumsum(counts.numpy(), dtype=np.int64)
    if after[-1] == 0:
        return np.zeros(0, row_type.numpy_dtype())
    out: Any = wp.empty(int(after[-1]), dtype=Segment, device=device)
    starts: Any = wp.array((after - counts.numpy()).astype(np.int32), dtype=int, device=device)
    pass_over(starts, out, lambda last: None)
    return out.numpy()


def _cutter(stroke: Stroke, f: Any, mesh: wp.Mesh, slack: float, device: str) -> tuple[Any, list[Any], Any]:
    """(kernel that cuts stretches, what it is given before those that a launch is about, what must stay alive)."""
    f.taken = wp.array(stroke.taken.astype(np.uint8), dtype=wp.uint8, device=device)
    if stroke.curves.space != "uv":
        return cut_on_surface, [f, mesh.id, slack], mesh
    faces = np.flatnonzero(stroke.taken).astype(np.int32)
    flat = np.concatenate([f.uvs.numpy().reshape(-1, 3, 2)[faces], np.zeros((len(faces), 3, 1), np.float32)], -1)
    over = wp.Bvh(
        wp.array(flat.min(1), dtype=wp.vec3, device=device), wp.array(flat.max(1), dtype=wp.vec3, device=device)
    )
    return cut_in_uv, [f, over.id, wp.array(faces, dtype=int, device=device)], over


def foresee(
    few: Stroke, every: int, points: Any, uvs: Any, dpdu: Any, dpdv: Any, mesh: wp.Mesh, device: str = "cpu"
) -> None:
    """ValueError where a few of ``every`` polylines tell that ``build`` would make of all of them far more than
    ``MOST_PIECES``; before the others are laid out."""
    _estimated(few, every, *_facets([few], points, uvs, dpdu, dpdv, device), mesh, device)


def _foreseen(stroke: Stroke, f: Any, mesh: wp.Mesh, slack: float, device: str) -> None:
    """The same where the polylines are there: by one of so many."""
    curves = stroke.curves
    counts = np.asarray(curves.counts, np.int64)
    taken = np.arange(0, len(counts), len(counts) // SAMPLE)
    first = (np.cumsum(counts) - counts)[taken]
    own = counts[taken]
    at = np.repeat(first - (np.cumsum(own) - own), own) + np.arange(own.sum())
    sizes = {"widths": curves.widths[at], "depths": curves.depths[at]}
    few = replace(curves, points=curves.points[at], counts=own.astype(np.int32), **sizes)
    _estimated(replace(stroke, curves=few), len(counts), f, slack, mesh, device)


def _estimated(stroke: Stroke, every: int, f: Any, slack: float, mesh: wp.Mesh, device: str) -> None:
    s, n = stretches(stroke.curves, stroke.layer, device)
    if n == 0:
        return
    kernel, given, _held = _cutter(stroke, f, mesh, slack, device)
    found: Any = wp.zeros(n, dtype=int, device=device)
    nothing: Any = wp.empty(0, dtype=Segment, device=device)
    none: Any = wp.empty(0, dtype=int, device=device)
    wp.launch(kernel, n, inputs=[s, *given, none, found, nothing], device=device)
    pieces = float(found.numpy().sum(dtype=np.int64)) * every / len(stroke.curves.counts)
    if pieces > 1.5 * MOST_PIECES:
        raise ValueError(
            f"{stroke.curves.path}: its {every} scratches would be cut into about {pieces:.2g} pieces by the triangles "
            f"that they cross, more than {MOST_PIECES}; make the scratches fewer or shorter, or set the layer's model "
            "to table"
        )


def _some(s: Any, first: int, last: int) -> Stretches:
    """Stretches ``first`` to ``last - 1``."""
    r: Any = Stretches()
    for name in ("a", "b", "along_a", "along_b", "width", "depth"):
        setattr(r, name, getattr(s, name)[first:last])
    r.layer = s.layer
    return r
