"""The command line with the renderer behind it, each in a process of its own."""

import importlib
import json
import subprocess
import sys
from contextlib import contextmanager

import numpy as np
import pytest

from scratchwarp import image
from scratchwarp.cli import main
from scratchwarp.pipelines.author_demo import author


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    (stage,) = author(tmp_path_factory.mktemp("stages"), detail=0.1, names=["plain"])
    return stage


def run(*argv, **options):
    command = [sys.executable, "-m", "scratchwarp", *(str(a) for a in argv)]
    return subprocess.run(command, capture_output=True, text=True, **options)


def test_a_stage_becomes_an_image(plain, tmp_path):
    out = tmp_path / "a.exr"
    done = run("render", plain, out, "-w", 24, "--spp", 2, "--json")
    assert done.returncode == 0, done.stderr
    row = json.loads(done.stdout)
    assert row["stats"]["tables_simulated"] == 0 and row["stats"]["write"] > 0
    layers, header = image.read_layers(out)
    assert layers["color"].shape[1:] == (24, 3) and layers["color"].max() > 0
    assert header["scratchwarp:spp"] == 2 and len(header["worldToNDC"]) == 16


def test_a_crop_is_the_same_pixels(plain, tmp_path):
    assert run("render", plain, tmp_path / "whole.exr", "-w", 24, "--spp", 2).returncode == 0
    crop = ["--crop", 0.25, 0.75, 0.5, 1]
    assert run("render", plain, tmp_path / "part.exr", "-w", 24, "--spp", 2, *crop).returncode == 0
    whole, part = (image.read_layers(tmp_path / f"{n}.exr")[0]["color"] for n in ("whole", "part"))
    height = whole.shape[0]
    np.testing.assert_array_equal(part, whole[height // 2 :, 6:18])


def test_what_is_no_stage(tmp_path):
    (tmp_path / "bad.usda").write_text("this is no stage")
    for name in ("none.usda", "bad.usda"):
        done = run("render", tmp_path / name, tmp_path / "a.exr")
        assert done.returncode == 1
        assert name in done.stderr and "Traceback" not in done.stderr
    assert not (tmp_path / "a.exr").exists()


def test_interrupted_and_resumed_gives_the_same_bits(plain, tmp_path, monkeypatch, capsys):
    """Ctrl-C after a third of the tiles keeps them and no image; the rest then makes the image of one go."""
    rooms = importlib.import_module("scratchwarp.render")
    seen = []

    @contextmanager
    def interrupted(quiet):
        def progress(done, total, stage):
            if stage == "trace" and 3 * done > total:
                seen.append(done)
                raise KeyboardInterrupt

        yield lambda title: progress

    argv = [
        "render",
        str(plain),
        str(tmp_path / "a.exr"),
        "-w",
        "96",
        "--spp",
        "2",
        "--checkpoint",
        str(tmp_path / "c"),
    ]
    with monkeypatch.context() as patch:
        patch.setattr(rooms, "bars", interrupted)
        assert main(argv) == 130
    assert seen and "--resume" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["c"]
    assert main([*argv, "--resume"]) == 0
    assert main([*argv[:2], str(tmp_path / "b.exr"), *argv[3:-2]]) == 0
    resumed, at_once = (image.read_layers(tmp_path / f"{n}.exr")[0] for n in "ab")
    for name, values in at_once.items():
        np.testing.assert_array_equal(resumed[name], values)
