"""Rules about relationships: the profile of a layer, the curves of a layer."""

from collections.abc import Iterator

from pxr import Sdf, Usd, UsdGeom

from .validation_rule import LAYER_PREFIX, Problem, Rule, layer_attribute, layer_names, value


def dropped_targets(relationship: Usd.Relationship) -> list[Sdf.Path]:
    """Authored targets that composition dropped because they lie outside the prim that was referenced.

    USD says so on stderr only: neither GetTargets nor the composition errors hold them.
    """
    composed = relationship.GetTargets()
    authored: list[Sdf.Path] = []
    for spec in relationship.GetPropertyStack():
        listed = spec.targetPathList
        authored += [path for path in listed.GetAddedOrExplicitItems() if path not in authored]
        if listed.isExplicit:
            break
    if len(authored) <= len(composed):
        return []
    names = {path.name for path in composed}
    return [path for path in authored if path.name not in names]


def check_target_paths(relationship: Usd.Relationship, wanted: str) -> Iterator[Problem]:
    """Targets that were dropped or do not exist; ``wanted`` says what belongs there."""
    path, name = relationship.GetPath(), relationship.GetName()
    for target in dropped_targets(relationship):
        yield Problem(
            path,
            f"{name} targets {target}, which lies outside the referenced prim and is dropped; move the target inside "
            "the prim that is referenced, or reference a prim that holds both",
        )
    for target in relationship.GetTargets():
        if not relationship.GetStage().GetPrimAtPath(target):
            yield Problem(path, f"{name} targets {target}, which does not exist; target {wanted}")


def check_profile_targets(prim: Usd.Prim) -> Iterator[Problem]:
    """Layers whose profile is missing, several, not a ScratchProfile, or outside the Material."""
    stage = prim.GetStage()
    for relationship in (
        prim.GetRelationship(f"{LAYER_PREFIX}{layer}:{name}")
        for layer in layer_names(prim)
        for name in ("profile", "profileEnd")
    ):
        path, name = relationship.GetPath(), relationship.GetName()
        yield from check_target_paths(relationship, f"a ScratchProfile below {prim.GetPath()}")
        targets = relationship.GetTargets()
        if len(targets) > 1:
            listed = ", ".join(str(target) for target in targets)
            yield Problem(path, f"{name} has {len(targets)} targets ({listed}); keep one, a layer has one profile")
        for target in targets:
            found = stage.GetPrimAtPath(target)
            if found and found.GetTypeName() != "ScratchProfile":
                kind = found.GetTypeName() or "untyped"
                yield Problem(path, f"{name} targets {target} of type {kind!r}; target a ScratchProfile")
            elif found and not target.HasPrefix(prim.GetPath()):
                yield Problem(
                    path,
                    f"{name} targets {target}, outside the Material: the profile is lost when {prim.GetPath()} "
                    "alone is referenced; make the profile a child of the Material",
                    "warning",
                )


def check_curve_targets(prim: Usd.Prim) -> Iterator[Problem]:
    """Layers of distribution curves without curves, and targets that are no curves with ScratchCurvesAPI."""
    stage = prim.GetStage()
    for layer in layer_names(prim):
        relationship = prim.GetRelationship(f"{LAYER_PREFIX}{layer}:curves")
        distribution = value(layer_attribute(prim, layer, "distribution"))
        path, name = relationship.GetPath(), relationship.GetName()
        yield from check_target_paths(relationship, "a BasisCurves prim with ScratchCurvesAPI")
        targets = relationship.GetTargets()
        if distribution == "curves" and not targets and not dropped_targets(relationship):
            yield Problem(
                path,
                f"layer {layer!r} has distribution 'curves' but {name} has no target; target a BasisCurves prim with "
                "ScratchCurvesAPI, or choose another distribution",
            )
        if distribution != "curves" and targets:
            yield Problem(
                path,
                f"{name} targets {targets[0]} but the distribution of layer {layer!r} is {distribution!r}; set it to "
                "'curves' or remove the target",
                "warning",
            )
        for target in targets:
            found = stage.GetPrimAtPath(target)
            if found and not found.IsA(UsdGeom.Curves):
                kind = found.GetTypeName() or "untyped"
                yield Problem(path, f"{name} targets {target} of type {kind!r}; target a BasisCurves prim")
            elif found and not found.HasAPI("ScratchCurvesAPI"):
                yield Problem(
                    path, f"{name} targets {target}, which lacks ScratchCurvesAPI; apply ScratchCurvesAPI to it"
                )


RULES = (
    Rule(
        "ScratchProfileTargets",
        "A layer's profile is one ScratchProfile inside its Material.",
        check_profile_targets,
        ("UsdShadeMaterial",),
    ),
    Rule(
        "ScratchCurveTargets",
        "A layer of curves targets curves with ScratchCurvesAPI.",
        check_curve_targets,
        ("UsdShadeMaterial",),
    ),
)
