"""Put a look on the materials of an asset: a layer over the asset, whose own files stay as they are."""

from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from pxr import Sdf, Usd, UsdShade

from scratchwarp import usd_schemas
from scratchwarp.stage.open import open_stage
from scratchwarp.stage.overlay import check_target, export, overlay, relative, reload
from scratchwarp.stage.validation import validate_stage
from scratchwarp.whole import whole

from .looks import LAYER, WEAR, Look, preset_material

VARIANT_SET = "wear"
_SURFACES = ("surface", "scratchwarp:surface")


def put_on(
    asset: Path | str, out: Path | str, look: Look, pattern: str = "", wear: str = "used", surface: bool = False
) -> dict[str, list[str]]:
    """Write ``out``, a layer over ``asset`` that adds the look to its materials.

    Args:
        asset: a USD file. out: .usda, .usdc or .usd; an earlier one is replaced.
        pattern: path or name of materials, with * and ?; "" is the only one there is.
        wear: which of new, used and worn is chosen.
        surface: whether the base surface of the preset takes the place of the material's own; a material that has
            none gets it anyway.

    Returns path of each material -> names of the layers it got.

    Raises:
        ValueError: no such material, a value that the schema does not allow, or ``out`` is a file of the asset.
        OSError: ``out`` cannot be written.
    """
    usd_schemas.register()
    target = Path(out)
    stage = open_stage(asset)
    check_target(stage, target)
    owners = materials(stage, asset, pattern)
    known = {(f.rule, f.message) for f in validate_stage(stage, core=False)}
    edits = Sdf.Layer.CreateAnonymous("look")
    stage.GetSessionLayer().subLayerPaths.insert(0, edits.identifier)
    stage.SetEditTarget(edits)
    made: dict[str, list[str]] = {}
    worn: dict[str, dict[str, Any]] = {state: {} for state in WEAR}
    for owner in owners:
        names, properties = _names(owner, look)
        _author(owner, look, names, properties, target.parent)
        if look.source and (surface or not UsdShade.Material(owner).GetSurfaceOutput().HasConnectedSource()):
            _copy_surface(owner, Path(look.source), edits)
        made[str(owner.GetPath())] = [names[layer] for layer in look.layers]
        for state, values in look.wear.items():
            worn[state] |= {f"{owner.GetPath()}{_relative(properties, name)}": v for name, v in values.items()}
    if look.wear:
        _author_wear(stage, asset, worn, wear, target.parent)
    layer = overlay(edits, stage.GetRootLayer(), target)
    layer.comment = "Scratches over an asset. Written by scratchwarp author."
    with whole(target) as draft:
        export(layer, draft, target)
        composed = Usd.Stage.Open(str(draft))
        for finding in validate_stage(composed, core=False):
            if finding.severity == "error" and (finding.rule, finding.message) not in known:
                raise ValueError(f"{target}: not written, for it would not be valid: {finding.message}")
    reload(target)
    return made


def materials(stage: Usd.Stage, asset: Path | str, pattern: str = "") -> list[Usd.Prim]:
    """The Materials that ``pattern`` means; ValueError with the paths there are where it means none, or where there
    are several and no pattern."""
    found = [p for p in Usd.PrimRange(stage.GetPseudoRoot(), Usd.TraverseInstanceProxies()) if p.IsA(UsdShade.Material)]
    if not found:
        raise ValueError(f"{asset}: has no Material to put scratches on; bind one to its meshes first")
    paths = ", ".join(str(prim.GetPath()) for prim in found)
    if not pattern and len(found) > 1:
        raise ValueError(f"{asset}: has {len(found)} materials: {paths}; choose by --material PATTERN ('*' is all)")
    meant = [p for p in found if not pattern or _matches(p, pattern)]
    if not meant:
        raise ValueError(f"{asset}: no material matches {pattern!r}; there are {paths}")
    for prim in meant:
        if prim.IsInstanceProxy():
            raise ValueError(
                f"{asset}: {prim.GetPath()} is shared by instances and cannot be changed from outside; give the file "
                "that defines it, or author instanceable = false"
            )
    return meant


def _matches(prim: Usd.Prim, pattern: str) -> bool:
    return fnmatchcase(str(prim.GetPath()), pattern) or fnmatchcase(prim.GetName(), pattern)


def _names(owner: Usd.Prim, look: Look) -> tuple[dict[str, str], dict[str, str]]:
    """Layer -> its name on the material, and layer prefix or profile -> the same there, all different from what the
    material has."""
    api = "ScratchLayerAPI:"
    taken = {s.removeprefix(api) for s in owner.GetAppliedSchemas() if s.startswith(api)}
    layers = {layer: _free(layer, taken) for layer in look.layers}
    children = {child.GetName() for child in owner.GetAllChildren()}
    profiles = {profile: _free(profile, children) for profile in look.profiles}
    return layers, {f"{LAYER}{old}:": f"{LAYER}{new}:" for old, new in layers.items()} | profiles


