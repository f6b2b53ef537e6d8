"""What scratches that diffract make the renderer do, counted: pieces near a footprint, scratches in it, and each under
the lights that its narrow lobe reaches."""

import math
from collections.abc import Sequence

import numpy as np

from ...scene import (
    CylinderLight,
    DiskLight,
    DistantLight,
    DomeLight,
    Instance,
    Light,
    MeshLight,
    RectLight,
    Scene,
    SphereLight,
)
from ..choice import EffectPlan
from ..crowds import AROUND, SEEN, STRAY, laid, lit, under
from ..knobs import value
from ..wave_effects import footprint_and_triangle
from .footprints import footprints, parts_of_pixel

Units = dict[tuple[str, str], float]
SLACK = 0.03
"""About how far [rad] a lobe reaches where surfaces bend."""
DOME = 8.0
"""What a dome takes besides its parts, in parts; seven are usual."""
_FLAT = (RectLight, DiskLight, CylinderLight, MeshLight)


def wave_units(scene: Scene, plan: EffectPlan, shares: Sequence[float]) -> Units:
    """Units a sample; ``shares``: of the image, of each material."""
    found: Units = {}
    if not plan.on("diffraction"):
        return found
    prints = footprints(scene, plan.size, parts_of_pixel(plan.settings))
    triangle = 1e6 * footprint_and_triangle(scene, plan.settings, plan.waves)[1]
    lights, most, colors = _lights(scene, plan), lit(plan.settings.knobs), _wavelengths(plan)

    def add(effect: str, unit: str, count: float) -> None:
        if count > 0.0:
            found[effect, unit] = found.get((effect, unit), 0.0) + count

    for number, (share, own) in enumerate(zip(shares, plan.waves, strict=False)):
        for p in own.layers if own is not None and share > 0.0 else ():
            strands = 2.0 if p.layer.distribution == "crosshatch" else 1.0
            if p.layer.distribution in STRAY:
                dense, length = laid(scene, number, p.layer)
                side = 0.6 * triangle
                piece = min(length, side)  # triangles cut scratches
                strands = under(dense, length, prints[number].across, triangle)
                listed = plan.on("diffraction.lists") and not plan.on("diffraction.crowds")
                if listed and 4.0 * prints[number].across <= triangle:
                    near = AROUND * dense * length * side * (1.0 + side / max(piece, 1e-12))
                else:
                    near = 1.5 * strands
                if plan.on("diffraction.crowds") and most > 0:
                    near = min(near, 1.5 * SEEN * most)
                    strands = min(strands, float(most))
                add("diffraction.segments", "diffraction.pieces", share * near)
                add("diffraction.segments", "diffraction.found", share)
                add("diffraction.segments", "diffraction.strands", share * strands)
            else:
                add("diffraction.bands", "diffraction.bands", share * strands)
            if plan.on("diffraction.pairs") and own.wave.summation == "coherent":
                strands *= 0.5 * (strands + 1.0)
            if p.outline is not None and not plan.on("diffraction.lookup"):
                rows = max(len(rows) for rows in (p.outline, *p.others))
                add("diffraction.outlines", "diffraction.nodes", share * strands * rows * _wide(scene) * colors)
            for unit, count in lights.items():
                add("diffraction.areaLights" if unit != "diffraction.points" else "diffraction", unit,
                    share * strands * count)  # fmt: skip
    return found


def _lights(scene: Scene, plan: EffectPlan) -> dict[str, float]:
    """How often one scratch is in reach of lights: unit -> of points (by wavelengths), caps, polygons and domes."""
    made: dict[str, float] = {}
    middle = _middle(scene, [i for i in scene.instances if any(plan.waves[m] is not None for m in i.materials)])
    colors = 1.0 if plan.on("diffraction.distantLookup") else _wavelengths(plan)
    for light in scene.lights:
        if isinstance(light, DomeLight):
            parts = max(int(value(plan.settings.knobs, "diffraction.slices")) - 1, 1)
            each = 1.0 if plan.on("diffraction.lookup") else _wavelengths(plan)
            made["diffraction.domes"] = made.get("diffraction.domes", 0.0) + each * (DOME + parts) / (DOME + 7.0)
            continue
        half, polygons = _half_angle(scene, light, middle)
        unit = "diffraction.polygons" if isinstance(light, _FLAT) else "diffraction.caps"
        count = min(1.0, half + SLACK) * polygons
        if half <= 0.0:
            unit, count = "diffraction.points", SLACK * colors
        made[unit] = made.get(unit, 0.0) + count
    return made


def _wide(scene: Scene) -> float:
    """Lights over which lobes of facets are summed node by node: a dome once, polygons and caps as twice that."""
    flat = sum(not isinstance(light, DomeLight | DistantLight) and not getattr(light, "point", False)
               for light in scene.lights)  # fmt: skip
    return 2.0 * flat + sum(isinstance(light, DomeLight) for light in scene.lights)


def _wavelengths(plan: EffectPlan) -> float:
    """That are summed where no table has colours: as the knob has it, else the most of any material."""
    asked = value(plan.settings.knobs, "diffraction.wavelengths")
    waves = [own.wave for own in plan.waves if own is not None]
    if asked != "auto":
        return float(asked)
    return float(max((3 if wave.sampling == "rgb" else wave.samples for wave in waves), default=1))


def _half_angle(scene: Scene, light: Light, middle: np.ndarray) -> tuple[float, int]:
    """(half the angle that a light fills from ``middle``, its polygons)."""
    polygons, radius = 1, 0.0
    if isinstance(light, DistantLight):
        return 0.5 * light.angle, 1
    if isinstance(light, MeshLight):
        instance = scene.instances[light.instance]
        mesh = scene.meshes[instance.mesh]
        points = mesh.points @ instance.transform[:3, :3].T + instance.transform[:3, 3]
        center, polygons = points.mean(axis=0), len(mesh.triangles)
        radius = float(np.linalg.norm(points - center, axis=1).max())
    elif isinstance(light, SphereLight):
        center, radius = light.center, 0.0 if light.point else light.radius
    elif isinstance(light, CylinderLight):
        center, radius = light.center, light.radius + float(np.linalg.norm(light.axis))
    elif isinstance(light, RectLight | DiskLight):
        center, radius = light.center, float(np.linalg.norm(light.ex) + np.linalg.norm(light.ey))
    else:
        return 0.0, 1
    away = float(np.linalg.norm(np.asarray(center, float) - middle))
    return math.asin(min(1.0, radius / max(away, 1e-12))), polygons


def _middle(scene: Scene, instances: Sequence[Instance]) -> np.ndarray:
    """The middle of surfaces, in the world."""
    points = [i.transform[:3, 3] + i.transform[:3, :3] @ scene.meshes[i.mesh].points.mean(axis=0) for i in instances
              if len(scene.meshes[i.mesh].points)]  # fmt: skip
    return np.mean(points, axis=0) if points else np.zeros(3)
