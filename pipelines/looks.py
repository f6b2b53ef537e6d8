"""A look: scratch layers with their profiles, and how wear changes them; from a preset file or from attributes.

Preset files are ordinary USD: a Material as default prim, with layers, profiles, a surface and a variant set ``wear``.
Those that are shipped lie in the folder presets.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pxr import Sdf, Tf, Usd, UsdShade

from scratchwarp import usd_schemas
from scratchwarp.stage.open import open_stage

WEAR = ("new", "used", "worn")
USED = "used"
LAYER = "scratch:layer:"
WAVE = "scratch:wave:"
# Of each kind of value, what it is at new, used and worn in multiples of what it is at used.
FACTORS = {"amount": (0.35, 1.0, 2.2), "depth": (0.6, 1.0, 1.5), "rim": (0.5, 1.0, 1.4)}
_RELATIONSHIPS = ("profile", "profileEnd")
_BOOLS = {"true": True, "1": True, "on": True, "false": False, "0": False, "off": False}
_STATISTICAL = ("worley", "random")


@dataclass(frozen=True)
class Look:
    """Layers to be put on a material.

    Attributes:
        layers: names. profiles: names of ScratchProfile prims below the material.
        targets: (layer, relationship) -> profile.
        values: property -> value at wear ``used``; properties are named relative to the material:
            ``scratch:layer:<layer>:width``, ``<profile>.scratch:rim``.
        wear: "new", "used" and "worn" -> those values that are not the same in all three.
        wave: whether the material diffracts. source: the file of the preset, "" without one.
    """

    layers: tuple[str, ...]
    profiles: tuple[str, ...] = ()
    targets: Mapping[tuple[str, str], str] = field(default_factory=dict)
    values: Mapping[str, Any] = field(default_factory=dict)
    wear: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    wave: bool = False
    source: str = ""


def presets() -> dict[str, Path]:
    """Name -> file of the presets that are shipped."""
    return {path.stem: path for path in sorted((Path(__file__).parent / "presets").glob("*.usda"))}


def preset_path(name: str) -> Path:
    """The file of a preset: one that is shipped, or any USD file; ValueError with the names there are."""
    known = presets()
    if name in known:
        return known[name]
    if Path(name).suffix in (".usda", ".usdc", ".usd", ".usdz"):
        return Path(name)
    raise ValueError(f"preset {name!r} is neither a USD file nor one of {', '.join(known)}")


def about(path: Path) -> str:
    """The documentation of a preset file."""
    layer = Sdf.Layer.FindOrOpen(str(path))
    return " ".join(layer.pseudoRoot.GetInfo("documentation").split()) if layer else ""


def preset_material(stage: Usd.Stage, path: Path) -> Usd.Prim:
    """The Material of a preset; ValueError where it is not the default prim."""
    prim = stage.GetDefaultPrim()
    if not prim or not prim.IsA(UsdShade.Material):
        raise ValueError(f"{path}: its default prim is no Material; a preset is a Material with scratch layers")
    return prim


def read_preset(path: Path) -> Look:
    """The look of a preset file. StageError where it cannot be read, ValueError where it is no preset."""
    usd_schemas.register()
    stage = open_stage(path)
    prim = preset_material(stage, path)
    api = "ScratchLayerAPI:"
    layers = tuple(s.removeprefix(api) for s in prim.GetAppliedSchemas() if s.startswith(api))
    if not layers:
        raise ValueError(f"{path}: {prim.GetPath()} has no scratch layers")
    targets = {}
    for layer in layers:
        for name in _RELATIONSHIPS:
            for target in prim.GetRelationship(f"{LAYER}{layer}:{name}").GetTargets()[:1]:
                targets[layer, name] = target.name
    profiles = tuple(dict.fromkeys(targets.values()))
    states: dict[str, dict[str, Any]] = {}
    with_wear = "wear" in prim.GetVariantSets().GetNames()
    for wear in WEAR:
        if with_wear:
            prim.GetVariantSets().SetSelection("wear", wear)
        states[wear] = _values(prim, profiles)
    used = states[USED]
    varying = [name for name in used if any(states[wear].get(name) != used[name] for wear in WEAR)]
    worn = {wear: {name: states[wear][name] for name in varying if name in states[wear]} for wear in WEAR}
    wave = "ScratchWaveAPI" in prim.GetAppliedSchemas()
    return Look(layers, profiles, targets, used, worn if varying else {}, wave, str(path))


def plain_look(layer: str) -> Look:
    """A look of one layer with a profile, both as the schema has them."""
    if not Tf.IsValidIdentifier(layer) or not layer[0].islower():
        raise ValueError(f"layer {layer!r} is no name: a lower-case letter, then letters and digits")
    profile = f"{layer}Profile"
    return Look((layer,), (profile,), {(layer, "profile"): profile})


def with_values(look: Look, given: Sequence[str]) -> Look:
    """The look with attributes set: ``width=20`` in every layer, ``hairlines.width=20`` in one, ``profile.rim=0.2`` or
    ``hairlines.profile.rim=0.2`` in profiles, ``wave.coherenceRadius=60``.

    Wear follows what is set. ValueError names what no schema has.
    """
    values, wave, changed = dict(look.values), look.wave, set()
    for text in given:
        key, equals, value = text.partition("=")
        if not equals or not key:
            raise ValueError(f"{text!r} is not NAME=VALUE, such as width=20 or hairlines.width=20")
        head, _, rest = key.rpartition(".")
        if head == "wave":
            wave = True
            names = [f"{WAVE}{rest}"]
        else:
            names = _properties(look, head, rest)
        for name in names:
            values[name] = _parsed(name, value)
            changed.add(name)
    return replace(look, values=values, wave=wave, wear=_wear(look, values, changed))


def _properties(look: Look, head: str, attribute: str) -> list[str]:
    """Properties that a key of the command line means."""
    layer, _, part = head.partition(".")
    if layer == "profile" and layer not in look.layers:
        layer, part = "", "profile"
    if layer and layer not in look.layers:
        raise ValueError(f"{head}.{attribute}: there is no layer {layer!r}, only {', '.join(look.layers)}")
    layers = [layer] if layer else list(look.layers)
    if part in ("", "profile"):
        if not part:
            return [f"{LAYER}{name}:{attribute}" for name in layers]
        found = [look.targets[name, "profile"] for name in layers if (name, "profile") in look.targets]
        return [f"{profile}.scratch:{attribute}" for profile in dict.fromkeys(found)]
    raise ValueError(f"{head}.{attribute}: after the layer comes an attribute, or profile and one of its attributes")


def _wear(look: Look, values: Mapping[str, Any], changed: set[str]) -> dict[str, dict[str, Any]]:
    """Wear of what the preset says, but for what is changed: that is scaled, as is a look without a preset."""
    kept = {w: {n: v for n, v in look.wear.get(w, {}).items() if n not in changed} for w in WEAR}
    for layer in look.layers:
        prefix = f"{LAYER}{layer}:"
        if values.get(f"{prefix}distribution", "worley") not in _STATISTICAL:
            continue  # regular patterns are machined, and explicit curves are drawn: wear does not move them
        density = values.get(f"{prefix}density", 0.0) > 0.0
        amount = f"{prefix}density" if density else f"{prefix}coverage"
        rim = f"{look.targets.get((layer, 'profile'))}.scratch:rim"
        if density:  # which wins over coverage
            kept = {w: {n: v for n, v in kept[w].items() if n != f"{prefix}coverage"} for w in WEAR}
        for name, kind, fallback in ((amount, "amount", 0.1), (f"{prefix}depth", "depth", 1.0), (rim, "rim", 0.0)):
            value = values.get(name, fallback)
            if (look.source and name not in changed) or not value:
                continue
            for wear, factor in zip(WEAR, FACTORS[kind], strict=True):
                share = name.endswith(":coverage")
                worn = 1.0 - (1.0 - min(max(value, 0.0), 1.0)) ** factor if share else value * factor
                kept[wear][name] = value if wear == USED else float(f"{worn:.6g}")
    return kept if any(kept.values()) else {}


def _values(prim: Usd.Prim, profiles: Sequence[str]) -> dict[str, Any]:
    """What a preset authors on its material and its profiles, under our schemas."""
    found: dict[str, Any] = {}
    for owner, prefix in [(prim, ""), *((prim.GetChild(name), f"{name}.") for name in profiles)]:
        if not owner:
            raise ValueError(f"{prim.GetPath()}: its profile {prefix[:-1]} is no prim below it")
        for attribute in owner.GetAuthoredAttributes():
            if attribute.GetName().startswith("scratch:") and attribute.HasAuthoredValue():
                found[f"{prefix}{attribute.GetName()}"] = attribute.Get()
    return found


def _parsed(name: str, text: str) -> Any:
    """``text`` as the value of a property of our schemas; ValueError where it cannot be one."""
    registry = Usd.SchemaRegistry()
    usd_schemas.register()
    owner, _, plain = name.rpartition(".")
    if owner:
        definition = registry.FindConcretePrimDefinition("ScratchProfile")
        wanted = plain
    elif name.startswith(WAVE):
        definition, wanted = registry.FindAppliedAPIPrimDefinition("ScratchWaveAPI"), name
    else:
        definition = registry.FindAppliedAPIPrimDefinition("ScratchLayerAPI")
        wanted = f"{LAYER}__INSTANCE_NAME__:{name.rpartition(':')[2]}"
    attribute = definition.GetAttributeDefinition(wanted)
    short = name.rpartition(":")[2]
    if not attribute:
        known = [n.rpartition(":")[2] for n in definition.GetPropertyNames() if n.startswith("scratch:")]
        raise ValueError(f"there is no attribute {short!r}; the schema has {', '.join(known)}")
    kind = attribute.GetTypeName()
    try:
        return _value(kind, text)
    except (ValueError, TypeError):
        raise ValueError(f"{short}={text}: {text!r} is no {kind}") from None


def _value(kind: Sdf.ValueTypeName, text: str) -> Any:
    scalar = str(kind.scalarType)
    if kind.isArray and scalar == "float2":
        numbers = [float(x) for x in text.replace(",", " ").split()]
        return [tuple(pair) for pair in zip(numbers[::2], numbers[1::2], strict=True)]
    if scalar in ("token", "string"):
        return text
    if scalar == "asset":
        return Sdf.AssetPath(str(Path(text).resolve()))
    if scalar == "bool":
        if text.lower() not in _BOOLS:
            raise ValueError(text)
        return _BOOLS[text.lower()]
    if scalar == "int":
        return int(text)
    numbers = [float(x) for x in text.replace(",", " ").split()]
    if kind.isArray:
        return numbers
    wanted = {"float2": 2, "float3": 3, "color3f": 3}.get(scalar, 1)
    if len(numbers) != wanted:
        raise ValueError(text)
    return numbers[0] if wanted == 1 else tuple(numbers)
