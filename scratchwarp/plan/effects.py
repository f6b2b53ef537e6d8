"""The effects, and how each is decided. A new effect is one line in EFFECTS and the function it names.

A rule gets the facts of a scene and answers (calls for it, reason, prims).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..lights.registry import MODELS
from ..reflectance.responses import RESPONSES
from ..scene import (
    CylinderLight,
    DiskLight,
    DistantLight,
    DomeLight,
    Material,
    PreviewSurface,
    RectLight,
    Scene,
    ScratchSurface,
    Settings,
    SphereLight,
    TextureInput,
)
from ..scene.light import Light
from ..scratches import KINDS, ORIENTED
from .choice import LayerPlan, ResponsePlan, TablePlan
from .groove_effects import GROOVE_EFFECTS
from .occlusion import can_occlude
from .wave_effects import WAVE_EFFECTS

MOST_SMOOTH = 0.03
"""GGX alpha up to which surfaces are polished."""
NARROW = 0.1
"""Sine of half the angle up to which lights are small."""
LEAST_FILTER = 1e-3
"""Filters narrower than so much of a pixel leave no room for samples near highlights."""
Answer = tuple[bool, str, tuple[str, ...]]


@dataclass(frozen=True, eq=False)
class Facts:
    """What rules look at: the scene, its used materials, the planned layers, tables, responses and what diffracts of
    each material, the decided settings."""

    scene: Scene
    settings: Settings
    materials: tuple[Material, ...]
    layers: tuple[tuple[LayerPlan, ...], ...]
    tables: tuple[TablePlan, ...]
    responses: tuple[ResponsePlan, ...] = ()
    waves: tuple[Any, ...] = ()
    bases: tuple[int, ...] = ()
    grooves: tuple[Any, ...] = ()

    @property
    def replaced(self) -> set[str]:
        """Paths of the materials whose base a response stands in for."""
        return {m.path for m, base in zip(self.scene.materials, self.bases, strict=False) if base >= 0}

    @property
    def every(self) -> list[LayerPlan]:
        """All sublayers of all materials."""
        return [p for own in self.layers for p in own]


def _answer(prims: list[str], on: str, off: str) -> Answer:
    unique = tuple(dict.fromkeys(p or "(no material)" for p in prims))
    return bool(unique), on if unique else off, unique


def _surfaces(f: Facts, test: Callable[[Any], bool], on: str, off: str) -> Answer:
    return _answer([m.path for m in f.materials if m.path not in f.replaced and test(m.surface)], on, off)


def _scratches(f: Facts) -> Answer:
    return _answer([p.sublayer.layer.label for p in f.every], "layers with visible scratches", "no layer has scratches")


def _distribution(kind: str) -> Callable[[Facts], Answer]:
    def rule(f: Facts) -> Answer:
        found = [p.sublayer.layer.label for p in f.every if p.sublayer.distribution == kind]
        return _answer(found, f"layers laid out as {kind}", f"no layer laid out as {kind}")

    return rule


def _tables(f: Facts) -> Answer:
    found = [u for t in f.tables for u in t.users]
    return _answer(found, f"{len(f.tables)} profile tables to simulate", "no layer needs a profile table")


def _interreflection(f: Facts) -> Answer:
    found = [u for t in f.tables if t.max_bounces > 1 for u in t.users]
    return _answer(found, "light can meet these profiles more than once", "no profile sends light into itself twice")


def _fresnel(f: Facts) -> Answer:
    found = [u for t in f.tables if t.fresnel is not None for u in t.users]
    models = {t.theta_model: max(u.error for u in f.tables if u.theta_model == t.theta_model) for t in f.tables}
    how = ", ".join(f"{name} within {error:.2g}" for name, error in models.items())
    return _answer(found, f"reflectance varies along the cone: {how}", "mirrors need one table")


def _diffuse_scratches(f: Facts) -> Answer:
    found = [p.sublayer.layer.label for p in f.every if p.lambert]
    return _answer(found, "Lambert scratches", "no Lambert scratch")


def _response(name: str) -> Callable[[Facts], Answer]:
    def rule(f: Facts) -> Answer:
        found = [user for r in f.responses if r.name == name for user in r.users]
        place = "the base" if RESPONSES[name].base else "a table"
        return _answer(found, f"reflect by {name} in place of {place}", f"nothing reflects by {name}")

    return rule


def _stencil(f: Facts) -> Answer:
    scratched = sum(bool(m.layers) for m in f.materials)
    return False, f"on: {scratched} scratched materials become highlight stencils, as they look from far away", ()


def _sum_coverage(f: Facts) -> Answer:
    return False, "layers overlap at random, 1 - product (1 - alpha); on: the sum, at most 1 (Raymond 2016 Eq. 4)", ()


def _variation(f: Facts) -> Answer:
    found = [p for p in f.every if p.variation is not None or (p.sublayer.layer.width_variation > 0.0)]
    tables = {p.table + k for p in found if p.variation for k in range(p.variation.aspects * p.variation.blends)}
    return _answer(
        [p.sublayer.layer.label for p in found],
        f"scratches of one layer differ: {len(tables)} tables stand for them",
        "the scratches of each layer are alike",
    )


def _textured_scratches(f: Facts) -> Answer:
    found = [p.sublayer.layer.label for p in f.every if p.f0 is not None]
    return _answer(found, "scratches take the local reflectance of textured bases", "no textured base lends any")


def _masks(f: Facts) -> Answer:
    layers = [p.sublayer.layer for p in f.every]
    found = [x.label for x in layers if x.mask_primvar or x.mask_texture >= 0]
    return _answer(found, "masks multiply the coverage of these layers", "no layer has a mask")


def _orientation(f: Facts) -> Answer:
    subs = [p.sublayer for p in f.every if p.sublayer.distribution in ORIENTED]
    found = [x.layer.label for x in subs if x.layer.orientation_primvar or x.layer.orientation_texture >= 0]
    return _answer(found, "maps turn the scratches of these layers", "no layer has a map of directions")


def _textured(s: Any) -> bool:
    return any(isinstance(v, TextureInput) for v in vars(s).values())


def _positive(value: Any) -> bool:
    return isinstance(value, TextureInput) or bool(np.any(np.asarray(value) > 0.0))


def _transparent(s: Any) -> bool:
    return isinstance(s, PreviewSurface) and (isinstance(s.opacity, TextureInput) or s.opacity < 1.0)


def _directed(f: Facts) -> Answer:
    ids = [m.path for m, own in zip(f.scene.materials, f.layers, strict=True) if own]
    ids += [m.path for m in f.materials if isinstance(m.surface, ScratchSurface) and m.surface.anisotropy != 0.0]
    ids += f.replaced
    return _answer(ids, "these materials have a direction: tangents are built", "no material has a direction")


def _light(kind: str, record: type) -> Callable[[Facts], Answer]:
    def rule(f: Facts) -> Answer:
        found = [light.path for light in f.scene.lights if type(light) is record]
        return _answer(found, f"{len(found)} of them", f"no {kind} light")

    return rule


def _any_transparent(f: Facts) -> bool:
    return any(_transparent(m.surface) for m in f.materials)


def _shadows(f: Facts) -> Answer:
    casting = [light.path for light in f.scene.lights if light.shadow]
    if not casting:
        return False, "no light casts shadows", ()
    if not can_occlude(f.scene, _any_transparent(f)):
        return False, "nothing can occlude: no geometry, or one flat or convex body", ()
    return True, "geometry may stand between surfaces and these lights", tuple(casting)


def _links(f: Facts) -> Answer:
    found = [light.path for light in f.scene.lights if light.linked is not None]
    return _answer(found, "these lights pick what they light", "every light lights everything")


def _multipliers(f: Facts) -> Answer:
    found = [light.path for light in f.scene.lights if light.diffuse != 1.0 or light.specular != 1.0]
    return _answer(found, "diffuse or specular multipliers other than 1", "all multipliers are 1")


def integrated_lights(f: Facts) -> list[str]:
    """Lights with extent whose light along a scratch's cone has a closed form."""
    return [light.path for light in f.scene.lights if MODELS[type(light)].arcs is not None and not _small(light)]


