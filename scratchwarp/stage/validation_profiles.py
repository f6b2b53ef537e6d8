"""Rules about ScratchProfile prims: the polyline of shape points."""

from collections.abc import Iterator

import numpy as np
from pxr import Usd

from .validation_rule import Problem, Rule, times, value

# How far a profile may be from its normalised extent before it is worth a warning; float32 text keeps 1e-6.
TOLERANCE = 1e-3


def crosses_itself(points: np.ndarray) -> tuple[int, int] | None:
    """First pair of edges of the polyline ``points`` [n, 2] that cross properly, as indices; None when it is simple."""
    start, edge = points[:-1], np.diff(points, axis=0)
    for i in range(len(edge) - 2):
        a, b, rest = start[i], edge[i], slice(i + 2, None)
        c, d = start[rest], edge[rest]
        denominator = b[0] * d[:, 1] - b[1] * d[:, 0]
        along = np.where(denominator == 0, 1.0, denominator)
        t = ((c[:, 0] - a[0]) * d[:, 1] - (c[:, 1] - a[1]) * d[:, 0]) / along
        s = ((c[:, 0] - a[0]) * b[1] - (c[:, 1] - a[1]) * b[0]) / along
        hit = (denominator != 0) & (t > 0) & (t < 1) & (s > 0) & (s < 1)
        if hit.any():
            return i, i + 2 + int(np.argmax(hit))
    return None


def check_points(prim: Usd.Prim) -> Iterator[Problem]:
    """Points that make no profile: too few, not from left to right, crossing, not normalised, or not read."""
    attribute = prim.GetAttribute("scratch:points")
    shape = value(prim.GetAttribute("scratch:shape"))
    if shape != "points":
        if attribute.HasAuthoredValue() and len(value(attribute)):
            yield Problem(
                attribute.GetPath(),
                f"scratch:points holds {len(value(attribute))} points but scratch:shape is {shape!r}; set the shape to "
                "'points' or remove the points",
                "warning",
            )
        return
    held = [found for found in (attribute.Get(time) for time in times(attribute)) if found is not None]
    for found in held or [[]]:
        problems = list(problems_of(prim, np.asarray(found, dtype=float).reshape(-1, 2)))
        yield from problems
        if problems:
            return


def problems_of(prim: Usd.Prim, points: np.ndarray) -> Iterator[Problem]:
    """Problems with one polyline ``points`` [n, 2] of (x, z); values that are not finite are another rule's."""
    path = prim.GetPath().AppendProperty("scratch:points")
    if len(points) < 2:
        yield Problem(
            path, f"scratch:points holds {len(points)} points; shape 'points' needs at least two (x, z) pairs"
        )
        return
    if not np.isfinite(points).all():
        return
    x, z = points[:, 0], points[:, 1]
    if x[-1] < x[0] and (np.diff(x) <= 0).all():
        yield Problem(path, f"scratch:points runs from x = {x[0]:g} down to {x[-1]:g}; reverse the order of the points")
        return
    if x[0] > x.min() or x[-1] < x.max() or x[0] == x[-1]:
        yield Problem(
            path,
            f"scratch:points starts at x = {x[0]:g} and ends at {x[-1]:g} but spans [{x.min():g}, {x.max():g}]; order "
            "the points from left to right, the first the leftmost, the last the rightmost, with x ascending",
        )
        return
    crossing = crosses_itself(points) if (np.diff(x) < 0).any() else None
    if crossing:
        i, j = crossing
        yield Problem(
            path,
            f"scratch:points crosses itself: points {i} to {i + 1} and {j} to {j + 1}; order them along the surface",
        )
    if x.min() < -TOLERANCE or x.max() > 1 + TOLERANCE:
        yield Problem(
            path,
            f"scratch:points spans x from {x.min():g} to {x.max():g}; divide x by the width so that it runs from 0 to "
            "1, and author the width on the layer",
        )
    elif x[0] > TOLERANCE or x[-1] < 1 - TOLERANCE:
        yield Problem(
            path,
            f"scratch:points spans x from {x[0]:g} to {x[-1]:g} only; let x run from 0 to 1, the whole width",
            "warning",
        )
    if z.min() < 0 and abs(z.min() + 1) > TOLERANCE:
        yield Problem(
            path,
            f"the deepest of scratch:points has z = {z.min():g}; scale z so that it is -1, and author the depth on "
            "the layer",
            "warning",
        )


RULES = (Rule("ScratchProfilePoints", "Points go from left to right, normalised.", check_points, ("ScratchProfile",)),)
