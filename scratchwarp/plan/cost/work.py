"""What a plan makes the renderer do, counted in units of which each has a measured price.

A unit is (effect, unit name) -> how often a camera sample does it, on average over the image. Layers, lights and
grooves count where their material is seen, by ``visible``.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...lights.registry import MODELS
from ...scene import PreviewSurface, Scene, TextureInput
from ..choice import EffectPlan, TablePlan
from ..effects import integrated_lights, sampled_lights
from ..occlusion import can_occlude
from .groove_work import groove_units, laid_pieces
from .visible import visible
from .wave_work import wave_units

SLICES = {"gamma": 2, "quadratic": 3, "table": 8, "full": 16}
"""About how many slices along the cone a theta model keeps."""
GOES_ON = 2.0 / 3.0
"""How often a path goes on where something reflects something else."""

Units = dict[tuple[str, str], float]


@dataclass(frozen=True)
class Work:
    """Counts: ``samples``: of the whole image; ``each``: units of a sample; ``tables``: units of simulating; ``build``:
    of what is built before tracing; ``indirect``: how often a sample's work at surfaces is done again."""

    samples: float
    each: Mapping[tuple[str, str], float]
    tables: Mapping[tuple[str, str], float]
    build: Mapping[tuple[str, str], float]
    indirect: float


def work(scene: Scene, plan: EffectPlan, seen: np.ndarray | None = None) -> Work:
    """Count what a plan does. ``seen``: as ``visible`` gives it."""
    shares = visible(scene, plan.size, plan.window) if seen is None else seen
    x0, x1, y0, y1 = plan.window
    samples = float((x1 - x0) * (y1 - y0) * (plan.settings.spp or 1))
    each = _surfaces(scene, plan, shares)
    own = shares.tolist()
    for more in (_scratches(scene, plan, shares), wave_units(scene, plan, own), groove_units(scene, plan, own)):
        for name, count in more.items():
            each[name] = each.get(name, 0.0) + count
    tables: Units = {}
    for table in plan.tables:
        for name, count in of_table(table).items():
            tables[name] = tables.get(name, 0.0) + count
    pixels = sum(t.pixels.shape[0] * t.pixels.shape[1] for t in scene.textures)
    build = {
        ("geometry", "build.triangles"): float(scene.triangles),
        ("base.textures", "build.pixels"): float(pixels),
        ("kernel", "build.kernel"): 1.0,
        ("diffraction", "build.strokes"): _strokes(scene) if plan.on("diffraction.segments") else 0.0,
        ("grooves", "build.grooves"): laid_pieces(scene, plan),
        ("scratches.table", "build.cells"): float(sum(_cells(table) for table in plan.tables)),
    }
    depth = plan.settings.max_depth or 1
    several = plan.on("indirect") and can_occlude(scene, plan.on("base.opacity"))  # not only grooves light one another
    indirect = GOES_ON * (1.0 - GOES_ON ** (depth - 1)) / (1.0 - GOES_ON) if several else 0.0
    return Work(samples, each, tables, {k: v for k, v in build.items() if v}, indirect)


def of_table(table: TablePlan) -> Units:
    """Units of simulating one table."""
    parts = float(len(table.parts) or 1)
    slices = _slices(table)
    cells = parts * _cells(table)
    if table.source == "facets":
        return {("scratches.table", "tables.table"): 1.0, ("scratches.table", "tables.cell"): cells}
    rays = parts * table.resolution * table.rays
    effect = "scratches.interreflection" if table.max_bounces > 1 else "scratches.table"
    return {
        ("scratches.table", "tables.table"): parts,
        ("scratches.table", "tables.cell"): cells,
        (effect, "tables.rayBounced" if table.max_bounces > 1 else "tables.ray"): rays * (1.0 + 0.15 * slices),
    }


def _slices(table: TablePlan) -> int:
    return 1 if table.fresnel is None else SLICES.get(table.theta_model, 8)


def _cells(table: TablePlan) -> float:
    return float(table.resolution**2 * _slices(table))


def _surfaces(scene: Scene, plan: EffectPlan, shares: np.ndarray) -> Units:
    hit = float(shares.sum())
    deep = math.log2(scene.triangles + 2)
    found: Units = {
        ("camera", "camera"): 1.0,
        ("camera", "camera.triangles"): deep / 16.0,
        ("base", "base"): hit,
    }
    casting = 0
    for record, model in MODELS.items():
        lights = [light for light in scene.lights if type(light) is record]
        name = f"lights.{model.name}"
        if lights and plan.on(name):
            found[name, name] = hit * len(lights)
            casting += sum(light.shadow for light in lights)
    if plan.on("shadows"):
        found["shadows", "shadows"] = hit * casting * deep / 16.0
    for number, material in enumerate(scene.materials[: len(shares)]):
        share, surface = float(shares[number]), material.surface
        response = plan.bases[number] if number < len(plan.bases) else -1
        if response >= 0 and share:
            name = f"base.{plan.responses[response].name}"
            found[name, name] = found.get((name, name), 0.0) + share * (1 + len(scene.lights))
            continue
        textured = sum(isinstance(v, TextureInput) for v in vars(surface).values())
        clear = isinstance(surface, PreviewSurface) and (
            isinstance(surface.opacity, TextureInput) or surface.opacity < 1.0
        )
        bumped = isinstance(surface, PreviewSurface) and surface.normal is not None
        for effect, count in (("base.textures", textured), ("base.opacity", clear), ("base.normalMaps", bumped)):
            if count and plan.on(effect):
                found[effect, effect] = found.get((effect, effect), 0.0) + share * count
    if plan.on("lens"):
        found["lens", "lens"] = 1.0
    return {k: v for k, v in found.items() if v}


@dataclass(frozen=True)
class _Facts:
    """What ``effects.integrated_lights`` looks at."""

    scene: Scene
    settings: Any
    tables: Any


def _scratches(scene: Scene, plan: EffectPlan, shares: np.ndarray) -> Units:
    found: Units = {}
    if not plan.on("scratches"):
        return found
    facts: Any = _Facts(scene, plan.settings, plan.tables)
    closed = integrated_lights(facts) if plan.on("lights.closedForm") else []
    drawn = sampled_lights(facts)
    by_path = {light.path: light for light in scene.lights}
    uneven = [p for p in closed if getattr(by_path[p], "shaping", None) or getattr(by_path[p], "texture", -1) >= 0]
    others = len(scene.lights) - len(closed) - len(drawn)

    def add(effect: str, unit: str, count: float) -> None:
        if count:
            found[effect, unit] = found.get((effect, unit), 0.0) + count

    for share, own in zip(shares, plan.layers, strict=False):
        bare = tabled = responding = 1.0
        for p in own:
            name = f"scratches.{p.sublayer.distribution}"
            add(name, name, float(share))
            covered = min(max(float(p.sublayer.coverage), 0.0), 1.0)
            bare *= 1.0 - covered
            if p.table >= 0:
                tabled *= 1.0 - covered
            elif p.response >= 0:
                responding *= 1.0 - covered
        hit = float(share) * (1.0 - tabled)
        add("scratches.table", "scratches.table", hit * max(others, 1))
        add("scratches.responses", "scratches.responses", float(share) * (1.0 - responding) * len(scene.lights))
        add("lights.closedForm", "lights.closedForm", hit * len(closed))
        add("lights.closedForm", "lights.coneTaps", hit * len(uneven) * (plan.settings.cone_taps or 16))
        add("lights.sampleLights", "lights.sampled", hit * len(drawn))
    return found


def _strokes(scene: Scene) -> float:
    return float(sum(len(c.counts) for c in scene.curves))
