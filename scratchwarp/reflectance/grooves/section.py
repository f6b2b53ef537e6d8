"""Cross-sections of grooves, checked, and made ready for the device."""

import numpy as np
from numpy.typing import ArrayLike

from ..vectors import numbers
from .solid_device import GROUP, LONG


def section_points(name: str, points: ArrayLike) -> np.ndarray:
    """``points`` checked as a cross-section [n, 2], n >= 2; ValueError naming ``name``.

    The last x lies above the first; what is between may overhang, the ends as well.
    """
    array = numbers(name, points)
    if array.ndim != 2 or array.shape[1] != 2 or len(array) < 2:
        raise ValueError(f"{name} must have shape [n, 2] with n of 2 and more, got {list(array.shape)}")
    x = array[:, 0]
    if not x[-1] > x[0]:
        raise ValueError(f"{name} must run from left to right, got x = {x[0]:g} first and {x[-1]:g} last")
    return array


def closed_section(points: np.ndarray) -> np.ndarray:
    """The section from the plane z = 0 back to it, without doubled points, with a vertex wherever it crosses z = 0."""
    line = np.concatenate([[[points[0, 0], 0.0]], points, [[points[-1, 0], 0.0]]])
    made = [line[0]]
    for a, b in zip(line[:-1], line[1:], strict=True):
        if a[1] * b[1] < 0.0:
            made.append(np.array([a[0] + (b[0] - a[0]) * a[1] / (a[1] - b[1]), 0.0]))
        made.append(b)
    whole = np.array(made)
    keep = np.concatenate([[True], np.any(np.diff(whole, axis=0) != 0.0, axis=1)])
    return whole[keep]


def run_boxes(section: np.ndarray) -> np.ndarray:
    """Corners (low, high) of boxes about runs of ``GROUP`` facets of a closed section [2 n, 2]; none of a short one."""
    if len(section) < int(LONG):
        return np.zeros((0, 2))
    runs = [section[k : k + int(GROUP) + 1] for k in range(0, len(section) - 1, int(GROUP))]
    return np.concatenate([[run.min(0), run.max(0)] for run in runs])


def height_at(section: np.ndarray, x: float) -> float:
    """The highest z of a section at ``x``; 0 outside it."""
    best = [-np.inf]
    for a, b in zip(section[:-1], section[1:], strict=True):
        if min(a[0], b[0]) <= x <= max(a[0], b[0]):
            w = 0.0 if a[0] == b[0] else (x - a[0]) / (b[0] - a[0])
            best.append(max(a[1], b[1]) if a[0] == b[0] else a[1] + w * (b[1] - a[1]))
    return float(max(best)) if len(best) > 1 else 0.0
