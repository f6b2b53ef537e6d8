"""Layers on an asset that exists: the asset stays as it is, what is written is valid, and wear wears."""

import json

import pytest
from pxr import Sdf, Usd

import scratchwarp as sw
from scratchwarp import cli
from scratchwarp.pipelines import author, looks
from scratchwarp.pipelines.put_on import put_on
from scratchwarp.scratches.expand import sublayers
from scratchwarp.stage.validation import validate, validate_stage

PRESETS = looks.presets()


def layers_of(scene, name):
    return next(m.layers for m in scene.materials if m.path.endswith(f"/{name}"))


def area(layers):
    """Share of the surface that is scratched: 1 - product (1 - coverage)."""
    clear = 1.0
    for layer in layers:
        for sublayer in sublayers(layer):
            clear *= 1.0 - sublayer.coverage
    return 1.0 - clear


def read_at(path, wear, folder):
    """The scene of ``path`` with another choice of wear, made by a session layer."""
    over = folder / f"session_{wear}.usda"
    chosen = f'    variants = {{\n        string wear = "{wear}"\n    }}'
    over.write_text(f'#usda 1.0\nover "World" (\n{chosen}\n)\n{{\n}}\n')
    return sw.read(path, session_layer=str(over))


def test_there_are_the_presets_that_people_ask_for():
    assert len(PRESETS) >= 12
    assert all(len(looks.about(path)) > 60 for path in PRESETS.values())


@pytest.mark.parametrize("name", PRESETS)
def test_preset(name, asset):
    """Valid without a warning in every state of wear, by itself and on an asset; more wear is more scratched area,
    deeper and with higher rims."""
    stage = Usd.Stage.Open(str(PRESETS[name]))
    for wear in looks.WEAR:
        stage.GetDefaultPrim().GetVariantSets().SetSelection("wear", wear)
        assert validate_stage(stage) == []
    out = asset.with_name("worn.usda")
    put_on(asset, out, looks.read_preset(PRESETS[name]), "steel", surface=True)
    assert validate(out) == []
    found = []
    for wear in looks.WEAR:
        scene = read_at(out, wear, asset.parent)
        assert scene.warnings == ()
        found.append(layers_of(scene, "steel"))
    assert sw.make_plan(sw.read(out), sw.Settings(width=16, quality="draft")).warnings == ()
    areas = [area(layers) for layers in found]
    assert areas[0] < areas[1] < areas[2]
    for less, more in zip(found, found[1:], strict=False):
        assert [layer.name for layer in less] == [layer.name for layer in more]
        assert all(a.depth <= b.depth and a.profile.rim <= b.profile.rim for a, b in zip(less, more, strict=True))
        assert any(a.depth < b.depth for a, b in zip(less, more, strict=True))


def test_the_asset_stays_as_it_is_and_twice_is_once(asset, capsys):
    before, out = asset.read_bytes(), asset.with_name("out.usda")
    argv = [str(asset), str(out), "--preset", "worn-brass", "--material", "*", "--json"]
    assert author.main(argv) == 0
    record = json.loads(capsys.readouterr().out)
    assert [row["path"] for row in record["materials"]] == ["/World/mtl/steel", "/World/mtl/wood"]
    first = out.read_bytes()
    assert author.main(argv) == 0
    assert out.read_bytes() == first and asset.read_bytes() == before
    assert Sdf.Layer.FindOrOpen(str(out)).subLayerPaths == ["./cup.usda"]
    assert not layers_of(sw.read(asset), "steel")
    assert sorted(p.name for p in asset.parent.iterdir()) == ["cup.usda", "out.usda"]


