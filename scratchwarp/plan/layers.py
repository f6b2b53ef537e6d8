"""The scene's layers -> sublayers to render and the tables they share."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from .. import optics
from ..optics import metals
from ..scene import Layer, Material, PreviewSurface, Scene, ScratchSurface, TextureInput
from ..scratches.expand import Sublayer, Threshold, computed
from . import models
from .choice import LayerPlan, ResponsePlan, TablePlan, Variation
from .profiles import cross_section
from .textured import greatest_f0
from .theta import RENDERED, theta_model
from .variation import varied

_MODELS = {"exact": "exact", "schlick": "schlick", "lazanyi": "lazanyi", "lazanyiError": "lazanyi-error"}


def conductor_index(surface: Any) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """(eta, k) for R, G, B of a ScratchSurface or a layer: the named metal's, or its own."""
    if surface.metal != "custom":
        eta, k = metals.rgb(surface.metal)
        return (float(eta[0]), float(eta[1]), float(eta[2])), (float(k[0]), float(k[1]), float(k[2]))
    return tuple(surface.eta), tuple(surface.k)


def mean_color(value: Any, scene: Scene) -> tuple[float, float, float]:
    """A colour or scalar input as one colour; a texture counts with its mean."""
    if isinstance(value, TextureInput):
        texel = scene.textures[value.texture].pixels.reshape(-1, 4).mean(0) * value.scale + value.bias
        if value.channel != "rgb":
            texel = np.full(3, texel["rgba".index(value.channel)])
    else:
        texel = np.broadcast_to(np.asarray(value, np.float64), 3)
    r, g, b = (float(c) for c in texel[:3])
    return r, g, b


