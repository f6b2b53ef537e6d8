"""make_plan: walk the scene once and decide every effect."""

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..lights.registry import MODELS
from ..reflectance.profile_table import table_bytes
from ..reflectance.responses import RESPONSES
from ..scene import Layer, Material, Scene, Settings
from .choice import EffectChoice, EffectPlan, LayerPlan, ResponsePlan, TablePlan
from .cost.aim import aim, suited
from .cost.shares import shares
from .coverage import baked_thresholds
from .effects import EFFECTS, Facts, sampled_lights
from .grooves import coarse_sections, laid_out, mark_near, plan_grooves, refracts, slack_of
from .knobs import by_quality, checked, turned_tables, value
from .layers import mean_color, plan_layers, reflector
from .models import base_responses
from .nearby import SMOOTH_BASE, near_layers
from .resolve import resolve
from .waves import complaints, diffracts, plan_waves, wide_ones

MODELLED = ("draft", "preview", "final")
"""Qualities whose knobs are chosen by what they cost and leave; reference takes the most of all."""

Layers = tuple[tuple[LayerPlan, ...], ...]


def make_plan(scene: Scene, settings: Settings | None = None, earlier: EffectPlan | None = None) -> EffectPlan:
    """Decide each effect on or off with a reason that names the prim, and every setting.

    ``earlier``: a plan of this scene as it was; tables that it chose a theta model for are not looked at again.
    Raises ValueError on an unknown effect name, or a layer whose profile cannot be simulated.
    """
    start = time.perf_counter()
    settings = settings or Settings()
    plan = _planned(scene, settings, earlier)
    given = {**dict(scene.options.knobs), **settings.knobs}
    if plan.settings.max_error is not None and settings.quality is None:
        plan = _aimed(scene, settings, plan, given)
    elif plan.settings.quality in MODELLED:
        plan = _suited(scene, settings, plan, given)
    return replace(plan, seconds=time.perf_counter() - start)


def _aimed(scene: Scene, settings: Settings, plan: EffectPlan, given: Mapping[str, Any]) -> EffectPlan:
    """The plan with all knobs chosen for its error that are not ``given`` in some way."""
    given = _given(scene, settings, given)
    asked: Any = given.get("spp")
    found = aim(scene, plan, given, asked)
    knobs = {**found.knobs, **settings.knobs}
    if asked is None:
        knobs["spp"] = found.samples
    made = _planned(scene, replace(settings, knobs=knobs), plan)
    text = f"samples grow from {found.first} until relMSE is estimated below {found.noise:.3g}"
    if found.bias > 0.0:
        text += f", of {found.error:g} asked for: about {found.bias:.2g} is what knobs may leave"
    text += f"; {found.combinations} combinations of {', '.join(found.knobs) or 'no knobs'} compared"
    return replace(made, aim=found, numbers={**made.numbers, "error": text})


def _suited(scene: Scene, settings: Settings, plan: EffectPlan, given: Mapping[str, Any]) -> EffectPlan:
    """The plan with all knobs that no one turned as they go with its quality."""
    spp = int(by_quality(plan.settings.quality)["spp"])
    found = suited(scene, plan, _given(scene, settings, given), spp)
    text = f"{plan.settings.quality}, {spp} samples unless others are asked for"
    if found.knobs:
        made = _planned(scene, replace(settings, knobs={**found.knobs, **settings.knobs}), plan)
        text += (
            f"; of {found.combinations} combinations of {', '.join(found.knobs)} the cheapest that leaves less than "
            f"{found.most:.2g}, a sixteenth of the noise of so many samples: about {found.bias:.2g}"
        )
        plan = replace(made, settings=replace(made.settings, spp=plan.settings.spp))
    return replace(plan, numbers={**plan.numbers, "quality": text})


def _given(scene: Scene, settings: Settings, knobs: Mapping[str, Any]) -> dict[str, Any]:
    """Knobs that were turned in some way."""
    fields = {"spp": settings.spp, "pathDepth": settings.max_depth, "lights.coneTaps": settings.cone_taps}
    given = {**{n: v for n, v in fields.items() if v is not None}, **checked(knobs)}
    if scene.options.max_depth is not None:
        given.setdefault("pathDepth", scene.options.max_depth)
    return given