def sampled_lights(f: Facts) -> list[str]:
    """Lights with extent that scratches sample; none where no scratch reflects by a table."""
    if not f.tables:
        return []
    closed = set(integrated_lights(f)) if f.settings.effects.get("lights.closedForm", True) else set()
    return [light.path for light in f.scene.lights if light.path not in closed and not _small(light)]


def _small(light: Light) -> bool:
    return (isinstance(light, SphereLight) and (light.point or light.radius == 0.0)) or (
        isinstance(light, DistantLight) and light.angle < 2e-6
    )


def _closed_form(f: Facts) -> Answer:
    found = integrated_lights(f) if f.tables else []
    return _answer(found, "integrated along the mirror cones of scratches", "no scratch reflects a light with extent")


def _small_lights(f: Facts) -> Answer:
    if not f.tables or not f.settings.effects.get("lights.closedForm", True):
        return False, "no scratch reflects a light with extent in closed form", ()
    low, high = f.scene.bounds()
    found = [light.path for light in f.scene.lights if not _small(light) and _narrow(light, low, high)]
    return _answer(found, "rarely on a scratch's cone: all layers are asked for them", "no light is small")


def _reach(light: Light) -> float:
    """Radius of a ball about a light's center that holds it [m]; 0 for domes and meshes."""
    if isinstance(light, SphereLight):
        return light.radius
    if isinstance(light, RectLight | DiskLight):
        return float(np.linalg.norm(light.ex) + np.linalg.norm(light.ey))
    if isinstance(light, CylinderLight):
        return light.radius + float(np.linalg.norm(light.axis))
    return 0.0


