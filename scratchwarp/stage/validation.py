"""Is a USD file fit to be rendered? Our rules and OpenUSD's own, as one list of findings.

USD itself checks the type of a value and nothing else: a misspelt attribute, a token nobody knows or a negative width
is accepted without a word. The rules are in the modules validation_*, one theme each; validation_framework registers
them with OpenUSD, so that other programs which run its validators run them as well.
"""

from dataclasses import dataclass
from pathlib import Path

from pxr import Sdf, Tf, Usd, UsdUtils, UsdValidation

from scratchwarp import usd_schemas
from scratchwarp.scene import StageError

from .open import open_stage
from .validation_framework import KEYWORD, register_rules

SEVERITY = {"Error": "error", "Warn": "warning"}
# The usd-core wheel has no MaterialX: its nodes are unknown and its files cannot be read, whatever they say.
MATERIALX_NODE = "shaderId 'ND_"
MATERIALX_FILE = ".mtlx@ for reference"


@dataclass(frozen=True, order=True)
class Finding:
    """One problem of a stage.

    Attributes:
        severity: "error" (would be refused or rendered wrongly) or "warning".
        rule: name of the validator, for example ``scratchwarp:ScratchValues``.
        path: path of the prim, "/" when the problem is one of the whole file.
        message: what is wrong, with the value, and what to do; starts with the path of the prim.
        variants: the combination of variants that has it; "" for the stage as it is.
    """

    severity: str
    rule: str
    path: str
    message: str
    variants: str = ""

    def __str__(self) -> str:
        where = f" (with {self.variants})" if self.variants else ""
        return f"{self.severity}: {self.message}{where} [{self.rule}]"


def validate(path: str | Path, core: bool = True) -> list[Finding]:
    """Run the rules of scratchwarp, and with ``core`` every validator of OpenUSD, on a file; errors come first.

    Raises:
        StageError: the file is missing or is no USD.
        RuntimeError: a stage was opened in this process before the schemas were registered.
    """
    usd_schemas.register()
    return validate_stage(open_stage(path), core)


def validate_stage(stage: Usd.Stage, core: bool = True) -> list[Finding]:
    """The same for a stage that is already open."""
    findings = {finding_of(error) for error in run(stage, core)}
    return sorted(findings)


def fix(path: str | Path) -> list[Finding]:
    """Mend in the file what needs no guess (properties without effect are removed) and return what was mended.

    Raises:
        StageError: the file is missing, is no USD, or cannot be written.
    """
    usd_schemas.register()
    stage = open_stage(path)
    target, time = stage.GetEditTarget(), Usd.TimeCode.Default()
    fixed = []
    for error in run(stage, core=False):
        finding = finding_of(error)
        for fixer in error.GetFixers():
            if not fixer.CanApplyFix(error, target, time):
                continue
            try:
                fixer.ApplyFix(error, target, time)
            except Tf.ErrorException as reason:
                raise StageError(f"{path}: cannot be written ({last_line(reason)}); check its permissions") from reason
            fixed.append(finding)
    return sorted(fixed)


def run(stage: Usd.Stage, core: bool) -> list[UsdValidation.ValidationError]:
    """The errors of the framework, from our validators or from all."""
    usd_schemas.register_shaders()
    register_rules()
    registry = UsdValidation.ValidationRegistry()
    if core:
        context = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators())
    else:
        names = [entry.name for entry in registry.GetValidatorMetadataForKeyword(KEYWORD)]
        context = UsdValidation.ValidationContext(registry.GetOrLoadValidatorsByName(names))
    # USD prints what its validators run into on stderr as well; the findings say it once.
    quiet = UsdUtils.CoalescingDiagnosticDelegate()
    try:
        return [error for error in context.Validate(stage) if not error.HasNoError()]
    finally:
        quiet.TakeUncoalescedDiagnostics()
        del quiet


def last_line(error: Exception) -> str:
    """The line of a USD error that says what happened."""
    return str(error).strip().splitlines()[-1].strip()


def finding_of(error: UsdValidation.ValidationError) -> Finding:
    """The framework's error as a Finding; the prim is that of its first site."""
    validator = error.GetValidator()
    rule = validator.GetMetadata().name if validator else error.GetName()
    sites = error.GetSites()
    where = site_path(sites[0]) if sites else Sdf.Path.absoluteRootPath
    message = " ".join(error.GetMessage().split())
    if str(where) not in message:
        message = f"{where}: {message}"
    severity = SEVERITY.get(error.GetType().displayName, "warning")
    if MATERIALX_NODE in message:
        severity, message = "warning", f"{message} It is a MaterialX node, which this build of USD cannot check."
    if MATERIALX_FILE in message:
        severity, message = "warning", f"{message} It is a MaterialX file, which this build of USD cannot read."
    return Finding(severity, rule, str(where), message)


def site_path(site: UsdValidation.ValidationErrorSite) -> Sdf.Path:
    """Path of the prim that a site of an error points to; "/" for a whole layer."""
    if site.IsProperty():
        return site.GetProperty().GetPrim().GetPath()
    if site.IsPrim():
        return site.GetPrim().GetPath()
    if site.IsValidSpecInLayer() and site.GetPropertySpec():
        return site.GetPropertySpec().path.GetPrimPath()
    if site.IsValidSpecInLayer() and site.GetPrimSpec():
        return site.GetPrimSpec().path
    return Sdf.Path.absoluteRootPath
