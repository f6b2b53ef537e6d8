"""The simulated farm, and the job template for farms of another kind."""

import json
import math
import re
from pathlib import Path

import pytest

from scratchwarp import arguments
from scratchwarp.pipelines.farm_model import Costs, main, simulated

EVEN = Costs(width=256, height=256, spread=0.0, slow=0.0, dies=0.0, scene=0.0, ready=0.0, task=0.0, pixel=0.0)


def test_without_costs_a_farm_is_ideal():
    """64 equal tiles: n workers take as many rounds as it takes; 1 takes the work itself."""
    work = 256 * 256 * 256 * 10e-6
    for workers in (1, 2, 4, 8):
        found = simulated(EVEN, workers)
        assert found.ideal == pytest.approx(work / workers) and found.seconds == pytest.approx(found.ideal)
    assert simulated(EVEN, 1000).seconds == pytest.approx(work / 64)


def test_each_cost_counts():
    from dataclasses import replace

    ideal = simulated(EVEN, 8).seconds
    assert simulated(replace(EVEN, ready=5.0), 8).seconds == pytest.approx(ideal + 5.0)
    sent = simulated(replace(EVEN, scene=1e9), 8)
    assert sent.seconds == pytest.approx(ideal + 4.0), "one worker after 1 s, 2 after 2, 4 after 3, 8 after 4"
    assert simulated(replace(EVEN, task=1.0), 8).seconds >= 64.0
    for worse in ({"slow": 0.5}, {"dies": 2000.0}, {"spread": 1.0}, {"pixel": 1e5}):
        assert simulated(replace(EVEN, **worse), 8).seconds > 1.02 * ideal, worse


def test_command(capsys):
    assert main(["--workers", "1", "1000", "--width", "320", "--height", "200", "--json"]) == 0
    farms = json.loads(capsys.readouterr().out)["farms"]
    assert [farm["workers"] for farm in farms] == [1, 1000] and farms[1]["of use"] < farms[0]["of use"] <= 1.0
    assert main(["--workers", "2"]) == 0
    assert capsys.readouterr().out.splitlines()[2].startswith("| 2 | 2040 |")
    assert main(["--workers", "0"]) == 2


def test_the_job_template_fits_the_command_line():
    """Every name in braces is defined, and what it runs is understood."""
    template = json.loads(
        (Path(__file__).resolve().parents[2] / "docs" / "farm.openjd.json").read_text(encoding="utf-8")
    )
    assert template["specificationVersion"] == "jobtemplate-2023-09" and len(template["name"]) <= 128
    given = {p["name"]: p for p in template["parameterDefinitions"]}
    assert all(p["type"] in ("STRING", "INT", "FLOAT", "PATH") for p in given.values())
    (step,) = template["steps"]
    (frame,) = step["parameterSpace"]["taskParameterDefinitions"]
    assert (frame["type"], frame["range"]) == ("INT", "{{Param.Frames}}")
    run = step["script"]["actions"]["onRun"]
    assert run["command"] == "scratchwarp" and run["cancelation"]["mode"] == "NOTIFY_THEN_TERMINATE"
    values = {f"Param.{name}": str(p.get("default", f"/{name}")) for name, p in given.items()}
    values[f"Task.Param.{frame['name']}"] = "7"
    said = [re.sub(r"\{\{([\w.]+)\}\}", lambda m: values[m[1]], arg) for arg in (*run["args"], template["name"])]
    args = arguments.parser().parse_args(said[:-1])
    assert (args.stage, args.frames, args.imageWidth, args.resume) == ("/Stage", "7", 1920, True)
    assert arguments.settings(args).quality == "final" and args.checkpoint == "/OutDir/frame.####.part"
    assert math.isclose(args.maxMemory, 8e9)
