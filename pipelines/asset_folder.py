"""The folder of a published asset, as the USD working group lays it out.

<name>.usda          entry: default prim with kind, assetInfo, extents hint, and a payload
contents/            the stage and every file it needs, by relative paths; baked surfaces over it
thumbnails/<name>.*  picture of the asset
<name>.usdz          all of it in one file
manifest.json        path, size and SHA-256 of every other file
"""

import hashlib
import json
import os
import shutil
import struct
import uuid
import zipfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pxr import Kind, Sdf, Tf, Usd, UsdGeom, UsdMedia, UsdUtils

from scratchwarp import usd_schemas
from scratchwarp.stage.open import open_stage
from scratchwarp.stage.overlay import copy_metadata
from scratchwarp.stage.validation import validate_stage

from .gather import gather

MANIFEST = "manifest.json"
_BEGINNING = struct.pack("<2H", 0, 0x21)  # of the times that a zip file can say
Draw = Callable[[Path, Path], None]
Bake = Callable[[Path], tuple[Path, list[str]]]


@contextmanager
def replaced(target: Path, source: str | Path, mark: str = MANIFEST) -> Iterator[Path]:
    """A new folder that takes the place of ``target`` when the block ends well, and is removed when it raises.

    ``mark``: file by which a folder is known that was made so. ValueError where ``target`` holds other files, or files
    of the stage ``source``; OSError where it cannot be written.
    """
    target = target.resolve()
    stage = open_stage(source)
    used = [Path(layer.realPath).resolve() for layer in stage.GetUsedLayers() if layer.realPath]
    inside = [path for path in used if path.is_relative_to(target)]
    if inside:
        what = "published" if mark == MANIFEST else "exported"
        raise ValueError(f"{target}: holds {inside[0]}, which is {what}; choose another folder")
    if target.exists() and (not target.is_dir() or (any(target.iterdir()) and not (target / mark).is_file())):
        what = "published" if mark == MANIFEST else "exported"
        raise ValueError(f"{target}: is there and was not {what}; choose another folder, or remove it")
    target.parent.mkdir(parents=True, exist_ok=True)
    name = uuid.uuid4().hex[:12]
    draft, old = (target.with_name(f".{target.name}.{name}.{what}") for what in ("new", "old"))
    draft.mkdir()
    try:
        yield draft
        if target.exists():
            os.replace(target, old)
        os.replace(draft, target)
    finally:
        for folder in (draft, old):
            shutil.rmtree(folder, ignore_errors=True)


def thumbnail_file(path: str | Path) -> Draw:
    """A thumbnail that is copied; ValueError unless it is a PNG or JPEG file."""
    source = Path(path)
    if source.suffix.lower() not in (".png", ".jpg", ".jpeg") or not source.is_file():
        raise ValueError(f"{source}: a thumbnail is a PNG or JPEG file that exists")

    def copy(entry: Path, target: Path) -> None:
        shutil.copyfile(source, target.with_suffix(source.suffix.lower()))

    return copy


def build(
    source: str | Path,
    folder: Path,
    name: str,
    version: str,
    draw: Draw | None,
    usdz: bool = True,
    bake: Bake | None = None,
    kind: str = "component",
) -> dict[str, Any]:
    """Fill ``folder`` with the asset ``name`` made of the stage ``source`` and return its manifest.

    ``draw(entry, target)`` writes the thumbnail ``target``, a PNG, or a file of its name with another suffix.
    ``bake(payload)`` lays baked surfaces over the copy of the stage and returns the layer to take in its place, and
    the materials that have some. Of the ``kind`` component, models below the default prim become subcomponents.

    Raises:
        ValueError: a name that is none, no default prim, something that the default prim needs
            outside of it, or new faults.
        OSError: a file cannot be written.
    """  # fmt: skip
    usd_schemas.register()
    if not Tf.IsValidIdentifier(name):
        raise ValueError(f"name {name!r} has other characters than letters, digits and _, or begins with a digit")
    stage = open_stage(source)
    root = stage.GetDefaultPrim()
    if not root:
        raise ValueError(f"{source}: has no default prim, which is what is published; author defaultPrim")
    payload, missing = gather(Path(source), folder / "contents")
    baked: list[str] = []
    if bake:
        payload, baked = bake(payload)
    entry = folder / f"{name}.usda"
    _write_entry(stage, payload, entry, name, version, kind)
    known = {_nameless(finding) for finding in validate_stage(stage)}
    for finding in validate_stage(Usd.Stage.Open(str(entry))):
        if finding.severity == "error" and _nameless(finding) not in known:
            raise ValueError(f"{source}: cannot be published: {finding.message}")
    if draw:
        _add_thumbnail(entry, folder / "thumbnails" / f"{name}.png", draw)
    _check_inside(entry, folder)
    if usdz:
        package = folder / f"{name}.usdz"
        packed = UsdUtils.CreateNewUsdzPackage(str(entry), str(package))
        if not (packed or missing) or not zipfile.is_zipfile(package):
            raise ValueError(f"{source}: cannot be packed into a usdz; --no-usdz leaves it out")
        _undated(package)
    return _write_manifest(folder, name, version, missing, baked)


