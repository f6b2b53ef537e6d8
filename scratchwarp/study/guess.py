"""Guess: how long the next render of a study will take, by the forecast and by what was measured meanwhile."""

from collections.abc import Mapping

import numpy as np

from ..kernels import KernelKey, kernel_key
from ..plan import EffectPlan
from ..plan.cost import Forecast, forecast
from ..plan.cost.visible import visible
from ..render.launch import compiled
from ..scene.knob import Value
from .measurement import setting_name
from .shots import Shot, Shots

FIRST = {"simulate": 1.5, "build": 1.5, "trace": 2.0, "compile": 1.5}
"""Seconds of a part over those predicted, before anything was measured: prices are of another machine."""
WARM = 0.6
"""Seconds of loading a kernel that a cache has."""
OVERHEAD = 0.05
"""Seconds of a render beside its parts: comparing images, writing them."""
FITTED = {"scratches.farField": "stencil"}
"""Knob -> value that planning fits something for, which takes long."""
FIT = 1.0
"""Seconds of such a fit, for each table."""


class Guess:
    """Predicted seconds of renders; ``learn`` corrects the predictions part by part, late measurements most."""

    def __init__(self, shots: Shots) -> None:
        self.shots = shots
        self._seen: dict[tuple[int, int], np.ndarray] = {}
        self._forecasts: dict[str, Forecast] = {}
        self._cold: dict[KernelKey, bool] = {}
        self._taken: dict[str, tuple[float, float]] = {}  # part -> (measured, predicted), both weighted

    def planning(self, knobs: Mapping[str, Value]) -> float:
        """Seconds that planning a setting takes, where that is long."""
        if not any(knobs.get(name) == value for name, value in FITTED.items()) or self.shots.known(knobs):
            return 0.0
        return FIT * len(self.shots.plan.tables) * self._times("simulate")

    def of(self, knobs: Mapping[str, Value], times: int = 1) -> float | None:
        """Seconds that rendering a setting now takes, ``times`` times; None where it cannot be planned."""
        plan = self.shots.planned(knobs)
        if plan is None:
            return None
        parts = self._parts(knobs, plan)
        seconds = sum(self._times(part) * parts[part] for part in ("simulate", "build", "compile"))
        return seconds + parts["load"] + times * (self._times("trace") * parts["trace"] + OVERHEAD)

    def before(self, knobs: Mapping[str, Value]) -> Mapping[str, float]:
        """Parts of a render as the forecast has them, for ``learn``; empty where it cannot be planned."""
        plan = self.shots.planned(knobs)
        return {} if plan is None else self._parts(knobs, plan)

    def learn(self, predicted: Mapping[str, float], shot: Shot) -> None:
        """Compare a render with what was predicted of it."""
        if shot.stock.key is not None:
            self._cold[shot.stock.key] = False
        for part, expected in predicted.items():
            if part in shot.spent and expected > 0.0:
                own, other = self._taken.get(part, (0.0, 0.0))
                self._taken[part] = 0.5 * own + shot.spent[part], 0.5 * other + expected

    def _times(self, part: str) -> float:
        """Measured over predicted seconds of a part."""
        if part in self._taken:
            measured, predicted = self._taken[part]
            return max(measured / predicted, 0.05)
        if part == "compile" and self._taken:  # as busy as the machine is otherwise
            others = [measured / predicted for measured, predicted in self._taken.values()]
            return float(np.clip(np.median(others), FIRST[part], 4.0))
        return FIRST[part]

    def _parts(self, knobs: Mapping[str, Value], plan: EffectPlan) -> dict[str, float]:
        scene, stock = self.shots.scene, self.shots.stock
        if plan.size not in self._seen:
            self._seen[plan.size] = visible(scene, plan.size, plan.window)
        name = f"{setting_name(knobs)} {plan.size}"
        if name not in self._forecasts:
            self._forecasts[name] = forecast(scene, plan, seen=self._seen[plan.size])
        expected, key = self._forecasts[name], kernel_key(scene, plan)
        lacking, other = self.shots.missing(plan)
        rows = expected.effects.items()
        cells = sum(seconds for (part, effect), seconds in rows if part == "build" and effect == "scratches.table")
        once = expected.part("build") - cells
        if key not in self._cold:
            self._cold[key] = not compiled(key)
        cold = self._cold[key]
        return {
            "simulate": expected.part("simulate") * lacking,
            "build": (cells if lacking or other else 0.0) + (once if other or stock.key is None else 0.1 * once),
            "trace": expected.part("trace"),
            "compile": expected.compile if cold else 0.0,
            "load": 0.0 if cold or not other else WARM,
        }
