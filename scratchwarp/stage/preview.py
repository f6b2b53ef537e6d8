"""UsdPreviewSurface networks to PreviewSurface."""

from dataclasses import replace
from typing import Any

import numpy as np
from pxr import Usd, UsdShade

from scratchwarp.scene import PreviewSurface, TextureInput

from .color import color
from .light import held
from .reading import Reading
from .shader_input import constant, is_output, source_of
from .texture import Textures
from .texture_input import read_texture_input

_COLORS = {
    "diffuseColor": ("diffuse_color", (0.18, 0.18, 0.18)),
    "emissiveColor": ("emissive_color", (0.0, 0.0, 0.0)),
    "specularColor": ("specular_color", (0.0, 0.0, 0.0)),
}
_NUMBERS = {
    "metallic": ("metallic", 0.0),
    "roughness": ("roughness", 0.5),
    "clearcoat": ("clearcoat", 0.0),
    "clearcoatRoughness": ("clearcoat_roughness", 0.01),
    "opacity": ("opacity", 1.0),
}
_PRIMVAR_READER = "UsdPrimvarReader_"


def read_preview(reading: Reading, prim: Usd.Prim, textures: Textures) -> tuple[PreviewSurface, bool]:
    """(the surface of a UsdPreviewSurface node, whether its diffuse colour is the geometry's displayColor).

    A texture that cannot be read gives its authored ``fallback``, else the input's own default.
    """
    shader = UsdShade.Shader(prim)
    fields: dict[str, Any] = {}
    display_color = False
    for name, (field, default) in _COLORS.items():
        got = _value(reading, shader, name, default, textures)
        if isinstance(got, str) and got == "displayColor":
            display_color = name == "diffuseColor"
            if not display_color:
                reading.warn(prim.GetPath(), f"inputs:{name} reads displayColor; only diffuseColor can")
            continue
        fields[field] = got if isinstance(got, TextureInput) else _rgb(got, default)
    fields["emissive_color"] = _held(reading, prim, fields.get("emissive_color"), textures)
    for name, (field, number) in _NUMBERS.items():
        got = _value(reading, shader, name, number, textures)
        fields[field] = got if isinstance(got, TextureInput) else _clean(reading, prim, name, got, number)
    normal = _value(reading, shader, "normal", (0.0, 0.0, 1.0), textures)
    if isinstance(normal, TextureInput):
        fields["normal"] = normal
    elif tuple(_rgb(normal, (0.0, 0.0, 1.0))) != (0.0, 0.0, 1.0):
        reading.warn(prim.GetPath(), "a constant inputs:normal is not honoured")
    displacement = _value(reading, shader, "displacement", 0.0, textures)
    if displacement != 0.0:
        reading.warn(prim.GetPath(), "inputs:displacement is not honoured")

    ior = _constant(reading, shader, "ior", 1.5, textures)
    if not 0 < ior <= 100:
        reading.warn(prim.GetPath(), f"inputs:ior is {ior}; 1.5 is used")
        ior = 1.5
    mode = str(_value(reading, shader, "opacityMode", "transparent", textures))
    if mode not in ("transparent", "presence"):
        reading.warn(prim.GetPath(), f"inputs:opacityMode is {mode!r}; transparent is used")
        mode = "transparent"
    surface = PreviewSurface(
        **fields,
        use_specular_workflow=bool(_constant(reading, shader, "useSpecularWorkflow", 0, textures)),
        opacity_threshold=_constant(reading, shader, "opacityThreshold", 0.0, textures),
        opacity_mode=mode,
        ior=ior,
    )
    return surface, display_color


def _value(reading: Reading, shader: UsdShade.Shader, name: str, default: Any, textures: Textures) -> Any:
    """A constant (colours in linear Rec.709), a TextureInput, or the word displayColor."""
    given = shader.GetInput(name)
    source = source_of(shader, name)
    if source is None:
        if given and given.GetRawConnectedSourcePaths():
            target = given.GetRawConnectedSourcePaths()[0]
            reading.warn(shader.GetPath(), f"inputs:{name} is connected to {target}, which does not exist")
        return default
    if not is_output(source):
        got = constant(reading, source, default)
        authored_color = name in _COLORS and got is not default
        return color(reading, source, np.array(got, np.float64)) if authored_color else got
    node = UsdShade.Shader(source.GetPrim())
    kind = str(node.GetShaderId() or "")
    if kind == "UsdUVTexture":
        # UsdPreviewSurface wants normal maps read raw, whatever an image of three 8-bit channels usually is.
        automatic = "raw" if name == "normal" else "auto"
        return read_texture_input(reading, node, source.GetBaseName(), default, textures, automatic)
    if kind.startswith(_PRIMVAR_READER):
        named = source_of(node, "varname")
        varname = str(named.Get(reading.time)) if named else ""
        if varname == "displayColor":
            return "displayColor"
        fallback = node.GetInput("fallback")
        reading.warn(node.GetPath(), f"primvar {varname!r} is not read by inputs:{name}; its fallback is used")
        got = fallback.Get(reading.time) if fallback else None
        return default if got is None else got
    reading.warn(shader.GetPath(), f"inputs:{name} is driven by {kind or source.GetPath()}; its default is used")
    return default


def _held(reading: Reading, prim: Usd.Prim, glow: Any, textures: Textures) -> Any:
    """An emissiveColor that images hold; none is black."""
    if glow is None:
        return (0.0, 0.0, 0.0)
    if not isinstance(glow, TextureInput):
        factor = held(reading, prim, float(np.abs(glow).max()))
        return tuple(factor * v for v in glow)
    texels = float(np.abs(textures.records[glow.texture].pixels).max())
    factor = held(reading, prim, float(np.abs(glow.scale).max()) * texels + float(np.abs(glow.bias).max()))
    return replace(glow, scale=factor * glow.scale, bias=factor * glow.bias)


def _constant(reading: Reading, shader: UsdShade.Shader, name: str, default: float, textures: Textures) -> float:
    got = _value(reading, shader, name, default, textures)
    if isinstance(got, TextureInput):
        reading.warn(shader.GetPath(), f"inputs:{name} takes no texture; {default:g} is used")
        return default
    number = float(got)
    if not np.isfinite(number):
        reading.warn(shader.GetPath(), f"inputs:{name} is {number}; {default:g} is used")
        return default
    return number


def _rgb(values: Any, default: Any) -> tuple[float, ...]:
    found = tuple(float(v) for v in values)
    return found if len(found) == 3 and np.isfinite(found).all() else default


def _clean(reading: Reading, prim: Usd.Prim, name: str, got: Any, default: float) -> float:
    number = float(got)
    inside = min(max(number, 0.0), 1.0) if np.isfinite(number) else default
    if inside != number:
        reading.warn(prim.GetPath(), f"inputs:{name} is {number:g}; {inside:g} is used")
    return inside
