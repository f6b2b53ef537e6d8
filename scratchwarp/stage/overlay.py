"""A USD layer that lies over a stage and leaves the files of the stage as they are."""

import os
from collections.abc import Sequence
from pathlib import Path

from pxr import Sdf, Tf, Usd

from scratchwarp.whole import whole

SUFFIXES = (".usda", ".usdc", ".usd")
# Metadata that a root layer has to say itself: sublayers do not give theirs to it.
_METADATA = (
    "defaultPrim", "metersPerUnit", "upAxis", "timeCodesPerSecond", "framesPerSecond", "startTimeCode", "endTimeCode",
    "renderSettingsPrimPath", "colorConfiguration", "colorManagementSystem", "primaryCameraName", "kilogramsPerUnit",
)  # fmt: skip


def check_target(stage: Usd.Stage, target: Path) -> None:
    """ValueError where ``target`` is no USD file name or would replace a file of the stage, OSError where its folder
    does not exist."""
    if target.suffix not in SUFFIXES:
        raise ValueError(f"{target}: edits are saved as .usda, .usdc or .usd")
    used = {Path(layer.realPath).resolve() for layer in stage.GetUsedLayers() if layer.realPath}
    if target.resolve() in used:
        raise ValueError(f"{target}: is a file of the stage that is looked at; save the edits under another name")
    if not target.parent.is_dir():
        raise OSError(f"{target}: the folder {target.parent} does not exist")


def overlay(edits: Sdf.Layer, root: Sdf.Layer, target: Path, between: Sequence[Path | str] = ()) -> Sdf.Layer:
    """A layer in memory with the content of ``edits`` over that of ``root``, which it names relative to ``target``;
    layers ``between`` lie over the root."""
    out = Sdf.Layer.CreateAnonymous(".usda")
    out.TransferContent(edits)
    copy_metadata(root, out)
    out.subLayerPaths = [relative(Path(layer), target.parent) for layer in (*between, root.realPath)]
    return out


def copy_metadata(root: Sdf.Layer, other: Sdf.Layer) -> None:
    """Give ``other`` the metadata of a root layer that says how its stage is to be understood."""
    for name in _METADATA:
        if root.pseudoRoot.HasInfo(name):
            other.pseudoRoot.SetInfo(name, root.pseudoRoot.GetInfo(name))


def save_layer(layer: Sdf.Layer, target: Path) -> None:
    """Write ``layer`` to ``target``, whole or not at all; a copy of the file that is open in this process follows.
    OSError where it cannot be written."""
    with whole(target) as draft:
        export(layer, draft, target)
    reload(target)


def export(layer: Sdf.Layer, draft: Path, target: Path) -> None:
    """Write ``layer`` to ``draft``; OSError that names ``target`` where that fails."""
    try:
        if not layer.Export(str(draft)):
            raise OSError(f"{target}: cannot be written")
    except Tf.ErrorException as error:
        raise OSError(f"{target}: cannot be written: {error}") from None


def reload(target: Path) -> None:
    """Let the copy of a file that is open in this process follow what was written."""
    opened = Sdf.Layer.Find(str(target))
    if opened is not None:
        opened.Reload(force=True)


def relative(path: Path, folder: Path) -> str:
    """``path`` as a layer in ``folder`` names it."""
    try:
        text = Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
    except ValueError:  # another drive
        return path.resolve().as_posix()
    return text if text.startswith("../") else f"./{text}"
