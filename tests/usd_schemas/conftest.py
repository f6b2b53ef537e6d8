"""Registered schemas, and a check of an attribute that every schema's test uses."""

import pytest
from pxr import Usd, UsdShade

from scratchwarp import usd_schemas

usd_schemas.register()


@pytest.fixture
def stage():
    return Usd.Stage.CreateInMemory()


@pytest.fixture
def material(stage):
    return UsdShade.Material.Define(stage, "/Material").GetPrim()


@pytest.fixture
def check():
    """A function that compares an attribute with what the schema promises."""

    def check(attribute, type_name, default, low=None, high=None, tokens=None, unit=None):
        assert attribute.IsDefined(), attribute.GetPath()
        assert attribute.GetTypeName() == type_name
        assert same(attribute.Get(), default), attribute.Get()
        hard = (attribute.GetMetadata("limits") or {}).get("hard", {})
        assert (hard.get("minimum"), hard.get("maximum")) == (low, high)
        assert list(attribute.GetMetadata("allowedTokens") or []) == (tokens.split() if tokens else [])
        assert attribute.GetMetadata("scratchUnits") == unit
        assert attribute.GetMetadata("displayName") and attribute.GetMetadata("displayGroup")

    return check


def same(value, expected):
    """Equal to float32 precision; None and empty arrays only to themselves."""
    if expected is None or isinstance(expected, str | bool):
        return value == expected
    if isinstance(expected, tuple | list):
        return value is not None and list(value) == pytest.approx(list(expected), rel=1e-6)
    return value == pytest.approx(expected, rel=1e-6)
