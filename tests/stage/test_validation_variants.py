"""Every combination of variants is looked at, and fixing writes a copy that needs no guess."""

import pytest
from pxr import Sdf, Usd

from scratchwarp.scene import StageError
from scratchwarp.stage.validation import validate
from scratchwarp.stage.validation_variants import combinations, fixed_copy, validate_variants

STAGE = """#usda 1.0
(
    defaultPrim = "World"
    metersPerUnit = 1
    upAxis = "Y"
)
def Xform "World" (
    prepend variantSets = ["wear", "size"]
    variants = {
        string wear = "new"
        string size = "small"
    }
)
{
    variantSet "size" = {
        "big" {
        }
        "small" {
        }
    }
    variantSet "wear" = {
        "new" {
        }
        "worn" (
            prepend variantSets = "where"
        ) {
            variantSet "where" = {
                "edges" {
                    def Material "Steel" (
                        prepend apiSchemas = ["ScratchLayerAPI:fine"]
                    )
                    {
                        float scratch:layer:fine:width = -1
                        float scratch:layer:gone:width = 1
                    }
                }
                "faces" {
                }
            }
        }
    }
}
"""


@pytest.fixture
def stage(tmp_path):
    path = tmp_path / "stage.usda"
    path.write_text(STAGE)
    return path


def test_combinations_with_nested_sets(stage):
    """new x 2 sizes and worn x 2 places x 2 sizes; the session layer is as before."""
    opened = Usd.Stage.Open(str(stage))
    found = [tuple(choice.values()) for choice in combinations(opened)]
    assert sorted(map(sorted, found)) == sorted(
        map(sorted, [("new", s) for s in ("big", "small")] + [("worn", p, s) for p in ("edges", "faces")
                                                              for s in ("big", "small")])
    )  # fmt: skip
    assert not opened.GetSessionLayer().subLayerPaths


def test_a_fault_in_a_variant_that_is_not_chosen(stage):
    before = stage.read_bytes()
    assert validate(stage) == []
    found, count = validate_variants(stage)
    assert count == 6 and stage.read_bytes() == before
    (width,) = [one for one in found if "width is -1" in one.message]
    assert width.severity == "error" and "{wear=worn}" in width.variants and "{where=edges}" in width.variants
    assert f"(with {width.variants})" in str(width)


def test_the_limit_is_said(stage):
    found, count = validate_variants(stage, limit=2)
    assert count == 2 and any("more than 2 combinations" in one.message for one in found)


def test_fixed_copy(tmp_path):
    path, out = tmp_path / "bare.usda", tmp_path / "fixed.usda"
    path.write_text(
        '#usda 1.0\ndef Xform "World"\n{\n    def Material "Steel"\n    {\n'
        "        float scratch:layer:gone:width = 1\n        float other = 2\n    }\n}\n"
    )
    before = path.read_bytes()
    said = fixed_copy(path, out)
    assert path.read_bytes() == before and len(said) == 4
    layer = Sdf.Layer.FindOrOpen(str(out))
    assert layer.defaultPrim == "World" and layer.pseudoRoot.GetInfo("metersPerUnit") == 0.01
    assert "gone" not in out.read_text() and "other" in out.read_text()
    first = out.read_bytes()
    assert fixed_copy(path, out) == said and out.read_bytes() == first
    assert not [one for one in validate(out) if one.rule.endswith("StageMetadataChecker")]


def test_fixing_never_writes_into_its_input(stage, tmp_path):
    with pytest.raises(ValueError, match="is a file of the stage"):
        fixed_copy(stage, stage)
    (tmp_path / "other").mkdir()
    with pytest.raises(StageError, match="has to lie beside"):
        fixed_copy(stage, tmp_path / "other" / "out.usda")
