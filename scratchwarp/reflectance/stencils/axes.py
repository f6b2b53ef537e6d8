"""Where the axes of anisotropy lie: ridges of brightness across each candidate axis, and what is left after a fit.

The paper reads peaks off one slice of fixed elevations, which sees half vectors within 64 degrees of an azimuth only
and shows a false peak at the mirror direction. Here the ridge of every azimuth is averaged over all pairs of
elevations from 30 degrees up, half vectors near the normal left out. Further axes are those that would explain most of
the residual of the fit so far, and stay when the fit with them is much better.
"""

import numpy as np

from .angles import THETAS, Pairs
from .direct import TYPICAL, direct, subset
from .forward import MODE, band, model_values

_STEP = np.radians(1.5)
_SIGMA = 0.04  # of H . U across a ridge
_NEAR_NORMAL = 0.975
_APART = np.radians(12.0)  # two axes closer than this are one
_GAIN = 0.7  # a further axis must bring the squared error below this share
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def ridge_curve(luminance: np.ndarray, where: Pairs) -> tuple[np.ndarray, np.ndarray]:
    """(azimuths [m] in [0, pi), mean of ``luminance`` [n] along the ridge of each, in standard deviations)."""
    first, second = np.divmod(where.elevations, THETAS)
    kept = (np.minimum(first, second) >= 2) & (where.half[:, 2] < _NEAR_NORMAL)
    group, y, w = where.elevations[kept], luminance[kept], where.weight[kept]
    total = np.maximum(np.bincount(group, w), 1e-30)
    mean = np.bincount(group, w * y) / total
    spread = np.sqrt(np.maximum(np.bincount(group, w * (y - mean[group]) ** 2) / total, 0.0))
    z = (y - mean[group]) / np.maximum(spread[group], 1e-12 + 1e-6 * np.abs(mean[group]))
    azimuths = np.arange(0.0, np.pi, _STEP)
    axis = np.stack([np.cos(azimuths), np.sin(azimuths)])
    near = np.exp(-((axis.T @ where.half[kept, :2].T / _SIGMA) ** 2)) * w
    return azimuths, near @ z / np.maximum(near.sum(axis=1), 1e-30)


def peaks(azimuths: np.ndarray, curve: np.ndarray) -> list[float]:
    """Azimuths of the maxima of a periodic curve, highest first, between samples by a parabola."""
    before, after = np.roll(curve, 1), np.roll(curve, -1)
    top = np.nonzero((curve >= before) & (curve > after))[0]
    top = top[np.argsort(-curve[top])]
    bend = np.minimum(before + after - 2.0 * curve, -1e-30)[top]
    shift = np.clip(0.5 * (before - after)[top] / bend, -0.5, 0.5)
    return list((azimuths[top] + shift * _STEP) % np.pi)


def gain_curve(left: np.ndarray, where: Pairs) -> tuple[np.ndarray, np.ndarray]:
    """(azimuths [m], how much of the squared residual ``left`` [n] a typical mode along each would explain)."""
    azimuths = np.arange(0.0, np.pi, _STEP)
    curve = np.zeros(len(azimuths))
    for number, azimuth in enumerate(azimuths):
        typical = band(np.array([azimuth, *TYPICAL]), where, derivatives=False)
        shape = typical.mask * typical.power
        weighted = where.weight * shape
        curve[number] = max(float(weighted @ left), 0.0) ** 2 / max(float(weighted @ shape), 1e-30)
    return azimuths, curve


def apart(candidates: list[float], axes: list[float]) -> list[float]:
    """Those of ``candidates`` that are not along one of ``axes``."""
    turned = [[abs((c - a + 0.5 * np.pi) % np.pi - 0.5 * np.pi) for a in axes] for c in candidates]
    return [c for c, gaps in zip(candidates, turned, strict=True) if all(gap > _APART for gap in gaps)]


def further_axes(axes: list[float], left: np.ndarray, where: Pairs) -> list[float]:
    """Where one more mode may lie, given the residual luminance ``left`` [n]: at most three azimuths, likeliest first.

    Two by what a mode would explain, which bright directions rule, and one by the ridge it would be.
    """
    found = apart(peaks(*gain_curve(left, where)), axes)[:2]
    return found + apart(peaks(*ridge_curve(left, where)), [*axes, *found])[:1]


def detect(where: Pairs, values: np.ndarray, boost: np.ndarray, modes: int | None, most: int = 3) -> list[np.ndarray]:
    """Azimuth, width, b and log alpha, [4] each, of the modes of ``values`` [n, 3], the dominant first.

    ``modes`` of them, or as many as are worth it where pairs weigh ``boost``.
    """
    part, seen = subset(where, values, 700, boost)
    luminance = seen @ _LUMINANCE
    axes = (peaks(*ridge_curve(values @ _LUMINANCE, where)) or [0.0])[:1]
    error, numbers = direct(axes, part, seen)
    while len(axes) < (modes or most):
        model = model_values(numbers, len(axes), part)
        ridges = further_axes(axes, luminance - _LUMINANCE @ model, part)
        if not ridges and modes is None:
            break
        found = ridges[0] if ridges else _widest_gap(axes)
        better, trial = direct([*axes, found], part, seen, _shapes(numbers, len(axes)))
        if modes is None and better > _GAIN * error:
            break
        error, numbers = better, trial
        axes = [float(shape[0]) for shape in _shapes(numbers, len(axes) + 1)]
    return _shapes(numbers, len(axes))


def _shapes(numbers: np.ndarray, modes: int) -> list[np.ndarray]:
    return [numbers[MODE * k : MODE * k + 4].copy() for k in range(modes)]


def _widest_gap(axes: list[float]) -> float:
    """The middle of the widest gap: for a mode that is asked for where nothing stands out."""
    sides = np.sort(axes)
    gaps = np.diff(np.append(sides, sides[0] + np.pi))
    widest = int(np.argmax(gaps))
    return float((sides[widest] + 0.5 * gaps[widest]) % np.pi)
