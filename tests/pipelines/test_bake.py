"""Baked tables: used to the bit, and never when they are stale or damaged."""

import json

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import cli
from scratchwarp.pipelines import looks
from scratchwarp.pipelines.put_on import put_on
from scratchwarp.render.baked import bake_folder


def author(asset, *values):
    """worn.usda with one layer."""
    out = asset.with_name("worn.usda")
    look = looks.with_values(looks.plain_look("hair"), ["coverage=0.4", "depth=5", *values])
    put_on(asset, out, look, "*")
    return out


def rendered(stage, **reading):
    scene = sw.read(stage, **reading)
    return sw.render(scene, sw.make_plan(scene, sw.Settings(width=16, spp=2, quality="draft")))


def bake(stage, *options):
    return cli.main(["bake", str(stage), "--quality=draft", "--json", *options])


@pytest.fixture
def worn(asset):
    return author(asset)


def test_a_bake_is_used_to_the_bit(worn, capsys):
    plain = rendered(worn)
    assert plain.stats["tables_simulated"] == 1
    before = {p.name: p.read_bytes() for p in worn.parent.iterdir()}
    capsys.readouterr()  # Warp's greeting, in a process that the command line did not start
    assert bake(worn) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["tables"] == 1 and "hair" in record["layers"][0]
    files = {p.name: p.read_bytes() for p in bake_folder(worn).iterdir()}
    found = rendered(worn)
    assert found.stats["tables_simulated"] == 0 and found.warnings == plain.warnings
    assert np.array_equal(found["color"], plain["color"])
    assert bake(worn) == 0 and {p.name: p.read_bytes() for p in bake_folder(worn).iterdir()} == files
    assert {p.name: p.read_bytes() for p in worn.parent.iterdir() if p.is_file()} == before


def test_a_stale_bake_is_said_and_not_used(worn, asset, capsys):
    assert bake(worn) == 0
    author(asset, "depth=3")
    found = rendered(worn)
    (said,) = found.warnings
    assert "hair" in said and "is stale" in said and found.stats["tables_simulated"] == 1
    files = {p.name for p in bake_folder(worn).iterdir()}
    assert bake(worn) == 0
    assert len({p.name for p in bake_folder(worn).iterdir()} - files) == 1 == len(files) - 2
    again = rendered(worn)
    assert again.warnings == () and np.array_equal(again["color"], found["color"])


def test_coverage_is_found_again_and_never_stale(worn, asset, monkeypatch, capsys):
    """A plan takes the thresholds that were baked and computes none; another coverage is computed, and said to be."""
    from scratchwarp.scratches import worley

    plain = rendered(worn)
    capsys.readouterr()
    assert bake(worn) == 0 and json.loads(capsys.readouterr().out)["thresholds"] == 1
    asked = []
    monkeypatch.setattr(worley, "threshold", lambda *given: asked.append(given) or 0.3)
    found = rendered(worn)
    assert asked == [] and found.warnings == () and np.array_equal(found["color"], plain["color"])
    author(asset, "coverage=0.25")
    other = sw.make_plan(sw.read(worn), sw.Settings(width=16, spp=2, quality="draft"))
    assert asked and [said for said in other.warnings if "coverage" in said and "is stale" in said]


@pytest.mark.parametrize("what", ["table", "index", "coverage"])
def test_a_damaged_bake_is_said_and_not_used(worn, what, capsys):
    plain = rendered(worn)
    assert bake(worn) == 0
    pattern = {"table": "*.npz", "index": "bake.json", "coverage": "coverage.json"}[what]
    (file,) = bake_folder(worn).glob(pattern)
    file.write_bytes(file.read_bytes()[:-20])
    found = rendered(worn)
    assert any(file.name in said for said in found.warnings)
    assert found.stats["tables_simulated"] == (0 if what == "coverage" else 1)
    assert np.array_equal(found["color"], plain["color"])


def test_every_state_of_wear_is_baked(worn, tmp_path, capsys):
    assert bake(worn, "--variants=wear") == 0
    assert json.loads(capsys.readouterr().out)["tables"] == 3
    session = tmp_path / "session.usda"
    session.write_text('#usda 1.0\nover "World" (\n    variants = {\n        string wear = "new"\n    }\n)\n{\n}\n')
    found = rendered(worn, session_layer=str(session))
    assert found.stats["tables_simulated"] == 0 and found.warnings == ()


def test_nothing_to_bake(asset, capsys):
    assert bake(asset) == 1
    assert "nothing to bake" in capsys.readouterr().err and not bake_folder(asset).exists()
