"""ScratchLayerAPI: applied several times, to Materials only."""

import pytest
from pxr import Usd, UsdGeom

MODELS = "auto table diffraction groove normalMap ashikhminShirley tabulatedNdf singleBounce mirror fullTable"
METALS = "custom aluminium gold copper silver iron brass"
ATTRIBUTES = [
    ("enabled", "bool", True, None, None, None, None),
    ("order", "int", 0, None, None, None, "none"),
    ("model", "token", "auto", None, None, MODELS, None),
    ("distribution", "token", "worley", None, None, "worley random linear concentric spiral crosshatch curves", None),
    ("space", "token", "surface", None, None, "surface uv", None),
    ("width", "float", 10.0, 0, None, None, "micrometer"),
    ("depth", "float", 1.0, 0, None, None, "micrometer"),
    ("length", "float", 1000.0, 0, None, None, "micrometer"),
    ("coverage", "float", 0.1, 0, 1, None, "none"),
    ("density", "float", 0.0, 0, None, None, "1/millimeter^2"),
    ("pitch", "float", 100.0, 0, None, None, "micrometer"),
    ("patterns", "int", 1, 1, 64, None, "none"),
    ("angle", "float", 0.0, None, None, None, "degree"),
    ("angleSpread", "float", 0.0, 0, 360, None, "degree"),
    ("crossAngle", "float", 90.0, 0, 180, None, "degree"),
    ("curvature", "float", 0.0, -360, 360, None, "degree"),
    ("offset", "float2", (0, 0), None, None, None, "none"),
    ("center", "float2", (0.5, 0.5), None, None, None, "none"),
    ("seed", "int", 0, 0, None, None, "none"),
    ("widthVariation", "float", 0.0, 0, 1, None, "none"),
    ("depthVariation", "float", 0.0, 0, 1, None, "none"),
    ("profileVariation", "float", 0.0, 0, 1, None, "none"),
    ("variationLength", "float", 0.0, 0, None, None, "micrometer"),
    ("ends", "token", "cap", None, None, "cap mitre", None),
    ("material", "token", "inherit", None, None, "inherit conductor dielectric diffuse", None),
    ("metal", "token", "aluminium", None, None, METALS, None),
    ("eta", "color3f", (1.3456, 0.9652, 0.6172), 0, None, None, "none"),
    ("k", "color3f", (7.4746, 6.3995, 5.3031), 0, None, None, "none"),
    ("ior", "float", 1.5, 0, None, None, "none"),
    ("diffuseColor", "color3f", (0.18, 0.18, 0.18), 0, 1, None, "none"),
    ("fresnelModel", "token", "exact", None, None, "exact schlick lazanyi lazanyiError mirror", None),
    ("maskTexture", "asset", None, None, None, None, None),
    ("maskPrimvar", "token", "", None, None, None, None),
    ("orientationTexture", "asset", None, None, None, None, None),
    ("orientationEncoding", "token", "vector", None, None, "angle vector", None),
    ("orientationPrimvar", "token", "", None, None, None, None),
    ("normalTexture", "asset", None, None, None, None, None),
    ("normalRepeats", "float2", (1, 1), None, None, None, "none"),
    ("normalStrength", "float", 1.0, 0, None, None, "none"),
    ("normalDeformation", "token", "linear", None, None, "linear sqrt none", None),
    ("facets", "token", "ashikhminShirley", None, None, "ashikhminShirley ward beckmann ggx", None),
    ("facetRoughness", "float2", (0.3, 0.1), None, None, None, "none"),
]
RELATIONSHIPS = {"profile", "profileEnd", "curves"}


@pytest.fixture
def layered(material):
    assert material.ApplyAPI("ScratchLayerAPI", "fine")
    return material


def test_registered():
    assert Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchLayerAPI")
    assert Usd.SchemaRegistry.IsMultipleApplyAPISchema("ScratchLayerAPI")


def test_applies_many_times(layered):
    assert layered.ApplyAPI("ScratchLayerAPI", "coarse")
    assert layered.HasAPI("ScratchLayerAPI", "fine") and layered.HasAPI("ScratchLayerAPI", "coarse")
    layered.GetAttribute("scratch:layer:fine:width").Set(3)
    assert layered.GetAttribute("scratch:layer:coarse:width").Get() == 10


def test_refuses_other_prims(stage):
    mesh = UsdGeom.Mesh.Define(stage, "/Mesh").GetPrim()
    assert not mesh.CanApplyAPI("ScratchLayerAPI", "fine")


@pytest.mark.parametrize("name", ["3d", "depth"])
def test_refuses_instance_name(material, name):
    """USD itself refuses a leading digit and the name of an attribute."""
    assert not material.CanApplyAPI("ScratchLayerAPI", name)


@pytest.mark.parametrize("row", ATTRIBUTES, ids=lambda row: row[0])
def test_attribute(layered, check, row):
    check(layered.GetAttribute(f"scratch:layer:fine:{row[0]}"), *row[1:])


def test_every_property_is_tested():
    definition = Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchLayerAPI")
    names = {name.rpartition(":")[2] for name in definition.GetPropertyNames()}
    assert names == {row[0] for row in ATTRIBUTES} | RELATIONSHIPS


def test_profile_follows_a_reference(stage, layered):
    """A profile below its Material is found again wherever the Material is referenced."""
    stage.DefinePrim("/Material/Vee", "ScratchProfile")
    layered.GetRelationship("scratch:layer:fine:profile").SetTargets(["/Material/Vee"])
    other = stage.DefinePrim("/Other")
    other.GetReferences().AddInternalReference("/Material")
    targets = other.GetRelationship("scratch:layer:fine:profile").GetTargets()
    assert [str(path) for path in targets] == ["/Other/Vee"]
