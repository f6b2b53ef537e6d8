"""The file of what knobs leave, made from nothing on a ball of a few pixels."""

import json

import pytest

import scratchwarp as sw
from scratchwarp.cli import main
from scratchwarp.plan.cost import models
from scratchwarp.study import error_calibration
from scratchwarp.study.error_calibration import calibrate_errors
from scratchwarp.study.error_cases import cases, deep_grooves, round_grooves, under_lamps, under_windows

from ..render import scenes as S

KNOBS = ("tables.bounces", "lights.coneTaps")


@pytest.fixture(scope="module")
def ball():
    return S.scene([S.sphere(8, 16)], [S.scratched(S.lambert(0.3), depth=75.0)], [S.dome()])


def test_cases_of_a_stage_let_more_knobs_act(ball):
    found = {case.name: case.knobs for case in cases("ball", ball, sw.Settings(width=12, spp=4))}
    taps = ("lights.coneTaps",)
    assert {name: own for name, own in found.items() if name != "ball"} == {
        "ball under windows": taps,
        "ball under lamps": taps,
    }
    assert {"tables.bounces", *taps} < set(found["ball"]) and "grooves.lines" not in found["ball"]
    for lit in (under_windows(ball), under_lamps(ball)):
        pixels = lit.textures[lit.lights[0].texture].pixels
        assert pixels.max() > 10.0 * pixels.min()
    assert round_grooves(ball).materials[0].layers[0].profile.shape == "round"
    deep = deep_grooves(ball).materials[0].layers[0]
    assert deep.depth >= deep.width and deep.metal == "gold"


def test_an_interrupted_calibration_goes_on_to_the_same_file(ball, tmp_path, monkeypatch):
    """Deep scratches lose light without later bounces; one line is measured once, whatever happens in between."""
    left, asked = error_calibration.left, []

    def measured(scene, settings, names):
        asked.append(names)
        if len(asked) == 3:
            raise KeyboardInterrupt
        return left(scene, settings, names)

    monkeypatch.setattr(error_calibration, "left", measured)
    file, part = tmp_path / "errors.json", tmp_path / "errors.json.part"
    with pytest.raises(KeyboardInterrupt):
        calibrate_errors([("ball", ball)], file, 8, 2, knobs=KNOBS)
    assert not file.exists() and len(part.read_text().splitlines()) == 3  # the noise and two knobs
    part.write_text(part.read_text()[:-20])  # the last line is cut off
    told = []
    calibrate_errors([("ball", ball)], file, 8, 2, lambda *now: told.append(now), KNOBS)
    assert asked[3:] == [("lights.coneTaps",)] * 3 and told[0][:2] == (0, 5) and told[-1][:2] == (5, 5)
    assert not part.exists()
    record = json.loads(file.read_text())
    assert "processors" in record["machine"] and "Warp" in record["versions"] and len(record["date"]) == 10
    assert record["width"] == 8 and record["spp"] == 2
    assert record["stages"]["ball"] == ["tables.bounces"]
    assert record["stages"]["ball under windows"] == record["stages"]["ball under lamps"] == ["lights.coneTaps"]
    bounces = list(record["bias"]["tables.bounces"].values())
    assert bounces[0] > 10.0 * bounces[-2] and bounces[-1] == 0.0
    assert record["bias"]["lights.coneTaps"]["1"] > record["bias"]["lights.coneTaps"]["32"] >= 0.0
    found = models.read_errors(file)
    assert found.bias["tables.bounces"]["1"] == bounces[0] and found.noise[0] > 0.0


def test_ones_own_errors_are_found(tmp_path, monkeypatch):
    """Targets go by the user's own file; qualities, which are the same everywhere, by the shipped one."""
    monkeypatch.setenv("SCRATCHWARP_CACHE", str(tmp_path))
    assert models.errors() == models.shipped_errors() and models.errors().bias
    record = {"format": models.FORMAT, "bias": {"tables.rays": {"8": 0.5}}, "noisier": {}, "noise": [0.3, 1.1]}
    models.user_errors().write_text(json.dumps(record))
    assert models.errors().bias == {"tables.rays": {"8": 0.5}} and models.errors().noise == (0.3, 1.1)
    assert models.shipped_errors().bias != models.errors().bias
    models.user_errors().write_text(json.dumps({**record, "format": 0}) + " ")
    assert models.errors() == models.shipped_errors()


def test_the_command(tmp_path, monkeypatch, capsys):
    from scratchwarp.pipelines import calibrate

    calls, made = [], tmp_path / "own.json"
    monkeypatch.setattr(calibrate, "calibrate_errors", lambda stages, *how: calls.append(how) or made)
    monkeypatch.setattr(calibrate, "author", lambda folder, names: [])
    assert main(["study", "--calibrate", "--errors", "--json"]) == 0
    assert str(made) in capsys.readouterr().out and calls[0][0] is None
    assert calibrate.main([str(tmp_path / "e.json"), "--errors", "--width", "16"]) == 0
    assert calls[1][:2] == (tmp_path / "e.json", 16)
    assert main(["study", "a.usda", "out", "--errors"]) == 2
    assert "study --calibrate --errors" in capsys.readouterr().err
    with pytest.raises(SystemExit, match="2"):
        calibrate.main(["--errors", "--knobs", "spp"])
