"""Gauss rules for lights that begin and end round, tabulated.

The weight e^{-x^2} sqrt((x - x0) (x1 - x)) between the two ends of a circle's chord, seen from the end that is nearer
to 0 or beyond it: x = x0 + y, 0 <= y <= L. Rows are even in 1 / (1 + e), e = sqrt(1 + x0^2) - x0, which is about how
far the weight reaches from there; columns even in L / (L + e).
"""

import functools

import numpy as np

ROWS, COLUMNS = 96, 96
FIRST, LAST = 0.1, 0.985
"""1 / (1 + e) of the first and the last row: x0 = -4.4 and 33."""
_FINE = 400


@functools.lru_cache(maxsize=1)
def round_rules() -> np.ndarray:
    """(y / S, weight / N) of two nodes each, float64 ``[ROWS, COLUMNS, 4]``; S = L e / (L + e), N = e^{-max(x0, 0)^2}
    S^{3/2} L^{1/2}. The weights are those of a function divided by the square root."""
    reach = 1.0 / np.linspace(FIRST, LAST, ROWS)[:, None, None] - 1.0
    x0 = 0.5 * (1.0 / reach - reach)
    share = np.linspace(0.0, 1.0, COLUMNS)[:, None]
    share = np.clip(share, 1e-4, 1.0 - 1e-4)
    length = reach * share / (1.0 - share)
    scale = length * reach / (length + reach)
    # y = a sin^2(tau / 2) takes the root out of the first end; beyond a there is nothing
    a = np.minimum(length, np.sqrt(40.0 + np.maximum(x0, 0.0) ** 2) - x0)
    tau = (np.arange(_FINE) + 0.5) / _FINE * np.pi
    y = a * 0.5 * (1.0 - np.cos(tau))
    weight = 0.5 * a * np.sin(tau) * np.pi / _FINE * np.sqrt(np.maximum(y * (length - y), 0.0))
    weight = weight * np.exp(np.maximum(x0, 0.0) ** 2 - (x0 + y) ** 2)
    t = y / scale
    mass, first = weight.sum(-1), (weight * t).sum(-1)
    first /= mass
    away = t - first[..., None]
    variance, third = (weight * away**2).sum(-1) / mass, (weight * away**3).sum(-1) / mass
    lean = third / variance
    root = np.sqrt(lean**2 + 4.0 * variance)
    low, high = 0.5 * (lean - root), 0.5 * (lean + root)
    norm = (scale**1.5 * length**0.5)[..., 0]
    return np.stack((first + low, mass * high / root / norm, first + high, -mass * low / root / norm), axis=-1)
