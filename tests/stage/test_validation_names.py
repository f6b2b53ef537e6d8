"""The validator on names and single values: one stage for each thing that can be wrong, and what is said about it."""

import pytest
from pxr import Usd, UsdValidation

from scratchwarp import usd_schemas
from scratchwarp.stage import validation_names, validation_values
from scratchwarp.stage.validation import validate
from scratchwarp.stage.validation_framework import RULES, full_name, register_rules

MATERIAL = """
def Material "M" (
    prepend apiSchemas = [{apis}]
)
{{
{body}
}}
{more}
"""
PROFILE = 'def ScratchProfile "P" {{\n{body}\n}}'


@pytest.fixture
def findings(tmp_path):
    """A function: the text of a layer to the findings of our rules."""

    def findings(text, core=False):
        path = tmp_path / "stage.usda"
        path.write_text("#usda 1.0\n" + text)
        return validate(path, core)

    return findings


def material(body="", apis='"ScratchLayerAPI:fine"', more=""):
    return MATERIAL.format(apis=apis, body=body, more=more)


def points(values):
    return PROFILE.format(body=f'uniform token scratch:shape = "points"\nfloat2[] scratch:points = {values}')


# (name, text, severity, rule, what the message must contain)
CASES = [
    (
        "misspelt attribute",
        material("float scratch:layer:fine:widht = 3"),
        "error",
        "ScratchNames",
        ["/M:", "scratch:layer:fine:widht is unknown", "did you mean 'scratch:layer:fine:width'"],
    ),
    (
        "misspelt layer",
        material("float scratch:layer:fien:width = 3"),
        "error",
        "ScratchNames",
        ["scratch:layer:fien:width", "'scratch:layer:fine:width'"],
    ),
    (
        "attribute on a prim without schemas",
        'def Scope "S" {\nfloat scratch:depth = 3\n}',
        "error",
        "ScratchNames",
        ["/S:", "scratch:depth is unknown", "Scope"],
    ),
    (
        "orphan of a removed layer",
        material("float scratch:layer:rough:width = 3"),
        "warning",
        "ScratchNames",
        ["scratch:layer:rough:width has no effect", "apply ScratchLayerAPI:rough"],
    ),
    (
        "orphan of a schema that is not applied",
        material("uniform int scratch:wave:samples = 3"),
        "warning",
        "ScratchNames",
        ["scratch:wave:samples has no effect", "apply ScratchWaveAPI"],
    ),
    (
        "misspelt schema",
        material(apis='"ScratchWavesAPI"'),
        "error",
        "ScratchApplication",
        ["'ScratchWavesAPI'", "did you mean 'ScratchWaveAPI'"],
    ),
    (
        "layer without a name",
        material(apis='"ScratchLayerAPI"'),
        "error",
        "ScratchApplication",
        ["without a name", "ScratchLayerAPI:<name>"],
    ),
    (
        "layer on a mesh",
        'def Mesh "B" (\nprepend apiSchemas = ["ScratchLayerAPI:fine"]\n) {\n}',
        "error",
        "ScratchApplication",
        ["/B:", "ScratchLayerAPI:fine", "'Mesh'", "type Material"],
    ),
    (
        "curves schema on a mesh",
        'def Mesh "B" (\nprepend apiSchemas = ["ScratchCurvesAPI"]\n) {\n}',
        "error",
        "ScratchApplication",
        ["ScratchCurvesAPI", "'Mesh'", "type Curves"],
    ),
    (
        "layer on an over of nothing",
        'over "Nobody" (\nprepend apiSchemas = ["ScratchLayerAPI:fine"]\n) {\n}',
        "error",
        "ScratchOvers",
        ["/Nobody:", "nothing defines", "ScratchLayerAPI:fine"],
    ),
    (
        "layer name in capitals",
        material(apis='"ScratchLayerAPI:Fine"'),
        "error",
        "ScratchInstanceNames",
        ["'Fine'", "rename"],
    ),
    (
        "layer name with a colon",
        material(apis='"ScratchLayerAPI:fine:one"'),
        "error",
        "ScratchInstanceNames",
        ["'fine:one'", "rename"],
    ),
    (
        "token",
        material('uniform token scratch:layer:fine:distribution = "spirals"'),
        "error",
        "ScratchValues",
        ["scratch:layer:fine:distribution is 'spirals'", "did you mean 'spiral'"],
    ),
    (
        "below the range",
        material("float scratch:layer:fine:width = -3"),
        "error",
        "ScratchValues",
        ["/M:", "scratch:layer:fine:width is -3", "[0, inf) micrometer"],
    ),
    (
        "above the range",
        material("float scratch:layer:fine:coverage = 1.5"),
        "error",
        "ScratchValues",
        ["coverage is 1.5", "[0, 1]"],
    ),
    (
        "on an open end of the range",
        material('uniform token scratch:layer:fine:distribution = "linear"\nfloat scratch:layer:fine:pitch = 0'),
        "error",
        "ScratchValues",
        ["pitch is 0", "(0, inf)"],
    ),
    (
        "one channel of a colour",
        material("color3f scratch:layer:fine:diffuseColor = (0.1, 2, 0.1)"),
        "error",
        "ScratchValues",
        ["diffuseColor[1] is 2", "[0, 1]"],
    ),
    (
        "a time sample",
        material("float scratch:layer:fine:coverage.timeSamples = {\n1: 0.5,\n2: 7,\n}"),
        "error",
        "ScratchValues",
        ["coverage is 7 at time 2"],
    ),
    (
        "not a number",
        material("float scratch:layer:fine:depth = nan"),
        "error",
        "ScratchValues",
        ["depth is nan", "[0, inf)"],
    ),
    (
        "infinite, without limits",
        material("float scratch:layer:fine:angle = inf"),
        "error",
        "ScratchValues",
        ["angle is inf", "finite number"],
    ),
    (
        "not a number in points",
        points("[(0, 0), (0.5, nan), (1, 0)]"),
        "error",
        "ScratchValues",
        ["/P:", "scratch:points[1] is nan", "finite"],
    ),
    (
        "render settings",
        'def RenderSettings "R" {\nuniform int scratch:render:samplesPerPixel = 0\n}',
        "error",
        "ScratchValues",
        ["/R:", "samplesPerPixel is 0", "[1, 1.04858e+06]"],
    ),
    (
        "input of the surface node",
        'def Shader "S" {\nuniform token info:id = "ScratchSurface"\nfloat inputs:rougness = 0.1\n}',
        "error",
        "ScratchSurface",
        ["/S:", "inputs:rougness", "did you mean 'inputs:roughness'"],
    ),
    (
        "range of the surface node",
        'def Shader "S" {\nuniform token info:id = "ScratchSurface"\nfloat inputs:roughness = 1.5\n}',
        "error",
        "ScratchSurface",
        ["inputs:roughness is 1.5", "[0, 1]"],
    ),
]


