"""The attributes of materials, lights and the camera as controls, with what their schemas say of them."""

import re
from collections.abc import Iterator
from typing import Any

from pxr import Gf, Sdf, Sdr, Usd, UsdGeom, UsdLux, UsdShade

from scratchwarp.scene import Control
from scratchwarp.usd_schemas import register_shaders

from .material import RENDER_CONTEXT

_LAYER = "scratch:layer:"
_KINDS = {
    "bool": "switch",
    "int": "whole",
    "float": "number",
    "double": "number",
    "float2": "pair",
    "float3": "triple",
    "color3f": "color",
    "token": "name",
    "string": "name",
}
# UsdLux and UsdGeom say no ranges: the ends of their sliders.
_RANGES = {
    "inputs:intensity": (0.0, 100.0),
    "inputs:exposure": (-10.0, 10.0),
    "inputs:color": (0.0, 1.0),
    "inputs:colorTemperature": (1000.0, 10000.0),
    "inputs:diffuse": (0.0, 2.0),
    "inputs:specular": (0.0, 2.0),
    "inputs:radius": (0.0, 1.0),
    "inputs:width": (0.0, 1.0),
    "inputs:height": (0.0, 1.0),
    "inputs:length": (0.0, 1.0),
    "inputs:angle": (0.0, 180.0),
    "inputs:roughness": (0.0, 1.0),
    "inputs:anisotropy": (-1.0, 1.0),
    "inputs:anisotropyRotation": (0.0, 1.0),
    "inputs:metallic": (0.0, 1.0),
    "inputs:clearcoat": (0.0, 1.0),
    "inputs:clearcoatRoughness": (0.0, 1.0),
    "inputs:opacity": (0.0, 1.0),
    "inputs:opacityThreshold": (0.0, 1.0),
    "inputs:ior": (1.0, 3.0),
    "inputs:diffuseColor": (0.0, 1.0),
    "inputs:specularColor": (0.0, 1.0),
    "inputs:emissiveColor": (0.0, 1.0),
    "exposure": (-10.0, 10.0),
    "focalLength": (10.0, 200.0),
    "fStop": (0.0, 22.0),
}
# What must not be below 0 although no schema says so.
_NOT_NEGATIVE = {
    "inputs:radius", "inputs:width", "inputs:height", "inputs:length", "inputs:angle", "inputs:intensity", "fStop",
    "focusDistance", "focalLength", "inputs:colorTemperature",
}  # fmt: skip
_LIGHT = (
    "inputs:intensity", "inputs:exposure", "inputs:color", "inputs:enableColorTemperature", "inputs:colorTemperature",
    "inputs:normalize", "inputs:diffuse", "inputs:specular", "inputs:radius", "inputs:width", "inputs:height",
    "inputs:length", "inputs:angle",
)  # fmt: skip
_FIRST = (
    "enabled", "order", "shape", "width", "depth", "coverage", "density", "pitch", "length", "angle", "angleSpread",
    "curvature", "material", "metal", "fresnelModel", "ior", "distribution", "model", "patterns", "space",
)  # fmt: skip
_CAMERA = ("focalLength", "exposure", "fStop", "focusDistance")


def material_controls(prim: Usd.Prim, time: Usd.TimeCode) -> Iterator[Control]:
    """Of a material: its layers, their profiles and curves, wave optics, a measured base, constants of its surface."""
    below: dict[tuple[str, Sdf.Path], Usd.Prim] = {}
    for name in layer_names(prim):
        for attribute in _attributes(prim, f"{_LAYER}{name}:"):
            yield control(attribute, "layer", f"{prim.GetPath()} {name}", time)
        for section, relationships in (("profile", ("profile", "profileEnd")), ("curves", ("curves",))):
            for target in _targets(prim, name, relationships):
                found = prim.GetStage().GetPrimAtPath(target)
                if found and not found.IsInstanceProxy():
                    below[section, target] = found
    for (section, path), found in below.items():
        for attribute in _attributes(found, "scratch:"):
            yield control(attribute, section, str(path), time)
    for section in ("wave", "measured"):
        if f"Scratch{section.title()}API" in prim.GetAppliedSchemas():
            for attribute in _attributes(prim, f"scratch:{section}:"):
                yield control(attribute, section, str(prim.GetPath()), time)
    yield from _surface_controls(prim, time)


