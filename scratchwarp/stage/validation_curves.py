"""Rules about explicit scratches: Curves prims with ScratchCurvesAPI."""

from collections.abc import Iterator

import numpy as np
from pxr import Usd, UsdGeom

from .validation_rule import Problem, Rule


def sizes(curves: UsdGeom.Curves, time: Usd.TimeCode) -> dict[str, int]:
    """How many values each interpolation needs on ``curves``."""
    counts = np.asarray(curves.GetCurveVertexCountsAttr().Get(time) or [], dtype=int)
    vertex = int(counts.sum())
    basis = UsdGeom.BasisCurves(curves.GetPrim())
    varying = basis.ComputeVaryingDataSize(time) if basis else vertex
    return {"constant": 1, "uniform": len(counts), "varying": int(varying), "vertex": vertex}


def check_curves(prim: Usd.Prim) -> Iterator[Problem]:
    """Curves without widths, with negative or infinite numbers, or with arrays of the wrong length."""
    curves = UsdGeom.Curves(prim)
    if not curves:
        return
    time, path = Usd.TimeCode.EarliestTime(), prim.GetPath()
    needed = sizes(curves, time)
    points = np.asarray(curves.GetPointsAttr().Get(time) or [], dtype=float).reshape(-1, 3)
    if len(points) == 0:
        yield Problem(path, "has no points, so there is no scratch; author points and curveVertexCounts")
    elif len(points) != needed["vertex"]:
        yield Problem(
            path, f"has {len(points)} points but curveVertexCounts add up to {needed['vertex']}; make them agree"
        )
    if not np.isfinite(points).all():
        at = int(np.argmax(~np.isfinite(points).all(axis=1)))
        yield Problem(path, f"points[{at}] is {tuple(points[at])}; every coordinate must be a finite number")
    primvars = UsdGeom.PrimvarsAPI(prim)
    own_width = primvars.GetPrimvar("scratch:width")
    widths = curves.GetWidthsAttr()
    if not (own_width.HasAuthoredValue() or widths.HasAuthoredValue()):
        yield Problem(
            path,
            "has no widths, so its scratches have no size; author widths (scene units) or primvars:scratch:width "
            "(micrometer)",
        )
    if widths.HasAuthoredValue():
        yield from check_array(prim, "widths", widths.Get(time), curves.GetWidthsInterpolation(), needed)
    for primvar in (own_width, primvars.GetPrimvar("scratch:depth")):
        if primvar.HasAuthoredValue():
            held = primvar.ComputeFlattened(time)
            yield from check_array(prim, primvar.GetName(), held, primvar.GetInterpolation(), needed)


def check_array(
    prim: Usd.Prim, name: str, held: object, interpolation: str, needed: dict[str, int]
) -> Iterator[Problem]:
    """Problems with the length and the signs of an array of sizes."""
    array = np.asarray([] if held is None else held, dtype=float).ravel()
    path = prim.GetPath().AppendProperty(name)
    want = needed.get(interpolation)
    if want is None:
        yield Problem(path, f"{name} has interpolation {interpolation!r}; use constant, uniform, varying or vertex")
    elif len(array) != want:
        yield Problem(path, f"{name} holds {len(array)} values, interpolation {interpolation!r} needs {want}")
    bad = ~np.isfinite(array) | (array < 0)
    if bad.any() and name == "widths":
        at = int(np.argmax(bad))
        yield Problem(path, f"{name}[{at}] is {array[at]:g}; author finite values in [0, inf)")


RULES = (
    Rule("ScratchCurves", "Explicit scratches have widths and arrays that fit.", check_curves, ("ScratchCurvesAPI",)),
)
