"""Which layers are laid out groove by groove, and what their facets are made of."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..scene import Layer, Material, Scene, ScratchSurface
from .profiles import cross_section

ARCS = 8  # chords for each arc of a smooth cross-section
BOUNCES = 8
LINES = 48  # over a footprint where grooves cross or end, shared by the samples of a pixel
# Widths of a footprint in widths of a groove between which model auto goes over to tables.
NEAR, FAR = 2.0, 6.0


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
    """What of a material is laid out; ``handover``: only where it is near."""

    layers: tuple[GrooveLayerPlan, ...]
    handover: bool = False

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


def _own(layer: Layer) -> Any:
    if layer.fresnel == "mirror" and layer.material != "diffuse":
        return "mirror"
    if layer.material == "inherit":
        return None
    return ScratchSurface(
        base=layer.material, metal=layer.metal, eta=layer.eta, k=layer.k, ior=layer.ior,
        color=layer.diffuse_color if layer.material == "diffuse" else (0.0, 0.0, 0.0),
    )  # fmt: skip


def plan_grooves(
    scene: Scene, wanted: Callable[[Material, Layer], bool], model: str | None = None
) -> tuple[GroovePlan | None, ...]:
    """For each material what of it is laid out groove by groove, None where nothing is.

    ``wanted(material, layer)``: whether it may; ``model``: in place of every layer's own. Raises ValueError on a
    profile that cannot be drawn.
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
        made.append(GroovePlan(tuple(own)) if own else None)
    return tuple(made)


def groove_layers(grooves: tuple[GroovePlan | None, ...]) -> list[GrooveLayerPlan]:
    """All layers that are laid out."""
    return [layer for own in grooves if own is not None for layer in own.layers]