def settings_controls(prim: Usd.Prim, time: Usd.TimeCode) -> Iterator[Control]:
    """Of a RenderSettings prim: what the renderer is asked for."""
    for attribute in _attributes(prim, "scratch:render:"):
        yield control(attribute, "settings", str(prim.GetPath()), time)


def _targets(prim: Usd.Prim, name: str, relationships: tuple[str, ...]) -> list[Sdf.Path]:
    """Paths of the prims that a layer's relationships name."""
    found = [prim.GetRelationship(f"{_LAYER}{name}:{which}") for which in relationships]
    return [target for relationship in found if relationship for target in relationship.GetForwardedTargets()]


def light_controls(prim: Usd.Prim, time: Usd.TimeCode) -> Iterator[Control]:
    """Of a light: how much it sheds, its colour and size."""
    for name in _LIGHT:
        attribute = prim.GetAttribute(name)
        if attribute:
            yield control(attribute, "light", str(prim.GetPath()), time)


def camera_controls(prim: Usd.Prim, time: Usd.TimeCode) -> Iterator[Control]:
    """Of a camera: lens and exposure."""
    for name in _CAMERA:
        attribute = prim.GetAttribute(name)
        if attribute:
            yield control(attribute, "camera", str(prim.GetPath()), time)


def layer_names(prim: Usd.Prim) -> list[str]:
    """Instance names of the ScratchLayerAPIs that a material has, also of the disabled ones."""
    schema = "ScratchLayerAPI:"
    return [s.removeprefix(schema) for s in prim.GetAppliedSchemas() if s.startswith(schema)]


def control(attribute: Usd.Attribute, section: str, owner: str, time: Usd.TimeCode) -> Control:
    """One attribute as a control, by the metadata of its schema."""
    name, base = attribute.GetName(), str(attribute.GetTypeName())
    choices = tuple(str(token) for token in attribute.GetMetadata("allowedTokens") or ())
    kind = "choice" if choices else _KINDS.get(base, "fixed")
    limits = attribute.GetMetadata("limits") or {}
    hard, soft = limits.get("hard", {}), limits.get("soft", {})
    definition = attribute.GetPrim().GetPrimDefinition().GetAttributeDefinition(name)
    default = _plain(definition.GetFallbackValue()) if definition else None
    value = _plain(attribute.Get(time))
    value = default if value is None else value
    if value is None and kind in ("switch", "pair", "triple", "color"):
        kind = "fixed"
    low = soft.get("minimum", hard.get("minimum", _RANGES.get(name, (None, None))[0]))
    high = soft.get("maximum", hard.get("maximum", _RANGES.get(name, (None, None))[1]))
    low, high = _ends(low, high, value, default)
    return Control(
        id=str(attribute.GetPath()),
        section=section,
        owner=owner,
        label=attribute.GetDisplayName() or _words(name),
        kind=kind,
        value=value,
        default=default,
        group=attribute.GetDisplayGroup(),
        documentation=attribute.GetDocumentation() or "",
        units=_units(attribute),
        low=low,
        high=high,
        least=hard.get("minimum", 0.0 if name in _NOT_NEGATIVE else None),
        most=hard.get("maximum"),
        open_least=bool(hard.get("exclusiveMinimum")),
        open_most=bool(hard.get("exclusiveMaximum")),
        choices=choices,
    )


def author(attribute: Usd.Attribute, value: Any) -> None:
    """Set an attribute to a value that a control has checked."""
    if isinstance(value, tuple):
        value = Gf.Vec2f(*value) if len(value) == 2 else Gf.Vec3f(*value)
    attribute.Set(value)


