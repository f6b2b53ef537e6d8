"""Explicit scratches on a mesh: polylines -> pieces, each in the plane of one triangle, in the order of triangles."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from ..scene import Curves
from .segments_device import Segment
from .segments_kernels import Facets, Stretches, bounds, cut_in_uv, cut_on_surface

Array = np.ndarray[Any, Any]

# Sharper bends than this [rad] are corners of the scratch; gentler ones are a smooth scratch drawn by a polyline.
CORNER = 0.6


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


def stretches(curves: Curves, layer: int, device: str = "cpu") -> tuple[Stretches, int]:
    """The straight parts of polylines with the directions that a smooth scratch has at their ends, and how many."""
    points, counts = np.asarray(curves.points, np.float64), np.asarray(curves.counts, np.int64)
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

    width = 0.5 * (curves.widths[start] + curves.widths[start + 1])
    depth = 0.5 * (curves.depths[start] + curves.depths[start + 1])
    width = -width if curves.width_unit == "uv" else width
    depth = -depth if curves.depth_unit == "uv" else depth
    keep = (size[start, 0] > 0) & (width != 0)
    s: Any = Stretches()
    s.a = wp.array(points[start][keep], dtype=wp.vec3d, device=device)
    s.b = wp.array(points[start + 1][keep], dtype=wp.vec3d, device=device)
    s.along_a = wp.array(at_start[keep].astype(np.float32), dtype=wp.vec3, device=device)
    s.along_b = wp.array(at_end[keep].astype(np.float32), dtype=wp.vec3, device=device)
    s.width = wp.array(width[keep].astype(np.float32), dtype=float, device=device)
    s.depth = wp.array(depth[keep].astype(np.float32), dtype=float, device=device)
    s.layer = layer
    return s, int(keep.sum())


def build(
    strokes: Sequence[Stroke],
    points: Any,
    uvs: Any,
    dpdu: Any,
    dpdv: Any,
    mesh: wp.Mesh,
    with_bvh: bool = True,
    device: str = "cpu",
) -> SegmentSet:
    """Lay scratches on triangles and cut them there.

    Scratches in space are projected onto the surface where it is near: as near as their ends and middle are, so that a
    stretch that ends off the surface by more than half of its length is left out. Those in uv follow the mapping.

    Args:
        points, uvs: corners of all triangles, dpdu, dpdv: of each triangle (arrays of ``kernels.geometry``).
        mesh: over the same triangles. with_bvh: whether to build a hierarchy over the pieces.
    """
    corners = points.numpy().reshape(-1, 3, 3)
    f: Any = Facets()
    f.points, f.uvs, f.dpdu, f.dpdv = points, uvs, dpdu, dpdv
    on_surface = any(s.curves.space == "object" for s in strokes)
    inward = edge_normals(corners) if on_surface else np.zeros((1, 3, 3), np.float32)
    f.edges = wp.array(inward.reshape(-1, 3), dtype=wp.vec3, device=device)
    # what rounding moves a point on the surface
    slack = 4e-6 * float(np.abs(corners).max(initial=0.0)) + 1e-9
    parts = [_cut(s, f, mesh, slack, device) for s in strokes]
    parts = [p for p in parts if len(p)]
    row_type: Any = Segment
    rows = np.concatenate(parts) if parts else np.zeros(0, row_type.numpy_dtype())
    rows = rows[np.argsort(rows["triangle"], kind="stable")]
    starts = np.searchsorted(rows["triangle"], np.arange(len(corners) + 1)).astype(np.int32)
    count = len(rows)
    segments: Any = wp.array(rows if count else np.zeros(1, row_type.numpy_dtype()), dtype=Segment, device=device)
    hierarchy = None
    if with_bvh and count:
        lower: Any = wp.empty(count, dtype=wp.vec3, device=device)
        upper: Any = wp.empty(count, dtype=wp.vec3, device=device)
        wp.launch(bounds, count, inputs=[segments, points], outputs=[lower, upper], device=device)
        hierarchy = wp.Bvh(lower, upper)
    return SegmentSet(segments, wp.array(starts, dtype=int, device=device), count, hierarchy)


def _cut(stroke: Stroke, f: Any, mesh: wp.Mesh, slack: float, device: str) -> Array:
    s, n = stretches(stroke.curves, stroke.layer, device)
    row_type: Any = Segment
    if n == 0 or not stroke.taken.any():
        return np.zeros(0, row_type.numpy_dtype())
    f.taken = wp.array(stroke.taken.astype(np.uint8), dtype=wp.uint8, device=device)
    none: Any = wp.empty(0, dtype=int, device=device)
    counts: Any = wp.zeros(n, dtype=int, device=device)
    nothing: Any = wp.empty(0, dtype=Segment, device=device)
    kernel: Any
    if stroke.curves.space == "uv":
        faces = np.flatnonzero(stroke.taken).astype(np.int32)
        flat = np.concatenate([f.uvs.numpy().reshape(-1, 3, 2)[faces], np.zeros((len(faces), 3, 1), np.float32)], -1)
        over = wp.Bvh(
            wp.array(flat.min(1), dtype=wp.vec3, device=device), wp.array(flat.max(1), dtype=wp.vec3, device=device)
        )
        given = [s, f, over.id, wp.array(faces, dtype=int, device=device)]
        kernel = cut_in_uv
    else:
        given = [s, f, mesh.id, slack]
        kernel = cut_on_surface
    wp.launch(kernel, n, inputs=[*given, none, counts, nothing], device=device)
    found = counts.numpy()
    starts = np.concatenate([[0], np.cumsum(found)]).astype(np.int64)
    if starts[-1] == 0:
        return np.zeros(0, row_type.numpy_dtype())
    out: Any = wp.empty(int(starts[-1]), dtype=Segment, device=device)
    begin: Any = wp.array(starts[:-1].astype(np.int32), dtype=int, device=device)
    wp.launch(kernel, n, inputs=[*given, begin, counts, out], device=device)
    return out.numpy()
