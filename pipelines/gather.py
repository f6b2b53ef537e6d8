"""Copy a stage with every file that it needs, in all its variants, so that the copies find one another."""

import os
import shutil
from pathlib import Path

from pxr import Sdf, UsdUtils

OUTSIDE = "outside"  # folder of the files that do not lie below the stage's own
_TILES = "<UDIM>"


def gather(source: Path, folder: Path) -> tuple[Path, list[str]]:
    """Copy ``source`` and what it needs into ``folder`` and return the copy of ``source`` and the files that are
    missing, relative to its folder.

    Files below the folder of ``source`` keep their place relative to it, the others come into the folder ``outside``.
    A layer whose asset paths need not change is copied byte by byte.
    """
    source = source.resolve()
    layers, assets, missing = UsdUtils.ComputeAllDependencies(str(source))
    files = {Path(layer.realPath).resolve() for layer in layers if layer.realPath}
    files |= {Path(_outer(asset)).resolve() for asset in assets}
    places = _places(source, sorted(files), folder)
    for file, place in places.items():
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, place)
    for layer in layers:
        if layer.realPath and "[" not in layer.identifier and not layer.GetFileFormat().IsPackage():
            _relink(layer, places)
    named = (os.path.relpath(path, source.parent) if os.path.isabs(path) else path for path in missing)
    return places[source], sorted(Path(path).as_posix() for path in named)


def _places(source: Path, files: list[Path], folder: Path) -> dict[Path, Path]:
    """File -> where its copy lies."""
    home = source.parent
    outside = [file for file in files if not file.is_relative_to(home)]
    root = Path(os.path.commonpath([file.parent for file in outside])) if outside else home
    inside = {file: folder / file.relative_to(home) for file in (source, *files) if file not in outside}
    return inside | {file: folder / OUTSIDE / file.relative_to(root) for file in outside}


def _relink(layer: Sdf.Layer, places: dict[Path, Path]) -> None:
    """Let the copy of ``layer`` name the copies of what ``layer`` names."""
    place = places[Path(layer.realPath).resolve()]
    changed = False

    def moved(name: str) -> str:
        nonlocal changed
        outer = _outer(name)
        if not outer:
            return name
        wanted = Path(layer.ComputeAbsolutePath(outer)).resolve()
        found = places.get(wanted)
        if found is None and _TILES in wanted.name:
            head, tail = wanted.name.split(_TILES, 1)
            beside = [tile for tile in places if tile.parent == wanted.parent]
            tiles = [tile for tile in beside if tile.name.startswith(head) and tile.name.endswith(tail)]
            found = places[tiles[0]].with_name(wanted.name) if tiles else None
        if found is None or (place.parent / outer).resolve() == found.resolve():
            return name
        changed = True
        relative = Path(os.path.relpath(found, place.parent)).as_posix()
        return (relative if relative.startswith("../") else f"./{relative}") + name[len(outer) :]

    copied = Sdf.Layer.OpenAsAnonymous(str(place))
    UsdUtils.ModifyAssetPaths(copied, moved)
    if changed:
        # a binary layer stays one, whatever its suffix says
        binary = layer.GetFileFormat().formatId == "usdc" or Sdf.FileFormat.FindById("usdc").CanRead(str(place))
        copied.Export(str(place), args={"format": "usdc" if binary else "usda"} if place.suffix == ".usd" else {})


def _outer(name: str) -> str:
    """The file of an asset path, without what lies inside a package."""
    return name.split("[")[0]
