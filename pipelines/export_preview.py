"""The look of scratched materials as UsdPreviewSurface with baked textures, in a layer over the stage.

``outputs:surface`` of a material becomes the baked network, which every renderer knows; what it was before goes to
``outputs:scratchwarp:surface``, which scratchwarp reads first, so that our own pictures stay as they are. The layer
opens without scratchwarp's schemas.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pxr import Gf, Sdf, Tf, Usd, UsdShade

from scratchwarp import usd_schemas
from scratchwarp.stage.open import open_stage
from scratchwarp.stage.overlay import check_target, overlay, save_layer

from . import texture_files
from .baked_look import Look, isotropic, lay_out, nearest, plan_tables
from .fates import lost

Array = np.ndarray

OURS = "scratchwarp:surface"
_KINDS = {"color": "diffuseColor", "roughness": "roughness", "metallic": "metallic", "normal": "normal"}


@dataclass(frozen=True, eq=False)
class Baked:
    """A material's look: ``maps`` color [h, w, 3], roughness, metallic, slope; and the Look they come from."""

    look: Look
    maps: Mapping[str, Array]


def bake(scene: Any, settings: Any, longest: int, density: float, pattern: str = "") -> list[Baked]:
    """Every scratched material of a scene that ``pattern`` (path or name with * and ?) means; ValueError where there
    is none."""
    plan = plan_tables(scene, settings)
    made = []
    for number in scratched(scene, pattern):
        look = lay_out(scene, plan, number, longest, density)
        made.append(Baked(look, isotropic(look, nearest(look, plan.tables))))
    return made


def scratched(scene: Any, pattern: str = "") -> list[int]:
    """Numbers of the materials with scratches that geometry uses, that ``pattern`` means; ValueError where there is
    none."""
    from fnmatch import fnmatchcase

    from .baked_look import first_user

    found = []
    for number, material in enumerate(scene.materials):
        names = (material.path, material.path.rsplit("/", 1)[-1])
        meant = not pattern or any(fnmatchcase(name, pattern) for name in names)
        if meant and material.layers and first_user(scene, number) >= 0:
            found.append(number)
    if not found:
        which = f" that {pattern!r} means" if pattern else ""
        raise ValueError(f"{scene.path}: no bound material{which} has scratches; scratchwarp author puts some on")
    return found


def chosen(source: Path | str, variants: str) -> Iterator[tuple[str, str | None]]:
    """(variant, session layer that chooses it) of a set on root prims; ("", None) without one."""
    from .contact_sheet import sessions

    stage = open_stage(source)
    if variants and any(variants in p.GetVariantSets().GetNames() for p in stage.GetPseudoRoot().GetChildren()):
        yield from sessions(str(source), variants)
    else:
        yield "", None


def write(
    source: Path | str,
    target: Path,
    settings: Any,
    longest: int = 512,
    density: float = 0.0,
    pattern: str = "",
    variants: str = "",
) -> tuple[list[dict[str, Any]], list[str]]:
    """Write ``target``, a layer over ``source``, and its textures into the folder textures beside it.

    ``longest``, ``density``: of ``baked_look.lay_out``; ``variants``: a set, such as wear, of which every variant gets
    textures of its own. Returns a record of each material, and notes; without a material nothing is written. Raises
    ValueError where no material has scratches, OSError where something cannot be written.
    """  # fmt: skip
    import scratchwarp as sw

    usd_schemas.register()
    stage = open_stage(source)
    check_target(stage, target)
    edits = Sdf.Layer.CreateAnonymous("preview")
    stage.GetSessionLayer().subLayerPaths.insert(0, edits.identifier)
    stage.SetEditTarget(edits)
    states: dict[str, list[Baked]] = {}
    for name, session in chosen(source, variants):
        states[name] = bake(sw.read(source, session_layer=session), settings, longest, density, pattern)
    looks = [baked.look for one in states.values() for baked in one]
    notes = [note for look in looks for note in (*look.notes, *lost(look.fates, rough=True))]
    records = []
    first = next(iter(states.values()))
    for number, baked in enumerate(first):
        prim = stage.GetPrimAtPath(baked.look.path)
        if not prim or prim.IsInstanceProxy():
            notes.append(
                f"{baked.look.path}: is shared by instances and cannot be changed from outside; it is left out"
            )
            continue
        every = {name: one[number] for name, one in states.items() if number < len(one)}
        files = _author(UsdShade.Material(prim), every, target, variants)
        width, height = baked.look.size
        records.append({
            "material": baked.look.path, "texels": [width, height], "texel_um": list(baked.look.texel),
            "textures": sorted(files), "variants": [name for name in every if name],
        })  # fmt: skip
    if records:
        layer = overlay(edits, stage.GetRootLayer(), target)
        layer.comment = "Baked UsdPreviewSurface looks over a stage. Written by scratchwarp."
        save_layer(layer, target)
    return records, list(dict.fromkeys(notes))


