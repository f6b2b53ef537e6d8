"""The generated files: fresh, strict JSON, and with the documentation of the source."""

import importlib
import json
import re
from pathlib import Path

import pytest
from pxr import Sdf

from scratchwarp import usd_schemas

pytest.importorskip("jinja2", reason="usdGenSchema needs jinja2, which the extra `test` brings")
generate = importlib.import_module("scratchwarp.usd_schemas.generate")
RESOURCES = usd_schemas.plugin_path() / usd_schemas.PLUGIN_NAME / "resources"


@pytest.fixture(scope="module")
def files():
    return generate.generate()


def test_generated_files_are_fresh(files):
    assert generate.stale(files) == []


def test_a_changed_source_is_noticed(files):
    """Guards the guard: an attribute that only the new text holds makes its file stale."""
    name = "scratchSchema/resources/generatedSchema.usda"
    assert generate.stale({**files, name: files[name].replace("scratch:apex", "scratch:tip")}) == [name]


@pytest.mark.parametrize("path", [usd_schemas.plugin_path() / "plugInfo.json", RESOURCES / "plugInfo.json"])
def test_plugin_files_are_strict_json(path: Path):
    assert json.loads(path.read_text())


def test_plugin_names_every_schema():
    types = json.loads((RESOURCES / "plugInfo.json").read_text())["Plugins"][0]["Info"]["Types"]
    assert set(types) == set(usd_schemas.SCHEMAS)


SOURCE = Sdf.Layer.FindOrOpen(str(usd_schemas.plugin_path() / "schema.usda"))
PATHS = [str(prop.path) for cls in SOURCE.rootPrims for prop in cls.properties]
NUMERIC = ("float", "int", "float2", "color3f")


@pytest.mark.parametrize("path", PATHS)
def test_documentation_agrees_with_limits(path):
    """Range: and Units: lines say what `limits` and `scratchUnits` say."""
    prop = SOURCE.GetPropertyAtPath(path)
    assert prop.documentation
    if not isinstance(prop, Sdf.AttributeSpec):
        return
    assert bool(prop.allowedTokens) == (prop.typeName == "token" and "Primvar" not in path)
    if str(prop.typeName.scalarType) not in NUMERIC:
        return
    units = re.search(r"^\s*Units: (\S+)", prop.documentation, re.MULTILINE)
    assert units and units[1] == prop.GetInfo("scratchUnits")
    if prop.name == "scratch:points":
        return
    left, low, high, right = re.search(
        r"^\s*Range: ([\[(])(\S+), (\S+?)([\])])$", prop.documentation, re.MULTILINE
    ).groups()
    hard = (prop.GetInfo("limits") or {}).get("hard", {})
    assert float(low) == pytest.approx(hard.get("minimum", float("-inf")))
    assert float(high) == pytest.approx(hard.get("maximum", float("inf")))
    assert (left == "(") == ("minimum" not in hard or bool(hard.get("exclusiveMinimum")))
    assert (right == ")") == ("maximum" not in hard or bool(hard.get("exclusiveMaximum")))
