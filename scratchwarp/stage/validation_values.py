"""Rules about single values: tokens, ranges, numbers that are none; on prims and on ScratchSurface shaders."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from pxr import Sdf, Usd, UsdShade

from scratchwarp import usd_schemas

from .validation_rule import Problem, Rule, did_you_mean, scratch_properties, times


def interval(limits: dict[str, Any]) -> str:
    """Hard limits as text, for example ``(0, inf)``."""
    low = f"{limits['minimum']:g}" if "minimum" in limits else "-inf"
    high = f"{limits['maximum']:g}" if "maximum" in limits else "inf"
    left = "(" if limits.get("exclusiveMinimum") or low == "-inf" else "["
    right = ")" if limits.get("exclusiveMaximum") or high == "inf" else "]"
    return f"{left}{low}, {high}{right}"


def outside(values: np.ndarray, limits: dict[str, Any]) -> np.ndarray:
    """Mask of the ``values`` beyond hard ``limits``, which are float32 as the values are."""
    low, high = np.float32(limits.get("minimum", -np.inf)), np.float32(limits.get("maximum", np.inf))
    bad = (values < low) | (values > high)
    if limits.get("exclusiveMinimum"):
        bad |= values <= low
    if limits.get("exclusiveMaximum"):
        bad |= values >= high
    return bad


def numbers(held: Any) -> np.ndarray | None:
    """A value as a flat array of floats; None for a value that is not numeric."""
    array = np.asarray(held)
    return array.astype(float).ravel() if array.dtype.kind in "fiu" else None


def first_bad(held: Any, limits: dict[str, Any]) -> tuple[str, float, bool] | None:
    """The first number that is not finite or out of limits: where it stands, its value, whether it is finite."""
    array = numbers(held)
    if array is None or array.size == 0:
        return None
    for bad, finite in ((~np.isfinite(array), False), (outside(array, limits), True)):
        if bad.any():
            at = int(np.argmax(bad))
            width = int(np.prod(np.asarray(held).shape[1:])) if np.ndim(held) else 1
            return (f"[{at // width}]" if np.ndim(held) else ""), float(array[at]), finite
    return None


def describe(definition: Any, name: str) -> tuple[list[str], dict[str, Any], str]:
    """Tokens, hard limits and unit that the schema gives an attribute."""
    tokens = definition.GetMetadata("allowedTokens") or []
    limits = (definition.GetMetadata("limits") or {}).get("hard", {})
    unit = definition.GetMetadata("scratchUnits")
    return list(tokens), limits, "" if unit in (None, "none") else f" {unit}"


def check_value(attribute: Usd.Attribute, tokens: list[str], limits: dict[str, Any], unit: str) -> Iterator[Problem]:
    """The first problem with the value of an attribute, over all its times."""
    name, path = attribute.GetName(), attribute.GetPath()
    for time in times(attribute):
        held = attribute.Get(time)
        if held is None:
            continue
        when = "" if time.IsDefault() else f" at time {time.GetValue():g}"
        if tokens and held not in tokens:
            yield Problem(path, f"{name} is {str(held)!r}{when}; {did_you_mean(str(held), tokens)}")
            return
        bad = None if isinstance(held, str) else first_bad(held, limits)
        if bad:
            where, number, finite = bad
            wanted = f"a value in {interval(limits)}{unit}" if finite or limits else "a finite number"
            yield Problem(path, f"{name}{where} is {number:g}{when}; author {wanted}")
            return


def check_values(prim: Usd.Prim) -> Iterator[Problem]:
    """Values that are no allowed token, not finite, or beyond the hard limits of the schema."""
    definition = prim.GetPrimDefinition()
    for prop in scratch_properties(prim):
        known = definition.GetAttributeDefinition(prop.GetName())
        if known and isinstance(prop, Usd.Attribute):
            yield from check_value(prop, *describe(known, prop.GetName()))


def node_definition() -> tuple[Sdf.Layer, Sdf.PrimSpec]:
    """The shader definition of ScratchSurface, with the layer that must outlive it."""
    layer = Sdf.Layer.FindOrOpen(str(usd_schemas.shader_definitions()))
    return layer, layer.GetPrimAtPath("/ScratchSurface")


def check_surface(prim: Usd.Prim) -> Iterator[Problem]:
    """Inputs of a ScratchSurface shader that it does not have, or with bad values."""
    if UsdShade.Shader(prim).GetShaderId() != "ScratchSurface":
        return
    layer, node = node_definition()
    known = [name for name in node.attributes.keys() if name.startswith("inputs:")]
    for name in prim.GetAuthoredPropertyNames():
        if not name.startswith("inputs:"):
            continue
        attribute = prim.GetAttribute(name)
        if name not in known:
            yield Problem(attribute.GetPath(), f"{name} is unknown to ScratchSurface; {did_you_mean(name, known)}")
            continue
        spec = node.attributes[name]
        limits = (spec.GetInfo("limits") or {}).get("hard", {})
        yield from check_value(attribute, list(spec.allowedTokens or []), limits, "")


RULES = (
    Rule("ScratchValues", "Values are allowed tokens, finite and within the limits of the schema.", check_values),
    Rule("ScratchSurface", "ScratchSurface shaders have known, good inputs.", check_surface, ("UsdShadeShader",)),
)
