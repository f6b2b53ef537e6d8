"""How far an image still is from what more samples would make of it, and rendering until that is little enough."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

FLOOR = 0.01
"""Share of the squared mean luminance that is added to each pixel's own: black ones do not count without end."""
MOST = 64
"""A render with an error target has at most so many times the samples that it begins with."""


def remaining(sums: Mapping[str, Any], samples: int) -> float:
    """Estimated relMSE of an image by the spread of its samples: the mean over pixels of the variance of their mean
    luminance Y over Y^2 + ``FLOOR`` times the squared mean of Y. Samples are taken for independent; ours lie more
    evenly, so that the true error is mostly below. What samples do not cure, such as coarse tables, is not in it.

    ``sums``: color [h, w, 3], square and invalid [h, w] over ``samples`` of each pixel. Infinite for one sample.
    """
    if samples < 2:
        return float("inf")
    good = np.maximum(samples - np.asarray(sums["invalid"], np.float64), 1.0)
    y = np.asarray(sums["color"], np.float64) @ np.array([0.2126, 0.7152, 0.0722]) / good
    spread = np.maximum(np.asarray(sums["square"], np.float64) / good - y**2, 0.0) / np.maximum(good - 1.0, 1.0)
    floor = FLOOR * float(y.mean()) ** 2
    return float((spread / (y**2 + floor)).mean()) if floor > 0.0 else 0.0


def until(
    target: float | None,
    samples: int,
    sums: Callable[[], Mapping[str, Any]],
    more: Callable[[int, int], None],
    begun: int = 0,
) -> tuple[int, float]:
    """(samples, estimated error): ``more(first, count)`` doubles the samples until ``sums()`` are within ``target``, or
    there are ``MOST`` times as many as at the start. None adds none. ``begun``: samples that are there already, of a
    render that goes on."""
    most = MOST * samples
    samples = max(samples, begun)
    while (error := remaining(sums(), samples)) > (float("inf") if target is None else target) and samples < most:
        more(samples, samples)
        samples *= 2
    return samples, error


def noted(error: float) -> dict[str, float]:
    """An estimate for the header of an image file; nothing for that of a single sample."""
    return {"scratchwarp:error": error} if np.isfinite(error) else {}


def says(target: float | None, samples: int, error: float, seconds: float) -> tuple[str, ...]:
    """A warning where the target was not reached."""
    if target is None or error <= target:
        return ()
    return (
        f"max_error {target:g} was not reached: {error:.2g} after {samples} samples; half of it takes about "
        f"{seconds:.3g} s more, begin with more samples",
    )