def _unit(color: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(min(max(c, 0.0), 1.0) for c in color)


def reflector(scene: Scene, material: Material, layer: Layer) -> tuple[Any, bool]:
    """(what the scratch's facets reflect by, or None for a Lambert scratch; whether the base's diffuse term stays).

    A scratch that inherits takes its base's Fresnel reflectance. A UsdPreviewSurface gives F0 by its workflow and a
    dielectric its index; the diffuse term under a dielectric is common to base and scratch (Raymond 2016, Figure 12c).
    """
    simple = "schlick" if layer.fresnel == "schlick" else "exact"
    if layer.material == "diffuse":
        return None, False
    if layer.fresnel == "mirror":
        return optics.Mirror(), False
    if layer.material == "conductor":
        return optics.Conductor(*conductor_index(layer), _MODELS[layer.fresnel]), False
    if layer.material == "dielectric":
        return optics.Dielectric(layer.ior, simple), True
    surface = material.surface
    if isinstance(surface, ScratchSurface):
        if surface.base == "conductor":
            return optics.Conductor(*conductor_index(surface), _MODELS[layer.fresnel]), False
        return (optics.Dielectric(surface.ior, simple), True) if surface.base == "dielectric" else (None, False)
    if surface.use_specular_workflow:
        return optics.Schlick(_unit(mean_color(surface.specular_color, scene))), True
    metallic = min(max(mean_color(surface.metallic, scene)[0], 0.0), 1.0)
    if metallic == 0.0:
        return optics.Dielectric(max(surface.ior, 1e-3), simple), True
    r2 = ((1.0 - surface.ior) / (1.0 + surface.ior)) ** 2
    f0 = _unit(tuple(r2 + (c - r2) * metallic for c in mean_color(surface.diffuse_color, scene)))
    return (optics.Mirror() if min(f0) >= 1.0 else optics.Schlick(f0)), metallic < 1.0


def lobe_weight(fresnel: Any) -> float:
    """About what a scratch reflects, for choosing among lobes: the reflectance at 45 degrees, a little light left."""
    if isinstance(fresnel, optics.Mirror):
        return 1.0
    return float(max(np.max(fresnel.reflectance(math.sqrt(0.5))), 0.02))


def _sized(scene: Scene, layer: Layer, curves: int) -> Layer:
    """The layer with the size of its scratches: that of the middle one of an explicit set, else its own."""
    if curves < 0:
        return layer
    record = scene.curves[curves]
    if record.width_unit != record.depth_unit or not len(record.widths):
        return layer
    width, depth = float(np.median(record.widths)), float(np.median(record.depths))
    return replace(layer, width=width, depth=depth) if width > 0.0 else layer


# Largest error of a directional albedo along the cone, for tables of scratches that differ.
VARIED_ERROR = 0.04


class _Tables:
    """Tables asked for so far, each once: layers of one profile, aspect and reflectance share one."""

    def __init__(self, scene: Scene, max_error: float | None, known: tuple[TablePlan, ...], summed: bool) -> None:
        self._scene, self._max_error, self._summed = scene, max_error, summed
        fits = [t for t in known if t.fresnel is None or not summed or t.theta_model != "gamma"]
        self._chosen = {t.key: (t.theta_model, t.error) for t in fits}
        self._plans: dict[tuple[Any, ...], TablePlan] = {}
        self._variations: dict[tuple[int, int, str], Any] = {}

    def index(self, layer: Layer, curves: int, fresnel: Any) -> int:
        """Number of the table that a layer (or its explicit set ``curves``) reflects by."""
        sized, p = _sized(self._scene, layer, curves), layer.profile
        aspect = sized.depth / sized.width
        points = b"" if p.points is None else p.points.tobytes()
        variant = layer.model if layer.model in models.TABLE_MODELS else ""
        outline = (p.shape, points, p.rim, p.rim_width, p.periodic, p.parameters)
        key = (*outline, round(aspect, 12), fresnel, variant)
        known = self._plans.get(key)
        if known is None:
            profile = cross_section(p, sized)
            reflecting = None if isinstance(fresnel, optics.Mirror) else fresnel
            model, off = self._chosen.get(key) or theta_model(profile, reflecting, self._max_error, self._summed)
            flat = p.rim == 0.0 and (p.shape == "flat" or aspect == 0.0)
            known = TablePlan(key, profile, reflecting, 1 if flat else 2000, (), theta_model=model, error=off)
            known = models.changed(known, layer.model)
        if layer.label not in known.users:
            known = replace(known, users=(*known.users, layer.label))
        self._plans[key] = known
        return list(self._plans).index(key)

    def varied(self, sublayer: Sublayer, fresnel: Any, differ: bool) -> tuple[int, Variation | None]:
        """Number of the first table of a sublayer whose scratches ``differ``, and how they do (None: they are
        alike)."""
        layer, curves = sublayer.layer, sublayer.curves
        sized = _sized(self._scene, layer, curves)
        record = self._scene.curves[curves] if curves >= 0 else None
        found = None
        if differ:
            asked = (id(layer), curves, sublayer.distribution)  # the patterns of a layer are alike in this
            if asked not in self._variations:
                self._variations[asked] = varied(sublayer, sized, record, self._max_error)
            found = self._variations[asked]
        if found is None:
            return self.index(layer, curves, fresnel), None
        how, nodes = found
        reflecting = None if isinstance(fresnel, optics.Mirror) else fresnel
        digest = tuple((tuple((p.token, s) for p, s in parts)) for parts in nodes)
        first = None
        # many tables: unless more is asked for they are kept small where that will do, 6 MB each instead of 32
        bound = VARIED_ERROR if self._max_error is None else self._max_error
        for number, parts in enumerate(nodes):
            key = ("varied", number, digest, fresnel, layer.model if layer.model in models.TABLE_MODELS else "")
            known = self._plans.get(key)
            if known is None:
                middle = parts[len(parts) // 2][0]
                model, off = self._chosen.get(key) or max(
                    (theta_model(p, reflecting, bound, self._summed) for p in {parts[0][0], parts[-1][0]}),
                    key=lambda chosen: RENDERED.index(chosen[0]),
                )
                known = TablePlan(key, middle, reflecting, 2000, (), theta_model=model, error=off, parts=parts)
                known = models.changed(known, layer.model)
            if layer.label not in known.users:
                known = replace(known, users=(*known.users, layer.label))
            self._plans[key] = known
            first = list(self._plans).index(key) if first is None else first
        assert first is not None
        return first, how

    def plans(self) -> tuple[TablePlan, ...]:
        """All of them, by number."""
        return tuple(self._plans.values())


def _complaints(material: Material, layer: Layer) -> list[str]:
    """What of a layer cannot be honoured."""
    said = []
    if layer.model == "diffraction" and material.wave is None:
        said.append(f"{layer.label}: model diffraction needs ScratchWaveAPI on {material.path}; its table is used")
    if layer.model == "normalMap" and layer.normal_map is None:
        why = "no normalTexture, which is read of layers of that model alone"
        said.append(f"{layer.label}: model normalMap has {why}; its table is used")
    return said


def _lends_mean(material: Material, layer: Layer, fresnel: Any) -> list[str]:
    """What a layer cannot know of its textured base."""
    surface = material.surface
    if isinstance(surface, PreviewSurface) and layer.material == "inherit" and isinstance(fresnel, optics.Schlick):
        read = ("specular_color",) if surface.use_specular_workflow else ("diffuse_color", "metallic")
        textured = [name for name in read if isinstance(getattr(surface, name), TextureInput)]
        return [f"{layer.label}: scratches reflect by the mean of the textured {name}" for name in textured[:1]]
    return []


def plan_layers(
    scene: Scene,
    allowed: Callable[[str], bool],
    max_error: float | None = None,
    known: tuple[TablePlan, ...] = (),
    model: str | None = None,
    elsewhere: Callable[[Material, Layer], bool] = lambda material, layer: False,
    summed: bool = False,
    threshold: Threshold = computed,
) -> tuple[tuple[tuple[LayerPlan, ...], ...], tuple[TablePlan, ...], tuple[ResponsePlan, ...], tuple[str, ...]]:
    """(sublayers of each material, tables to simulate, responses over solid angle, warnings).

    ``allowed(distribution)``: whether it may be on; ``max_error``: of a table's albedos, None for the default;
    ``known``: tables planned earlier for the same ``max_error``; ``model``: in place of every layer's own;
    ``elsewhere``: whether a layer is rendered by other means than sublayers; ``summed``: of theta
    models with sums along a cone; ``threshold``: of ``scratches.expand.sublayers``.
    """
    tables = _Tables(scene, max_error, known, summed)
    responses = models.Responses()
    warnings: dict[str, None] = {}
    every: list[tuple[LayerPlan, ...]] = []
    used = {m for i in scene.instances for m in i.materials}
    for number, material in enumerate(scene.materials):
        own: list[LayerPlan] = []
        for authored in material.layers if number in used else ():
            layer = replace(authored, model=model) if model else authored
            if elsewhere(material, layer):
                continue
            subs = [s for s in models.laid_out(layer, threshold) if allowed(s.distribution)]
            try:
                fresnel, keeps = reflector(scene, material, layer)
            except ValueError as error:
                raise ValueError(f"{layer.label}: {error}") from None
            fresnel, keeps = models.reflector_of(layer.model, fresnel, keeps)
            warnings |= dict.fromkeys(_complaints(material, layer))
            if fresnel is None:
                color = layer.diffuse_color
                if layer.material != "diffuse" and isinstance(material.surface, ScratchSurface):
                    color = material.surface.color
                own += [LayerPlan(s, -1, False, max(*color, 0.02), color) for s in subs]
            else:
                weight = lobe_weight(fresnel)
                lends = layer.material == "inherit" and isinstance(fresnel, optics.Schlick) and allowed("textured")
                lent = greatest_f0(scene, material.surface) if lends else None
                for s in subs:
                    answer = responses.index(layer, _sized(scene, layer, s.curves), fresnel)
                    if answer >= 0 or not allowed("textured"):
                        warnings |= dict.fromkeys(_lends_mean(material, layer, fresnel))
                    if answer >= 0:
                        own.append(LayerPlan(s, -1, keeps, weight, response=answer))
                        continue
                    f0 = lent[0] if lent else None
                    table, how = tables.varied(s, optics.Schlick(f0) if f0 else fresnel, allowed("variation"))
                    stays = lent[1] if lent else keeps
                    own.append(LayerPlan(s, table, stays, weight, variation=how, f0=f0))
        every.append(tuple(own))
    return tuple(every), tables.plans(), responses.plans(), tuple(warnings)
