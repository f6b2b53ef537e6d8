"""What each value of a knob leaves in an image, without noise: the file ``plan/cost/errors.json`` is made by this.

Two pairs of images with seeds of their own are rendered, each with the same samples at a value and at the knob's
reference value. The mean product of the two differences has no noise in it on average; its standard error is added.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..plan import make_plan
from ..plan.knobs import KNOBS, acting
from ..render.progress import Progress, silent
from ..render.renderer import render
from ..scene import Scene, Settings
from ..scene.knob import Value
from ..whole import whole
from .measures import rel_mse, weights

MEASURED = (
    "tables.resolution", "tables.rays", "tables.bounces", "lights.coneTaps", "pathDepth", "grooves.lines",
    "grooves.bounces", "diffraction.wavelengths", "diffraction.slices",
)  # fmt: skip
"""Knobs that a target may turn: each costs the more the more accurate it is."""
SHARE = 0.8
"""Share of the stages whose bias lies below what is noted."""
SEEDS = (11, 12)


def biases(scene: Scene, settings: Settings, names: Iterable[str] = MEASURED) -> dict[str, dict[str, float]]:
    """knob -> value as text -> relMSE against the knob's reference value with the same samples, noise taken out."""
    plan = make_plan(scene, settings)
    found: dict[str, dict[str, float]] = {}
    for name in names:
        if name in acting(plan):
            best = [_image(scene, settings, {name: KNOBS[name].reference}, seed) for seed in SEEDS]
            found[name] = {}
            for value in KNOBS[name].values[:-1]:
                if value == "auto":
                    continue
                pairs = zip(SEEDS, best, strict=True)
                first, second = (_image(scene, settings, {name: value}, seed) - other for seed, other in pairs)
                mean = 0.5 * (best[0].astype(np.float64) + best[1])
                off = (first.astype(np.float64) * second).mean(axis=-1) * weights(mean)
                found[name][str(value)] = max(float(off.mean()), 0.0) + float(off.std()) / np.sqrt(off.size)
    return found


def noise(scene: Scene, settings: Settings, counts: tuple[int, ...] = (2, 8, 32)) -> list[float]:
    """relMSE of images of ``counts`` samples against one of 1024."""
    best = _image(scene, settings, {"spp": 1024}, SEEDS[0])
    return [rel_mse(_image(scene, settings, {"spp": n}, SEEDS[1]), best) for n in counts]


def _image(scene: Scene, settings: Settings, knobs: Mapping[str, Value], seed: int) -> np.ndarray:
    plan = make_plan(scene, replace(settings, knobs={**settings.knobs, **knobs}, seed=seed))
    return render(scene, replace(plan, settings=replace(plan.settings, max_error=None)))["color"]


def summed_up(stages: Iterable[Mapping[str, Mapping[str, float]]]) -> dict[str, dict[str, float]]:
    """knob -> value -> what ``SHARE`` of the stages stay below, made to fall from value to value."""
    every: dict[str, dict[str, list[float]]] = {}
    for stage in stages:
        for name, values in stage.items():
            for value, bias in values.items():
                every.setdefault(name, {}).setdefault(value, []).append(bias)
    made: dict[str, dict[str, float]] = {}
    for name, known in every.items():
        least = 0.0
        falling: dict[str, float] = {str(KNOBS[name].reference): 0.0}
        for value in reversed([str(v) for v in KNOBS[name].values if str(v) in known]):
            least = max(least, float(np.quantile(known[value], SHARE)))
            falling[value] = least
        made[name] = {str(v): falling[str(v)] for v in KNOBS[name].values if str(v) in falling}
    return made


def write(file: str | Path, stages: Mapping[str, Mapping[str, Any]], progress: Progress = silent) -> Path:
    """Write what was measured: stage -> {"bias": as ``biases`` gives it, "noise": as ``noise`` does}."""
    one = [found["noise"][1] * 8.0 for found in stages.values()]
    powers = [np.log(f["noise"][0] / f["noise"][2]) / np.log(16.0) for f in stages.values() if f["noise"][2] > 0.0]
    record = {
        "stages": list(stages),
        "bias": summed_up(found["bias"] for found in stages.values()),
        "noise": [float(np.median(one)), float(np.clip(np.median(powers), 0.8, 1.5))],
    }
    progress(1, 1, "errors")
    with whole(Path(file)) as draft:
        draft.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return Path(file)
