"""Seconds that a render will take, by effect, before anything is compiled, simulated or traced."""

import os
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...scene import Scene
from ..choice import EffectPlan
from ..knobs import acting, value
from .models import Costs, costs
from .work import work

PARTS = ("simulate", "build", "trace")
SLOW = 900.0
"""Predicted seconds of an image from which on ``explain`` warns."""


@dataclass(frozen=True)
class Forecast:
    """Predicted wall-clock seconds.

    Attributes:
        effects: (part, effect) -> seconds, parts as in ``PARTS``. threads: that share the work.
        compile: seconds of compiling the kernel where no cache has it; nothing otherwise.
        read, plan: what reading and planning took. samples: a pixel, that were counted on.
        spread: factor within which nine of ten predictions lay. machine: that the prices are of.
    """

    effects: Mapping[tuple[str, str], float]
    threads: int
    compile: float
    read: float
    plan: float
    samples: int
    spread: float
    machine: str

    def part(self, name: str) -> float:
        """Seconds of a part."""
        return sum(seconds for (part, _), seconds in self.effects.items() if part == name)

    @property
    def seconds(self) -> float:
        """Seconds of simulating, building and tracing, with a kernel that a cache has."""
        return sum(self.effects.values())

    def record(self) -> dict[str, object]:
        """As what JSON can hold."""
        rows: dict[str, dict[str, float]] = {part: {} for part in PARTS}
        for (part, effect), seconds in self.effects.items():
            rows[part][effect] = seconds
        return {
            "seconds": self.seconds,
            "effects": rows,
            "compile": self.compile,
            "threads": self.threads,
            "samples": self.samples,
            "spread": self.spread,
            "machine": self.machine,
        }

    def text(self, taken: Mapping[str, float] | None = None) -> str:
        """A table, dearest first; ``taken``: ``Film.stats`` of the render, to compare with."""
        lines = ["cost predicted        seconds  share  effect", "--------------------  -------  -----  ------"]
        whole = max(self.seconds, 1e-30)
        for (part, effect), seconds in sorted(self.effects.items(), key=lambda row: -row[1]):
            if seconds >= 5e-4 * whole:
                lines.append(f"{part:<20}  {seconds:7.3g}  {100 * seconds / whole:3.0f} %  {effect}")
        known = {"simulate": "simulate", "trace": "trace"}
        lines.append(f"together: {self.seconds:.3g} s with {self.threads} threads, {self.samples} samples a pixel; "
                     f"nine of ten predictions are within a factor of {self.spread:.2g}")  # fmt: skip
        lines.append(f"besides: read {self.read:.2g} s, plan {self.plan:.2g} s, compile about {self.compile:.2g} s "
                     "unless a cache has the kernel")  # fmt: skip
        lines.append(f"prices: of {self.machine}")
        if taken is not None:
            for part, name in known.items():
                lines.append(f"{part}: predicted {self.part(part):.3g} s, took {taken[name]:.3g} s")
            lines.append(f"build and compile took {taken['compile']:.3g} s")
        return "\n".join(lines)


def slow(cost: Forecast, plan: EffectPlan) -> str:
    """What takes so long, and what to do about it; "" where an image takes less than ``SLOW``."""
    if cost.seconds < SLOW:
        return ""
    (part, effect), most = max(cost.effects.items(), key=lambda row: row[1])
    room = effect.split(".")[0]
    turned = [
        name
        for name, knob in acting(plan).items()
        if any(e.split(".")[0] == room for e in knob.effects)
        and isinstance(knob.values[0], int)
        and value(plan.settings.knobs, name) != knob.values[0]
    ]
    said = f"about {cost.seconds / 60.0:.2g} minutes are predicted, {100.0 * most / cost.seconds:.0f} % of them to "
    said += f"{part} {effect}: fewer samples (--spp) or pixels (-w), --quality draft"
    return said + (f", or a lower {' or '.join(turned)} (--knob) take less" if turned else " take less")


def forecast(scene: Scene, plan: EffectPlan, prices: Costs | None = None, seen: np.ndarray | None = None) -> Forecast:
    """Predict a render. ``prices``: None takes those of ``costs()``; ``seen``: as ``visible`` gives it."""
    prices = prices or costs()
    counted = work(scene, plan, seen)
    threads = max(1, min(plan.settings.threads or 1, os.cpu_count() or 1))
    speed = 1.0 if threads == 1 else prices.efficiency * threads
    found: dict[tuple[str, str], float] = {}

    def add(part: str, effect: str, seconds: float) -> None:
        found[part, effect] = found.get((part, effect), 0.0) + seconds

    surfaces = 0.0
    for (effect, unit), count in counted.each.items():
        seconds = counted.samples * count * prices.of(unit) / speed
        add("trace", effect, seconds)
        surfaces += 0.0 if effect == "camera" else seconds
    if counted.indirect > 0.0:
        add("trace", "indirect", counted.indirect * prices.indirect * surfaces)
    for (effect, unit), count in counted.tables.items():
        add("simulate", effect, count * prices.of(unit) / speed)
    for (effect, unit), count in counted.build.items():
        add("build", effect, count * prices.of(unit))
    features = sum(choice.enabled for choice in plan.effects.values())
    return Forecast(
        effects=found,
        threads=threads,
        compile=prices.cold[0] + prices.cold[1] * features,
        read=scene.seconds,
        plan=plan.seconds,
        samples=plan.settings.spp or 1,
        spread=prices.spread,
        machine=prices.machine,
    )