def _author(material: UsdShade.Material, states: Mapping[str, Baked], target: Path, variants: str) -> set[str]:
    """The network of a material, and its textures on disk; returns their names."""
    prim = material.GetPrim()
    stage, path = prim.GetStage(), prim.GetPath()
    _keep(material)
    taken = {child.GetName() for child in prim.GetAllChildren()}

    def shader(name: str, kind: str) -> UsdShade.Shader:
        made, number = f"Baked{name}", 1
        while made in taken:
            number += 1
            made = f"Baked{name}{number}"
        taken.add(made)
        node = UsdShade.Shader.Define(stage, path.AppendChild(made))
        node.CreateIdAttr(kind)
        return node

    some = next(iter(states.values()))
    surface = shader("Surface", "UsdPreviewSurface")
    base = some.look.base
    constants = {"ior": base["ior"], "clearcoat": base["clearcoat"], "opacity": base["opacity"]}
    constants["clearcoatRoughness"] = np.sqrt(base["clearcoat_alpha"])
    for name, value in constants.items():
        surface.CreateInput(name, Sdf.ValueTypeNames.Float).Set(float(np.mean(value)))
    glow = np.asarray(base["emissive"], float).reshape(-1, 3).mean(0)
    if glow.max() > 0.0:
        surface.CreateInput("emissiveColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(*map(float, glow)))
    if base["specular_color"] is not None:
        f0 = np.asarray(base["specular_color"], float).reshape(-1, 3).mean(0)
        surface.CreateInput("useSpecularWorkflow", Sdf.ValueTypeNames.Int).Set(1)
        surface.CreateInput("specularColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(*map(float, f0)))
    material.CreateSurfaceOutput().ConnectToSource(surface.CreateOutput("surface", Sdf.ValueTypeNames.Token))

    coordinates = None
    files: set[str] = set()
    stem = Tf.MakeValidIdentifier(str(path).strip("/").replace("/", "_"))
    for name, entry in _KINDS.items():
        values = {state: _map(one, name) for state, one in states.items()}
        textured = some.look.mapped and any(texture_files.varies(v) for v in values.values())
        if not textured and name == "normal":
            continue
        is_color, kind = name == "color", Sdf.ValueTypeNames.Float
        if name in ("color", "normal"):
            kind = Sdf.ValueTypeNames.Color3f if is_color else Sdf.ValueTypeNames.Normal3f
        given = surface.CreateInput(entry, kind)
        if not textured:
            means = {state: texture_files.mean(v) for state, v in values.items()}
            plain = {s: Gf.Vec3f(*map(float, m)) if is_color else float(m) for s, m in means.items()}
            _set(given.GetAttr(), plain, variants)
            continue
        if coordinates is None:
            coordinates = _coordinates(shader, some.look)
        node = shader(name.capitalize(), "UsdUVTexture")
        paths = {}
        for state, pixels in values.items():
            suffix = f"_{state}" if state else ""
            file = texture_files.write(target.parent / "textures" / f"{stem}_{name}{suffix}.png", pixels, is_color)
            files.add(f"textures/{file.name}")
            paths[state] = Sdf.AssetPath(f"./textures/{file.name}")
        _set(node.CreateInput("file", Sdf.ValueTypeNames.Asset).GetAttr(), paths, variants)
        node.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("sRGB" if is_color else "raw")
        wrap = "repeat" if some.look.window == (0.0, 0.0, 1.0, 1.0) else "clamp"
        for side in ("wrapS", "wrapT"):
            node.CreateInput(side, Sdf.ValueTypeNames.Token).Set(wrap)
        if name == "normal":
            node.CreateInput("scale", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(2, 2, 2, 1))
            node.CreateInput("bias", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(-1, -1, -1, 0))
        node.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(coordinates)
        channel, out = ("rgb", Sdf.ValueTypeNames.Float3) if name in ("color", "normal") else ("r", kind)
        given.ConnectToSource(node.CreateOutput(channel, out))
    return files


def _map(baked: Baked, name: str) -> Array:
    return texture_files.normals(baked.maps["slope"]) if name == "normal" else baked.maps[name]


def _coordinates(shader: Any, look: Look) -> UsdShade.Output:
    """The output that the textures read their place from."""
    reader = shader("St", "UsdPrimvarReader_float2")
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
    result = reader.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    u0, v0, u1, v1 = look.window
    if look.window == (0.0, 0.0, 1.0, 1.0):
        return result
    moved = shader("Window", "UsdTransform2d")
    moved.CreateInput("in", Sdf.ValueTypeNames.Float2).ConnectToSource(result)
    moved.CreateInput("scale", Sdf.ValueTypeNames.Float2).Set(Gf.Vec2f(1 / (u1 - u0), 1 / (v1 - v0)))
    moved.CreateInput("translation", Sdf.ValueTypeNames.Float2).Set(Gf.Vec2f(-u0 / (u1 - u0), -v0 / (v1 - v0)))
    return moved.CreateOutput("result", Sdf.ValueTypeNames.Float2)


def _keep(material: UsdShade.Material) -> None:
    """Let scratchwarp read the surface that it reads now, whatever ``outputs:surface`` becomes."""
    if material.GetPrim().GetAttribute(f"outputs:{OURS}").HasAuthoredConnections():
        return
    shader, name, _ = material.ComputeSurfaceSource("scratchwarp")
    known = shader and str(shader.GetShaderId() or "") in ("UsdPreviewSurface", "ScratchSurface")
    if not known:  # what stands for it: grey
        shader = UsdShade.Shader.Define(material.GetPrim().GetStage(), material.GetPath().AppendChild("Unbaked"))
        shader.CreateIdAttr("UsdPreviewSurface")
        shader.CreateOutput("surface", Sdf.ValueTypeNames.Token)
        name = "surface"
    output = material.CreateSurfaceOutput("scratchwarp")
    output.ConnectToSource(shader.ConnectableAPI(), str(name))


def _set(attribute: Usd.Attribute, values: Mapping[str, Any], variants: str) -> None:
    """One value, or one for each variant of a set on the root prim; a value of their own also for who knows none."""
    stage = attribute.GetPrim().GetStage()
    if list(values) == [""]:
        attribute.Set(values[""])
        return
    root = stage.GetPrimAtPath(attribute.GetPath().GetPrefixes()[0].GetPrimPath())
    owner = root.GetVariantSets().GetVariantSet(variants)
    before = owner.GetVariantSelection()
    for state, value in values.items():
        owner.AddVariant(state)
        owner.SetVariantSelection(state)
        with owner.GetVariantEditContext():
            attribute.Set(value)
    owner.SetVariantSelection(before)


def without_scratches(source: Path, materials: Sequence[str], folder: Path) -> Path:
    """A session layer in ``folder`` that shows the baked surfaces of ``materials`` alone, as other renderers do."""
    stage = open_stage(source)
    layer = Sdf.Layer.CreateNew(str(folder / "without_scratches.usda"))
    for path in materials:
        prim = stage.GetPrimAtPath(path)
        over = Sdf.CreatePrimInLayer(layer, path)
        kept = [s for s in prim.GetAppliedSchemas() if not s.startswith("Scratch")]
        over.SetInfo("apiSchemas", Sdf.TokenListOp.CreateExplicit(kept))
        surface = UsdShade.Material(prim).GetSurfaceOutput()
        connected = surface.GetAttr().GetConnections()
        attribute = Sdf.AttributeSpec(over, f"outputs:{OURS}", Sdf.ValueTypeNames.Token)
        attribute.connectionPathList.explicitItems = connected
    layer.Save()
    return folder / "without_scratches.usda"