def test_attributes_without_a_preset(asset):
    out = asset.with_name("out.usda")
    values = ["--set=width=20", "--set=coverage=0.3", "--set=profile.rim=0.2", "--set=profile.shape=round"]
    argv = ["author", str(asset), str(out), "--layer=hair", "--material=w*d", "--wear=worn", "--quiet", *values]
    assert cli.main(argv) == 0
    (layer,) = layers_of(sw.read(out), "wood")
    assert (layer.name, layer.width, layer.profile.shape) == ("hair", 20.0, "round")
    assert layer.coverage == pytest.approx(1 - 0.7**2.2) and layer.profile.rim == pytest.approx(0.28)
    assert not layers_of(sw.read(out), "steel")


def test_what_is_set_wins_over_the_preset_and_wears_on(asset):
    look = looks.with_values(looks.read_preset(PRESETS["worn-brass"]), ["hairlines.coverage=0.5", "handling.width=99"])
    out = asset.with_name("out.usda")
    put_on(asset, out, look, "steel", wear="new")
    hairlines, handling = layers_of(sw.read(out), "steel")
    assert hairlines.coverage == pytest.approx(1 - 0.5**0.35, rel=1e-5) and handling.width == 99.0


def test_layers_over_layers_keep_both(asset):
    """Author over what author wrote: names differ, and one choice of wear serves both."""
    first, second = asset.with_name("first.usda"), asset.with_name("second.usda")
    put_on(asset, first, looks.read_preset(PRESETS["worn-brass"]), "steel")
    made = put_on(first, second, looks.read_preset(PRESETS["polished-gold"]), "steel", wear="worn")
    assert made == {"/World/mtl/steel": ["cloth", "handling2"]}
    assert validate(second) == []
    names = [layer.name for layer in layers_of(sw.read(second), "steel")]
    assert sorted(names) == ["cloth", "hairlines", "handling", "handling2"]


def test_the_surface_is_kept_unless_asked_for(asset):
    kept, taken = asset.with_name("kept.usda"), asset.with_name("taken.usda")
    for out, surface in ((kept, False), (taken, True)):
        put_on(asset, out, looks.read_preset(PRESETS["car-paint"]), "steel", surface=surface)
    stages = [Usd.Stage.Open(str(path)) for path in (kept, taken)]
    names = [s.GetPrimAtPath("/World/mtl/steel").GetAttribute("outputs:surface").GetConnections()[0].GetPrimPath().name
             for s in stages]  # fmt: skip
    assert names == ["preview", "Preview"]


@pytest.mark.parametrize(
    "argv, says",
    [
        (["--preset", "worn-brass"], "choose by --material"),
        (["--preset", "worn-brass", "--material", "glass"], "no material matches 'glass'"),
        (["--preset", "mirror", "--material", "steel"], "nor one of brushed-aluminium"),
        (["--set", "widht=3", "--material", "steel"], "no attribute 'widht'"),
        (["--set", "width=wide", "--material", "steel"], "'wide' is no float"),
        (["--set", "width=-3", "--material", "steel"], "width"),
        (["--set", "distribution=wordly", "--material", "steel"], "wordly"),
        (["--set", "coat.width=3", "--material", "steel"], "no layer 'coat'"),
    ],
)
def test_faults_are_named_and_nothing_is_written(asset, argv, says, capsys):
    assert cli.main(["author", str(asset), str(asset.with_name("out.usda")), *argv]) == 1
    assert says in capsys.readouterr().err
    assert [p.name for p in asset.parent.iterdir()] == ["cup.usda"]


def test_never_into_its_input(asset, capsys):
    before = asset.read_bytes()
    assert cli.main(["author", str(asset), str(asset), "--preset", "vinyl", "--material", "*"]) == 1
    assert "is a file of the stage" in capsys.readouterr().err and asset.read_bytes() == before


def test_usage(capsys):
    assert cli.main(["author", "--list", "--json"]) == 0
    assert set(json.loads(capsys.readouterr().out)) == set(PRESETS)
    assert cli.main(["author", "a.usda", "b.usda"]) == 2
    assert "--list lists the presets" in capsys.readouterr().err
