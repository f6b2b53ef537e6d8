"""Scene materials -> device materials, with their scratch layers."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import warp as wp

from ..plan.choice import LayerPlan
from ..plan.layers import conductor_index
from ..scene import PreviewSurface, Scene, ScratchSurface, TextureInput
from ..scene.material import Color
from ..scene.texture import CHANNELS, WRAPS
from ..scratches import kind_number
from ..scratches.expand import bend
from ..scratches.layer_device import LayerData
from ..scratches.variation_device import VariationData
from .material_device import MaterialArrays, MaterialData, TextureRead

KINDS = ("preview", "conductor", "dielectric", "diffuse")


@dataclass(frozen=True, eq=False)
class PackedMaterials:
    """Device materials and layers, in scene order."""

    arrays: MaterialArrays
    layers: Any


def _read(value: Any, reads: list[TextureRead]) -> int:
    if not isinstance(value, TextureInput):
        return -1
    r = TextureRead()
    r.texture = value.texture
    r.channel = CHANNELS.index(value.channel)
    r.wrap_s, r.wrap_t = WRAPS.index(value.wrap_s), WRAPS.index(value.wrap_t)
    r.scale, r.bias = wp.vec4(*map(float, value.scale)), wp.vec4(*map(float, value.bias))
    r.row0, r.row1 = wp.vec3(*map(float, value.transform[0])), wp.vec3(*map(float, value.transform[1]))
    reads.append(r)
    return len(reads) - 1


def _color(value: Any) -> Any:
    return wp.vec3(0.0, 0.0, 0.0) if isinstance(value, TextureInput) else wp.vec3(*map(float, value))


def _scalar(value: Any) -> float:
    return 0.0 if isinstance(value, TextureInput) else float(value)


def _preview(m: MaterialData, s: PreviewSurface, reads: list[TextureRead]) -> None:
    m.kind = KINDS.index("preview")
    for field, source in (("diffuse", "diffuse_color"), ("emissive", "emissive_color"), ("specular", "specular_color")):
        value = getattr(s, source)
        setattr(m, field, _color(value))
        setattr(m, f"{field}_read", _read(value, reads))
    for field in ("metallic", "roughness", "clearcoat", "clearcoat_roughness", "opacity"):
        value = getattr(s, field)
        setattr(m, field, _scalar(value))
        setattr(m, f"{field}_read", _read(value, reads))
    m.specular_workflow = int(s.use_specular_workflow)
    m.opacity_threshold = s.opacity_threshold
    m.presence = int(s.opacity_mode == "presence")
    m.ior = s.ior
    m.normal_read = _read(s.normal, reads)
    m.cos_rotation = 1.0


def _scratch_surface(m: MaterialData, s: ScratchSurface) -> None:
    m.kind = KINDS.index(s.base)
    eta, k = conductor_index(s)
    m.eta, m.k = wp.vec3(*eta), wp.vec3(*k)
    m.diffuse, m.ior, m.opacity = wp.vec3(*s.color), s.ior, 1.0
    m.alpha_x, m.alpha_y = s.roughness * (1.0 + s.anisotropy), s.roughness * (1.0 - s.anisotropy)
    m.cos_rotation, m.sin_rotation = math.cos(s.rotation), math.sin(s.rotation)
    for name in ("diffuse", "emissive", "specular", "metallic", "roughness", "clearcoat", "clearcoat_roughness"):
        setattr(m, f"{name}_read", -1)
    m.opacity_read = m.normal_read = -1


def pack_layer(plan: LayerPlan, curves: Any = None, maps: int = -1) -> LayerData:
    """Device record of one sublayer; see ``LayerData``. ``curves``: its packed segments, if it has any; ``maps``:
    number of its maps."""
    sub, layer = plan.sublayer, plan.sublayer.layer
    d: Any = LayerData()
    d.kind = kind_number(sub.distribution)
    d.uv_space = int(layer.space == "uv")
    d.cos_a, d.sin_a = math.cos(sub.angle), math.sin(sub.angle)
    d.inv_length, d.inv_width = 1.0 / sub.cell_length, 1.0 / sub.cell_width
    d.radius, d.width_variation = sub.radius, layer.width_variation
    d.offset = wp.vec2d(*sub.offset)
    d.seed = sub.seed
    d.width, d.pitch = layer.width, max(layer.pitch, 1e-30)
    d.center = wp.vec2d(*layer.center)
    d.bend, d.bend_number = bend(layer)
    d.mean, d.table, d.keeps_diffuse, d.weight = sub.coverage, plan.table, int(plan.keeps_diffuse), plan.weight
    d.diffuse = wp.vec3(*plan.diffuse)
    d.response = plan.response
    d.maps, d.near = maps, int(plan.near)
    d.f0 = wp.vec3(*(plan.f0 or (0.0, 0.0, 0.0)))
    d.varied = int(layer.width_variation > 0.0 or plan.variation is not None)
    wavelength = layer.variation_length or (layer.length if sub.distribution == "spiral" else 0.0)
    d.wave = 1.0 / wavelength if wavelength > 0.0 else 0.0
    if curves is not None and curves.uv != (layer.space == "uv"):
        d.wave = 0.0
    if curves is not None and curves.bvh is not None:
        d.first, d.bvh, d.reach = curves.first, curves.bvh.id, curves.reach
        d.curve_uv, d.width_uv = int(curves.uv), int(curves.width_uv)
    return d


def pack_variations(layers: Sequence[Sequence[LayerPlan]], device: str = "cpu") -> Any:
    """Device array of how the scratches of each sublayer differ, in the order of ``pack``."""
    records = []
    for plan in (p for own in layers for p in own):
        v: Any = VariationData()
        v.aspects = v.blends = 1
        if plan.variation is not None:
            how = plan.variation
            v.aspects, v.blends, v.low, v.aspect = how.aspects, how.blends, how.low, how.aspect
            v.scale = (how.aspects - 1) / max(how.high - how.low, 1e-9)
            v.depth, v.own = plan.sublayer.layer.depth_variation, int(how.explicit)
        records.append(v)
    return wp.array(records or [VariationData()], dtype=VariationData, device=device)


def pack(
    scene: Scene,
    layers: list[list[LayerData]],
    atlas: Any,
    device: str = "cpu",
    bases: Mapping[int, tuple[int, Color]] | None = None,
    glass: Collection[int] = (),
) -> PackedMaterials:
    """Device materials; ``layers[i]`` are the packed sublayers of material i, the ones that cut deepest last.

    ``atlas``: the scene's textures as ``reflectance.texture.pack_textures`` puts them on the device. ``bases``:
    material -> response that stands in for its base, and about its albedo. ``glass``: materials that refract.
    """
    reads: list[TextureRead] = []
    records: list[MaterialData] = []
    flat: list[LayerData] = []
    for number, (material, own) in enumerate(zip(scene.materials, layers, strict=True)):
        m = MaterialData()
        m.response = -1
        if bases and number in bases:
            m.response, albedo = bases[number]
            _scratch_surface(m, ScratchSurface(base="diffuse", color=albedo))
        elif isinstance(material.surface, PreviewSurface):
            _preview(m, material.surface, reads)
        else:
            _scratch_surface(m, material.surface)
        m.display_color = int(material.uses_display_color and m.response < 0)
        m.refracts = int(number in glass)
        m.first_layer, m.layers = len(flat), len(own)
        m.veil = math.prod(1.0 - min(d.mean, 1.0) for d in own if d.keeps_diffuse == 0 and d.bvh == 0)
        flat.extend(own)
        records.append(m)
    arrays = MaterialArrays()
    arrays.materials = wp.array(records or [MaterialData()], dtype=MaterialData, device=device)
    arrays.reads = wp.array(reads or [TextureRead()], dtype=TextureRead, device=device)
    arrays.atlas = atlas
    packed_layers: Any = wp.array(flat or [LayerData()], dtype=LayerData, device=device)
    return PackedMaterials(arrays, packed_layers)
