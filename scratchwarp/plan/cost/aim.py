"""The cheapest values of all knobs whose predicted error is below the one asked for, or goes with a quality.

The error of an image is that of its noise, which falls with samples, and the biases of its knobs, which do not. They
are taken for independent, so that relMSE add up. What a bias buys in seconds is set against the samples that it costs.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from ...scene import Scene, Wave
from ...scene.knob import Value
from ..choice import EffectPlan
from ..grooves import recut, slack_of
from ..knobs import KNOBS, acting, turned_tables
from .forecast import forecast
from .models import Costs, Errors, costs, errors, shipped, shipped_errors
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
NEGLIGIBLE = 0.01
"""Of what knobs may leave together, what makes dearer values of one of them pointless."""
TYPICAL = 0.4
"""Of an image, what a material fills on the stages where errors were measured."""
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
    seen = visible(scene, plan.size, plan.window)
    left = _as_seen(plan, seen, left)
    fixed = sum(left.bias[n].get(str(v), 0.0) for n, v in given.items() if n in left.bias and n in known)
    if samples is None:  # footprints and lines over them are those of about so many samples
        plan = replace(plan, settings=replace(plan.settings, spp=wanted(target, left)))
    tables, traced = _ladders(scene, plan, given, prices, left, BIAS_SHARE * target, seen)
    best: tuple[float, float, Aim] | None = None
    least = fixed + min(row.bias for row in tables) + min(row.bias for row in traced)
    for table, other in product(_front(tables), _front(traced)):
        whole = fixed + table.bias + other.bias
        if whole > max(BIAS_SHARE * target, least):
            continue
        noise = max(target - whole, (1.0 - BIAS_SHARE) * target)
        seconds = table.seconds + other.seconds * (samples or needed(noise, left))
        if best is None or (seconds, whole) < best[:2]:
            chosen: dict[str, Value] = {**table.knobs, **other.knobs}
            number = len(tables) * len(traced)
            count = samples or wanted(noise, left, other.more)
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
    alike, one thread, and prices and errors are those that are shipped. Of the camera only how many grooves and
    scratches that diffract lie under a footprint counts, so frames of a zoom onto these may differ.
    """
    prices, left = prices or shipped(), left or shipped_errors()
    one, power = left.noise
    most = QUALITY_SHARE * one / samples**power
    seen = np.full(max(len(scene.materials), 1), 1.0 / max(len(scene.materials), 1))
    alike = replace(plan, window=(0, plan.size[0], 0, plan.size[1]), settings=replace(plan.settings, threads=1))
    kept = {**given, "grooves.section": "auto"}  # which goes with a quality by itself
    tables, traced = _ladders(scene, alike, kept, prices, left, most, seen)
    pixels = plan.size[0] * plan.size[1]
    scale = NOMINAL / pixels * samples  # tables against samples as in an image of one size
    best: tuple[float, float, dict[str, Value]] | None = None
    for table, other in product(_front(tables), _front(traced)):
        bias = table.bias + other.bias
        row = table.seconds + scale * other.seconds, bias, {**table.knobs, **other.knobs}
        if bias <= most and (best is None or row[:2] < best[:2]):
            best = row
    if best is None:
        best = 0.0, 0.0, {n: KNOBS[n].reference for n in (*tables[0].knobs, *traced[0].knobs)}
    return Suited(best[2], best[1], most, len(tables) * len(traced))


@dataclass(frozen=True)
class Row:
    """Values of some knobs: the ``bias`` that they leave, ``seconds`` (of tables; of as many samples a pixel as leave
    the noise of one at the reference values) and ``more``: how many samples those are."""

    knobs: dict[str, Value]
    bias: float
    seconds: float
    more: float = 1.0


Rows = list[Row]