def _attributes(prim: Usd.Prim, prefix: str) -> list[Usd.Attribute]:
    """Those that are turned most first, the rest by name."""
    found = [a for a in prim.GetAttributes() if a.GetName().startswith(prefix)]
    order = {name: i for i, name in enumerate(_FIRST)}
    return sorted(found, key=lambda a: (order.get(a.GetName().removeprefix(prefix), len(order)), a.GetName()))


def _surface_controls(prim: Usd.Prim, time: Usd.TimeCode) -> Iterator[Control]:
    register_shaders()
    shader, _, _ = UsdShade.Material(prim).ComputeSurfaceSource(RENDER_CONTEXT)
    node = Sdr.Registry().GetShaderNodeByIdentifier(str(shader.GetShaderId() or "")) if shader else None
    if not node or shader.GetPrim().IsInstanceProxy():
        return
    for name in node.GetShaderInputNames():
        given = shader.GetInput(name)
        if given and given.HasConnectedSource():
            continue
        described = node.GetShaderInput(name)
        choices = tuple(str(option[0]) for option in described.GetOptions())
        default = _plain(described.GetDefaultValueAsSdfType())
        base = str(described.GetTypeAsSdfType().GetSdfType())
        value = _plain(given.Get(time)) if given else None
        value = default if value is None else value
        kind = "choice" if choices else _KINDS.get(base, "fixed")
        if kind == "fixed" or value is None or (kind == "name" and not choices):
            continue
        least, most = _RANGES.get(f"inputs:{name}", (None, None))
        low, high = _ends(least, most, value, default)
        yield Control(
            id=f"{shader.GetPath()}.inputs:{name}",
            section="surface",
            owner=str(shader.GetPath()),
            label=_words(name),
            kind=kind,
            value=value,
            default=default,
            group="Surface",
            documentation=str(described.GetHelp() or ""),
            low=low,
            high=high,
            choices=choices,
        )


def surface_attribute(stage: Usd.Stage, path: Sdf.Path) -> Usd.Attribute:
    """The attribute of a shader's input, made where it has no opinion yet."""
    shader = UsdShade.Shader(stage.GetPrimAtPath(path.GetPrimPath()))
    name = path.name.removeprefix("inputs:")
    found = shader.GetInput(name)
    if found:
        return found.GetAttr()
    node = Sdr.Registry().GetShaderNodeByIdentifier(str(shader.GetShaderId()))
    return shader.CreateInput(name, node.GetShaderInput(name).GetTypeAsSdfType().GetSdfType()).GetAttr()


def is_light(prim: Usd.Prim) -> bool:
    """Whether a prim is a light that can be turned: any but a shape that shines or one inside an instance."""
    return prim.HasAPI(UsdLux.LightAPI) and not prim.IsA(UsdGeom.Gprim) and not prim.IsInstanceProxy()


def _plain(value: Any) -> Any:
    """A value as JSON has it; None for what it has not."""
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, Gf.Vec2f | Gf.Vec3f | Gf.Vec2d | Gf.Vec3d):
        return tuple(float(part) for part in value)
    if isinstance(value, Sdf.AssetPath):
        return value.path
    return None


def _ends(low: float | None, high: float | None, value: Any, default: Any) -> tuple[float, float]:
    """Ends of a slider that reaches the value and the default."""
    numbers = [n for v in (value, default) for n in (v if isinstance(v, tuple) else (v,)) if _is_number(n)]
    top = max((abs(n) for n in numbers), default=0.0)
    low = (0.0 if min(numbers, default=0.0) >= 0.0 else -2.0 * top) if low is None else float(low)
    high = (2.0 * top or 1.0) if high is None else float(high)
    return min([low, *numbers]), max([high, *numbers])


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _units(attribute: Usd.Attribute) -> str:
    said = attribute.GetMetadata("scratchUnits")
    return "" if said in (None, "none") else str(said)


def _words(name: str) -> str:
    """``inputs:clearcoatRoughness`` as words."""
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name.rsplit(":", 1)[-1])
    return spaced[:1].upper() + spaced[1:]