def _write_entry(stage: Usd.Stage, payload: Path, entry: Path, name: str, version: str, kind: str) -> None:
    """The entry file: what can be known of the asset before its payload is loaded."""
    root = stage.GetDefaultPrim()
    layer = Sdf.Layer.CreateNew(str(entry))
    copy_metadata(stage.GetRootLayer(), layer)
    layer.pseudoRoot.ClearInfo("renderSettingsPrimPath")  # which is not part of the asset
    made = Usd.Stage.Open(layer)
    prim = made.DefinePrim(root.GetPath(), root.GetTypeName())
    made.SetDefaultPrim(prim)
    prim.GetPayloads().AddPayload(f"./contents/{payload.name}", root.GetPath())
    model = Usd.ModelAPI(prim)
    model.SetKind(kind)
    if kind == Kind.Tokens.component:  # nothing below a component is a model
        for path in _models(stage, root):
            Usd.ModelAPI(made.OverridePrim(path)).SetKind(Kind.Tokens.subcomponent)
    model.SetAssetName(name)
    model.SetAssetVersion(version)
    model.SetAssetIdentifier(Sdf.AssetPath(f"./{entry.name}"))
    sets = root.GetVariantSets()
    for variants in sets.GetNames():
        if sets.GetVariantSelection(variants):
            prim.GetVariantSets().SetSelection(variants, sets.GetVariantSelection(variants))
    boxes = UsdGeom.BBoxCache(Usd.TimeCode.EarliestTime(), [UsdGeom.Tokens.default_, UsdGeom.Tokens.render])
    if prim.IsA(UsdGeom.Boundable) or prim.IsA(UsdGeom.Xform):
        hint = UsdGeom.ModelAPI.Apply(prim).ComputeExtentsHint(boxes)
        UsdGeom.ModelAPI(prim).SetExtentsHint(hint)
    layer.comment = "A published asset. Written by scratchwarp publish."
    layer.Save()


def _models(stage: Usd.Stage, root: Usd.Prim) -> list[Sdf.Path]:
    """Paths below ``root`` of components, groups and assemblies, whichever of its variants is chosen."""
    session = Sdf.Layer.CreateAnonymous()
    seen = Usd.Stage.Open(stage.GetRootLayer(), session)
    chosen = Sdf.CreatePrimInLayer(session, root.GetPath()).variantSelections
    found: dict[Sdf.Path, None] = {}
    for name in (None, *root.GetVariantSets().GetNames()):
        for choice in root.GetVariantSets().GetVariantSet(name).GetVariantNames() if name else (None,):
            if name:
                chosen[name] = choice
            for prim in Usd.PrimRange(seen.GetPrimAtPath(root.GetPath())):
                if prim.GetPath() != root.GetPath() and Kind.Registry.IsA(Usd.ModelAPI(prim).GetKind(), "model"):
                    found[prim.GetPath()] = None
        if name:
            del chosen[name]
    return list(found)


def _add_thumbnail(entry: Path, target: Path, draw: Draw) -> None:
    target.parent.mkdir()
    draw(entry, target)
    (drawn,) = target.parent.iterdir()
    stage = Usd.Stage.Open(str(entry), Usd.Stage.LoadNone)
    previews = UsdMedia.AssetPreviewsAPI.Apply(stage.GetDefaultPrim())
    path = Sdf.AssetPath(f"./thumbnails/{drawn.name}")
    previews.SetDefaultThumbnails(UsdMedia.AssetPreviewsAPI.Thumbnails(defaultImage=path))
    stage.GetRootLayer().Save()


def _check_inside(entry: Path, folder: Path) -> None:
    """ValueError where the asset still needs a file outside of its folder."""
    layers, assets, _ = UsdUtils.ComputeAllDependencies(str(entry))
    used = [layer.realPath for layer in layers if layer.realPath] + list(assets)
    home = folder.resolve()
    for path in used:
        if not Path(path.split("[")[0]).resolve().is_relative_to(home):
            raise ValueError(f"{entry.name}: still needs {path}, outside of its folder")


def _undated(package: Path) -> None:
    """Set every date in a zip file to 1980-01-01, its beginning, so that the same contents are the same bytes."""
    with zipfile.ZipFile(package) as opened:
        members, directory = opened.infolist(), opened.start_dir
    data = bytearray(package.read_bytes())
    for member in members:
        data[member.header_offset + 10 : member.header_offset + 14] = _BEGINNING
        data[directory + 12 : directory + 16] = _BEGINNING
        directory += 46 + sum(struct.unpack_from("<3H", data, directory + 28))
    package.write_bytes(data)


def _write_manifest(
    folder: Path, name: str, version: str, missing: Sequence[str], baked: Sequence[str]
) -> dict[str, Any]:
    rows = []
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        rows.append({"path": path.relative_to(folder).as_posix(), "bytes": path.stat().st_size, "sha256": digest})
    manifest: dict[str, Any] = {"name": name, "version": version, "entry": f"{name}.usda", "files": rows}
    manifest["missing"] = sorted(missing)
    manifest["baked"] = sorted(baked)
    (folder / MANIFEST).write_text(json.dumps(manifest, indent=1) + "\n", encoding="utf-8")
    return manifest


def _nameless(finding: Any) -> tuple[str, str]:
    """A finding without the names of files, which differ between a stage and its copy."""
    return finding.rule, finding.path
