"""From a measurement to a stencil model: detection, direct fit, least squares, and again where a mode was hidden."""

from collections.abc import Iterable, Sequence
from itertools import permutations
from typing import Any, NamedTuple

import numpy as np

from .angles import SIZE, Pairs, collapse, pairs
from .axes import detect, further_axes
from .direct import TYPICAL, add_highlight, background_share, boosts, direct, level, reordered, subset
from .forward import AZIMUTH, COLOR, MODE, Q, count, model_values, to_model
from .model import Mode, Model
from .refine import refine as least_squares

_MOST_MODES = 3  # that are looked for when nobody says how many; more, where asked for
_HIDDEN = 0.8  # a mode found late must bring the squared error below this share
_USELESS = 1.2  # a mode whose loss raises the squared error by less goes
_HIGHLIGHTS = ((0.0, np.log(30.0)), (1.3, np.log(30.0)))  # starts of k and the log of its exponent, besides the best
_PERFECT = 1e-7  # share of the squares that nobody looks into
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


class _Fit(NamedTuple):
    modes: int
    numbers: np.ndarray
    error: float


def fit(brdf: Any, modes: int | None = None, refine: bool = True, retro: bool = False) -> Model:
    """The stencil model of a BRDF, without initial guess.

    ``brdf``: a ``measured.Brdf`` or values [288, 288, 3] (illumination 48 it + ip, view 48 it + ip, linear rgb);
    negative values count as 0. ``modes``: how many axes; None finds up to three, each worth a fifth of the squared
    error at least (a highlight of another shape than a stencil's may be given several). ``refine``: bounded least
    squares after the direct fit, which needs scipy (extra ``study``). ``retro``: highlights return to the light. Raises
    ValueError naming the argument, ImportError saying what to install.
    """
    values = np.asarray(brdf, np.float64)
    if values.shape != (SIZE, SIZE, 3):
        raise ValueError(f"brdf must have shape [288, 288, 3], got {list(values.shape)}")
    if not np.all(np.isfinite(values)):
        raise ValueError(f"brdf must be finite, got {values[~np.isfinite(values)][0]}")
    if modes is not None and (int(modes) != modes or not 1 <= modes <= 12):
        raise ValueError(f"modes must be a whole number in [1, 12] or None, got {modes}")
    values = np.maximum(values, 0.0)
    where = pairs(bool(retro))
    means = collapse(values, where)
    top = float(means.max())
    if top <= 0.0 or float(np.ptp(means, axis=0).max()) <= 1e-9 * top:
        return _constant(means.mean(axis=0), retro)
    means = means / top
    boost = boosts(where, means)
    shapes = detect(where, means, boost, modes, _MOST_MODES)
    part, seen = subset(where, means, 1500)
    numbers = _started([float(shape[0]) for shape in shapes], part, seen, shapes)
    mean = np.average(means, axis=0, weights=where.weight)
    if _squares(numbers, len(shapes), where, means) > float(np.sum(where.weight[:, None] * (means - mean) ** 2)):
        numbers = level(len(shapes), mean)  # what fitted the part did not fit the whole: data without ridges
    if refine:
        numbers = _refined(
            numbers, len(shapes), modes is None, where, means, boost, _noise(values / top, where, means, boost)
        )
    return to_model(_scaled(numbers, top), (len(numbers) - 2) // (MODE + 1), retro)


def _constant(color: np.ndarray, retro: bool) -> Model:
    luminance = float(color @ _LUMINANCE)
    paint = tuple(color / luminance) if luminance > 0.0 else (1.0, 1.0, 1.0)
    return Model((Mode(0.0, 0.0, 1.0, 0.0, luminance, 0.0, 1.0, paint),), retro=retro)


def _scaled(numbers: np.ndarray, scale: float) -> np.ndarray:
    """The numbers of the same model times ``scale``."""
    result = numbers.copy()
    for k in range((len(numbers) - 2) // (MODE + 1)):
        result[MODE * k + COLOR : MODE * (k + 1)] *= scale
    return result


def _noise(values: np.ndarray, where: Pairs, means: np.ndarray, boost: np.ndarray) -> float:
    """Squared error that no symmetric model can undercut by more than chance: scatter inside the pairs."""
    squares = np.bincount(where.member, np.sum(values**2, axis=-1).ravel(), len(where.weight))
    within = np.maximum(squares - where.weight * np.sum(means**2, axis=1), 0.0)
    several = where.weight > 1.0
    scatter = float(np.sum((boost * within)[several] / (where.weight[several] - 1.0)))
    return max(scatter, _PERFECT * float(np.sum(where.weight * boost * np.sum(means**2, axis=1))))


def _squares(numbers: np.ndarray, modes: int, where: Pairs, means: np.ndarray) -> float:
    """Squared error over all pairs."""
    return float(np.sum((model_values(numbers, modes, where) - means.T) ** 2 * where.weight))


def _started(axes: list[float], part: Pairs, seen: np.ndarray, known: Sequence[np.ndarray] = ()) -> np.ndarray:
    _, numbers = direct(axes, part, seen, known)
    add_highlight(numbers, model_values(numbers, len(axes), part), part, seen)
    return numbers


def _orders(modes: int) -> list[tuple[int, ...]]:
    """Which modes may lie on top: every order of three, neighbours exchanged beyond."""
    plain = tuple(range(modes))
    if modes <= 3:
        return list(permutations(plain))
    swaps = [plain[:k] + (plain[k + 1], plain[k]) + plain[k + 2 :] for k in range(modes - 1)]
    return [plain, *swaps]


def _best(starts: Iterable[np.ndarray], modes: int, part: Pairs, seen: np.ndarray) -> tuple[np.ndarray, float]:
    """The best of some starts, each refined a little."""
    trials = [least_squares(start, modes, part, seen, 10) for start in starts]
    return min(trials, key=lambda trial: trial[1])


def _settled(starts: Iterable[np.ndarray], modes: int, part: Pairs, seen: np.ndarray) -> _Fit:
    """The best start, with the best start of the specular factor, refined more."""
    best = _best(starts, modes, part, seen)
    others = [np.append(best[0][:-2], highlight) for highlight in _HIGHLIGHTS]
    best = min(best, _best(others, modes, part, seen), key=lambda trial: trial[1])
    return _Fit(modes, *least_squares(best[0], modes, part, seen, 25))


def _extended(fit: _Fit, azimuth: float) -> list[np.ndarray]:
    """A further mode at ``azimuth`` in every place of the order, as bright as the faintest there is."""
    rows = fit.numbers[: MODE * fit.modes].reshape(fit.modes, MODE)
    faint = rows[np.argmin(rows[:, COLOR:].sum(axis=1) * (1.0 + rows[:, Q])), COLOR:]
    mode = np.array([azimuth, *TYPICAL, 0.1, *np.maximum(faint, 1e-3 * rows[:, COLOR:].max())])
    starts = []
    for place in range(fit.modes + 1):
        start = np.zeros(count(fit.modes + 1))
        start[: MODE * (fit.modes + 1)] = np.insert(rows, place, mode, axis=0).ravel()
        start[MODE * (fit.modes + 1) : -3] = 0.05
        start[-3:] = fit.numbers[-3:]
        if place == fit.modes:
            start[-3] = background_share(fit.numbers[-3] * rows[-1, COLOR:], mode[COLOR:])
        starts.append(start)
    return starts


def _without(numbers: np.ndarray, modes: int, k: int) -> np.ndarray:
    order = [j for j in range(modes) if j != k]
    rows = numbers[: MODE * modes].reshape(modes, MODE)
    shorter = np.zeros(count(modes - 1))
    shorter[: MODE * (modes - 1)] = rows[order].ravel()
    shorter[-3:] = numbers[-3:]
    shorter[-3] = background_share(numbers[-3] * rows[-1, COLOR:], rows[order[-1], COLOR:])
    return shorter


def _searched(best: _Fit, part: Pairs, seen: np.ndarray) -> _Fit | None:
    """The best fit with one more mode, at one of the ridges that are left."""
    left = (seen.T - model_values(best.numbers, best.modes, part)).T @ _LUMINANCE
    axes = [float(best.numbers[MODE * k + AZIMUTH]) for k in range(best.modes)]
    starts = []
    for found in further_axes(axes, left, part):
        starts += [_started([*axes, found], part, seen), *_extended(best, found)]
    return _settled(starts, best.modes + 1, part, seen) if starts else None


def _shaken(best: _Fit, part: Pairs, seen: np.ndarray) -> _Fit:
    """The best fit after each mode in turn was taken out and looked for again, where it was and elsewhere."""
    starts = []
    for k in range(best.modes):
        rest = _Fit(
            best.modes - 1, *least_squares(_without(best.numbers, best.modes, k), best.modes - 1, part, seen, 8)
        )
        left = (seen.T - model_values(rest.numbers, rest.modes, part)).T @ _LUMINANCE
        axes = [float(rest.numbers[MODE * j + AZIMUTH]) for j in range(rest.modes)]
        own = float(best.numbers[MODE * k + AZIMUTH])
        for azimuth in [own, *further_axes([*axes, own], left, part)[:1]]:
            starts += _extended(rest, azimuth)
    return min(best, _settled(starts, best.modes, part, seen), key=lambda one: one.error)


def _refined(
    numbers: np.ndarray,
    modes: int,
    free: bool,
    where: Pairs,
    means: np.ndarray,
    boost: np.ndarray,
    noise: float,
) -> np.ndarray:
    """Modes are settled where all elevations count alike, their numbers in the end by the plain sum of squares."""
    part, seen = subset(where, means, 1500, boost)
    best = _settled([reordered(numbers, order) for order in _orders(modes)], modes, part, seen)
    while free and best.modes < _MOST_MODES and best.error > 1.5 * noise:
        trial = _searched(best, part, seen)
        if trial is None or trial.error > _HIDDEN * best.error:
            break
        best = trial
    while free and best.modes > 1:
        fewer = [_without(best.numbers, best.modes, k) for k in range(best.modes)]
        trial = _settled(fewer, best.modes - 1, part, seen)
        if trial.error > _USELESS * max(best.error, noise):
            break
        best = trial
    if best.modes > 1 and best.error > 2.0 * noise:
        best = _shaken(best, part, seen)
    half, half_seen = subset(where, means, 4000, seed=1)
    settled, _ = least_squares(best.numbers, best.modes, half, half_seen, 20)
    return least_squares(settled, best.modes, where, means, 4)[0]
