"""Which layers are laid out groove by groove, and what their facets are made of."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..scene import Layer, Material, PreviewSurface, Scene, ScratchSurface, Settings, TextureInput
from .choice import LayerPlan
from .profiles import cross_section

ARCS = 8  # chords for each arc of a smooth cross-section
# Widths of a footprint in widths of a groove between which model auto goes over to tables.
NEAR, FAR = 2.0, 6.0
MOST = 20_000  # scratches on a surface that model auto lays out


@dataclass(frozen=True, eq=False)
class GrooveLayerPlan:
    """A layer to lay out; ``section``: its cross-section [n, 2] in widths of the groove at the layer's aspect, x from 0
    to 1; ``own``: what its facets are made of (a ``ScratchSurface``, "mirror"), None for what the surface is made
    of."""

    layer: Layer
    section: np.ndarray
    own: Any = None


@dataclass(frozen=True, eq=False)
class GroovePlan:
    """What of a material is laid out; ``handover``: only where it is near; ``refracts``: they are cut in glass."""

    layers: tuple[GrooveLayerPlan, ...]
    handover: bool = False
    refracts: bool = False

    @property
    def crossings(self) -> bool:
        """Whether some of its grooves may cross, bend or end: all but one set of parallel lines."""
        return len(self.layers) > 1 or self.layers[0].layer.distribution != "linear"

    @property
    def bounces(self) -> bool:
        """Whether facets can send light to one another: all but flat ones can."""
        return any(np.ptp(own.section[:, 1]) > 0.0 for own in self.layers)


def laid_out(material: Material, layer: Layer) -> bool:
    """Whether a layer is rendered groove by groove."""
    return layer.model == "groove" and layer.width > 0.0


def refracts(surface: Any) -> bool:
    """Whether a surface is the skin of something that light goes into: a UsdPreviewSurface, no metal, whose opacity is
    below 1 and says how much light passes rather than where the surface is."""
    if not isinstance(surface, PreviewSurface) or surface.opacity_mode == "presence" or surface.opacity_threshold > 0.0:
        return False
    whole = not isinstance(surface.opacity, TextureInput) and surface.opacity >= 1.0
    return not whole and not isinstance(surface.metallic, TextureInput) and surface.metallic == 0.0


def _own(layer: Layer) -> Any:
    if layer.fresnel == "mirror" and layer.material != "diffuse":
        return "mirror"
    if layer.material == "inherit":
        return None
    return ScratchSurface(
        base=layer.material, metal=layer.metal, eta=layer.eta, k=layer.k, ior=layer.ior,
        color=layer.diffuse_color if layer.material == "diffuse" else (0.0, 0.0, 0.0),
    )  # fmt: skip


def _number(layer: Layer, scene: Scene, area: float) -> float:
    """About how many scratches of a layer lie on ``area`` square metres."""
    if layer.distribution == "curves":
        return float(sum(len(scene.curves[c].counts) for c in layer.curves))
    unit = 1e6 * math.sqrt(area) if layer.space == "surface" else 1.0
    if layer.distribution in ("worley", "random"):
        each = max(layer.length, layer.width) * layer.width
        dense = layer.density * (1e-6 if layer.space == "surface" else 1.0)
        return unit * unit * (dense or layer.coverage / max(each, 1e-300))
    return unit / max(layer.pitch, 1e-300)


def near_layers(scene: Scene, settings: Settings, size: tuple[int, int], number: int) -> list[Layer]:
    """Layers of model auto of a material that the camera comes near enough to: a sample's footprint is less than
    ``FAR`` of their widths wide somewhere, and they have ``MOST`` scratches at most on each surface."""
    camera, found = scene.camera, []
    left, right, *_ = camera.window(*size, scene.options.conform, scene.options.pixel_aspect)
    pixel = (right - left) / size[0] / math.sqrt(settings.spp or 1)
    for layer in scene.materials[number].layers:
        wide = True
        for instance in scene.instances if layer.model == "auto" and layer.width > 0.0 else ():
            if number not in instance.materials:
                continue
            mesh = scene.meshes[instance.mesh]
            corners = mesh.points[mesh.triangles] @ instance.transform[:3, :3].T + instance.transform[:3, 3]
            if not len(corners):
                continue
            area = 0.5 * float(np.linalg.norm(np.cross(*np.moveaxis(np.diff(corners, axis=1), 1, 0)), axis=-1).sum())
            eye = camera.transform[:3, 3]
            low, high = corners.min((0, 1)), corners.max((0, 1))
            away = 1.0
            if camera.projection != "orthographic":
                away = float(np.linalg.norm(np.maximum(np.maximum(low - eye, eye - high), 0.0)))
            width = layer.width * (1.0 if layer.space == "surface" else 1e6 * math.sqrt(max(area, 0.0)))
            wide = wide and _number(layer, scene, area) <= MOST
            if wide and 1.128e6 * pixel * away < FAR * width:
                found.append(layer)
                break
    return found


def plan_grooves(
    scene: Scene,
    wanted: Callable[[Material, Layer], bool],
    model: str | None = None,
    near: Callable[[int], list[Layer]] = lambda number: [],
) -> tuple[GroovePlan | None, ...]:
    """For each material what of it is laid out groove by groove, None where nothing is.

    ``wanted(material, layer)``: whether it may; ``model``: in place of every layer's own; ``near(number)``: layers of a
    material of which none is wanted that are laid out where they are near. Raises ValueError on a profile that cannot
    be drawn.
    """
    used = {m for i in scene.instances for m in i.materials}
    made: list[GroovePlan | None] = []
    for number, material in enumerate(scene.materials):
        own = []
        for authored in material.layers if number in used else ():
            layer = replace(authored, model=model) if model else authored
            if wanted(material, layer):
                profile = cross_section(layer.profile, layer)
                section = np.array(profile.polyline(ARCS))
                own.append(GrooveLayerPlan(layer, section, _own(layer)))
        handover = not own and number in used
        if handover:
            own = [
                GrooveLayerPlan(x, np.array(cross_section(x.profile, x).polyline(ARCS)), _own(x)) for x in near(number)
            ]
        made.append(GroovePlan(tuple(own), handover, refracts(material.surface)) if own else None)
    return tuple(made)


def groove_layers(grooves: tuple[GroovePlan | None, ...]) -> list[GrooveLayerPlan]:
    """All layers that are laid out."""
    return [layer for own in grooves if own is not None for layer in own.layers]


def mark_near(
    layers: tuple[tuple[LayerPlan, ...], ...], grooves: tuple[GroovePlan | None, ...]
) -> tuple[tuple[LayerPlan, ...], ...]:
    """The sublayers, those marked that are laid out groove by groove where they are near."""
    made = []
    for own, groove in zip(layers, grooves, strict=True):
        names = {p.layer.label for p in groove.layers} if groove is not None and groove.handover else set()
        made.append(tuple(replace(p, near=True) if p.sublayer.layer.label in names else p for p in own))
    return tuple(made)
