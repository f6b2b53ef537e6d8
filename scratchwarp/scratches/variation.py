"""How scratches of one layer differ: the distribution of their aspects, and the few tables that stand for it.

A scratch of a layer has width w (1 + V t), depth d (1 + D t') with t and t' uniform in [-1, 1]; its aspect decides what
it reflects. The axis of tables is the angle a = atan(2 depth / width), that of the walls of a V groove: a highlight
moves by 2 a. Table k is the average over the aspects of the layer, weighted by what they cover and by a hat function
about node k; a scratch between two nodes takes one of them with the probabilities of linear interpolation. Hats sum to
one, so a footprint over many scratches sees the average over all aspects, however few the nodes; their number says how
well single scratches are told apart.
"""

import math
from dataclasses import dataclass

import numpy as np

# Nodes lie this far apart, in angles of the highlight, at the default accuracy; simulated aspects at most PART.
STEP, PART = math.radians(8.0), math.radians(1.0)
MOST_NODES, MOST_PARTS = 8, 48
DEFAULT_ERROR = 0.01
# A smaller range of highlights than this is no variation.
SMALLEST = math.radians(0.25)


@dataclass(frozen=True)
class Axis:
    """Nodes of tables over the wall angle.

    Attributes:
        low, high: wall angle of the first and the last node [rad]; count: nodes, equally spaced.
        parts: for each node the aspects to simulate and their shares, ((aspect, share), ...).
    """

    low: float
    high: float
    count: int
    parts: tuple[tuple[tuple[float, float], ...], ...]


def spread(ratio: float, width: float, depth: float, power: int) -> tuple[np.ndarray, np.ndarray]:
    """(wall angles [rad], shares) of scratches whose mean aspect is ``ratio``; each covers in proportion to its width
    to the ``power`` (2 where its length varies with it). ``width``, ``depth``: relative variations."""
    t = (np.arange(64) + 0.5) / 32.0 - 1.0
    wide, deep = np.meshgrid(1.0 + width * t, 1.0 + depth * t, indexing="ij")
    share = (wide**power).ravel()
    return np.arctan2(2.0 * ratio * deep, wide).ravel(), share / share.sum()


def axis(angles: np.ndarray, shares: np.ndarray, max_error: float | None = None, blended: bool = False) -> Axis | None:
    """Nodes for scratches of these wall angles, so many that neighbours' highlights are ``STEP`` apart at the default
    accuracy and nearer for a smaller ``max_error``, up to ``MOST_NODES``; None where all are alike. ``blended``: each
    has several tables, so half of the nodes and a third of the aspects have to do."""
    order = np.argsort(angles)
    sums = np.cumsum(shares[order])
    # the least and greatest thousandth join their neighbours
    low, high = (float(angles[order][min(int(np.searchsorted(sums, q)), len(order) - 1)]) for q in (0.001, 0.999))
    if 2.0 * (high - low) < SMALLEST:
        return None
    step = STEP * min((max_error or DEFAULT_ERROR) / DEFAULT_ERROR, 4.0)
    count = min(max(math.ceil(2.0 * (high - low) / step) + 1, 2), MOST_NODES // 2 if blended else MOST_NODES)
    fine = min(max(math.ceil(2.0 * (high - low) / PART), 2 * (count - 1)), MOST_PARTS // 3 if blended else MOST_PARTS)
    at = (np.arange(fine) + 0.5) / fine
    place = np.clip((angles - low) / (high - low), 0.0, 1.0)
    held = np.bincount(np.minimum((place * fine).astype(int), fine - 1), shares, minlength=fine)
    parts = []
    for node in range(count):
        hat = np.maximum(1.0 - np.abs(at * (count - 1) - node), 0.0) * held
        chosen = np.flatnonzero(hat > 0.0)
        aspects = np.tan(low + at[chosen] * (high - low)) / 2.0
        held_by = [(float(a), float(s)) for a, s in zip(aspects, hat[chosen], strict=True)]
        parts.append(tuple(held_by or [(math.tan(low + node / (count - 1) * (high - low)) / 2.0, 1.0)]))
    return Axis(low, high, count, tuple(parts))


def blends(amount: float) -> tuple[tuple[tuple[float, float], ...], ...]:
    """Nodes over the way from a profile to its other one, uniform in [0, ``amount``]: parts of it and their shares."""
    if amount <= 0.0:
        return (((0.0, 1.0),),)
    count, fine = 4, 7
    at = np.arange(fine) / (fine - 1)
    held = np.where((at == 0) | (at == 1), 0.5, 1.0)  # trapezoidal rule
    hats = [np.maximum(1.0 - np.abs(at * (count - 1) - node), 0.0) * held for node in range(count)]
    return tuple(tuple((float(amount * a), float(h)) for a, h in zip(at, hat, strict=True) if h > 0) for hat in hats)
