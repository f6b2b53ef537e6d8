"""The door of the validator: files, order of findings, OpenUSD's own rules beside ours."""

import dataclasses

import pytest
from pxr import UsdValidation

from scratchwarp.scene import StageError
from scratchwarp.stage.validation import Finding, fix, validate
from scratchwarp.stage.validation_framework import RULES, full_name, register_rules

CLEAN = """#usda 1.0
(
    defaultPrim = "World"
    metersPerUnit = 1
    upAxis = "Y"
)
def Xform "World"
{
    def Scope "mtl"
    {
        def Material "Brushed" (
            prepend apiSchemas = ["ScratchLayerAPI:fine", "ScratchWaveAPI"]
        )
        {
            token outputs:surface.connect = </World/mtl/Brushed/Preview.outputs:surface>
            token outputs:scratchwarp:surface.connect = </World/mtl/Brushed/Own.outputs:surface>
            rel scratch:layer:fine:profile = </World/mtl/Brushed/Vee>

            def Shader "Preview"
            {
                uniform token info:id = "UsdPreviewSurface"
                token outputs:surface
            }
            def Shader "Own"
            {
                uniform token info:id = "ScratchSurface"
                float inputs:roughness = 0.2
                token outputs:surface
            }
            def ScratchProfile "Vee"
            {
            }
        }
    }
}
"""


def test_clean_stage_has_no_findings_of_ours_or_usd(tmp_path):
    """A ScratchProfile and a ScratchSurface in a Material pass USD's encapsulation and shader rules, too."""
    path = tmp_path / "clean.usda"
    path.write_text(CLEAN)
    assert validate(path) == []


def test_findings_of_usd_are_there_and_can_be_left_out(tmp_path):
    path = tmp_path / "bare.usda"
    path.write_text(CLEAN.replace('defaultPrim = "World"', ""))
    found = validate(path)
    assert [one.rule for one in found] == ["usdValidation:StageMetadataChecker"]
    assert "defaultPrim" in found[0].message and found[0].severity == "error"
    assert validate(path, core=False) == []


def test_materialx_nodes_are_no_error(tmp_path):
    """The wheel of USD does not know them, so a file that uses them is not at fault."""
    path = tmp_path / "mtlx.usda"
    path.write_text(CLEAN.replace('"UsdPreviewSurface"', '"ND_standard_surface_surfaceshader"'))
    (found,) = validate(path)
    assert found.severity == "warning" and "MaterialX" in found.message


def test_materialx_files_are_no_error(tmp_path):
    path = tmp_path / "mtlx.usda"
    (tmp_path / "look.mtlx").write_text('<?xml version="1.0"?><materialx version="1.38"></materialx>')
    path.write_text(
        CLEAN.replace('def Scope "mtl"', 'def "look" (\nreferences = @./look.mtlx@\n)\n{\n}\ndef Scope "mtl"')
    )
    found = validate(path)
    assert {one.severity for one in found} == {"warning"} and all("MaterialX" in one.message for one in found), found


def test_validation_prints_nothing(tmp_path, capfd):
    path = tmp_path / "quiet.usda"
    path.write_text(CLEAN.replace("rel scratch", "rel scratch:layer:fine:curves = </World/gone>\nrel scratch", 1))
    assert validate(path)
    assert capfd.readouterr() == ("", "")


def test_errors_come_first(tmp_path):
    path = tmp_path / "two.usda"
    bad = "float scratch:layer:fine:width = -1\nfloat scratch:layer:fine:pitch = 3\n"
    path.write_text(CLEAN.replace("rel scratch", bad + "rel scratch", 1))
    found = validate(path)
    assert [one.severity for one in found] == ["error", "warning"]
    assert {one.path for one in found} == {"/World/mtl/Brushed"}
    assert str(found[0]).startswith("error: /World/mtl/Brushed: scratch:layer:fine:width is -1")


def test_same_findings_every_time(tmp_path):
    path = tmp_path / "bad.usda"
    path.write_text(CLEAN.replace("rel scratch", "float scratch:layer:fine:witdh = 1\nrel scratch", 1))
    assert validate(path) == validate(path) != []


def test_fix_removes_what_has_no_effect_and_nothing_else(tmp_path):
    path = tmp_path / "orphan.usda"
    orphan, misspelt = "float scratch:layer:gone:width = 1\n", "float scratch:layer:fine:witdh = 1\n"
    path.write_text(CLEAN.replace("rel scratch", orphan + misspelt + "rel scratch", 1))
    (fixed,) = fix(path)
    assert "scratch:layer:gone:width has no effect" in fixed.message
    assert [one.rule for one in validate(path)] == ["scratchwarp:ScratchNames"]
    assert "gone" not in path.read_text() and "witdh" in path.read_text()


def test_fix_leaves_a_sound_file_alone(tmp_path):
    path = tmp_path / "clean.usda"
    path.write_text(CLEAN)
    assert fix(path) == [] and path.read_text() == CLEAN


def test_missing_file(tmp_path):
    with pytest.raises(StageError, match=r"gone\.usda: no such file"):
        validate(tmp_path / "gone.usda")


@pytest.mark.parametrize("name", ["words.usda", "words.usdc", "words.usdz", "words.usd", "words.txt"])
def test_file_that_is_no_usd(tmp_path, name):
    path = tmp_path / name
    path.write_text("These are words.")
    with pytest.raises(StageError, match=r"words\.\w+: (is no USD|cannot be)"):
        validate(path)


def test_finding_is_frozen():
    with pytest.raises(dataclasses.FrozenInstanceError):
        Finding("error", "rule", "/", "message").path = "/Other"


def test_rules_are_registered_once_with_documentation():
    """Other programs find them in OpenUSD's registry by keyword."""
    register_rules()
    register_rules()
    listed = UsdValidation.ValidationRegistry().GetValidatorMetadataForKeyword("scratchwarp")
    assert sorted(entry.name for entry in listed) == sorted(full_name(rule) for rule in RULES)
    assert all(entry.doc for entry in listed)
