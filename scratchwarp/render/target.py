"""How far an image still is from what more samples would make of it, and rendering until that is little enough.

What samples changed since the image had about half of them tells its error: if errors squared fall as n^-p, then
the mean of n samples is off from that of the first m by (n / m)^p - 1 times its error squared. Bright samples that are
in the image by chance are in that change, too, just as they are in its error, and samples that lie more evenly than
chance leave little of it. p is 1 for independent samples; it is taken for greater as far as the change since a fourth
of the samples says so beyond two of its standard errors.

The error is relative to the luminance that a pixel would have without noise: its own, drawn towards the geometric
mean of the eight around it as far as its noise allows (a positive-part James-Stein estimate), so that one with a single
bright sample does not count as a bright pixel. One and a half times the standard error of the mean over pixels is
added: where few of them carry most of the error, less is known of it; and one part in n, for few samples tell little.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

FLOOR = 0.01
"""Share of the squared mean luminance that is added to each pixel's own: black ones do not count without end."""
MOST = 64
"""A render with an error target has at most so many times the samples that were asked for or predicted."""
DOUBT = 1.5
"""Standard errors of the estimate that are added to it."""
STEEPEST = 1.6
"""No faster than with this power do errors squared fall with samples, as far as is relied on."""
KEPT = 4
"""Earlier states of an image that are kept: each with at least ``APART`` times the samples of the one before it, so
that one has about half of the samples and one about a fourth."""
APART = 1.3
Passes = Sequence[tuple[np.ndarray, int]]
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def remaining(sums: Mapping[str, Any], samples: int, passes: Passes = ()) -> float:
    """Estimated relMSE of an image against one of many more samples; infinite for one sample.

    What samples do not cure, such as coarse tables, is not in it.

    ``sums``: color [h, w, 3], square and invalid [h, w] over ``samples`` of each pixel. ``passes``: (color, samples) of
    the same image as it was earlier; without any the spread of the samples tells, as if they were independent.
    """
    if samples < 2:
        return float("inf")
    color = np.asarray(sums["color"], np.float64)
    mean = luminance(sums, samples)
    floor = FLOOR * float(mean.mean()) ** 2
    if floor <= 0.0:
        return 0.0
    known = [(_changed(color, samples, *one), samples / one[1]) for one in passes if 0 < one[1] < samples]
    if known:
        changed, times = min(known, key=lambda one: abs(np.log(one[1] / 2.0)))
        square = changed / (times - 1.0)
    else:
        square = spread(sums, samples)
    off = square / (_squared_luminance(mean, square, floor) + floor)
    error, doubt = float(off.mean()), float(off.std()) / np.sqrt(off.size)
    longer = [one for one in known if one[1] > 1.2 * times]
    if longer and error > 0.0:
        far, wide = min(longer, key=lambda one: abs(np.log(one[1] / 4.0)))
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = np.where(square > 0.0, off / square, 0.0)
        error *= gained(changed * scale, times, far * scale, wide)
    return (error + DOUBT * doubt) * (1.0 + 1.0 / samples)


def on_scale(variance: np.ndarray, color: np.ndarray, noise: float) -> np.ndarray:
    """Standard error of each pixel's luminance, [h, w], on the scale of the estimate ``noise`` that ended a render: the
    mean of its square over that of the luminance of ``color``, ``FLOOR`` of the squared mean luminance added, is
    ``noise``. ``variance`` [h, w]: of the pixels' luminance, from the spread of their samples."""
    mean = np.asarray(color, np.float64) @ _LUMINANCE
    relative = float((variance / np.maximum(mean**2 + FLOOR * float(mean.mean()) ** 2, 1e-300)).mean())
    scale = noise / relative if np.isfinite(noise) and relative > 0.0 else 1.0
    return np.asarray(np.sqrt(variance * scale), np.float32)


def halving(seconds: float, error: float, left: float = 0.0, longer: float = 2.0) -> float:
    """About how many seconds more half of ``error`` takes, ``left`` of which more samples do not cure; where they
    cannot do it, those of a render with other knobs, ``longer`` times as long as one as it was planned."""
    noise = error - left
    if not np.isfinite(error):
        return seconds
    if noise <= 0.0 or 0.5 * error - left <= 0.1 * noise:
        return longer * seconds
    return seconds * (noise / (0.5 * error - left) - 1.0)


def luminance(sums: Mapping[str, Any], samples: int) -> np.ndarray:
    """Mean luminance of each pixel, [h, w]."""
    return np.asarray(sums["color"], np.float64) @ _LUMINANCE / _good(sums, samples)


def spread(sums: Mapping[str, Any], samples: int) -> np.ndarray:
    """Square of each pixel's error by the spread of its samples, were they independent, [h, w]."""
    good = _good(sums, samples)
    variance = np.asarray(sums["square"], np.float64) / good - luminance(sums, samples) ** 2
    return np.maximum(variance, 0.0) / np.maximum(good - 1.0, 1.0)


