"""ScratchProfile: a typed prim that is no Imageable, with every parameter of every shape."""

import pytest
from pxr import Usd, UsdGeom

SHAPES = "flat vGroove rectangle trapezoid round quartic gaussian sine points"
ATTRIBUTES = [
    ("scratch:shape", "token", "vGroove", None, None, SHAPES, None),
    ("scratch:points", "float2[]", [], None, None, None, "none"),
    ("scratch:apex", "float", 0.5, 0, 1, None, "none"),
    ("scratch:floorWidth", "float", 0.5, 0, 1, None, "none"),
    ("scratch:sigma", "float", 1 / 6, 0, None, None, "none"),
    ("scratch:rim", "float", 0.0, 0, None, None, "none"),
    ("scratch:rimWidth", "float", 0.25, 0, 0.5, None, "none"),
    ("scratch:periodic", "bool", False, None, None, None, None),
]


@pytest.fixture
def profile(stage, material):
    return stage.DefinePrim("/Material/Profile", "ScratchProfile")


def test_registered():
    assert Usd.SchemaRegistry().FindConcretePrimDefinition("ScratchProfile")


def test_is_typed_but_not_imageable(profile):
    """An Imageable below a Material would break the encapsulation of the Material."""
    assert profile.IsA("ScratchProfile")
    assert not profile.IsA(UsdGeom.Imageable)


def test_is_no_api_schema():
    assert not Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchProfile")


@pytest.mark.parametrize("row", ATTRIBUTES, ids=lambda row: row[0])
def test_attribute(profile, check, row):
    check(profile.GetAttribute(row[0]), *row[1:])


def test_every_attribute_is_tested():
    definition = Usd.SchemaRegistry().FindConcretePrimDefinition("ScratchProfile")
    assert set(definition.GetPropertyNames()) == {row[0] for row in ATTRIBUTES}


def test_author_and_read_back(profile):
    profile.GetAttribute("scratch:shape").Set("points")
    profile.GetAttribute("scratch:points").Set([(0, 0), (0.5, -1), (1, 0)])
    assert profile.GetAttribute("scratch:shape").Get() == "points"
    assert [tuple(point) for point in profile.GetAttribute("scratch:points").Get()] == [(0, 0), (0.5, -1), (1, 0)]
