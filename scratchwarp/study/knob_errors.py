"""What each value of a knob leaves in an image, measured; ``error_calibration`` writes the file of it.

Two pairs of images with seeds of their own are rendered, each with the same samples at a value and at the knob's
reference value. The mean product of the two differences has no noise in it on average; its standard error is added.
How much noisier a value is follows from how far the two seeds are apart, at that value and at the reference value.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ..plan import make_plan
from ..plan.knobs import KNOBS, acting
from ..scene import Scene, Settings
from ..scene.knob import Value
from .measures import weights
from .shots import Shots

MEASURED = (
    "tables.resolution", "tables.rays", "tables.bounces", "lights.coneTaps", "pathDepth", "grooves.lines",
    "grooves.section", "grooves.bounces", "diffraction.wavelengths", "diffraction.slices",
)  # fmt: skip
"""Knobs that a target may turn: each costs the more the more accurate it is."""
SHARE = 0.8
"""Share of the stages whose bias lies below what is noted."""
SEEDS = (11, 12)
FEW = {"grooves.lines": 4}
"""Samples a pixel at which a knob is measured that many samples make up for."""
MORE = {"tables.resolution": 8, "tables.rays": 8}
"""How many times as many samples knobs are measured with whose values draw other directions, which leaves noise."""
NOISY = ("lights.coneTaps", "grooves.lines")
"""Knobs whose values differ in noise, too: means of some places of each footprint or cone, of more at dearer values."""

Rows = dict[str, dict[str, float]]


@dataclass(frozen=True)
class Left:
    """What knobs leave on a stage, knob -> value as text: ``bias``: relMSE against the knob's reference value with the
    same samples, noise taken out; ``noisier``: relMSE of the noise over that at the reference value."""

    bias: Rows = field(default_factory=dict)
    noisier: Rows = field(default_factory=dict)


def left(scene: Scene, settings: Settings, names: Iterable[str] = MEASURED) -> Left:
    """Measure; knobs that do nothing here are left out."""
    known, found = acting(make_plan(scene, settings)), Left()
    shots = Shots(scene, settings)
    for name in (n for n in names if n in known):
        spp = settings.spp or 1
        count = min(FEW.get(name, spp), spp) * MORE.get(name, 1)
        own = shots if count == settings.spp else Shots(scene, replace(settings, spp=count))
        best = pair(own, {name: KNOBS[name].reference})
        weight = weights(0.5 * (best[0] + best[1]))
        apart = _mean_square(best, weight)
        bias: dict[str, float] = {}
        noisier: dict[str, float] = {}
        for value in KNOBS[name].values[:-1]:
            if value == "auto":
                continue
            made = pair(own, {name: value})
            if not bias and all(np.array_equal(one, other) for one, other in zip(made, best, strict=True)):
                break
            first, second = (one - other for one, other in zip(made, best, strict=True))
            off = (first * second).mean(axis=-1) * weight
            bias[str(value)] = max(float(off.mean()), 0.0) + float(off.std()) / np.sqrt(off.size)
            if name in NOISY:
                noisier[str(value)] = _mean_square(made, weight) / apart if apart > 0.0 else 1.0
        if bias:
            found.bias[name] = bias
        if noisier:
            found.noisier[name] = noisier
    return found


def pair(shots: Shots, knobs: Mapping[str, Value]) -> list[np.ndarray]:
    """Two images of a setting with seeds of their own, float64; tables are simulated once."""
    if shots.stock.key is None and not any(KNOBS[name].place[0] == "table" for name in knobs):
        shots.take({}, SEEDS[0])
    one = shots.take(knobs, SEEDS[0])
    two = shots.take(knobs, SEEDS[1], stock=one.stock)
    return [one.image.astype(np.float64), two.image.astype(np.float64)]


def _mean_square(images: list[np.ndarray], weight: np.ndarray) -> float:
    return float((((images[0] - images[1]) ** 2).mean(axis=-1) * weight).mean())


def noise(scene: Scene, settings: Settings, counts: tuple[int, ...] = (2, 8, 32)) -> list[float]:
    """relMSE of the noise of images of ``counts`` samples: half of the squared difference of two seeds, relative to the
    mean image of four times as many samples as the most."""
    shots = Shots(scene, settings)
    best = pair(shots, {"spp": 4 * max(counts)})
    weight = weights(0.5 * (best[0] + best[1]))
    return [0.5 * _mean_square(pair(shots, {"spp": count}), weight) for count in counts]


def worst(rows: Iterable[Mapping[str, Mapping[str, float]]]) -> Rows:
    """knob -> value -> the greatest of several rows, those of one stage as it is and as it was changed."""
    made: Rows = {}
    for row in rows:
        for name, values in row.items():
            own = made.setdefault(name, {})
            own.update({value: max(number, own.get(value, 0.0)) for value, number in values.items()})
    return made


def summed_up(stages: Iterable[Mapping[str, Mapping[str, float]]], least: float = 0.0) -> Rows:
    """knob -> value -> what ``SHARE`` of the stages stay below, made to fall from value to value down to ``least`` at
    the knob's reference value."""
    every: dict[str, dict[str, list[float]]] = {}
    for stage in stages:
        for name, values in stage.items():
            for value, number in values.items():
                every.setdefault(name, {}).setdefault(value, []).append(number)
    made: Rows = {}
    for name, known in every.items():
        most = least
        falling: dict[str, float] = {str(KNOBS[name].reference): least}
        for value in reversed([str(v) for v in KNOBS[name].values if str(v) in known]):
            most = max(most, float(np.quantile(known[value], SHARE)))
            falling[value] = most
        made[name] = {str(v): falling[str(v)] for v in KNOBS[name].values if str(v) in falling}
    return made
