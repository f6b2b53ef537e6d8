"""A Layer as the author wrote it -> the sublayers that the kernel runs through.

``random``, ``crosshatch`` and a ``worley`` layer of several patterns are sets of parallel scratches, each set turned by
one angle picked within the spread, as in Raymond 2016 section 5.3. Sublayers share what the layer covers so that, laid
at random over one another, they cover as much as the author asked for: 1 - (1 - a)^(1/n) each.
"""

import math
import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..scene import Layer
from . import worley

Threshold = Callable[[float, float, str], float]

# Sets of parallel scratches that stand for a continuous spread of angles.
SETS_RANDOM = 12


@dataclass(frozen=True)
class Sublayer:
    """One set of parallel (or concentric) scratches.

    Attributes:
        layer: the author's layer; distribution: a key of ``scratches.KINDS``.
        angle: radians in pattern space; radius: threshold in cells; coverage: mean covered fraction.
        cell_length, cell_width: of a noise cell, in the layer's unit. seed: of its noise. offset: shift in cells.
        curves: index into ``Scene.curves`` of an explicit set.
    """

    layer: Layer
    distribution: str
    angle: float
    coverage: float
    radius: float = 0.0
    cell_length: float = 1.0
    cell_width: float = 1.0
    seed: int = 0
    offset: tuple[float, float] = (0.0, 0.0)
    curves: int = -1


def computed(wanted: float, variation: float, label: str) -> float:
    """The threshold for a coverage; ``label`` names the layer to those who look it up."""
    return worley.threshold(wanted, variation)


def _statistical(
    layer: Layer, angle: float, share: float, seed: int, offset: tuple[float, float], threshold: Threshold
) -> Sublayer | None:
    length, width = max(layer.length, layer.width), layer.width
    variation = layer.width_variation
    if width <= 0.0:
        return None
    if layer.density > 0.0:
        # one scratch a cell: cell area = length width / (4 d^2) = 1 / density; a square millimetre is 1e6 um^2
        unit = 1e-6 if layer.space == "surface" else 1.0
        radius = math.sqrt(layer.density * share * unit * length * width) / 2.0
        covered = worley.coverage(min(radius, 10.0), variation)
    else:
        covered = 1.0 - (1.0 - layer.coverage) ** share
        if covered <= 0.0:
            return None
        radius = threshold(min(covered, worley.MOST), variation, layer.label)
    if covered <= 0.0:
        return None
    if covered > 0.9999:
        return Sublayer(layer, "full", angle, 1.0, seed=seed)
    return Sublayer(layer, "worley", angle, covered, radius, length / (2 * radius), width / (2 * radius), seed, offset)


def _regular(layer: Layer, distribution: str, angle: float) -> Sublayer | None:
    if layer.width <= 0.0 or layer.pitch <= 0.0:
        return None
    # bands that vary are at most a pitch wide
    spread = 1.0 + layer.width_variation * ((np.arange(256) + 0.5) / 128.0 - 1.0)
    covered = float(np.minimum(layer.width / layer.pitch * spread, 1.0).mean())
    seed = zlib.crc32(f"{layer.seed} {layer.name} {angle!r}".encode()) | 1
    if covered >= 1.0 and distribution == "linear":
        return Sublayer(layer, "full", angle, 1.0, seed=seed)
    return Sublayer(layer, distribution, angle, covered, seed=seed, offset=layer.offset)


def sublayers(layer: Layer, threshold: Threshold = computed) -> tuple[Sublayer, ...]:
    """The sets of scratches that ``layer`` stands for; none when nothing of it can be seen.

    ``threshold(coverage, variation, label)``: of ``worley.threshold``, or what was computed before.
    """
    if layer.distribution == "curves":
        return tuple(Sublayer(layer, "curves", 0.0, 1.0, seed=layer.seed, curves=index) for index in layer.curves)
    if layer.distribution in ("linear", "concentric", "spiral"):
        made = [_regular(layer, layer.distribution, layer.angle)]
    elif layer.distribution == "crosshatch":
        second = replace(layer, offset=(layer.offset[1], layer.offset[0]))
        made = [_regular(layer, "linear", layer.angle), _regular(second, "linear", layer.angle + layer.cross_angle)]
    else:
        spread = abs(layer.angle_spread)
        if layer.distribution == "random" and spread == 0.0:
            spread = math.pi
        spread = min(spread, 2 * math.pi)
        sets = max(layer.patterns, SETS_RANDOM if layer.distribution == "random" else 1)
        rng = np.random.default_rng([layer.seed & 0xFFFFFFFF, *layer.name.encode()])
        turns = (np.arange(sets) + rng.random(sets)) / sets - 0.5
        made = []
        for turn in turns:
            shift = rng.random(2) * 1024.0
            offset = (layer.offset[0] + float(shift[0]), layer.offset[1] + float(shift[1]))
            seed = int(rng.integers(1, 2**32, dtype=np.uint64))
            made.append(_statistical(layer, layer.angle + spread * float(turn), 1.0 / sets, seed, offset, threshold))
    return tuple(s for s in made if s is not None)


def bend(layer: Layer) -> tuple[float, float]:
    """(amplitude, wave number) of the sideways wave whose sharpest turn is ``curvature`` radians a scratch length.

    With f = A sin(k x), k = 2 pi / (4 length), the slope turns by at most A k^2 a unit: A = curvature / (k^2 length).
    """
    length = max(layer.length, layer.width)
    if layer.curvature == 0.0 or length <= 0.0:
        return 0.0, 0.0
    number = 2.0 * math.pi / (4.0 * length)
    return abs(layer.curvature) / (number * number * length), number
