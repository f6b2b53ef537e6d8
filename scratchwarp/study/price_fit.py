"""Prices of units of work from measured seconds: what the measurements tell, and the machine's speed for the rest.

A fit begins with the prices that are shipped, all multiplied by one factor, the machine's speed: the median over
measurements of seconds over those predicted. Then logarithms of prices move away from that as far as the logarithms of
seconds ask for it. What many measurements hang on moves freely; units that no measurement tells apart move together;
what none has stays at the machine's speed. No price falls to 0.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from ..plan.cost.models import UNMEASURED, shipped
from ..plan.cost.shares import LIGHT, SET

# Nanoseconds, as they were estimated before anything was measured.
ESTIMATED: dict[str, float] = {
    "camera": 600.0, "camera.triangles": 500.0, "base": 150.0, "shadows": 160.0, "scratches.table": 100.0,
    "lights.closedForm": 300.0, "lights.coneTaps": 15.0, "lights.sampled": 200.0, "diffraction.pieces": 40.0,
    "diffraction.found": 500.0, "diffraction.strands": 300.0, "diffraction.bands": 200.0, "diffraction.points": 300.0,
    "diffraction.caps": 3000.0, "diffraction.polygons": 10000.0, "diffraction.domes": 5000.0, "grooves.found": 300.0,
    "grooves.rays": 300.0, "grooves.rayFacets": 30.0, "grooves.lines": 300.0, "grooves.lineFacets": 100.0,
    "grooves.linePairs": 10.0, "build.grooves": 10000.0, "build.cells": 1000.0,
    "tables.table": 3e7, "tables.cell": 50.0, "tables.ray": 300.0, "tables.rayBounced": 600.0,
    "build.triangles": 3000.0, "build.pixels": 100.0, "build.kernel": 5e7, "build.strokes": 20000.0,
    **{f"lights.{name}": float(ns) for name, ns in LIGHT.items()},
    **{f"scratches.{name}": float(ns) for name, ns in SET.items()}, **UNMEASURED,
}  # fmt: skip
LEAST = 0.01
"""Of the estimate, what a fit begins with at least where the shipped price is less: one of 0 could never rise."""
RIDGE = 0.03
"""Weight of a price's own logarithm beside that of one measurement: about (a quarter, by which seconds are off, over a
factor of four, by which prices are, as logarithms) squared."""
_STEPS = 100


def known_prices() -> dict[str, float]:
    """Nanoseconds of every unit that has a price: shipped, or else estimated."""
    own = shipped().nanoseconds
    return {unit: max(own.get(unit, ns), LEAST * ns) for unit, ns in ESTIMATED.items()} | {
        unit: ns for unit, ns in own.items() if unit not in ESTIMATED
    }


def machine_speed(
    rows: Sequence[Mapping[str, float]], seconds: Sequence[float], known: Mapping[str, float] | None = None
) -> float:
    """Median of measured over predicted seconds; 1 where nothing was measured. ``rows``: unit -> how often, of each."""
    known = known_prices() if known is None else known
    guessed = [sum(1e-9 * known.get(unit, 100.0) * n for unit, n in row.items()) for row in rows]
    off = [np.log(max(took, 1e-6) / guess) for took, guess in zip(seconds, guessed, strict=True) if guess > 0.0]
    return float(np.exp(np.median(off))) if off else 1.0


def fitted(
    rows: Sequence[Mapping[str, float]],
    seconds: Sequence[float],
    ridge: float = RIDGE,
    known: Mapping[str, float] | None = None,
    speed: float | None = None,
) -> dict[str, float]:
    """Nanoseconds of the units in ``rows`` (unit -> how often, of each measurement).

    Least squares of log(predicted / measured), plus ``ridge`` times the squares of log(price / (``speed`` times the
    price ``known``)). ``known``: ``known_prices`` unless given; ``speed``: that of these measurements unless given.
    """
    known = known_prices() if known is None else known
    factor = machine_speed(rows, seconds, known) if speed is None else speed
    units = sorted({unit for row in rows for unit in row})
    start = np.array([1e-9 * factor * known.get(unit, 100.0) for unit in units])
    each = np.array([[row.get(unit, 0.0) for unit in units] for row in rows]).reshape(len(rows), len(units)) * start
    told = each.sum(axis=1) > 0.0
    each, taken = each[told], np.log(np.maximum(np.asarray(seconds, float)[told], 1e-6))
    moved, damping = np.zeros(len(units)), 1e-3

    def off(at: np.ndarray) -> np.ndarray:
        return np.log(each @ np.exp(at)) - taken

    def cost(at: np.ndarray) -> float:
        return float((off(at) ** 2).sum() + ridge * (at**2).sum())

    best = cost(moved)
    for _ in range(_STEPS if len(units) else 0):  # Levenberg, Marquardt
        parts = each * np.exp(moved)
        shares = parts / parts.sum(axis=1, keepdims=True)
        slope = shares.T @ off(moved) + ridge * moved
        normal = shares.T @ shares + (ridge + damping) * np.eye(len(units))
        step = np.clip(np.linalg.solve(normal, -slope), -2.0, 2.0)
        if np.abs(step).max() < 1e-9:
            break
        tried = cost(moved + step)
        if tried <= best:
            moved, best, damping = moved + step, tried, 0.3 * damping
        else:
            damping = max(10.0 * damping, 1e-9)
    return {unit: float(1e9 * ns) for unit, ns in zip(units, start * np.exp(moved), strict=True)}
