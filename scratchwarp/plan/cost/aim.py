"""The cheapest values of all knobs whose predicted error is below the one asked for, or goes with a quality.

The error of an image is that of its noise, which falls with samples, and the biases of its knobs, which do not. They
are taken for independent, so that relMSE add up. What a bias buys in seconds is set against the samples that it costs.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from ...scene import Scene
from ...scene.knob import Value
from ..choice import EffectPlan
from ..knobs import KNOBS, acting, turned_tables
from .forecast import forecast
from .models import Costs, Errors, costs, errors, shipped
from .visible import visible
from .work import of_table

BIAS_SHARE = 0.5
"""Largest share of an error that knobs may leave, so that noise has the rest."""
FIRST = 2
"""Samples a pixel of the first pass: the fewest whose spread says something."""
MOST = 1024
NOMINAL = 640 * 480
"""Pixels of the image for which the knobs of a quality are weighed."""
QUALITY_SHARE = 0.0625
"""Of the noise that the samples of a quality leave in a typical image, what its knobs may leave."""
_TABLE = "table"


@dataclass(frozen=True)
class Aim:
    """How an error is to be met.

    Attributes:
        error: asked for; bias: predicted of what the knobs leave; noise: what samples may leave.
        first: samples a pixel of the first pass, after which they are added by need.
        knobs: chosen. seconds: predicted, with ``samples`` a pixel; combinations: that were compared.
        halved: how much longer a render to half the error would take, predicted.
    """

    error: float
    bias: float
    noise: float
    first: int
    knobs: Mapping[str, Value]
    samples: int
    seconds: float
    combinations: int
    halved: float = 2.0


def aim(
    scene: Scene,
    plan: EffectPlan,
    given: Mapping[str, Value],
    samples: int | None = None,
    prices: Costs | None = None,
    left: Errors | None = None,
) -> Aim:
    """Choose for ``plan.settings.max_error``. ``plan``: with the knobs that are ``given``, which stay; ``samples``:
    asked for, None where they follow from the error."""
    prices, left = prices or costs(), left or errors()
    target = float(plan.settings.max_error or 0.0)
    one = _aimed(scene, plan, given, samples, prices, left, target)
    half = _aimed(scene, plan, given, None if samples is None else 2 * samples, prices, left, 0.5 * target)
    return replace(one, halved=half.seconds / max(one.seconds, 1e-12))


def _aimed(
    scene: Scene, plan: EffectPlan, given: Mapping[str, Value], samples: int | None, prices: Costs, left: Errors,
    target: float,
) -> Aim:  # fmt: skip
    known = acting(plan)
    fixed = sum(left.bias[n].get(str(v), 0.0) for n, v in given.items() if n in left.bias and n in known)
    seen = visible(scene, plan.size, plan.window)
    tables, traced = _ladders(scene, plan, given, prices, left, BIAS_SHARE * target, seen)
    best: tuple[float, float, Aim] | None = None
    least = fixed + min(bias for _, bias, _ in tables) + min(bias for _, bias, _ in traced)
    for (own, bias, once), (others, more, each) in product(_front(tables), _front(traced)):
        whole = fixed + bias + more
        if whole > max(BIAS_SHARE * target, least):
            continue
        noise = max(target - whole, (1.0 - BIAS_SHARE) * target)
        seconds = once + each * (samples or needed(noise, left))
        if best is None or (seconds, whole) < best[:2]:
            chosen: dict[str, Value] = {**own, **others}
            number = len(tables) * len(traced)
            count = samples or wanted(noise, left)
            first = samples or min(FIRST, count)
            best = seconds, whole, Aim(target, whole, noise, first, chosen, count, seconds, number)
    assert best is not None  # there is always the reference
    return best[2]


@dataclass(frozen=True)
class Suited:
    """What goes with a quality: ``knobs``, predicted ``bias`` of at most ``most``, ``combinations`` compared."""

    knobs: Mapping[str, Value]
    bias: float
    most: float
    combinations: int


def suited(
    scene: Scene,
    plan: EffectPlan,
    given: Mapping[str, Value],
    samples: int,
    prices: Costs | None = None,
    left: Errors | None = None,
) -> Suited:
    """The cheapest knobs that leave an error which the noise of ``samples`` a pixel hides; those ``given`` stay.

    Nothing depends on the part that is rendered or on the machine, so that crops have the same knobs: materials count
    alike, one thread, and prices are those that are shipped. Of the camera only how many grooves and scratches that
    diffract lie under a footprint counts, so frames of a zoom onto these may differ.
    """
    prices, left = prices or shipped(), left or errors()
    one, power = left.noise
    most = QUALITY_SHARE * one / samples**power
    seen = np.full(max(len(scene.materials), 1), 1.0 / max(len(scene.materials), 1))
    alike = replace(plan, window=(0, plan.size[0], 0, plan.size[1]), settings=replace(plan.settings, threads=1))
    tables, traced = _ladders(scene, alike, given, prices, left, most, seen)
    pixels = plan.size[0] * plan.size[1]
    scale = NOMINAL / pixels * samples  # tables against samples as in an image of one size
    best: tuple[float, float, dict[str, Value]] | None = None
    for (own, bias, once), (others, more, each) in product(_front(tables), _front(traced)):
        row = once + scale * each, bias + more, {**own, **others}
        if bias + more <= most and (best is None or row[:2] < best[:2]):
            best = row
    if best is None:
        best = 0.0, 0.0, {n: KNOBS[n].reference for n in (*tables[0][0], *traced[0][0])}
    return Suited(best[2], best[1], most, len(tables) * len(traced))


Rows = list[tuple[dict[str, Value], float, float]]


def _ladders(
    scene: Scene, plan: EffectPlan, given: Mapping[str, Value], prices: Costs, left: Errors, most: float,
    seen: np.ndarray,
) -> tuple[Rows, Rows]:  # fmt: skip
    """(knobs, bias, seconds) of combinations of the knobs of tables, once, and of the others, each sample a pixel."""
    known = acting(plan)
    threads = max(plan.settings.threads or 1, 1)
    speed = 1.0 if threads == 1 else prices.efficiency * threads
    names = [n for n in left.bias if n in known and n not in given]
    of_tables = [n for n in names if KNOBS[n].place[0] == _TABLE]
    tables = [(k, b, _simulated(plan, k, prices) / speed) for k, b in _combinations(of_tables, left, most)]
    spp, traced = plan.settings.spp or 1, []
    for knobs, bias in _combinations([n for n in names if n not in of_tables], left, most):
        cost = forecast(scene, _turned(plan, knobs), prices, seen)
        traced.append((knobs, bias, cost.part("trace") / spp))
    return tables, traced


def wanted(noise: float, left: Errors) -> int:
    """``needed``, up to the next power of two."""
    count = FIRST
    while count < min(needed(noise, left), MOST):
        count *= 2
    return count


def needed(noise: float, left: Errors) -> float:
    """Samples a pixel that leave a typical image this much noise."""
    one, power = left.noise
    return float((one / noise) ** (1.0 / power))


def _combinations(names: list[str], left: Errors, most: float) -> Iterator[tuple[dict[str, Value], float]]:
    """(values, their biases together) of knobs within ``most``; their reference values always."""
    ladders = []
    for name in names:
        rows = [(v, left.bias[name][str(v)]) for v in KNOBS[name].values if str(v) in left.bias[name]]
        ladders.append([row for row in rows if row[1] <= most] or rows[-1:])
    for values in product(*ladders):
        whole = sum(bias for _, bias in values)
        if whole <= most or all(v == ladder[-1][0] for (v, _), ladder in zip(values, ladders, strict=True)):
            yield {name: v for name, (v, _) in zip(names, values, strict=True)}, whole


def _front(rows: Rows) -> Rows:
    """Those that nothing beats in both bias and seconds."""
    kept: Rows = []
    for row in sorted(rows, key=lambda row: (row[2], row[1])):
        if not kept or row[1] < kept[-1][1]:
            kept.append(row)
    return kept


def _simulated(plan: EffectPlan, knobs: Mapping[str, Value], prices: Costs) -> float:
    """Seconds of one thread for the plan's tables."""
    made = turned_tables(plan.tables, knobs, False)
    return sum(count * prices.of(unit) for table in made for (_, unit), count in of_table(table).items())


def _turned(plan: EffectPlan, knobs: Mapping[str, Value]) -> EffectPlan:
    """The plan with knobs of tracing turned, as far as ``work`` looks."""
    fields: dict[str, Any] = {KNOBS[n].place[1]: v for n, v in knobs.items() if KNOBS[n].place[0] == "settings"}
    known = {**plan.settings.knobs, **knobs}
    return replace(plan, settings=replace(plan.settings, **fields, knobs=known))