def _planned(scene: Scene, settings: Settings, earlier: EffectPlan | None) -> EffectPlan:
    """The plan for settings as they are."""
    start = time.perf_counter()
    decided, size, window = resolve(scene, settings)
    forced = dict(decided.effects)
    for name in forced:
        if name not in EFFECTS:
            raise ValueError(f"effects names {name!r}; the effects are {', '.join(EFFECTS)}")

    def allowed(distribution: str) -> bool:
        return forced.get("scratches", True) and forced.get(f"scratches.{distribution}", True)

    def waved(material: Material, layer: Layer) -> bool:
        return forced.get("diffraction", True) and diffracts(material, layer)

    def grooved(material: Material, layer: Layer) -> bool:
        return forced.get("grooves", True) and laid_out(material, layer)

    def elsewhere(material: Material, layer: Layer) -> bool:
        return waved(material, layer) or grooved(material, layer)

    thresholds = baked_thresholds(scene.path)
    # closed forms along cones need tables whose sums follow from those of their slices
    summed = forced.get("lights.closedForm", any(MODELS[type(light)].arcs is not None for light in scene.lights))
    try:
        before = earlier.settings if earlier is not None else None
        alike = before is not None and (before.max_error, before.knobs) == (decided.max_error, decided.knobs)
        known = earlier.tables if earlier is not None and alike else ()
        layers, tables, responses, warnings = plan_layers(
            scene, allowed, decided.max_error, known, decided.model, elsewhere, summed, thresholds.find
        )
        warnings += tuple(thresholds.warnings)
        tables = turned_tables(tables, decided.knobs, summed)
        waves = plan_waves(scene, waved, reflector, decided.model, decided.knobs)
        warnings += complaints(waves) + wide_ones(scene.materials)

        def near(number: int) -> list[Layer]:
            asked = forced.get("grooves.handover")
            if asked is False or not forced.get("grooves", True) or decided.model not in (None, "auto"):
                return []
            if forced.get("scratches.stencil", False):
                return []
            material = scene.materials[number]
            if refracts(material.surface) and not asked:
                return []
            reflects = {x.label: reflector(scene, material, x) for x in material.layers}
            tabled = {name: (by is not None, diffuse) for name, (by, diffuse) in reflects.items()}
            smooth = mean_color(getattr(material.surface, "roughness", 0.0), scene)[0] <= SMOOTH_BASE
            return near_layers(scene, decided, size, number, waves[number], asked is True, tabled, smooth)

        slack = slack_of(value(decided.knobs, "grooves.section"), decided.quality)
        grooves = plan_grooves(scene, grooved, decided.model, near, waves, slack)
        layers = mark_near(layers, grooves)
        used = sorted({m for instance in scene.instances for m in instance.materials})
        responses, bases = base_responses(scene, used, responses, lambda effect: forced.get(effect, True))
        far = ""
        if forced.get("scratches.stencil", False):
            from .far_bases import far_bases

            layers, responses, bases, far, said = far_bases(scene, used, layers, tables, responses, bases)
            warnings += said
            tables = tables if any(plan.table >= 0 for own in layers for plan in own) else ()
    except ValueError as error:
        raise ValueError(f"{scene.path}: {error}") from None
    materials = tuple(scene.materials[i] for i in used)
    facts = Facts(scene, decided, materials, layers, tables, responses, waves, bases, grooves)
    effects = {}
    for name, rule in EFFECTS.items():
        enabled, reason, prims = rule(facts)
        if name in forced:
            reason = f"forced {'on' if forced[name] else 'off'}; by itself {'on' if enabled else 'off'}: {reason}"
            enabled = forced[name]
        effects[name] = EffectChoice(enabled, reason, prims, name in forced)
    unseen = sampled_lights(facts)
    if unseen and not effects["lights.sampleLights"].enabled and not effects["lights.sampleCones"].enabled:
        raise ValueError(
            f"effects: lights.sampleLights and lights.sampleCones are both off, but scratches find {', '.join(unseen)} "
            "only so; leave one of them on"
        )
    counts = {f"lights.{m.name}": sum(type(x) is r for x in scene.lights) for r, m in MODELS.items()}
    layers, tables = _without(effects, layers, tables, responses)
    by_cost = shares(effects, layers, counts, decided.max_depth or 1)
    effects = {n: replace(c, share=by_cost.get(n, 0.0)) for n, c in effects.items()}
    warnings += tuple(
        f"{light.path}: its shadow link is not honoured, everything casts its shadow"
        for light in scene.lights
        if light.shadow_linked is not None
    )
    x0, x1, y0, y1 = window
    kinds = [(t.resolution, None if t.fresnel is None else t.theta_model) for t in tables]
    megabytes = 1e-6 * sum(table_bytes(bins, model, summed) for bins, model in kinds)
    segments = sum(len(c.points) - len(c.counts) for c in scene.curves)
    numbers = {
        "image": f"{size[0]} x {size[1]} pixels, {x1 - x0} x {y1 - y0} rendered, {decided.spp} samples each, "
        f"filter {decided.filter} {decided.filter_width:g} pixels",
        "geometry": f"{scene.triangles} triangles in {len(scene.instances)} instances",
        "tables": f"{len(tables)} to simulate, {sum(len(own) for own in layers)} sets of scratches",
        "memory": f"{megabytes:.1f} MB of tables; {segments} segments of curves, about 100 bytes each; noise and "
        "lines take none, however many scratches there are",
    }
    if far:
        numbers["stencils"] = far
    if coarse_sections(grooves):
        numbers["grooves"] = coarse_sections(grooves)
    if decided.max_error is not None:
        numbers["error"] = f"samples grow from {decided.spp} until relMSE is estimated below {decided.max_error:g}"
    if decided.knobs:
        numbers["knobs"] = ", ".join(f"{name}={value}" for name, value in decided.knobs.items())
    if decided.model is not None:
        numbers["model"] = f"{decided.model}, in place of every layer's own"
    return EffectPlan(
        effects=effects,
        settings=decided,
        size=size,
        window=window,
        layers=layers,
        tables=tables,
        warnings=warnings,
        numbers=numbers,
        responses=responses,
        waves=waves,
        bases=bases,
        grooves=grooves,
        seconds=time.perf_counter() - start,
    )


def _without(
    effects: dict[str, EffectChoice], layers: Layers, tables: tuple[TablePlan, ...], responses: tuple[ResponsePlan, ...]
) -> tuple[Layers, tuple[TablePlan, ...]]:
    """What is left of layers and tables when effects of scratches are forced off: one bounce, mirrors, no scratches
    that reflect by a table or a response, or none that are Lambert surfaces."""
    off = {name for name, choice in effects.items() if choice.forced and not choice.enabled}
    if "scratches.table" in off:
        tables = ()
    if "scratches.interreflection" in off:
        tables = tuple(replace(t, max_bounces=1) for t in tables)
    if "scratches.fresnel" in off:
        tables = tuple(replace(t, fresnel=None) for t in tables)

    def kept(p: LayerPlan) -> bool:
        if p.response >= 0:
            return RESPONSES[responses[p.response].name].effect not in off
        return ("scratches.diffuse" if p.lambert else "scratches.table") not in off

    return tuple(tuple(p for p in own if kept(p)) for own in layers), tables