def _ladders(
    scene: Scene, plan: EffectPlan, given: Mapping[str, Value], prices: Costs, left: Errors, most: float,
    seen: np.ndarray,
) -> tuple[Rows, Rows]:  # fmt: skip
    """Combinations of the knobs of tables, simulated once, and of the others, for each sample."""
    known = acting(plan)
    threads = max(plan.settings.threads or 1, 1)
    speed = 1.0 if threads == 1 else prices.efficiency * threads
    names = [n for n in left.bias if n in known and n not in given]
    of_tables = [n for n in names if KNOBS[n].place[0] == _TABLE]
    tables = [Row(k, b, _simulated(plan, k, prices) / speed) for k, b in _combinations(of_tables, left, most)]
    spp, traced = plan.settings.spp or 1, []

    def each(knobs: Mapping[str, Value]) -> float:
        return forecast(scene, _turned(plan, knobs), prices, seen).part("trace") / spp

    others = [n for n in names if n not in of_tables and not _authored(plan, n)]
    ends = {n: [KNOBS[n].checked(list(left.bias[n])[k]) for k in (0, -1)] for n in others}
    others = [n for n in others if each({n: ends[n][0]}) != each({n: ends[n][1]})]  # what costs nothing does nothing
    for knobs, bias in _combinations(others, left, most):
        more = math.prod(left.more_samples(name, value) for name, value in knobs.items())
        traced.append(Row(knobs, bias, each(knobs) * more, more))
    return tables, traced


def _as_seen(plan: EffectPlan, seen: np.ndarray, left: Errors) -> Errors:
    """Errors where what knobs act on fills less of the image than it did where they were measured: relMSE is a mean
    over all pixels."""
    tabled = [any(p.table >= 0 for p in own) for own in plan.layers]
    grooved, waved = [[own is not None for own in plans] for plans in (plan.grooves, plan.waves)]
    acts = {"tables": tabled, "lights": tabled, "grooves": grooved, "diffraction": waved}
    bounced = plan.on("indirect")  # light goes on to other materials

    def part(name: str) -> float:
        on = acts.get(name.split(".")[0])
        if on is None or bounced or len(on) != len(seen):
            return 1.0
        return min(1.0, float(seen[np.array(on, bool)].sum()) / TYPICAL)

    bias = {name: {value: part(name) * b for value, b in values.items()} for name, values in left.bias.items()}
    return replace(left, bias=bias)


def _authored(plan: EffectPlan, name: str) -> bool:
    """Whether a stage means something by what a knob would change: the wavelengths of coloured light."""
    ranges = {(own.wave.wavelength_range, own.wave.samples) for own in plan.waves if own is not None}
    return name == "diffraction.wavelengths" and not ranges <= {(Wave.wavelength_range, Wave.samples)}


def wanted(noise: float, left: Errors, more: float = 1.0) -> int:
    """``more`` times ``needed``, up to the next power of two."""
    count = FIRST
    while count < min(more * needed(noise, left), MOST):
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
        good = [row for row in rows if row[1] <= most] or rows[-1:]
        enough = next((k for k, row in enumerate(good) if row[1] <= NEGLIGIBLE * most), len(good) - 1)
        ladders.append(good[: enough + 1])
    for values in product(*ladders):
        whole = sum(bias for _, bias in values)
        if whole <= most or all(v == ladder[-1][0] for (v, _), ladder in zip(values, ladders, strict=True)):
            yield {name: v for name, (v, _) in zip(names, values, strict=True)}, whole


def _front(rows: Rows) -> Rows:
    """Those that nothing beats in both bias and seconds."""
    kept: Rows = []
    for row in sorted(rows, key=lambda row: (row.seconds, row.bias)):
        if not kept or row.bias < kept[-1].bias:
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
    if "grooves.section" in knobs:
        grooves = recut(plan.grooves, slack_of(knobs["grooves.section"], plan.settings.quality))
        plan = replace(plan, grooves=grooves)
    return replace(plan, settings=replace(plan.settings, **fields, knobs=known))