@pytest.mark.parametrize(("text", "severity", "rule", "words"), [case[1:] for case in CASES], ids=[c[0] for c in CASES])
def test_rule(findings, text, severity, rule, words):
    """Exactly one finding: the right rule speaks, and no other rule speaks about the same thing."""
    found = findings(text)
    assert [(one.severity, one.rule) for one in found] == [(severity, f"scratchwarp:{rule}")], found
    assert all(word in found[0].message for word in words), found[0].message


def test_every_rule_has_a_case():
    themes = (validation_names, validation_values)
    assert {case[3] for case in CASES} == {rule.name for theme in themes for rule in theme.RULES}


def test_blocked_value_is_its_fallback(findings):
    assert findings(material("float scratch:layer:fine:width = None")) == []


def test_orphans_can_be_removed(tmp_path):
    """The one fix that needs no guess, offered through the framework, which saves the layer."""
    path = tmp_path / "stage.usda"
    path.write_text("#usda 1.0\n" + material("float scratch:layer:rough:width = 3"))
    usd_schemas.register()
    register_rules()
    stage = Usd.Stage.Open(str(path))
    rule = next(rule for rule in RULES if rule.name == "ScratchNames")
    validator = UsdValidation.ValidationRegistry().GetOrLoadValidatorByName(full_name(rule))
    (error,) = validator.Validate(stage.GetPrimAtPath("/M"))
    (fixer,) = error.GetFixers()
    target = stage.GetEditTarget()
    assert fixer.CanApplyFix(error, target, Usd.TimeCode.Default())
    assert fixer.ApplyFix(error, target, Usd.TimeCode.Default())
    assert "rough" not in path.read_text()
    assert list(validator.Validate(stage.GetPrimAtPath("/M"))) == []
