"""The direct fit: no initial guess and no iteration, mode by mode, from the axes alone.

The paper fits a and b to intensities and raises them to alpha later, so that its fit does not return the numbers that
data were made from. Here width, b and alpha of each mode come from a grid, coarse, then fine; for each of its points
the model without specular factor is linear in the colours of the modes and of the background, which linear algebra
gives. The factor comes from a grid of its own.
"""

from collections.abc import Sequence
from itertools import permutations

import numpy as np

from .angles import Pairs
from .forward import COLOR, MODE, Band, Q, band, coefficients, count

_WIDTHS = (0.0, 0.45, 0.6, 0.7, 0.8)
_BS = (-0.02, 0.0, 0.01, 0.03)
_ALPHAS = (3.0, 8.0, 14.0, 24.0, 45.0, 90.0)
TYPICAL = (0.6, 0.005, np.log(14.0))  # width, b, log alpha
_LEAST = np.array([-np.inf, 0.0, -0.05, 0.0])
_GREATEST = 13.93  # 1 / (cos_i cos_o) - 1 at 75 degrees
_GROWTH = 12.0  # most of the log of what a highlight may gain from the normal to there
_MATTE = 0.95  # H_z above which the specular highlight may sit
_EXPONENTS = (5.0, 10.0, 20.0, 35.0, 60.0, 120.0, 300.0)
_STRENGTHS = (0.0, 0.7, 1.0, 1.3, 1.7, 2.2, 3.0, 6.0)
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def boosts(where: Pairs, values: np.ndarray) -> np.ndarray:
    """[n] weights that make all pairs of elevations count alike in relative terms, the darkest a little less.

    Highlights may be a thousand times brighter at 75 degrees than at 30: a plain sum of squares sees no other mode.
    """
    square = where.weight * (values @ _LUMINANCE) ** 2
    group = np.bincount(where.elevations, square) / np.maximum(np.bincount(where.elevations, where.weight), 1e-30)
    return 1.0 / np.maximum(group, 1e-10 * group.max())[where.elevations]


def subset(
    where: Pairs, values: np.ndarray, size: int, boost: np.ndarray | None = None, seed: int = 0
) -> tuple[Pairs, np.ndarray]:
    """About ``size`` of the pairs, bright ones more often, weighted so that sums of squares keep their means.

    ``boost`` [n] multiplies the weights, and with it what is bright.
    """
    extra = np.ones_like(where.weight) if boost is None else boost
    luminance = np.abs(values) @ _LUMINANCE * np.sqrt(extra)
    luminance = np.minimum(luminance, np.quantile(luminance, 0.999))  # a stray value must not take all the room
    importance = where.weight * (luminance.mean() + luminance + 1e-30)
    share = np.minimum(importance * (size / importance.sum()), 1.0)
    kept = np.random.default_rng(seed).random(len(share)) < share
    weight = (where.weight * extra / share)[kept]
    part = Pairs(where.half[kept], where.inverse_cosines[kept], weight, where.elevations[kept], where.member[:0])
    return part, values[kept]


def _solve(bands: list[Band], where: Pairs, values: np.ndarray) -> tuple[float, np.ndarray]:
    """Least squares for the colours: (weighted squared error, coefficients [1 + 2 modes, 3])."""
    clear, shares = coefficients([b.mask for b in bands], np.zeros(len(bands) - 1))
    columns = [clear]
    for share, b in zip(shares, bands, strict=True):
        columns += [share, share * b.power]
    design = np.stack(columns)
    weighted = design * where.weight
    normal, right = weighted @ design.T, weighted @ values
    ridge = np.diag(1e-9 * np.diag(normal) + 1e-30)
    found = np.linalg.solve(normal + ridge, right)
    return float(-np.sum(found * right)), found


