"""ScratchRenderSettingsAPI: there on every RenderSettings prim without being applied."""

import pytest
from pxr import Usd, UsdRender

ATTRIBUTES = [
    ("samplesPerPixel", "int", 16, 1, 1048576, None, "none"),
    ("seed", "int", 0, 0, None, None, "none"),
    ("maxError", "float", None, 0, None, None, "none"),
    ("quality", "token", None, None, None, "draft preview final reference", None),
    ("integrator", "token", "direct", None, None, "direct path", None),
    ("maxDepth", "int", 8, 1, 1024, None, "none"),
    ("pixelFilter", "token", "blackmanHarris", None, None, "box gaussian blackmanHarris", None),
    ("filterWidth", "float", None, 0, 64, None, "pixel"),
    ("knobs", "string[]", [], None, None, None, None),
    ("enableEffects", "string[]", [], None, None, None, None),
    ("disableEffects", "string[]", [], None, None, None, None),
]


@pytest.fixture
def settings(stage):
    return UsdRender.Settings.Define(stage, "/Render/Settings").GetPrim()


def test_registered():
    assert Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchRenderSettingsAPI")


def test_applied_without_being_authored(settings):
    assert settings.HasAPI("ScratchRenderSettingsAPI")
    assert settings.GetMetadata("apiSchemas") is None


def test_refuses_other_prims(material):
    assert not material.HasAPI("ScratchRenderSettingsAPI")


@pytest.mark.parametrize("row", ATTRIBUTES, ids=lambda row: row[0])
def test_attribute(settings, check, row):
    check(settings.GetAttribute(f"scratch:render:{row[0]}"), *row[1:])


def test_every_attribute_is_tested():
    definition = Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchRenderSettingsAPI")
    assert set(definition.GetPropertyNames()) == {f"scratch:render:{row[0]}" for row in ATTRIBUTES}
