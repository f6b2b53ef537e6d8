"""Polylines -> segments on the device and a hierarchy over each set."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from ..scene import Curves
from .curves_device import OFF_PLANE, SegmentArrays


@dataclass(frozen=True, eq=False)
class CurveSet:
    """One set of explicit scratches in the device arrays.

    Attributes:
        first, count: its segments. bvh: Warp hierarchy over them (None when there are none).
        reach: how far from a segment's box its strip may lie, in the unit of widths.
        uv: the ends are (u, v, 0); width_uv: half widths are fractions of the uv square.
    """

    first: int
    count: int
    bvh: wp.Bvh | None
    reach: float
    uv: bool
    width_uv: bool


def segments(curves: Curves) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(starts [n, 3], ends [n, 3], half widths [n]) of a set, widths of the two ends averaged, in metres (or uv)."""
    last = np.zeros(len(curves.points), bool)
    last[np.cumsum(curves.counts) - 1] = True
    start = np.flatnonzero(~last)
    a, b = curves.points[start], curves.points[start + 1]
    scale = 1.0 if curves.width_unit == "uv" else 1e-6
    half = 0.25 * scale * (curves.widths[start] + curves.widths[start + 1])
    keep = (np.linalg.norm(b - a, axis=1) > 0) & (half > 0)
    return a[keep], b[keep], half[keep]


def along(curves: Curves) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(curve number [n], length before each segment and its own [n, 2], aspects at its ends [n, 2]) of the segments
    that
    ``segments`` gives. Lengths in micrometres, or in squares in uv. Aspects are -1 where widths and depths have no
    common unit or the width is 0."""
    last = np.zeros(len(curves.points), bool)
    last[np.cumsum(curves.counts) - 1] = True
    start = np.flatnonzero(~last)
    step = np.linalg.norm(curves.points[start + 1] - curves.points[start], axis=1)
    step *= 1e6 if curves.space == "object" else 1.0
    number = np.repeat(np.arange(len(curves.counts)), curves.counts)[start]
    before = np.cumsum(step) - step
    first = np.searchsorted(number, number)  # of each curve
    before = before - before[first] if len(before) else before
    aspects = np.full(len(curves.points), -1.0)
    if curves.width_unit == curves.depth_unit:
        np.divide(curves.depths, curves.widths, out=aspects, where=curves.widths > 0)
    keep = (step > 0) & (curves.widths[start] + curves.widths[start + 1] > 0)
    ends = np.stack([aspects[start], aspects[start + 1]], axis=1)
    return number[keep], np.stack([before, step], axis=1)[keep], ends[keep]


def pack(
    sets: Sequence[Curves], device: str = "cpu", varied: bool = False
) -> tuple[SegmentArrays, tuple[CurveSet, ...]]:
    """Device arrays of all sets, and what a layer needs to know of each; ``varied``: scratches differ."""
    made, parts, first = [], [], 0
    for curves in sets:
        a, b, half = segments(curves)
        parts.append((a, b, half))
        bvh, reach = None, 0.0
        if len(a):
            corners = (np.minimum(a, b).astype(np.float32), np.maximum(a, b).astype(np.float32))
            boxes: list[Any] = [wp.array(corner, dtype=wp.vec3, device=device) for corner in corners]
            bvh = wp.Bvh(boxes[0], boxes[1])
            reach = float(half.max())
            if curves.space == "object":
                reach += float(OFF_PLANE * np.linalg.norm(b - a, axis=1).max())
        made.append(CurveSet(first, len(a), bvh, reach, curves.space == "uv", curves.width_unit == "uv"))
        first += len(a)
    arrays = SegmentArrays()
    columns = [
        np.concatenate(c) if parts else np.zeros((1, 3)) for c in (zip(*parts, strict=True) if parts else [(), (), ()])
    ]
    arrays.a = wp.array(columns[0].reshape(-1, 3).astype(np.float32), dtype=wp.vec3, device=device)
    arrays.b = wp.array(columns[1].reshape(-1, 3).astype(np.float32), dtype=wp.vec3, device=device)
    arrays.half = wp.array(columns[2].ravel().astype(np.float32), dtype=float, device=device)
    more = list(zip(*(along(c) for c in sets), strict=True)) if varied and sets else []
    number, run, aspects = (
        (np.concatenate(c) for c in more) if more else (np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)))
    )
    arrays.curve = wp.array(number.astype(np.int32), dtype=int, device=device)
    arrays.run = wp.array(run.astype(np.float32), dtype=wp.vec2, device=device)
    arrays.aspects = wp.array(aspects.astype(np.float32), dtype=wp.vec2, device=device)
    return arrays, tuple(made)