def _free(name: str, taken: set[str]) -> str:
    number, made = 1, name
    while made in taken:
        number += 1
        made = f"{name}{number}"
    taken.add(made)
    return made


def _relative(properties: Mapping[str, str], name: str) -> str:
    """A property of the look, as it is named on the material: ".scratch:..." or "/Profile.scratch:..."."""
    profile, dot, attribute = name.rpartition(".")
    if dot:
        return f"/{properties[profile]}.{attribute}"
    for old, new in properties.items():
        if old.endswith(":") and name.startswith(old):
            return f".{new}{name.removeprefix(old)}"
    return f".{name}"


def _author(
    owner: Usd.Prim, look: Look, names: Mapping[str, str], properties: Mapping[str, str], folder: Path
) -> None:
    """Everything of the look that wear does not change."""
    stage = owner.GetStage()
    for name in names.values():
        owner.ApplyAPI("ScratchLayerAPI", name)
    if look.wave:
        owner.ApplyAPI("ScratchWaveAPI")
    for profile in look.profiles:
        stage.DefinePrim(owner.GetPath().AppendChild(properties[profile]), "ScratchProfile")
    for (layer, relationship), profile in look.targets.items():
        path = owner.GetPath().AppendChild(properties[profile])
        owner.GetRelationship(f"{LAYER}{names[layer]}:{relationship}").SetTargets([path])
    varying = {name for values in look.wear.values() for name in values}
    for name, value in look.values.items():
        if name not in varying:
            _set(stage, f"{owner.GetPath()}{_relative(properties, name)}", value, folder)


def _author_wear(
    stage: Usd.Stage, asset: Path | str, worn: Mapping[str, Mapping[str, Any]], chosen: str, folder: Path
) -> None:
    """The variant set, on the root prims above the materials, where whoever references the asset finds it."""
    roots = dict.fromkeys(Sdf.Path(name).GetPrimPath().GetPrefixes()[0] for name in worn["used"])
    for path in roots:
        root = stage.GetPrimAtPath(path)
        variants = root.GetVariantSets()
        if VARIANT_SET in variants.GetNames():
            strange = sorted(set(variants.GetVariantSet(VARIANT_SET).GetVariantNames()) - set(WEAR))
            if strange:
                raise ValueError(f"{asset}: {path} has a variant set {VARIANT_SET!r} of its own, with {strange[0]!r}")
        wear = variants.AddVariantSet(VARIANT_SET)
        for state in WEAR:
            wear.AddVariant(state)
            wear.SetVariantSelection(state)
            with wear.GetVariantEditContext():
                for name, value in worn[state].items():
                    if Sdf.Path(name).HasPrefix(path):
                        _set(stage, name, value, folder)
        wear.SetVariantSelection(chosen)


def _set(stage: Usd.Stage, name: str, value: Any, folder: Path) -> None:
    """Give an attribute that a schema has its value; paths of files are made relative to ``folder``."""
    path = Sdf.Path(name)
    if isinstance(value, Sdf.AssetPath) and value.path:
        value = Sdf.AssetPath(relative(Path(value.resolvedPath or value.path), folder))
    attribute = stage.GetPrimAtPath(path.GetPrimPath()).GetAttribute(path.name)
    if not attribute.Set(value):
        raise ValueError(f"{name} does not take {value!r}")


def _copy_surface(owner: Usd.Prim, source: Path, edits: Sdf.Layer) -> None:
    """Connect the material to copies of the shaders of a preset."""
    preset = open_stage(source)
    from_prim = preset_material(preset, source)
    root = preset.GetRootLayer()
    taken = {child.GetName() for child in owner.GetAllChildren()}
    shaders = {c.GetName(): _free(c.GetName(), taken) for c in from_prim.GetChildren() if c.IsA(UsdShade.Shader)}
    for old, new in shaders.items():
        path = from_prim.GetPath().AppendChild(old)
        if root.GetPrimAtPath(path):
            Sdf.CopySpec(root, path, edits, owner.GetPath().AppendChild(new))
    for output in _SURFACES:
        attribute = from_prim.GetAttribute(f"outputs:{output}")
        for connected in attribute.GetConnections() if attribute else ():
            there = owner.GetPath().AppendChild(shaders[connected.GetPrimPath().name]).AppendProperty(connected.name)
            made = owner.CreateAttribute(f"outputs:{output}", Sdf.ValueTypeNames.Token, custom=False)
            made.SetConnections([there])
