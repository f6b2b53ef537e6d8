"""Rules about names: schemas applied, layer instances, attributes that no schema knows."""

import re
from collections.abc import Iterator

from pxr import Sdf, Usd

from scratchwarp import usd_schemas

from .validation_rule import (
    LAYER_API,
    LAYER_PREFIX,
    NAMESPACES,
    Problem,
    Rule,
    did_you_mean,
    layer_names,
    scratch_properties,
    suggestion,
)

INSTANCE_NAME = re.compile(r"[a-z][A-Za-z0-9]*")
# Namespace of each schema's attributes, to say which schema is missing.
PREFIX_SCHEMAS = {
    "scratch:wave:": "ScratchWaveAPI",
    "scratch:curves:": "ScratchCurvesAPI",
    "scratch:measured:": "ScratchMeasuredAPI",
    "primvars:scratch:": "ScratchCurvesAPI",
}


def applied_names(prim: Usd.Prim) -> list[str]:
    """The authored apiSchemas of ``prim`` that are ours or look so, known to USD or not."""
    listed = prim.GetMetadata("apiSchemas") or Sdf.TokenListOp()
    return [name for name in listed.GetAddedOrExplicitItems() if name.startswith("Scratch")]


def check_application(prim: Usd.Prim) -> Iterator[Problem]:
    """Schemas that USD does not know, that lack an instance name, or that sit on a prim of the wrong type."""
    registry = Usd.SchemaRegistry()
    path = prim.GetPath()
    known = [name for name in usd_schemas.SCHEMAS if name.endswith("API")]
    for applied in applied_names(prim):
        schema, _, instance = applied.partition(":")
        if schema not in known:
            yield Problem(path, f"applies the unknown schema {applied!r}; {did_you_mean(schema, known)}")
            continue
        if schema == LAYER_API and not instance:
            yield Problem(path, f"applies {schema} without a name; apply {schema}:<name>, for example {schema}:fine")
        if schema != LAYER_API and instance:
            yield Problem(path, f"applies {applied!r}, but {schema} takes no instance name; apply {schema}")
        allowed = registry.GetAPISchemaCanOnlyApplyToTypeNames(schema)
        if allowed and not any(prim.IsA(registry.GetTypeFromSchemaTypeName(name)) for name in allowed):
            found = prim.GetTypeName() or "untyped"
            wanted = " or ".join(allowed)
            yield Problem(path, f"applies {applied} but is {found!r}; apply it to a prim of type {wanted}")


def check_instance_names(prim: Usd.Prim) -> Iterator[Problem]:
    """Layer names other than a lower-case letter followed by letters and digits."""
    for name in layer_names(prim):
        if not INSTANCE_NAME.fullmatch(name):
            yield Problem(
                prim.GetPath(),
                f"has a layer named {name!r}; rename it: a lower-case letter, then letters and digits (a-z, A-Z, 0-9)",
            )


def known_names(prim: Usd.Prim) -> list[str]:
    """Properties in our namespaces that the type and the schemas of ``prim`` define."""
    return [name for name in prim.GetPrimDefinition().GetPropertyNames() if name.startswith(NAMESPACES)]


def check_names(prim: Usd.Prim) -> Iterator[Problem]:
    """Properties that nothing reads: misspelt ones, and those of a layer or schema that is not applied."""
    authored = list(scratch_properties(prim))
    if not authored:
        return
    known = known_names(prim)
    for prop in authored:
        name = prop.GetName()
        if name in known:
            continue
        missing = orphan_of(prim, name)
        if missing:
            yield Problem(
                prop.GetPath(), f"{name} has no effect: apply {missing} to the prim or remove {name}", "warning"
            )
        else:
            kind = prim.GetTypeName() or "untyped"
            hint = did_you_mean(name, known) if known else f"no schema of a {kind} prim has scratch attributes"
            yield Problem(prop.GetPath(), f"{name} is unknown; {hint}")


def orphan_of(prim: Usd.Prim, name: str) -> str | None:
    """The schema that would have to be applied for ``name`` to be read; None for a name that no schema has."""
    registry = Usd.SchemaRegistry()
    if name.startswith(LAYER_PREFIX):
        layer, _, base = name.removeprefix(LAYER_PREFIX).rpartition(":")
        applied = layer_names(prim)
        definition = registry.FindAppliedAPIPrimDefinition(LAYER_API)
        is_attribute = f"{LAYER_PREFIX}__INSTANCE_NAME__:{base}" in definition.GetPropertyNames()
        misspelt = suggestion(layer, applied) is not None
        return f"{LAYER_API}:{layer}" if layer and layer not in applied and is_attribute and not misspelt else None
    for prefix, schema in PREFIX_SCHEMAS.items():
        if name.startswith(prefix) and name in registry.FindAppliedAPIPrimDefinition(schema).GetPropertyNames():
            return None if prim.HasAPI(schema) else schema
    return None


def check_overs(stage: Usd.Stage) -> Iterator[Problem]:
    """Scratch schemas on an `over` that no layer defines: nobody will ever see them."""
    for prim in Usd.PrimRange(stage.GetPseudoRoot(), Usd.PrimIsActive):
        if not prim.IsDefined() and applied_names(prim):
            names = ", ".join(applied_names(prim))
            yield Problem(
                prim.GetPath(),
                f"is an over of a prim that nothing defines, so its {names} has no effect; correct the path, or "
                "sublayer or reference the asset that defines it",
            )


RULES = (
    Rule("ScratchApplication", "Schemas exist, are named and sit on the right prim type.", check_application),
    Rule("ScratchInstanceNames", "Layer names are plain identifiers.", check_instance_names, ("UsdShadeMaterial",)),
    Rule("ScratchNames", "Every scratch property is one that a schema of its prim has.", check_names),
    Rule("ScratchOvers", "Schemas are not applied to prims that nothing defines.", check_overs, whole_stage=True),
)
