"""ScratchWaveAPI: applied once, to Materials only."""

import pytest
from pxr import Usd, UsdGeom

ATTRIBUTES = [
    ("scratch:wave:coherenceRadius", "float", 60.0, 0, None, None, "micrometer"),
    ("scratch:wave:phase", "token", "smallAngle", None, None, "smallAngle angleDependent", None),
    ("scratch:wave:summation", "token", "incoherent", None, None, "incoherent coherent", None),
    ("scratch:wave:sampling", "token", "auto", None, None, "auto lookup wavelengths rgb", None),
    ("scratch:wave:samples", "int", 32, 1, 1024, None, "none"),
    ("scratch:wave:wavelengthRange", "float2", (380, 780), 100, 20000, None, "nanometer"),
    ("scratch:wave:roughness", "float", 0.0, 0, None, None, "micrometer"),
    ("scratch:wave:ior:wavelengths", "float[]", [], 0, None, None, "nanometer"),
    ("scratch:wave:ior:eta", "float[]", [], 0, None, None, "none"),
    ("scratch:wave:ior:k", "float[]", [], 0, None, None, "none"),
]


def test_registered():
    assert Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchWaveAPI")


def test_applies(material):
    assert material.ApplyAPI("ScratchWaveAPI")
    assert material.HasAPI("ScratchWaveAPI")


def test_refuses_other_prims(stage):
    assert not UsdGeom.Mesh.Define(stage, "/Mesh").GetPrim().CanApplyAPI("ScratchWaveAPI")


@pytest.mark.parametrize("row", ATTRIBUTES, ids=lambda row: row[0])
def test_attribute(material, check, row):
    material.ApplyAPI("ScratchWaveAPI")
    check(material.GetAttribute(row[0]), *row[1:])


def test_every_attribute_is_tested():
    definition = Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchWaveAPI")
    assert set(definition.GetPropertyNames()) == {row[0] for row in ATTRIBUTES}
