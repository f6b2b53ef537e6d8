"""scratchwarp study: what it is called with, and what it says."""

import json
from types import SimpleNamespace

import pytest

from scratchwarp.cli import main
from scratchwarp.study import command


@pytest.fixture
def swept(monkeypatch, renderer):
    calls = []
    row = SimpleNamespace(seconds=0.5, error=0.01, name="defaults")
    report = SimpleNamespace(pareto=lambda: [row], record=lambda: {"rows": []}, write=lambda folder: f"{folder}/page")

    def sweep(scene, knobs, **how):
        calls.append((knobs, how))
        if how["settings"].seed == 13:
            raise KeyboardInterrupt
        return report

    monkeypatch.setattr(command, "sweep", sweep)
    return calls


def test_knobs_budget_and_settings_are_handed_on(swept, capsys):
    assert main(["study", "a.usda", "out", "--knobs", "spp,tables.rays", "--budget", "10m", "--repeats", "2"]) == 0
    knobs, how = swept[0]
    assert knobs == ("spp", "tables.rays") and (how["repeats"], how["budget"], how["folder"]) == (2, 600.0, "out")
    assert how["settings"].width == 160
    said = capsys.readouterr().out
    assert "defaults" in said and said.splitlines()[-1] == "out/page"


def test_json(swept, capsys):
    assert main(["study", "a.usda", "out", "--json", "-w", "32"]) == 0
    assert json.loads(capsys.readouterr().out) == {"rows": []}
    assert swept[0][0] is None and swept[0][1]["budget"] is None


def test_an_interruption_says_how_to_go_on(swept, capsys):
    assert main(["study", "a.usda", "out", "--seed", "13"]) == 130
    assert "kept in out; the same command goes on" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("extra", "says"),
    [
        (["--knobs", "glitter"], "'glitter' is not one of spp"),
        (["--budget", "soon"], "'soon' is no time"),
        (["--repeats", "0"], "--repeats 0"),
        (["--knob", "spp=0"], "spp is '0'"),
        (["--knob", "spp"], "is not NAME=VALUE"),
    ],
)
def test_wrong_usage(swept, capsys, extra, says):
    assert main(["study", "a.usda", "out", *extra]) == 2
    assert says in capsys.readouterr().err
