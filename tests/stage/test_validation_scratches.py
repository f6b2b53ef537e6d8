"""The validator on profiles, curves and layers: one stage for each thing that can be wrong, and what is said."""

import pytest

from scratchwarp.stage import validation_curves, validation_links, validation_materials, validation_profiles
from scratchwarp.stage.validation import validate

MATERIAL = """
def Material "M" (
    prepend apiSchemas = [{apis}]
)
{{
{body}
}}
{more}
"""
TWO = 'def ScratchProfile "P" {\n}\ndef ScratchProfile "Q" {\n}'
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


def curves(body, api='prepend apiSchemas = ["ScratchCurvesAPI"]'):
    geometry = "int[] curveVertexCounts = [2, 2]\npoint3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]"
    return f'def BasisCurves "C" (\n{api}\n) {{\nuniform token type = "linear"\n{geometry}\n{body}\n}}'


GOOD_CURVES = curves('float[] widths = [0.1] (\ninterpolation = "constant"\n)')

# (name, text, severity, rule, what the message must contain)
CASES = [
    (
        "profile missing",
        material("rel scratch:layer:fine:profile = </M/Gone>"),
        "error",
        "ScratchProfileTargets",
        ["scratch:layer:fine:profile targets /M/Gone", "does not exist", "a ScratchProfile below /M"],
    ),
    (
        "profile is something else",
        material('rel scratch:layer:fine:profile = </M/S>\ndef Shader "S" {\n}'),
        "error",
        "ScratchProfileTargets",
        ["targets /M/S of type 'Shader'", "target a ScratchProfile"],
    ),
    (
        "several profiles",
        material("rel scratch:layer:fine:profile = [</M/P>, </M/Q>]\n" + TWO),
        "error",
        "ScratchProfileTargets",
        ["2 targets (/M/P, /M/Q)", "keep one"],
    ),
    (
        "profile outside the material",
        material("rel scratch:layer:fine:profile = </P>", more='def ScratchProfile "P" {\n}'),
        "warning",
        "ScratchProfileTargets",
        ["targets /P, outside the Material", "child of the Material"],
    ),
    (
        "too few points",
        points("[(0, 0)]"),
        "error",
        "ScratchProfilePoints",
        ["/P:", "1 points", "at least two"],
    ),
    ("no points", points("[]"), "error", "ScratchProfilePoints", ["0 points", "at least two"]),
    (
        "points from right to left",
        points("[(1, 0), (0.5, -1), (0, 0)]"),
        "error",
        "ScratchProfilePoints",
        ["from x = 1 down to 0", "reverse"],
    ),
    (
        "points out of order",
        points("[(0, 0), (1, -1), (0.5, 0)]"),
        "error",
        "ScratchProfilePoints",
        ["ends at 0.5", "ascending"],
    ),
    (
        "points that cross",
        points("[(0, 0), (0.8, -1), (0.8, -0.2), (0.2, -0.8), (1, 0)]"),
        "error",
        "ScratchProfilePoints",
        ["crosses itself", "points 0 to 1 and 2 to 3"],
    ),
    (
        "points in micrometres",
        points("[(0, 0), (5, -1), (10, 0)]"),
        "error",
        "ScratchProfilePoints",
        ["from 0 to 10", "divide x by the width"],
    ),
    (
        "points that cover half",
        points("[(0, 0), (0.2, -1), (0.5, 0)]"),
        "warning",
        "ScratchProfilePoints",
        ["from 0 to 0.5 only"],
    ),
    (
        "depth not normalised",
        points("[(0, 0), (0.5, -4), (1, 0)]"),
        "warning",
        "ScratchProfilePoints",
        ["z = -4", "scale z"],
    ),
    (
        "points that are not read",
        PROFILE.format(body="float2[] scratch:points = [(0, 0), (1, 0)]"),
        "warning",
        "ScratchProfilePoints",
        ["2 points", "scratch:shape is 'vGroove'"],
    ),
    (
        "curves without widths",
        curves(""),
        "error",
        "ScratchCurves",
        ["/C:", "no widths", "author widths"],
    ),
    (
        "negative widths",
        curves('float[] widths = [0.1, -2] (\ninterpolation = "uniform"\n)'),
        "error",
        "ScratchCurves",
        ["widths[1] is -2", "[0, inf)"],
    ),
    (
        "too many widths",
        curves('float[] widths = [1, 2, 3] (\ninterpolation = "uniform"\n)'),
        "error",
        "ScratchCurves",
        ["widths holds 3 values", "'uniform' needs 2"],
    ),
    (
        "too few depths",
        curves("float[] primvars:scratch:width = [1, 1]\nfloat[] primvars:scratch:depth = [1]"),
        "error",
        "ScratchCurves",
        ["primvars:scratch:depth holds 1 values", "'uniform' needs 2"],
    ),
    (
        "curves with infinite points",
        curves("float[] primvars:scratch:width = [1, 1]").replace("(1, 1, 0)", "(1, inf, 0)"),
        "error",
        "ScratchCurves",
        ["points[3]", "inf", "finite"],
    ),
    (
        "curves that do not add up",
        curves("float[] primvars:scratch:width = [1, 1]").replace("[2, 2]", "[2, 3]"),
        "error",
        "ScratchCurves",
        ["4 points", "add up to 5"],
    ),
    (
        "layer of curves without a target",
        material('uniform token scratch:layer:fine:distribution = "curves"'),
        "error",
        "ScratchCurveTargets",
        ["layer 'fine'", "no target", "BasisCurves"],
    ),
    (
        "curves that are a mesh",
        material(
            'uniform token scratch:layer:fine:distribution = "curves"\nrel scratch:layer:fine:curves = </B>',
            more='def Mesh "B" {\n}',
        ),
        "error",
        "ScratchCurveTargets",
        ["targets /B of type 'Mesh'"],
    ),
    (
        "curves without the schema",
        material(
            'uniform token scratch:layer:fine:distribution = "curves"\nrel scratch:layer:fine:curves = </C>',
            more=curves("", api=""),
        ),
        "error",
        "ScratchCurveTargets",
        ["targets /C, which lacks ScratchCurvesAPI"],
    ),
    (
        "curves that are missing",
        material('uniform token scratch:layer:fine:distribution = "curves"\nrel scratch:layer:fine:curves = </C>'),
        "error",
        "ScratchCurveTargets",
        ["targets /C, which does not exist"],
    ),
    (
        "curves that are not read",
        material("rel scratch:layer:fine:curves = </C>", more=GOOD_CURVES),
        "warning",
        "ScratchCurveTargets",
        ["targets /C but the distribution", "'worley'"],
    ),
    (
        "micrometres in uv space",
        material('uniform token scratch:layer:fine:space = "uv"\nfloat scratch:layer:fine:length = 0.1'),
        "error",
        "ScratchSizes",
        ["width of layer 'fine' is 10 in space 'uv'", "fraction"],
    ),
    (
        "width of nothing",
        material("float scratch:layer:fine:width = 0"),
        "warning",
        "ScratchSizes",
        ["width of layer 'fine' is 0", "invisible"],
    ),
    (
        "amount that is not read",
        material("float scratch:layer:fine:pitch = 5"),
        "warning",
        "ScratchSizes",
        ["pitch of layer 'fine' is 5", "'worley' does not read it", "coverage or density"],
    ),
    (
        "wider than their distance",
        material('uniform token scratch:layer:fine:distribution = "linear"\nfloat scratch:layer:fine:pitch = 5'),
        "warning",
        "ScratchSizes",
        ["width of layer 'fine' is 10", "5 apart", "overlap"],
    ),
    (
        "two amounts",
        material("float scratch:layer:fine:coverage = 0.2\nfloat scratch:layer:fine:density = 3"),
        "warning",
        "ScratchSizes",
        ["coverage of layer 'fine' is 0.2", "density 3 wins"],
    ),
    (
        "diffraction without wave optics",
        material('uniform token scratch:layer:fine:model = "diffraction"'),
        "error",
        "ScratchWave",
        ["'diffraction'", "lacks ScratchWaveAPI"],
    ),
    (
        "wavelengths the wrong way round",
        material("uniform float2 scratch:wave:wavelengthRange = (780, 380)", apis='"ScratchWaveAPI"'),
        "error",
        "ScratchWave",
        ["(780, 380)", "first wavelength must be the smaller"],
    ),
    (
        "index of another length",
        material(
            "uniform float[] scratch:wave:ior:wavelengths = [400, 700]\nuniform float[] scratch:wave:ior:eta = [1]",
            apis='"ScratchWaveAPI"',
        ),
        "error",
        "ScratchWave",
        ["differ in length", "scratch:wave:ior:wavelengths 2", "scratch:wave:ior:eta 1"],
    ),
    (
        "index not sorted",
        material(
            "uniform float[] scratch:wave:ior:wavelengths = [700, 400]\nuniform float[] scratch:wave:ior:eta = [1, 1]\n"
            "uniform float[] scratch:wave:ior:k = [1, 1]",
            apis='"ScratchWaveAPI"',
        ),
        "error",
        "ScratchWave",
        ["[1] is 400 after 700", "ascending"],
    ),
    (
        "modes of different lengths",
        material("uniform float[] scratch:measured:modes:azimuth = [0, 90]", apis='"ScratchMeasuredAPI"'),
        "error",
        "ScratchMeasured",
        ["differ in length", "azimuth 2"],
    ),
    (
        "no modes",
        material(apis='"ScratchMeasuredAPI"'),
        "error",
        "ScratchMeasured",
        ["'stencils' but it has no mode"],
    ),
    (
        "no measured file",
        material('uniform token scratch:measured:source = "file"', apis='"ScratchMeasuredAPI"'),
        "error",
        "ScratchMeasured",
        ["'file'", "scratch:measured:file is empty"],
    ),
    (
        "effect on and off",
        'def RenderSettings "R" {\nuniform string[] scratch:render:enableEffects = ["shadows"]\n'
        'uniform string[] scratch:render:disableEffects = ["shadows"]\n}',
        "error",
        "ScratchSettings",
        ["'shadows'", "keep one"],
    ),
]


