"""How far an image still is from what more samples would make of it, and rendering until that is little enough.

The spread of the samples of each pixel says what error as many independent ones would leave. Ours lie more evenly. How
much that gains is told by what the last pass changed, all over the image: if errors squared fall as n^-p, the mean of
n samples is off from that of the ``before`` that were there by (n / before)^p - 1 times its remaining error squared,
and p follows. Where a few bright samples make the error nothing is gained: there both estimates are averaged. The error
is relative to the luminance that a pixel would have without noise: its own, drawn towards that of its neighbours as far
as its noise allows, so that a pixel with one bright sample does not count as a bright pixel. Pixels that missed what is
bright seem to have no error: their neighbours tell, so that the ratio of means over 5 x 5 pixels is looked at, too, and
the larger of both counts, up to three times the other. One and a half times the standard error of the mean over pixels
is added: where few of them carry most of the error, less is known of it; and one part in n, for few samples tell little
of their spread.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

FLOOR = 0.01
"""Share of the squared mean luminance that is added to each pixel's own: black ones do not count without end."""
MOST = 64
"""A render with an error target has at most so many times the samples that were asked for or predicted."""
RARE = 10.0
"""Pixels whose surroundings have so many times the mean error owe it to rare bright samples."""
STEEPEST = 1.25
"""No faster than with this power do errors squared fall with samples, as far as is relied on."""
DOUBT = 1.5
"""Standard errors of the estimate that are added to it."""
MISSED = 3.0
"""No more than so many times what the pixels tell by themselves is believed of what their neighbours tell."""
CLIP = 8.0
"""Neighbours brighter than so many times their median are cut there before they are averaged."""
EDGE = 2
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def remaining(sums: Mapping[str, Any], samples: int, before: tuple[np.ndarray, int] | None = None) -> float:
    """Estimated relMSE of an image against one of many more samples; infinite for one sample.

    What samples do not cure, such as coarse tables, is not in it.

    ``sums``: color [h, w, 3], square and invalid [h, w] over ``samples`` of each pixel. ``before``: an earlier (color,
    samples) of the same image.
    """
    if samples < 2:
        return float("inf")
    square, mean = squared(sums, samples, before), luminance(sums, samples)
    floor = FLOOR * float(mean.mean()) ** 2
    if floor <= 0.0:
        return 0.0
    alone = square / (shrunk(sums, samples, square) ** 2 + floor)
    together = _box(square) / (_box(mean) ** 2 + floor)
    own, near = (float(off.mean() + DOUBT * off.std() / np.sqrt(off.size)) for off in (alone, together))
    return max(own, min(near, MISSED * own)) * (1.0 + 1.0 / samples)


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


def squared(sums: Mapping[str, Any], samples: int, before: tuple[np.ndarray, int] | None = None) -> np.ndarray:
    """Estimated square of each pixel's error, mean over channels, [h, w]; arguments as of ``remaining``."""
    good = _good(sums, samples)
    mean = luminance(sums, samples)
    spread = np.maximum(np.asarray(sums["square"], np.float64) / good - mean**2, 0.0) / np.maximum(good - 1.0, 1.0)
    if before is None or not 0 < before[1] < samples:
        return spread
    color, count = before
    change = np.asarray(sums["color"], np.float64) / samples - np.asarray(color, np.float64) / count
    moved = (change**2).mean(axis=-1) * (count / (samples - count))
    both = 0.5 * (spread + moved)
    scale = 1.0 / (shrunk(sums, samples, both) ** 2 + max(FLOOR * float(mean.mean()) ** 2, 1e-300))
    around = _box(spread) * scale
    rare = around > RARE * around.mean()
    usual = float((spread * scale)[~rare].sum())
    gained = evenness(float((moved * scale)[~rare].sum()) / usual if usual > 0.0 else 1.0, samples, count)
    return np.where(rare, both, gained * spread)


