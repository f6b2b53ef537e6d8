"""Our rules in OpenUSD's own validation framework, so that any tool which runs validators runs them too."""

from collections.abc import Callable
from typing import Any

from pxr import Sdf, Tf, Usd, UsdValidation

from . import (
    validation_curves,
    validation_links,
    validation_materials,
    validation_names,
    validation_profiles,
    validation_values,
)
from .validation_rule import Problem, Rule

KEYWORD = "scratchwarp"
RULES: tuple[Rule, ...] = (
    *validation_names.RULES,
    *validation_values.RULES,
    *validation_links.RULES,
    *validation_profiles.RULES,
    *validation_curves.RULES,
    *validation_materials.RULES,
)
SEVERITIES = {
    "error": UsdValidation.ValidationErrorType.Error,
    "warning": UsdValidation.ValidationErrorType.Warn,
}


def full_name(rule: Rule) -> str:
    """The rule's name in the registry."""
    return f"{KEYWORD}:{rule.name}"


def as_errors(rule: Rule, stage: Usd.Stage, problems: list[Problem]) -> list[UsdValidation.ValidationError]:
    """Problems as the framework's errors; the message starts with the path of the prim."""
    return [
        UsdValidation.ValidationError(
            "Orphan" if rule.name == "ScratchNames" and problem.severity == "warning" else rule.name,
            SEVERITIES[problem.severity],
            [UsdValidation.ValidationErrorSite(stage, problem.path)],
            f"{problem.path.GetPrimPath()}: {problem.message}",
        )
        for problem in problems
    ]


def task(rule: Rule) -> Callable[[Any, Any], list[UsdValidation.ValidationError]]:
    """The function that the framework calls with a prim or a stage, and a time range."""

    def run(target: Any, time_range: Any) -> list[UsdValidation.ValidationError]:
        stage = target if rule.whole_stage else target.GetStage()
        return as_errors(rule, stage, list(rule.check(target)))

    return run


def spec_to_remove(error: UsdValidation.ValidationError, target: Usd.EditTarget) -> Sdf.PropertySpec | None:
    """The property spec that an Orphan error is about, in the layer being edited."""
    sites = error.GetSites()
    layer = target.GetLayer()
    return layer.GetPropertyAtPath(target.MapToSpecPath(sites[0].GetProperty().GetPath())) if sites and layer else None


def remove_orphan(error: UsdValidation.ValidationError, target: Usd.EditTarget, time: Usd.TimeCode) -> bool:
    """Remove a property that has no effect from the layer being edited."""
    spec = spec_to_remove(error, target)
    if spec is None:
        return False
    spec.owner.RemoveProperty(spec)
    return True


def can_remove_orphan(error: UsdValidation.ValidationError, target: Usd.EditTarget, time: Usd.TimeCode) -> bool:
    """Whether the layer being edited holds the property."""
    return spec_to_remove(error, target) is not None


def fixers(rule: Rule) -> list[UsdValidation.ValidationFixer]:
    """What can be mended without guessing: properties that have no effect are removed."""
    if rule.name != "ScratchNames":
        return []
    return [
        UsdValidation.ValidationFixer(
            "RemoveOrphan",
            "Remove a scratch property that has no effect.",
            remove_orphan,
            can_remove_orphan,
            [KEYWORD],
            "Orphan",
        )
    ]


def register_rules() -> None:
    """Put every rule into OpenUSD's validation registry; calling it again does nothing."""
    registry = UsdValidation.ValidationRegistry()
    for rule in RULES:
        name = full_name(rule)
        if registry.HasValidator(name):
            continue
        metadata = UsdValidation.ValidatorMetadata(
            name=name, keywords=[KEYWORD], doc=rule.doc, schemaTypes=list(rule.schemas)
        )
        try:
            if rule.whole_stage:
                registry.RegisterStageValidator(metadata, task(rule), fixers(rule))
            else:
                registry.RegisterPrimValidator(metadata, task(rule), fixers(rule))
        except Tf.ErrorException as error:
            raise RuntimeError(f"OpenUSD refused the validator {name}: {error}") from error
