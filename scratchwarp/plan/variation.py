"""What scratches of one layer that differ need: how many tables, and which cross-sections go into each."""

from dataclasses import replace
from typing import Any

import numpy as np

from .. import profiles
from ..scene import Curves, Layer
from ..scratches import variation
from ..scratches.expand import Sublayer
from .choice import Variation
from .profiles import cross_section

# How what a scratch covers grows with its width: the ellipses of the noise grow in length, too.
POWERS = {"worley": 2, "full": 2}

Parts = tuple[tuple[Any, float], ...]


def _spread(sublayer: Sublayer, record: Curves | None) -> tuple[np.ndarray, np.ndarray]:
    """(wall angles, shares) of the scratches of a sublayer; explicit ones have widths and depths of their own."""
    layer = sublayer.layer
    if record is not None and record.width_unit == record.depth_unit and (record.widths > 0).any():
        wide = record.widths > 0
        ratios = record.depths[wide] / record.widths[wide]
        deep = (
            np.ones(1) if layer.depth_variation == 0.0 else 1.0 + layer.depth_variation * (np.arange(31) / 15.0 - 1.0)
        )
        return np.arctan(2.0 * np.outer(ratios, deep)).ravel(), np.repeat(record.widths[wide], len(deep))
    own = 0.0 if sublayer.distribution == "curves" else layer.width_variation
    power = POWERS.get(sublayer.distribution, 1)
    return variation.spread(layer.depth / layer.width, own, layer.depth_variation, power)


def varied(
    sublayer: Sublayer, sized: Layer, record: Curves | None, max_error: float | None
) -> tuple[Variation, tuple[Parts, ...]] | None:
    """(how the scratches differ, what goes into each of their tables), None where all are alike.

    ``sized``: the layer with the size of its middle scratch; ``record``: its explicit scratches. Raises ValueError
    where a cross-section between a layer's two profiles cannot be made.
    """
    layer = sublayer.layer
    amount = layer.profile_variation if layer.profile_end is not None else 0.0
    angles, shares = _spread(sublayer, record)
    shares = shares / shares.sum()
    axis = variation.axis(angles, shares, max_error, amount > 0.0)
    if layer.profile.shape == "flat" and amount == 0.0:
        axis = None
    if axis is None and amount <= 0.0:
        return None
    aspect = sized.depth / sized.width
    nodes = (((aspect, 1.0),),) if axis is None else axis.parts
    made: list[Parts] = []
    ways = variation.blends(amount)
    for way in ways:
        for node in nodes:
            made.append(tuple((_section(layer, a, part), s * t) for part, s in way for a, t in node))
    low, high = (0.0, 1.0) if axis is None else (axis.low, axis.high)
    return Variation(len(nodes), len(ways), low, high, aspect, record is not None), tuple(made)


def _section(layer: Layer, aspect: float, part: float) -> profiles.Profile:
    """The cross-section of an aspect, part of the way to the layer's other profile."""
    sized = replace(layer, width=1.0, depth=aspect)
    first = cross_section(layer.profile, sized)
    if part <= 0.0 or layer.profile_end is None:
        return first
    try:
        return profiles.between(first, cross_section(layer.profile_end, sized), part)
    except ValueError as error:
        raise ValueError(
            f"{layer.label}: {part:.3g} of the way to profileEnd {layer.profile_end.path}: {error}"
        ) from None