def _narrow(light: Light, low: np.ndarray, high: np.ndarray) -> bool:
    """Whether a light with extent is small seen from somewhere in a box."""
    if isinstance(light, DistantLight):
        return 0.5 * light.angle < NARROW
    reach, center = _reach(light), getattr(light, "center", np.zeros(3))
    corner = np.maximum(np.abs(low - center), np.abs(high - center))
    return 0.0 < reach < NARROW * float(np.linalg.norm(corner))


def _sample_lights(f: Facts) -> Answer:
    return _answer(sampled_lights(f), "scratches draw from these lights, too", "no light left to draw from")


def _sample_cones(f: Facts) -> Answer:
    return _answer(sampled_lights(f), "scratches find these lights along their cones, too", "no light left to find so")


def _indirect(f: Facts) -> Answer:
    if f.settings.integrator != "path":
        return False, "integrator direct", ()
    if not can_occlude(f.scene, _any_transparent(f)) and not any(f.grooves):
        return False, "integrator path, but no surface reflects another: no geometry, or one flat or convex body", ()
    return True, "integrator path", ()


def _lens(f: Facts) -> Answer:
    c = f.scene.camera
    if c.lens_radius <= 0.0 or c.focus_distance <= 0.0:
        return False, "the camera is a pinhole", ()
    if not f.scene.options.depth_of_field:
        return False, "the stage's render settings disable depth of field", ()
    return True, f"aperture radius {c.lens_radius:.3g} m", (c.path,)


def _polished(m: Material) -> bool:
    s = m.surface
    if isinstance(s, ScratchSurface):
        return s.base != "diffuse" and s.roughness <= MOST_SMOOTH
    coat = s.clearcoat_roughness if _positive(s.clearcoat) else s.roughness
    return any(not isinstance(r, TextureInput) and r * r <= MOST_SMOOTH for r in (s.roughness, coat))


def _highlights(f: Facts) -> Answer:
    found = [m.path for m in f.materials if m.path not in f.replaced and _polished(m)]
    if not any(not isinstance(light, DomeLight) for light in f.scene.lights):
        return False, "no light but domes", ()
    if _lens(f)[0]:
        return False, "a lens blurs them", ()
    if (f.settings.filter_width or 0.0) < LEAST_FILTER:
        return False, "all samples of a pixel lie in its middle", ()
    return _answer(found, "polished: highlights smaller than a pixel are sampled by themselves", "nothing is polished")


EFFECTS: dict[str, Callable[[Facts], Answer]] = {
    "scratches": _scratches,
    **{f"scratches.{kind}": _distribution(kind) for kind in KINDS},
    "scratches.table": _tables,
    "scratches.interreflection": _interreflection,
    "scratches.fresnel": _fresnel,
    "scratches.diffuse": _diffuse_scratches,
    **{response.effect: _response(name) for name, response in RESPONSES.items()},
    "scratches.sumCoverage": _sum_coverage,
    "scratches.stencil": _stencil,
    "scratches.variation": _variation,
    "scratches.textured": _textured_scratches,
    "scratches.masks": _masks,
    "scratches.orientation": _orientation,
    **WAVE_EFFECTS,
    **GROOVE_EFFECTS,
    "base.preview": lambda f: _surfaces(
        f, lambda s: isinstance(s, PreviewSurface), "UsdPreviewSurface bases", "no UsdPreviewSurface base"
    ),
    "base.measured": lambda f: _answer(
        [m.path for m in f.materials if m.path in f.replaced or isinstance(m.surface, ScratchSurface)],
        "ScratchSurface bases, or what stands for measured ones",
        "no ScratchSurface base",
    ),
    "base.direction": _directed,
    "base.textures": lambda f: _surfaces(f, _textured, "inputs read from textures", "no input reads a texture"),
    "base.normalMaps": lambda f: _surfaces(
        f, lambda s: isinstance(s, PreviewSurface) and s.normal is not None, "normal maps", "no normal map"
    ),
    "base.displayColor": lambda f: _answer(
        [m.path for m in f.materials if m.uses_display_color],
        "surfaces without a material",
        "every surface has a material",
    ),
    "base.opacity": lambda f: _surfaces(f, _transparent, "opacity below 1", "every surface is opaque"),
    "base.emission": lambda f: _surfaces(
        f,
        lambda s: isinstance(s, PreviewSurface) and _positive(s.emissive_color),
        "emissive surfaces",
        "no surface glows",
    ),
    **{f"lights.{model.name}": _light(model.name, record) for record, model in MODELS.items()},
    "lights.closedForm": _closed_form,
    "lights.small": _small_lights,
    "lights.sampleLights": _sample_lights,
    "lights.sampleCones": _sample_cones,
    "lights.links": _links,
    "lights.multipliers": _multipliers,
    "shadows": _shadows,
    "indirect": _indirect,
    "lens": _lens,
    "highlights": _highlights,
}
