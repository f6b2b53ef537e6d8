"""Which layers are laid out groove by groove, and what their facets are made of."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import profiles
from ..scene import Layer, Material, PreviewSurface, Scene, ScratchSurface, TextureInput
from .choice import LayerPlan
from .profiles import cross_section
from .waves import REGULAR

COARSE = {"draft": 2, "preview": 1}
"""Thousandths of a width by which cross-sections may be off where the knob is left to the quality; else 0."""
ARCS = 8  # chords for each arc of a smooth cross-section
# Widths of a footprint in widths of a groove between which model auto goes over to tables.
NEAR, FAR = 2.0, 6.0
SMOOTH = 0.003
MOST = 20_000  # scratches on a surface that model auto lays out
DEEP = 48.0  # grooves of a regular pattern that lie over one another in one place, at most


@dataclass(frozen=True, eq=False)
class GrooveLayerPlan:
    """A layer to lay out; ``section``: its cross-section [n, 2] in widths of the groove at the layer's aspect, x from 0
    to 1; ``own``: what its facets are made of (a ``ScratchSurface``, "mirror"), None for what the surface is made
    of; ``slack``: how far [widths] cross-sections may be off the authored ones; ``facets``: of the authored one."""

    layer: Layer
    section: np.ndarray
    own: Any = None
    slack: float = 0.0
    facets: int = 0

    def section_at(self, part: float) -> np.ndarray:
        """The cross-section ``part`` of the way to the layer's other profile. Raises ValueError where there is none
        between the two."""
        layer = self.layer
        if part <= 0.0 or layer.profile_end is None:
            return self.section
        first, last = cross_section(layer.profile, layer), cross_section(layer.profile_end, layer)
        try:
            return profiles.simplified(np.array(profiles.between(first, last, part).polyline(ARCS)), self.slack)
        except ValueError as error:
            raise ValueError(f"{layer.label}: {part:.3g} of the way to {layer.profile_end.path}: {error}") from None


@dataclass(frozen=True, eq=False)
class GroovePlan:
    """What of a material is laid out; ``handover``: only where it is near; ``waved``: it diffracts elsewhere;
    ``tapers``: sizes change along single grooves; ``refracts``: they are cut in glass."""

    layers: tuple[GrooveLayerPlan, ...]
    handover: bool = False
    waved: bool = False
    tapers: bool = False
    refracts: bool = False

    @property
    def smooth(self) -> float:
        """Roughness of facets that go over to statistics. Tables take them for smooth; light that diffracts is spread
        by about a wavelength over a width (half of the lobes' peaks at the same angle)."""
        if not self.handover:
            return 0.0
        least = min(own.layer.width for own in self.layers)
        return min(max(SMOOTH, 0.34 * 0.55 / least), 0.1) if self.waved else SMOOTH

    @property
    def crossings(self) -> bool:
        """Whether some of its grooves may cross, bend or end: all but one set of parallel lines."""
        only = self.layers[0].layer
        steps = only.profile_end is not None and only.profile_variation > 0.0 and only.variation_length > 0.0
        return len(self.layers) > 1 or only.distribution != "linear" or self.tapers or steps

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


def _tapers(layer: Layer, scene: Scene) -> bool:
    """Whether the size of a layer's grooves changes along single ones."""
    if layer.variation_length > 0.0 and max(layer.width_variation, layer.depth_variation) > 0.0:
        return True
    sizes = [scene.curves[c] for c in layer.curves] if layer.distribution == "curves" else []
    return any(_changes(own.widths, own.counts) or _changes(own.depths, own.counts) for own in sizes)


def _changes(values: np.ndarray, counts: np.ndarray) -> bool:
    """Whether values of runs of ``counts`` differ within a run."""
    inner = np.ones(max(len(values) - 1, 0), bool)
    inner[np.cumsum(counts)[:-1] - 1] = False
    return bool((np.abs(np.diff(values))[inner] > 1e-6 * np.abs(values).max(initial=0.0)).any())


def slack_of(value: Any, quality: str | None) -> float:
    """Widths by which cross-sections may be off, of the knob ``grooves.section``."""
    return 1e-3 * float(COARSE.get(quality or "", 0) if value == "auto" else value)


def _told_apart(layer: Layer) -> None:
    """ValueError where regular grooves are so much wider than they are apart that none is left of them."""
    if layer.distribution not in REGULAR or layer.pitch <= 0.0:
        return
    sets = 2.0 if layer.distribution == "crosshatch" else 1.0
    over = sets * layer.width * (1.0 + layer.width_variation) / layer.pitch
    if over > DEEP:
        raise ValueError(
            f"{layer.label}: grooves of width {layer.width:g} every {layer.pitch:g} (pitch) lie over one another, "
            f"{over:.3g} in one place, more than {DEEP:g}; make pitch greater, width smaller, or set its model to table"
        )


def _layer_plan(layer: Layer, slack: float) -> GrooveLayerPlan:
    drawn = np.array(cross_section(layer.profile, layer).polyline(ARCS))
    return GrooveLayerPlan(layer, profiles.simplified(drawn, slack), _own(layer), slack, len(drawn) - 1)


def recut(grooves: Sequence["GroovePlan | None"], slack: float) -> tuple["GroovePlan | None", ...]:
    """The same grooves, their cross-sections off by ``slack`` widths at most."""
    return tuple(
        own and replace(own, layers=tuple(_layer_plan(old.layer, slack) for old in own.layers)) for own in grooves
    )


def coarse_sections(grooves: Sequence["GroovePlan | None"]) -> str:
    """What ``explain`` says of cross-sections that were simplified; "" where none is."""
    coarse = [own for plan in grooves if plan is not None for own in plan.layers if len(own.section) - 1 < own.facets]
    return "; ".join(
        f"{own.layer.label}: {len(own.section) - 1} of {own.facets} facets, off by at most {own.slack:g} of the width "
        f"({own.slack * own.layer.width:.3g} {'um' if own.layer.space == 'surface' else 'of uv'})"
        for own in coarse
    )


def plan_grooves(
    scene: Scene,
    wanted: Callable[[Material, Layer], bool],
    model: str | None = None,
    near: Callable[[int], list[Layer]] = lambda number: [],
    waves: Sequence[Any] = (),
    slack: float = 0.0,
) -> tuple[GroovePlan | None, ...]:
    """For each material what of it is laid out groove by groove, None where nothing is.

    ``wanted(material, layer)``: whether it may; ``model``: in place of every layer's own; ``near(number)``: layers of a
    material of which none is wanted that are laid out where they are near; ``waves``: for each material what of it
    diffracts, or None; ``slack``: widths by which cross-sections may be off. Raises ValueError on a profile that cannot
    be drawn, and on regular grooves far wider than they are apart.
    """
    used = {m for i in scene.instances for m in i.materials}
    made: list[GroovePlan | None] = []
    for number, material in enumerate(scene.materials):
        own = []
        for authored in material.layers if number in used else ():
            layer = replace(authored, model=model) if model else authored
            if wanted(material, layer):
                _told_apart(layer)
                own.append(_layer_plan(layer, slack))
        handover = not own and number in used
        if handover:
            own = [_layer_plan(x, slack) for x in near(number)]
        wave = waves[number] if number < len(waves) else None
        names = {w.layer.label for w in wave.layers} if wave is not None else set()
        waved = handover and any(x.layer.label in names for x in own)
        tapers = any(_tapers(x.layer, scene) for x in own)
        made.append(GroovePlan(tuple(own), handover, waved, tapers, refracts(material.surface)) if own else None)
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
