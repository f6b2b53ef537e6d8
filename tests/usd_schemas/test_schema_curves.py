"""ScratchCurvesAPI: applied to Curves prims; depths and widths are primvars."""

import pytest
from pxr import Usd, UsdGeom

ATTRIBUTES = [
    ("scratch:curves:space", "token", "object", None, None, "object uv", None),
    ("primvars:scratch:depth", "float[]", None, 0, None, None, "micrometer"),
    ("primvars:scratch:width", "float[]", None, 0, None, None, "micrometer"),
]


@pytest.fixture
def curves(stage):
    prim = UsdGeom.BasisCurves.Define(stage, "/Curves").GetPrim()
    assert prim.ApplyAPI("ScratchCurvesAPI")
    return prim


def test_registered():
    assert Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchCurvesAPI")


def test_applies_to_every_kind_of_curves(curves, stage):
    assert curves.HasAPI("ScratchCurvesAPI")
    assert UsdGeom.NurbsCurves.Define(stage, "/Nurbs").GetPrim().CanApplyAPI("ScratchCurvesAPI")


def test_refuses_other_prims(stage, material):
    assert not material.CanApplyAPI("ScratchCurvesAPI")
    assert not UsdGeom.Mesh.Define(stage, "/Mesh").GetPrim().CanApplyAPI("ScratchCurvesAPI")


@pytest.mark.parametrize("row", ATTRIBUTES, ids=lambda row: row[0])
def test_attribute(curves, check, row):
    check(curves.GetAttribute(row[0]), *row[1:])


def test_every_attribute_is_tested():
    definition = Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchCurvesAPI")
    assert set(definition.GetPropertyNames()) == {row[0] for row in ATTRIBUTES}


@pytest.mark.parametrize("name", ["scratch:depth", "scratch:width"])
def test_sizes_are_one_for_each_curve(curves, name):
    primvar = UsdGeom.PrimvarsAPI(curves).GetPrimvar(name)
    assert primvar.IsDefined() and primvar.GetInterpolation() == "uniform"
