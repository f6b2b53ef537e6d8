"""Which layers diffract, and what they reflect by at each wavelength."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from .. import optics, profiles
from ..optics import metals
from ..reflectance.diffraction.outline import facets
from ..scene import Layer, Material, Scene, ScratchSurface, Wave
from ..scene.knob import Value
from .knobs import turned_wave
from .profiles import cross_section

# Coherence radii beyond which a scratch is too wide to diffract by itself.
WIDE = 4.0
# Patterns of regular pitch have a closed form; all others become explicit scratches.
REGULAR = ("linear", "concentric", "spiral", "crosshatch")


@dataclass(frozen=True, eq=False)
class WaveLayerPlan:
    """A layer that diffracts; ``fresnel``: an ``optics`` reflector; ``index``: wavelength [nm] -> (n, k), or None where
    its reflectance is known for R, G and B alone; ``outline``: rows of ``diffraction``'s facets ``[n, 4]``, None for a
    rectangle; ``others``: further ones, of as many of its scratches each, where cross-sections vary."""

    layer: Layer
    fresnel: Any
    index: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]] | None
    outline: np.ndarray | None = None
    others: tuple[np.ndarray | None, ...] = ()

    @property
    def outlines(self) -> tuple[np.ndarray | None, ...]:
        """All cross-sections."""
        return (self.outline, *self.others)


@dataclass(frozen=True, eq=False)
class WavePlan:
    """What diffracts of a material."""

    wave: Wave
    layers: tuple[WaveLayerPlan, ...]


def diffracts(material: Material, layer: Layer) -> bool:
    """Whether a layer is rendered by wave optics: ScratchWaveAPI on the Material and model diffraction, or auto where
    scratches are not too wide for it."""
    wave = material.wave
    return wave is not None and (layer.model == "diffraction" or (layer.model == "auto" and not too_wide(wave, layer)))


def too_wide(wave: Wave, layer: Layer) -> bool:
    """Whether scratches are far wider than light is coherent: nothing that interferes across them is left."""
    return layer.space == "surface" and layer.width > WIDE * wave.coherence_radius


def wide_ones(materials: Sequence[Material]) -> tuple[str, ...]:
    """What ``too_wide`` keeps from diffracting, one sentence each."""
    return tuple(
        f"{layer.label}: scratches of {layer.width:g} um are far wider than light is coherent, "
        f"{m.wave.coherence_radius:g} um; tables render them, model diffraction would diffract them"
        for m in materials
        for layer in m.layers
        if m.wave is not None and layer.model == "auto" and too_wide(m.wave, layer)
    )


def is_grating(wave: Wave, layer: Layer) -> bool:
    """Whether a regular pattern is summed coherently: asked for, and closer than the light on it is coherent (lines
    further apart leave fringes that no light of finite size shows). A pitch in uv is taken for close."""
    close = layer.space == "uv" or layer.pitch <= wave.coherence_radius
    return wave.summation == "coherent" and layer.distribution in REGULAR and close


def looks_up(wave: Wave) -> bool:
    """Whether colours may come from tables: sampling auto or lookup, and a phase that does not depend on angles."""
    return wave.sampling in ("auto", "lookup") and wave.phase == "smallAngle"


def looks_up_points(wave: Wave, plan: "WaveLayerPlan") -> bool:
    """Whether the one-dimensional table holds a layer's colours under lights without extent: flat floors, no spread."""
    regular = plan.layer.distribution in REGULAR and plan.layer.depth_variation > 0.0
    return looks_up(wave) and plan.outline is None and wave.roughness == 0.0 and not regular


def wave_index(material: Material, layer: Layer) -> Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]] | None:
    """The refractive index by wavelength: that of ScratchWaveAPI, else of the measured metal that the scratch is of."""
    wave = material.wave
    if wave is not None and wave.ior is not None:
        rows = wave.ior
        return lambda at: (np.interp(at, rows[:, 0], rows[:, 1]), np.interp(at, rows[:, 0], rows[:, 2]))
    if layer.fresnel == "mirror":
        return None
    source: Any = layer if layer.material == "conductor" else material.surface
    inherits = layer.material == "inherit" and isinstance(source, ScratchSurface) and source.base == "conductor"
    if (layer.material == "conductor" or inherits) and source.metal != "custom":
        return lambda at: metals.index(source.metal, at)
    return None


