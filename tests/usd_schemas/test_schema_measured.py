"""ScratchMeasuredAPI: applied once, to Materials only; one array a parameter of the modes."""

import pytest
from pxr import Usd, UsdGeom

ATTRIBUTES = [
    ("source", "token", "stencils", None, None, "stencils file", None),
    ("file", "asset", None, None, None, None, None),
    ("format", "token", "auto", None, None, "auto utia merl rgl", None),
    ("beta", "float", 0.0, 0, 1, None, "none"),
    ("background", "color3f", (0, 0, 0), 0, None, None, "none"),
    ("k", "float", 0.0, 0, None, None, "none"),
    ("specularAlpha", "float", 1.0, 0, None, None, "none"),
    ("retro", "bool", False, None, None, None, None),
    ("mask", "token", "smooth", None, None, "smooth binary", None),
    ("modes:azimuth", "float[]", [], None, None, None, "degree"),
    ("modes:width", "float[]", [], 0, 1, None, "none"),
    ("modes:a", "float[]", [], None, None, None, "none"),
    ("modes:b", "float[]", [], None, None, None, "none"),
    ("modes:kd", "float[]", [], None, None, None, "none"),
    ("modes:ks", "float[]", [], None, None, None, "none"),
    ("modes:alpha", "float[]", [], 0, None, None, "none"),
    ("modes:beta", "float[]", [], 0, 1, None, "none"),
    ("modes:color", "color3f[]", [], 0, None, None, "none"),
]


def test_registered():
    assert Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchMeasuredAPI")


def test_applies(material):
    assert material.ApplyAPI("ScratchMeasuredAPI")
    assert material.HasAPI("ScratchMeasuredAPI")


def test_refuses_other_prims(stage):
    assert not UsdGeom.Mesh.Define(stage, "/Mesh").GetPrim().CanApplyAPI("ScratchMeasuredAPI")


@pytest.mark.parametrize("row", ATTRIBUTES, ids=lambda row: row[0])
def test_attribute(material, check, row):
    material.ApplyAPI("ScratchMeasuredAPI")
    check(material.GetAttribute(f"scratch:measured:{row[0]}"), *row[1:])


def test_every_attribute_is_tested():
    definition = Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchMeasuredAPI")
    assert set(definition.GetPropertyNames()) == {f"scratch:measured:{row[0]}" for row in ATTRIBUTES}
