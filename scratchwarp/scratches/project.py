"""Explicit scratches in space -> polylines in the surface's uv."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from ..scene import Curves
from .project_kernels import nearest

PARTS = 16  # of a straight stretch, looked at to see how it bends in uv
BEND = 0.02  # of a scratch's width that a stretch may leave its chord by [um]
JUMP = 4.0  # times as far in uv as in space: across a seam

Array = np.ndarray[Any, Any]


def in_uv(curves: Curves, mesh: wp.Mesh, uv: Array, taken: Array, scale: Array) -> Curves:
    """The scratches where the surface is near, as near as half of their stretch is long, in uv.

    Args:
        curves: in space. mesh: the surface. uv: of the corners of its triangles [m, 3, 2]. taken: triangles that they
            may lie on, bool [m]. scale: micrometres a unit of u and of v.

    Where a scratch crosses a seam of the mapping it is cut, at most ``1 / PARTS`` of a stretch beside the seam.
    """
    points, counts = np.asarray(curves.points, np.float64), np.asarray(curves.counts, np.int64)
    last = np.zeros(len(points), bool)
    last[np.cumsum(counts) - 1] = True
    at: list[Array] = []  # of each curve: places along it, in points
    for first, count in zip(np.cumsum(counts) - counts, counts, strict=True):
        at.append(np.append(first + np.arange((count - 1) * PARTS) / PARTS, first + count - 1.0))
    flat = np.concatenate(at)
    low = np.minimum(np.floor(flat).astype(int), len(points) - 1)
    high = np.where(last[low], low, np.minimum(low + 1, len(points) - 1))
    part = (flat - low)[:, None]
    world = (1.0 - part) * points[low] + part * points[high]
    step = np.linalg.norm(points[high] - points[low], axis=1)
    reach = 0.5 * float(step.max(initial=0.0))
    face, weights = _nearest(world, mesh, reach)
    b = np.concatenate([weights, 1.0 - weights.sum(1, keepdims=True)], 1)
    place = (uv[np.maximum(face, 0)] * b[..., None]).sum(1)
    there = (face >= 0) & taken[np.maximum(face, 0)]

    runs: list[Array] = []
    sizes: list[tuple[float, float]] = []
    begin = 0
    for own in at:
        span = slice(begin, begin + len(own))
        begin += len(own)
        width, depth = float(curves.widths[low[span]].mean()), float(curves.depths[low[span]].mean())
        here, flat_um = there[span], place[span] * scale
        far = np.linalg.norm(np.diff(flat_um, axis=0), axis=1)
        moved = 1e6 * np.linalg.norm(np.diff(world[span], axis=0), axis=1)
        joined = here[:-1] & here[1:] & (far <= JUMP * moved + 1e-9)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], joined, [False]]).astype(int)))
        for i, j in zip(edges[::2], edges[1::2], strict=True):
            line = flat_um[i : j + 1]
            runs.append(line[_kept(line, BEND * width)] / scale)
            sizes.append((width, depth))
    lengths = np.array([len(r) for r in runs], np.int32)
    table = np.repeat(np.array(sizes).reshape(-1, 2), lengths, axis=0)
    laid = np.concatenate(runs) if runs else np.zeros((0, 2))
    return Curves(
        path=curves.path,
        points=np.concatenate([laid, np.zeros((len(laid), 1))], 1),
        counts=lengths,
        widths=table[:, 0],
        depths=table[:, 1],
        space="uv",
        width_unit=curves.width_unit,
        depth_unit=curves.depth_unit,
    )


def _nearest(points: Array, mesh: wp.Mesh, reach: float) -> tuple[Array, Array]:
    device = mesh.device
    face: Any = wp.empty(len(points), dtype=int, device=device)
    weights: Any = wp.zeros(len(points), dtype=wp.vec2, device=device)
    given: Any = wp.array(points.astype(np.float32), dtype=wp.vec3, device=device)
    wp.launch(nearest, len(points), inputs=[mesh.id, reach, given], outputs=[face, weights], device=device)
    return face.numpy(), weights.numpy().astype(np.float64)


def _kept(line: Array, tolerance: float) -> Array:
    """Which points a polyline needs so that the others lie within ``tolerance`` of it (Douglas and Peucker 1973)."""
    keep = np.zeros(len(line), bool)
    keep[[0, -1]] = True
    spans: list[tuple[int, int]] = [(0, len(line) - 1)]
    while spans:
        i, j = spans.pop()
        if j > i + 1:
            run = line[j] - line[i]
            away = line[i + 1 : j] - line[i]
            length = float(np.linalg.norm(run))
            if length > 0.0:
                off = np.abs(away[:, 0] * run[1] - away[:, 1] * run[0]) / length
            else:
                off = np.linalg.norm(away, axis=1)
            k = int(off.argmax())
            if off[k] > tolerance:
                keep[i + 1 + k] = True
                spans += [(i, i + 1 + k), (i + 1 + k, j)]
    return keep


def all_in_uv(sets: Sequence[Curves], mesh: wp.Mesh, uv: Array, taken: Array, scale: Array) -> list[Curves]:
    """``in_uv`` of those that lie in space, the others as they are."""
    return [c if c.space == "uv" else in_uv(c, mesh, uv, taken, scale) for c in sets]