def outline(layer: Layer) -> np.ndarray | None:
    """The facets of a layer's cross-section, None where it is a rectangle as wide and deep as the scratch.

    Raises ValueError on a profile that cannot be drawn.
    """
    if layer.profile.shape == "rectangle" and layer.profile.rim == 0.0:
        return None
    rows = facets(cross_section(layer.profile, layer))
    return rows if len(rows) else np.zeros((1, 4))


def outlines(layer: Layer) -> tuple[np.ndarray | None, ...]:
    """The cross-sections of a layer's scratches: one, or four on the way to its other profile.

    Raises ValueError on a profile that cannot be drawn, or none between two of them.
    """
    end, amount = layer.profile_end, layer.profile_variation
    if end is None or amount <= 0.0:
        return (outline(layer),)
    made = []
    for part in (0.125, 0.375, 0.625, 0.875):
        try:
            between = profiles.between(cross_section(layer.profile, layer), cross_section(end, layer), amount * part)
        except ValueError as error:
            raise ValueError(f"{layer.label}: on the way to profileEnd {end.path}: {error}") from None
        rows = facets(between)
        made.append(rows if len(rows) else np.zeros((1, 4)))
    return tuple(made)


def plan_waves(
    scene: Scene,
    wanted: Callable[[Material, Layer], bool],
    reflector: Callable[..., tuple[Any, bool]],
    model: str | None = None,
    knobs: Mapping[str, Value] = MappingProxyType({}),
) -> tuple[WavePlan | None, ...]:
    """For each material what of it diffracts, None where nothing does.

    ``wanted(material, layer)``: whether it may; ``reflector``: as ``plan.layers.reflector``; ``model``: in place of
    every layer's own; ``knobs``: as ``Settings.knobs``. Lambert scratches do not diffract.
    """
    used = {m for i in scene.instances for m in i.materials}
    made: list[WavePlan | None] = []
    for number, material in enumerate(scene.materials):
        own = []
        for authored in material.layers if number in used else ():
            layer = replace(authored, model=model) if model else authored
            if wanted(material, layer) and layer.width > 0.0:
                fresnel = reflector(scene, material, layer)[0]
                if fresnel is not None:
                    first, *others = outlines(layer)
                    own.append(WaveLayerPlan(layer, fresnel, wave_index(material, layer), first, tuple(others)))
        wave = material.wave
        made.append(WavePlan(turned_wave(wave, knobs), tuple(own)) if own and wave is not None else None)
    return tuple(made)


def complaints(waves: tuple[WavePlan | None, ...]) -> tuple[str, ...]:
    """What of diffracting layers is not honoured, one sentence each."""
    said: list[str] = []
    for own in waves:
        for plan in own.layers if own is not None else ():
            layer = plan.layer
            coherent = own is not None and own.wave.summation == "coherent"
            if own is not None and coherent and layer.distribution in REGULAR and not is_grating(own.wave, layer):
                said.append(
                    f"{layer.label}: regular patterns are summed coherently where they are closer than "
                    "coherenceRadius; the light of these scratches adds up"
                )
            if layer.profile_variation > 0.0 and layer.variation_length > 0.0:
                said.append(f"{layer.label}: the cross-section of a scratch that diffracts is the same all along it")
            if layer.model == "auto" and layer.distribution == "worley":
                said.append(f"{layer.label}: worley scratches that diffract are laid out one by one, as random ones")
    return tuple(dict.fromkeys(said))


def reflectances(plan: WaveLayerPlan, cosines: np.ndarray, wavelengths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(linear Rec.709 ``[c, 3]``, by wavelength [nm] ``[c, n]``) of a layer; the latter ones where it is not known."""
    by_color = np.broadcast_to(plan.fresnel.reflectance(cosines), (len(cosines), 3))
    if plan.index is None:
        return by_color, np.ones((len(cosines), len(wavelengths)))
    r_s, r_p = optics.fresnel.amplitudes(cosines[:, None], *plan.index(wavelengths))
    return by_color, 0.5 * (np.abs(r_s) ** 2 + np.abs(r_p) ** 2)