def direct(
    axes: Sequence[float], where: Pairs, values: np.ndarray, known: Sequence[np.ndarray] = ()
) -> tuple[float, np.ndarray]:
    """(squared error off the specular highlight, numbers) of the fit of modes along ``axes``, in the best order.

    ``known``: azimuth, width, b and log alpha of the first modes, [4] each, where a coarser fit has found them.
    """
    matte = where.half[:, 2] < _MATTE
    half, inverse, weight, elevations = (a[matte] for a in where[:4])
    part = Pairs(half, inverse, weight, elevations, where.member)
    seen = values[matte]
    shapes = [*known, *(np.array([a, *TYPICAL]) for a in axes[len(known) :])]
    order = list(range(len(axes)))
    coarse = [(w, b, np.log(a)) for w in _WIDTHS for b in _BS for a in _ALPHAS if a * np.log1p(_GREATEST * b) < _GROWTH]
    for k in order[len(known) :]:
        grid = [np.array([axes[k], *numbers]) for numbers in coarse]
        _walk(shapes, k, order, grid, part, seen)
    if len(axes) > 1:
        order = _best_order(shapes, part, seen)
    for k in order:
        steps = [(w, b, a) for w in (-0.05, 0.0, 0.05) for b in (-0.006, 0.0, 0.006) for a in (-0.25, 0.0, 0.25)]
        grid = [np.maximum(shapes[k] + np.array([0.0, *step]), _LEAST) for step in steps]
        _walk(shapes, k, order, grid, part, seen)
    shapes = [shapes[k] for k in order]
    error, found = _solve([band(shape, part, derivatives=False) for shape in shapes], part, seen)
    numbers = np.zeros(count(len(axes)))
    for k, shape in enumerate(shapes):
        flat, peak = found[1 + 2 * k], found[2 + 2 * k]
        paint = np.maximum(flat + peak, 0.0)
        paint = paint / max(np.linalg.norm(paint), 1e-300) if np.any(paint > 0.0) else np.full(3, 3.0**-0.5)
        kd = max(float(flat @ paint), 0.0)
        ks = max(float(peak @ paint), 1e-4 * kd, 1e-12)
        row = numbers[MODE * k : MODE * (k + 1)]
        row[:Q] = shape
        row[Q] = kd / ks
        row[COLOR:] = ks * paint
    last = numbers[MODE * (len(axes) - 1) + COLOR :][:3]
    numbers[-3] = background_share(found[0], last)
    numbers[-1] = np.log(30.0)
    return error + float(np.sum(part.weight * np.sum(seen**2, axis=1))), numbers


def _walk(
    shapes: list[np.ndarray], k: int, order: list[int], grid: list[np.ndarray], part: Pairs, seen: np.ndarray
) -> None:
    """The best of the grid for mode ``k``, the others as they are."""
    bands = [band(shape, part, derivatives=False) for shape in shapes]
    known: dict[tuple[float, ...], np.ndarray] = {}
    none = np.empty(0)
    best, chosen = np.inf, shapes[k]
    for trial in grid:
        width, shape = (float(trial[1]),), (float(trial[2]), float(trial[3]))
        if width not in known or shape not in known:
            made = band(trial, part, derivatives=False)
            known.setdefault(width, made.mask)
            known.setdefault(shape, made.power)
        bands[k] = Band(known[width], known[shape], none, none, none, none, none)
        error, _ = _solve([bands[j] for j in order], part, seen)
        if error < best:
            best, chosen = error, trial
    shapes[k] = chosen


def _best_order(shapes: list[np.ndarray], part: Pairs, seen: np.ndarray) -> list[int]:
    bands = [band(shape, part, derivatives=False) for shape in shapes]
    orders = [list(o) for o in permutations(range(len(shapes)))]
    errors = [_solve([bands[k] for k in order], part, seen)[0] for order in orders]
    return orders[int(np.argmin(errors))]


def add_highlight(numbers: np.ndarray, matte: np.ndarray, where: Pairs, values: np.ndarray) -> None:
    """Set k and its exponent to the best of a grid, over ``matte`` [3, n], the model without them."""
    seen, dull = values @ _LUMINANCE, _LUMINANCE @ matte
    gain = 1.0 + numbers[2] * (where.inverse_cosines - 1.0)
    log_z = np.log(np.maximum(where.half[:, 2], 1e-12))
    best = np.inf
    for exponent in _EXPONENTS:
        lobe = np.exp(exponent * log_z) * gain
        for k in _STRENGTHS:
            error = float(np.sum(where.weight * (dull * np.maximum(k * lobe, 1.0) - seen) ** 2))
            if error < best:
                best = error
                numbers[-2], numbers[-1] = k, np.log(exponent)


def level(modes: int, color: np.ndarray) -> np.ndarray:
    """A model that is ``color`` everywhere, in the gauge of the fit."""
    numbers = np.zeros(count(modes))
    for k in range(modes):
        numbers[MODE * k : MODE * (k + 1)] = [np.pi * k / modes, *TYPICAL, 1e6, *(1e-6 * color)]
    numbers[-3], numbers[-1] = 1e6, np.log(30.0)
    return numbers


def background_share(color: np.ndarray, last: np.ndarray) -> float:
    """r for a background of ``color`` over a last mode of color ``last``, as well as one number can."""
    return float(np.clip(color @ last / max(last @ last, 1e-300), 0.0, 1e6))


def reordered(numbers: np.ndarray, order: Sequence[int]) -> np.ndarray:
    """The same modes, another one on top."""
    modes = len(order)
    rows = numbers[: MODE * modes].reshape(modes, MODE)
    result = numbers.copy()
    result[: MODE * modes] = rows[list(order)].ravel()
    result[MODE * modes : MODE * modes + modes - 1] = 0.05
    result[-3] = background_share(numbers[-3] * rows[-1, COLOR:], rows[order[-1], COLOR:])
    return result
