"""What each value of a knob leaves in an image: the file ``plan/cost/errors.json`` is made by this.

Two pairs of images with seeds of their own are rendered, each with the same samples at a value and at the knob's
reference value. The mean product of the two differences has no noise in it on average; its standard error is added.
How much noisier a value is follows from how far the two seeds are apart, at that value and at the reference value.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..plan import make_plan
from ..plan.knobs import KNOBS, acting
from ..render.progress import Progress, silent
from ..render.renderer import render
from ..scene import DomeLight, Profile, RectLight, Scene, Settings, Shaping, Texture
from ..scene.knob import Value
from ..whole import whole
from .measures import rel_mse, weights

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
    for name in (n for n in names if n in known):
        few = replace(settings, spp=min(FEW.get(name, settings.spp or 1), settings.spp or 1))
        best = [_image(scene, few, {name: KNOBS[name].reference}, seed) for seed in SEEDS]
        weight = weights(0.5 * (best[0].astype(np.float64) + best[1]))
        apart = _mean_square(best, weight)
        bias: dict[str, float] = {}
        noisier: dict[str, float] = {}
        for value in KNOBS[name].values[:-1]:
            if value == "auto":
                continue
            made = [_image(scene, few, {name: value}, seed) for seed in SEEDS]
            if not bias and all(np.array_equal(one, other) for one, other in zip(made, best, strict=True)):
                break
            first, second = (one.astype(np.float64) - other for one, other in zip(made, best, strict=True))
            off = (first * second).mean(axis=-1) * weight
            bias[str(value)] = max(float(off.mean()), 0.0) + float(off.std()) / np.sqrt(off.size)
            if name in NOISY:
                noisier[str(value)] = _mean_square(made, weight) / apart if apart > 0.0 else 1.0
        if bias:
            found.bias[name] = bias
        if noisier:
            found.noisier[name] = noisier
    return found


def _mean_square(pair: list[np.ndarray], weight: np.ndarray) -> float:
    return float((((pair[0].astype(np.float64) - pair[1]) ** 2).mean(axis=-1) * weight).mean())


def variants(scene: Scene, settings: Settings) -> dict[str, tuple[Scene, Settings, tuple[str, ...]]]:
    """Name -> the stage itself, or otherwise lit or coloured so that further knobs act, and the knobs to measure."""
    plan = make_plan(scene, settings)
    found: dict[str, tuple[Scene, Settings, tuple[str, ...]]] = {"": (scene, settings, MEASURED)}
    if plan.on("lights.closedForm"):
        found["under windows"] = under_windows(scene), settings, ("lights.coneTaps",)
    if plan.on("grooves"):
        found["of round grooves"] = round_grooves(scene), settings, ("grooves.section",)
    if plan.on("diffraction.lookup") or plan.on("diffraction.distantLookup"):
        knobs = {**settings.knobs, "diffraction.colors": "wavelengths"}
        found["by wavelengths"] = scene, replace(settings, knobs=knobs), ("diffraction.wavelengths",)
    return found


def under_windows(scene: Scene) -> Scene:
    """Domes show a room of three windows, plates of light shine mostly ahead."""
    pixels = np.full((32, 64, 4), 0.1, np.float32)
    for row, column, rows, columns in ((8, 6, 6, 4), (4, 27, 3, 12), (12, 50, 8, 3)):
        pixels[row : row + rows, column : column + columns] = 8.0
    shaped = Shaping(focus=4.0, cone_angle=0.9, cone_softness=0.3)
    lights = []
    for light in scene.lights:
        if isinstance(light, DomeLight):
            light = replace(light, texture=len(scene.textures))
        elif isinstance(light, RectLight):
            light = replace(light, shaping=shaped)
        lights.append(light)
    return replace(scene, lights=tuple(lights), textures=(*scene.textures, Texture("/windows", pixels)))


def round_grooves(scene: Scene) -> Scene:
    """Cross-sections are arcs, of which simplified ones have fewer facets."""
    materials = tuple(
        replace(m, layers=tuple(replace(x, profile=Profile(path="/round", shape="round")) for x in m.layers))
        for m in scene.materials
    )
    return replace(scene, materials=materials)


def noise(scene: Scene, settings: Settings, counts: tuple[int, ...] = (2, 8, 32)) -> list[float]:
    """relMSE of images of ``counts`` samples against one of 1024."""
    best = _image(scene, settings, {"spp": 1024}, SEEDS[0])
    return [rel_mse(_image(scene, settings, {"spp": n}, SEEDS[1]), best) for n in counts]


def _image(scene: Scene, settings: Settings, knobs: Mapping[str, Value], seed: int) -> np.ndarray:
    plan = make_plan(scene, replace(settings, knobs={**settings.knobs, **knobs}, seed=seed))
    return render(scene, replace(plan, settings=replace(plan.settings, max_error=None)))["color"]


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


def write(
    file: str | Path, stages: Mapping[str, Left], noises: Iterable[list[float]], progress: Progress = silent
) -> Path:
    """Write what was measured of stages; ``noises``: as ``noise`` gives them."""
    known = [found for found in noises if found[2] > 0.0]
    powers = [np.log(found[0] / found[2]) / np.log(16.0) for found in known]
    noisier = summed_up((found.noisier for found in stages.values()), 1.0)
    record: dict[str, Any] = {
        "stages": list(stages),
        "bias": _rounded(summed_up(found.bias for found in stages.values())),
        "noisier": _rounded(noisier),
        "noise": [float(np.median([8.0 * found[1] for found in known])), float(np.clip(np.median(powers), 0.8, 1.5))],
    }
    progress(1, 1, "errors")
    with whole(Path(file)) as draft:
        draft.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return Path(file)


def _rounded(rows: Rows) -> Rows:
    return {name: {value: float(f"{number:.3g}") for value, number in own.items()} for name, own in rows.items()}
