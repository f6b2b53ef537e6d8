"""Validation over every combination of variants, as usdchecker does it, and mending what needs no guess."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from pxr import Sdf, Usd, UsdGeom

from scratchwarp import usd_schemas
from scratchwarp.scene import StageError
from scratchwarp.whole import whole

from .open import open_stage
from .overlay import check_target, export, reload
from .validation import Finding, fix, validate_stage

LIMIT = 1000
Choice = dict[tuple[str, str], str]


def validate_variants(path: str | Path, limit: int = LIMIT) -> tuple[list[Finding], int]:
    """Findings over all combinations of variants, errors first, and how many combinations there were.

    A finding of the stage as it is comes without variants; others name the first combination that has them. Choices
    are made on the session layer. After ``limit`` combinations a warning says that there are more.
    Raises StageError as ``validate`` does.
    """
    usd_schemas.register()
    stage = open_stage(path)
    found = {_key(finding): finding for finding in validate_stage(stage)}
    count = 0
    for choice in combinations(stage):
        if count == limit:
            message = f"has more than {limit} combinations of variants; the others were not looked at"
            found["limit", "/", message] = Finding("warning", "scratchwarp:variants", "/", message)
            break
        count += 1
        if not choice:
            continue
        text = ", ".join(f"{prim}{{{name}={variant}}}" for (prim, name), variant in choice.items())
        for finding in validate_stage(stage):
            found.setdefault(_key(finding), replace(finding, variants=text))
    return sorted(found.values()), count


def combinations(stage: Usd.Stage) -> Iterator[Choice]:
    """Choose every combination of variants of the stage, one after the other, on its session layer; sets that exist
    only within a variant of another one count there alone."""
    layer = Sdf.Layer.CreateAnonymous("variants")
    session = stage.GetSessionLayer()
    session.subLayerPaths.insert(0, layer.identifier)
    try:
        yield from _walk(stage, layer, {})
    finally:
        session.subLayerPaths.remove(layer.identifier)


def _walk(stage: Usd.Stage, layer: Sdf.Layer, choice: Choice) -> Iterator[Choice]:
    layer.Clear()
    for (path, name), variant in choice.items():
        Sdf.CreatePrimInLayer(layer, path).variantSelections[name] = variant
    for prim in stage.Traverse():
        for name in prim.GetVariantSets().GetNames():
            if (str(prim.GetPath()), name) not in choice:
                for variant in prim.GetVariantSets().GetVariantSet(name).GetVariantNames():
                    yield from _walk(stage, layer, choice | {(str(prim.GetPath()), name): variant})
                return
    yield choice


def fixed_copy(path: str | Path, out: str | Path) -> list[str]:
    """Write a copy of a stage's root layer beside it, mended where no guess is needed, and return what was mended.

    Properties that have no effect go; defaultPrim is authored where there is one root prim, upAxis and metersPerUnit
    with the values that USD takes without them.

    Raises:
        StageError: the file is missing or is no USD, or ``out`` lies in another folder, where relative paths would
            mean other files.
        OSError: ``out`` cannot be written.
    """
    usd_schemas.register()
    source, target = Path(path), Path(out)
    stage = open_stage(source)
    check_target(stage, target)
    if target.resolve().parent != source.resolve().parent:
        raise StageError(f"{target}: has to lie beside {source}, whose relative paths mean other files elsewhere")
    root, said = stage.GetRootLayer(), []
    copy = Sdf.Layer.CreateAnonymous(target.suffix)
    copy.TransferContent(root)
    prims = [prim for prim in stage.GetPseudoRoot().GetChildren() if not prim.IsAbstract()]
    if not root.HasDefaultPrim() and len(prims) == 1:
        copy.defaultPrim = prims[0].GetName()
        said.append(f"defaultPrim is {prims[0].GetName()}, the only root prim")
    if not UsdGeom.StageHasAuthoredMetersPerUnit(stage):
        copy.pseudoRoot.SetInfo("metersPerUnit", UsdGeom.GetStageMetersPerUnit(stage))
        said.append(f"metersPerUnit is {UsdGeom.GetStageMetersPerUnit(stage)}, as it is without being authored")
    if not root.pseudoRoot.HasInfo("upAxis"):
        copy.pseudoRoot.SetInfo("upAxis", UsdGeom.GetStageUpAxis(stage))
        said.append(f"upAxis is {UsdGeom.GetStageUpAxis(stage)}, as it is without being authored")
    with whole(target) as draft:
        export(copy, draft, target)
        said += [f"removed: {finding.message}" for finding in fix(draft)]
    reload(target)
    return said


def _key(finding: Finding) -> tuple[str, str, str]:
    return finding.rule, finding.path, finding.message