@pytest.mark.parametrize(("text", "severity", "rule", "words"), [case[1:] for case in CASES], ids=[c[0] for c in CASES])
def test_rule(findings, text, severity, rule, words):
    """Exactly one finding: the right rule speaks, and no other rule speaks about the same thing."""
    found = findings(text)
    assert [(one.severity, one.rule) for one in found] == [(severity, f"scratchwarp:{rule}")], found
    assert all(word in found[0].message for word in words), found[0].message


def test_every_rule_has_a_case():
    themes = (validation_links, validation_profiles, validation_curves, validation_materials)
    elsewhere = {"ScratchUpAxis"}  # test_degenerate: about a stage, not a prim
    assert {case[3] for case in CASES} | elsewhere == {rule.name for theme in themes for rule in theme.RULES}


GOOD = [
    material(f"rel scratch:layer:fine:profile = </M/P>\n{points('[(0, 0), (0.5, -1), (1, 0)]')}"),
    material('uniform token scratch:layer:fine:distribution = "linear"\nfloat scratch:layer:fine:pitch = 15'),
    material(
        'uniform token scratch:layer:fine:distribution = "curves"\nrel scratch:layer:fine:curves = </C>',
        more=GOOD_CURVES,
    ),
    points("[(0, 0), (0.3, 0), (0.2, -1), (0.8, -1), (0.7, 0), (1, 0)]"),
    'def RenderSettings "R" {\nuniform string[] scratch:render:disableEffects = ["shadows"]\n}',
    'def Shader "S" {\nuniform token info:id = "ScratchSurface"\nfloat inputs:roughness = 0\n}',
    'def Sphere "S" {\n}',
]


@pytest.mark.parametrize("text", GOOD, ids=["profile", "pitch", "curves", "overhang", "settings", "node", "plain"])
def test_nothing_to_say(findings, text):
    assert findings(text) == []


def test_target_outside_the_referenced_prim(tmp_path):
    """USD drops such a target with a line on stderr; GetTargets and the composition errors do not show it."""
    body = "rel scratch:layer:fine:profile = </Profiles/P>"
    (tmp_path / "asset.usda").write_text(
        "#usda 1.0\n" + material(body, more='def Scope "Profiles" {\ndef ScratchProfile "P" {\n}\n}')
    )
    (tmp_path / "shot.usda").write_text('#usda 1.0\ndef "Use" (\nreferences = @./asset.usda@</M>\n) {\n}')
    found = validate(tmp_path / "shot.usda", core=False)
    assert [(one.rule, one.path) for one in found] == [("scratchwarp:ScratchProfileTargets", "/Use")]
    assert "targets /Profiles/P" in found[0].message and "outside the referenced prim" in found[0].message