def evenness(moved: float, samples: int, before: int) -> float:
    """What samples leave over what independent ones would, n^(1 - p): ``moved`` is what the ones since ``before``
    changed, 1 for independent ones (more than that is taken as it is), and falls with p; so that of all p up to
    ``STEEPEST`` the one that fits best is taken."""
    if moved >= 1.0:
        return moved
    p = np.linspace(1.0, STEEPEST, 51)
    ratio = samples / before
    left = float(samples) ** (1.0 - p)
    return float(left[np.abs(left * (ratio**p - 1.0) / (ratio - 1.0) - moved).argmin()])


def shrunk(sums: Mapping[str, Any], samples: int, square: np.ndarray) -> np.ndarray:
    """Luminance of each pixel, drawn towards the mean of its neighbours as far as ``square`` allows (a positive-part
    James-Stein estimate), [h, w]."""
    mean = luminance(sums, samples)
    middle = _median(mean)
    around = _box(np.minimum(mean, CLIP * middle + 0.1 * mean.mean()))
    noise = np.maximum(square, 0.3 * np.minimum(_box(square), around**2))
    off = mean - around
    keep = np.clip(1.0 - 2.0 * noise / np.maximum(off**2, 1e-30), 0.0, 1.0)
    return around + keep * off


def _good(sums: Mapping[str, Any], samples: int) -> np.ndarray:
    return np.maximum(samples - np.asarray(sums["invalid"], np.float64), 1.0)


def _shifted(values: np.ndarray, axis: int) -> list[np.ndarray]:
    pad = [(0, 0), (0, 0)]
    pad[axis] = (EDGE, EDGE)
    wide = np.pad(values, pad, mode="edge")
    size = values.shape[axis]
    return [np.take(wide, range(k, k + size), axis) for k in range(2 * EDGE + 1)]


def _box(values: np.ndarray) -> np.ndarray:
    """Mean over 5 x 5 pixels."""
    rows = np.mean(_shifted(values, 0), axis=0)
    return np.asarray(np.mean(_shifted(np.asarray(rows), 1), axis=0))


def _median(values: np.ndarray) -> np.ndarray:
    """Median over 5 rows of the median over 5 columns."""
    rows = np.partition(np.stack(_shifted(values, 0)), EDGE, axis=0)[EDGE]
    return np.asarray(np.partition(np.stack(_shifted(rows, 1)), EDGE, axis=0)[EDGE])


def later(samples: int) -> int:
    """The next number of samples: 2, 3, 4, 6, 8, 10, 12, 14, 16, 20 and on, four to a doubling, for then they lie
    evenly."""
    if samples < 4:
        return max(samples, 1) + 1
    step = max(1 << (samples.bit_length() - 3), 2)
    return (samples // step + 1) * step


def ahead(samples: int, error: float, target: float, most: int) -> int:
    """The number of samples to look at next: what is surely needed is not looked at."""
    needed, at = 0.85 * samples * error / target if np.isfinite(error) else 0.0, later(samples)
    while later(at) <= min(needed, 4 * samples):
        at = later(at)
    return min(at, most)


def until(
    target: float | None,
    samples: int,
    sums: Callable[[], Mapping[str, Any]],
    more: Callable[[int, int], None],
    begun: int = 0,
    before: tuple[np.ndarray, int] | None = None,
    most: int | None = None,
) -> tuple[int, float]:
    """(samples, estimated error): ``more(first, count)`` adds samples until ``sums()`` are within ``target``, or there
    are ``most`` (``MOST`` times as many as at the start, ``samples``). None adds none.

    ``begun``: samples that are there already, of a render that goes on; ``before``: (color sums, samples) of the pass
    before, without which it may go on otherwise than at once.
    """
    most = MOST * samples if most is None else most
    samples = max(samples, begun)
    while True:
        now = sums()
        error = remaining(now, samples, before)
        if target is None or error <= target or samples >= most:
            return samples, error
        before = (np.array(now["color"], np.float32), samples)
        count = ahead(samples, error, target, most)
        more(samples, count - samples)
        samples = count


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
