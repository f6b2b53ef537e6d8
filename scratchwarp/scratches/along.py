"""Scratches laid out one by one: those that follow a field of directions, and those that change along their way."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ..scene import Curves, Layer

Array = np.ndarray[Any, Any]
Field = Callable[[Array], Array]

STEPS = 8
"""Straight stretches on which a scratch follows a field, and to one wavelength of its variation."""
MOST_POINTS = 20_000_000


def followed(middle: Array, aside: Array, start: Array, length: float, low: Array, scale: Array, field: Field) -> Array:
    """Points ``[n, STEPS + 1, 2]`` of scratches of one length through ``middle`` [n, 2] that follow a field, turned by
    ``aside`` [n] from it; where it has no direction they go straight on, at first towards ``start`` [n].

    Lengths in pattern units; ``low``: uv of the pattern's corner, ``scale``: units a unit of u and of v.
    """
    half, step = STEPS // 2, length / STEPS
    points = np.empty((len(middle), STEPS + 1, 2))
    points[:, half] = middle
    first = _turn(field(low + middle / scale), aside, start)
    for side in (1, -1):
        at, heading = middle, first if side == 1 else first + math.pi
        for i in range(1, half + 1):
            # the direction half a step on
            ahead = at + 0.5 * step * np.stack([np.cos(heading), np.sin(heading)], axis=1)
            heading = _turn(field(low + ahead / scale), aside, heading)
            at = at + step * np.stack([np.cos(heading), np.sin(heading)], axis=1)
            points[:, half + side * i] = at
    return points


def _turn(two: Array, aside: Array, last: Array) -> Array:
    """Angles of a field given at twice its angle, of both ways the one nearer to ``last``; that where it has none."""
    angle = 0.5 * np.arctan2(two[:, 1], two[:, 0]) + aside
    angle = angle + math.pi * np.rint((last - angle) / math.pi)
    return np.where(np.hypot(two[:, 0], two[:, 1]) > 1e-6, angle, last)


def waves(along: Array, phase: Array, wobble: Array) -> Array:
    """A number in [0, 1] that changes smoothly along a scratch, ``along`` in wavelengths; uniform over all scratches
    at each place (as ``variation_device.along_scratch``)."""
    at = phase + along + 0.06 * (np.sin(4.0 * np.pi * along + wobble) - np.sin(wobble))
    return 1.0 - np.abs(2.0 * (at - np.floor(at)) - 1.0)


def varied(curves: Curves, layer: Layer, scale: Array, with_width: bool) -> Curves:
    """Scratches whose depth, and width ``with_width``, vary as the layer says: from one to the next, or along each
    where it has a ``variation_length``, on stretches of an eighth of that at most.

    ``scale``: the layer's units of length a unit of the points' coordinates. ValueError on more than ``MOST_POINTS``.
    """
    deep, wide = layer.depth_variation, layer.width_variation if with_width else 0.0
    if deep == 0.0 and wide == 0.0 or len(curves.counts) == 0:
        return curves
    points, counts = np.asarray(curves.points, np.float64), np.asarray(curves.counts, np.int64)
    number = np.repeat(np.arange(len(counts)), counts)
    last = np.cumsum(counts) - 1
    run = np.zeros(len(points))
    run[1:] = np.linalg.norm(np.diff(points * scale, axis=0), axis=1)
    run[(last + 1)[:-1]] = 0.0
    run = np.cumsum(run)
    run -= run[(last - counts + 1)[number]]
    widths, depths = np.asarray(curves.widths, np.float64), np.asarray(curves.depths, np.float64)
    if layer.variation_length > 0.0:
        step = layer.variation_length / STEPS
        inner = np.ones(len(points), np.int64)
        inner[:-1] = np.clip(np.ceil(np.diff(run) / step), 1, None)
        inner[last] = 1
        if inner.sum() > MOST_POINTS:
            raise ValueError(
                f"{layer.label}: scratches that change every {layer.variation_length:.3g} along themselves take "
                f"{inner.sum():.3g} points, more than {MOST_POINTS}; make variationLength longer"
            )
        left = np.repeat(np.arange(len(points)), inner)
        t = (np.arange(len(left)) - np.repeat(np.cumsum(inner) - inner, inner)) / np.repeat(inner, inner)
        right = np.minimum(left + 1, len(points) - 1)

        def between(values: Array) -> Array:
            part = t if values.ndim == 1 else t[:, None]
            return (1.0 - part) * values[left] + part * values[right]

        points, run, widths, depths = (between(x) for x in (points, run, widths, depths))
        number, counts = number[left], np.bincount(number[left], minlength=len(counts))
    rng = np.random.default_rng([layer.seed & 0xFFFFFFFF, 7, *layer.name.encode()])
    along = run / layer.variation_length if layer.variation_length > 0.0 else np.zeros(len(run))

    def factor(amount: float) -> Array:
        phase, wobble = rng.random(len(counts))[number], 2.0 * np.pi * rng.random(len(counts))[number]
        return 1.0 + amount * (2.0 * waves(along, phase, wobble) - 1.0)

    return replace(
        curves,
        points=points,
        counts=counts.astype(np.int32),
        widths=widths * factor(wide) if wide else widths,
        depths=depths * factor(deep) if deep else depths,
    )


def dealt(curves: Curves, layer: Layer, parts: int) -> list[Curves]:
    """The scratches dealt at random to ``parts`` sets, as those of several cross-sections."""
    if parts == 1:
        return [curves]
    rng = np.random.default_rng([layer.seed & 0xFFFFFFFF, 11, *layer.name.encode()])
    which = rng.integers(0, parts, len(curves.counts))
    number = np.repeat(which, curves.counts)
    return [
        replace(
            curves,
            points=curves.points[number == i],
            counts=curves.counts[which == i],
            widths=curves.widths[number == i],
            depths=curves.depths[number == i],
        )
        for i in range(parts)
    ]