def gained(near: np.ndarray, times: float, far: np.ndarray, wide: float) -> float:
    """What more evenly spread samples leave of the error that independent ones would, at most 1.

    ``near``, ``far``: changes squared of pixels since there were ``times`` and ``wide`` times fewer samples. Their
    ratio is (wide^p - 1) / (times^p - 1); two standard errors are taken off.
    """
    ratio = float(far.mean() / near.mean())
    ratio -= 2.0 * float((far - ratio * near).std()) / np.sqrt(near.size) / float(near.mean())
    p = np.linspace(1.0, STEEPEST, 61)
    fits = float(p[np.abs((wide**p - 1.0) / (times**p - 1.0) - ratio).argmin()])
    return float((times - 1.0) / (times**fits - 1.0))


def _changed(color: np.ndarray, samples: int, earlier: np.ndarray, count: int) -> np.ndarray:
    change = color / samples - np.asarray(earlier, np.float64) / count
    return np.asarray((change**2).mean(axis=-1))


def _squared_luminance(mean: np.ndarray, square: np.ndarray, floor: float) -> np.ndarray:
    """Square of the luminance of each pixel, drawn towards the geometric mean of those around it as far as its error
    ``square`` allows, [h, w]. ``floor`` is added to squares before they are multiplied."""
    wide = np.pad(mean, 1, mode="reflect" if min(mean.shape) > 1 else "edge")
    logs, (height, width) = np.log(wide**2 + floor), mean.shape
    total = sum(logs[j : j + height, i : i + width] for j in range(3) for i in range(3)) - logs[1:-1, 1:-1]
    around = np.maximum(np.exp(total / 8.0) - floor, 0.0)
    off = mean - np.sqrt(around)
    keep = np.clip(1.0 - square / np.maximum(off**2, 1e-300), 0.0, 1.0)
    return np.asarray(around + keep * (mean**2 - around))


def _good(sums: Mapping[str, Any], samples: int) -> np.ndarray:
    return np.maximum(samples - np.asarray(sums["invalid"], np.float64), 1.0)


def later(samples: int) -> int:
    """The next number of samples: 2, 3, 4, 6, 8, 10, 12, 14, 16, 20 and on, four to a doubling, for then they lie
    evenly."""
    if samples < 4:
        return max(samples, 1) + 1
    step = max(1 << (samples.bit_length() - 3), 2)
    return (samples // step + 1) * step


def ahead(samples: int, error: float, target: float, most: int) -> int:
    """The number of samples to look at next: up to twice as many, but not more than half of what the estimate asks for,
    which few samples overrate by as much."""
    needed, at = 0.5 * samples * error / target if np.isfinite(error) else 0.0, later(samples)
    while later(at) <= min(needed, 2 * samples):
        at = later(at)
    return min(at, most)


def until(
    target: float | None,
    samples: int,
    sums: Callable[[], Mapping[str, Any]],
    passes: Callable[[], Passes],
    more: Callable[[int], None],
    most: int | None = None,
) -> tuple[int, float]:
    """(samples, estimated error): ``more(count)`` renders to so many samples until ``sums()``, which were ``passes()``
    earlier, are within ``target``, or there are ``most`` (``MOST`` times as many as there are, ``samples``). None adds
    none."""
    most = MOST * samples if most is None else most
    while True:
        error = remaining(sums(), samples, passes())
        if target is None or error <= target or samples >= most:
            return samples, error
        samples = ahead(samples, error, target, most)
        more(samples)


def begins(first: int) -> list[int]:
    """Passes to the first estimate: to a fourth of its samples, to half of them, to all."""
    return sorted({max(first // 4, 1), max(first // 2, 1), first})


def noted(error: float) -> dict[str, float]:
    """An estimate for the header of an image file; nothing for that of a single sample."""
    return {"scratchwarp:error": error} if np.isfinite(error) else {}


def says(target: float | None, samples: int, error: float, seconds: float, left: float = 0.0) -> tuple[str, ...]:
    """A warning where the target was not reached; ``left``: the part of the error that knobs leave."""
    if target is None or error <= target * (1.0 + 1e-9):
        return ()
    if left > 0.5 * target:
        hint = f"about {left:.2g} of it is what the knobs leave: turn up those that were turned"
    else:
        hint = "begin with more samples"
    return (f"max_error {target:g} was not reached: {reached(samples, error, seconds)}; {hint}",)


def reached(samples: int, error: float, seconds: float) -> str:
    """What a render came to, and what half of its error costs: ``seconds`` that its samples took."""
    return f"relMSE {error:.2g} after {samples} samples a pixel; half of it takes about {seconds:.3g} s more"
