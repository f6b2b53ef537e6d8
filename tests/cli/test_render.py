import json

import pytest

from scratchwarp import image
from scratchwarp.cli import main
from scratchwarp.scene import RenderOptions, RenderProduct, RenderVar


def status(*argv):
    """Exit status of the command line, argparse's own included."""
    try:
        return main([str(a) for a in argv])
    except SystemExit as exit:
        return exit.code


def test_one_image(renderer, tmp_path, capsys):
    out = tmp_path / "a.exr"
    assert status("render", "ball.usda", out, "-w", 480, "--spp", 4, "--seed", 7, "--threads", 2) == 0
    assert out.is_file() and capsys.readouterr().out == f"{out}\n"
    (path, how), (settings,) = renderer.reads[0], renderer.settings
    assert path == "ball.usda" and how["frame"] is None and how["purposes"] == ("default", "render")
    assert (settings.width, settings.spp, settings.seed, settings.threads) == (480, 4, 7, 2)


def test_what_usdrecord_calls_it(renderer, tmp_path):
    argv = ["-cam", "Close", "--purposes", "guide,render", "--mask", "/A,/B", "--sessionLayer", "s.usda", "-rs", "/R/S"]
    assert status("render", "a.usda", tmp_path / "a.exr", *argv, "-color", "disabled", "-f", "3") == 0
    assert renderer.reads[0][1] == {
        "frame": 3,
        "camera": "Close",
        "purposes": ("default", "render", "guide"),
        "mask": ("/A", "/B"),
        "session_layer": "s.usda",
        "render_settings": "/R/S",
        "default_time": False,
        "max_memory": None,
    }
    assert status("render", "a.usda", tmp_path / "a.exr", "--defaultTime") == 0
    assert renderer.reads[1][1]["default_time"] and renderer.reads[1][1]["frame"] is None


def test_renderer_options(renderer, tmp_path):
    argv = ["--quality", "final", "--maxError", "0.01", "--crop", 0, 0.5, 0.25, 1, "--integrator", "path"]
    argv += ["--filter", "box", "--effect", "shadows=off", "--effect", "lens=on", "--checkpoint", tmp_path / "c"]
    assert status("render", "a.usda", tmp_path / "a.exr", *argv, "--resume") == 0
    settings = renderer.settings[0]
    assert (settings.quality, settings.max_error, settings.crop) == ("final", 0.01, (0, 0.5, 0.25, 1))
    assert (settings.integrator, settings.filter, dict(settings.effects)) == (
        "path",
        "box",
        {"shadows": False, "lens": True},
    )
    (how,) = renderer.renders
    assert (how["checkpoint"], how["resume"], how["farm"]) == (str(tmp_path / "c"), True, None)


def test_frames_are_numbered_and_warned_about_once(renderer, tmp_path, capsys):
    renderer.warnings = ("/World/Ball: a subdivision cage is rendered as it is",)
    assert status("render", "a.usda", tmp_path / "a.##.png", "--frames", "1:5x2") == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.01.png", "a.03.png", "a.05.png"]
    assert [how["frame"] for _, how in renderer.reads] == [1, 3, 5]
    assert capsys.readouterr().err.count("subdivision cage") == 1


def test_json_is_one_object_an_image_and_nothing_else(renderer, tmp_path, capsys):
    renderer.warnings = ("w",)
    assert status("render", "a.usda", tmp_path / "a.exr", "--json") == 0
    row = json.loads(capsys.readouterr().out)
    assert row.pop("stats")["rays"] == 6 and row.pop("predicted") == {"trace": 1.0}
    assert row == {"image": str(tmp_path / "a.exr"), "frame": None, "warnings": ["w", "dim"]}


def test_quiet_says_nothing(renderer, tmp_path, capsys):
    renderer.warnings = ("w",)
    assert status("render", "a.usda", tmp_path / "a.exr", "--quiet") == 0
    assert capsys.readouterr() == ("", "")


def test_chosen_layers(renderer, tmp_path):
    assert status("render", "a.usda", tmp_path / "a.exr", "--aov", "color") == 0
    assert set(image.read_layers(tmp_path / "a.exr")[0]) == {"color", "alpha"}


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["render", "a.usda"], "OUT"),
        (["render", "a.usda", "a.exr", "--sp", "3"], "--sp"),
        (["render", "a.usda", "a.exr", "--spp", "many"], "many"),
        (["render", "a.usda", "a.exr", "--max-memory", "lots"], "no size such as"),
        (["render", "a.usda", "a.exr", "--spp", "-3"], "spp is -3"),
        (["render", "a.usda", "a.exr", "--maxError", "nan"], "max_error is nan"),
        (["render", "a.usda", "a.exr", "--crop", "0.5", "0.5", "0", "1"], "crop"),
        (["render", "a.usda", "a.exr", "--frames", "1:x"], "1:x"),
        (["render", "a.usda", "a.exr", "--frames", "1:3"], "###"),
        (["render", "a.usda", "a.#.exr", "--frames", "1:3", "--checkpoint", "c"], "###"),
        (["render", "a.usda", "a.exr", "--resume"], "--checkpoint"),
        (["render", "a.usda", "a.exr", "--scheduler", "farm:80"], "local:N"),
        (["render", "a.usda", "a.jpg"], ".png"),
        (["render", "a.usda", "a.exr", "--effect", "shadows"], "NAME=on"),
        (["render", "a.usda", "a.exr", "--effect", "glitter=on"], "scratches.worley"),
        (["render", "a.usda", "a.exr", "--purposes", "everything"], "guide"),
        (["render", "a.usda", "a.exr", "--aov", "dept"], "depth"),
        (["render", "a.usda", "a.png", "-color", "gamma"], "gamma"),
        (["render", "a.usda", "a.png", "--view", "Raw"], "openColorIO"),
        (["rendr"], "rendr"),
        ([], "COMMAND"),
    ],
)
def test_wrong_usage_is_2(renderer, capsys, argv, message):
    assert status(*argv) == 2
    assert message in capsys.readouterr().err
    assert not renderer.reads


@pytest.mark.parametrize("error", [ValueError, OSError, KeyError])
def test_a_fault_is_1_with_one_message_and_no_file(renderer, tmp_path, capsys, monkeypatch, error):
    def fail():
        raise error("ball.usda: /World/Ball: points[3] is nan")

    monkeypatch.delenv("SCRATCHWARP_DEBUG", raising=False)
    renderer.during_render = fail
    assert status("render", "ball.usda", tmp_path / "a.exr") == 1
    said = capsys.readouterr().err
    assert "/World/Ball: points[3] is nan" in said and said.count("\n") == 1
    assert ("fault of scratchwarp" in said) == (error is KeyError)
    assert not list(tmp_path.iterdir())


def test_debug_shows_where(renderer, tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("SCRATCHWARP_DEBUG", "1")
    renderer.during_render = lambda: [][0]
    assert status("render", "ball.usda", tmp_path / "a.exr") == 1
    assert "Traceback" in capsys.readouterr().err


def test_unwritable_output_is_1_before_anything_is_read(renderer, tmp_path, capsys):
    assert status("render", "a.usda", tmp_path / "none" / "a.exr") == 1
    assert status("render", "a.usda", tmp_path / "a.exr", "--checkpoint", tmp_path / "none" / "c") == 1
    assert capsys.readouterr().err.count("there is no folder") == 2
    assert not renderer.reads


def test_interrupt_is_130_and_leaves_the_old_image(renderer, tmp_path, capsys):
    def interrupt():
        raise KeyboardInterrupt

    renderer.during_render = interrupt
    out = tmp_path / "a.exr"
    out.write_text("old")
    kept = tmp_path / "c"
    assert status("render", "a.usda", out, "--checkpoint", kept) == 130
    assert "--resume" not in capsys.readouterr().err, "there is nothing to go on from"
    assert out.read_text() == "old" and list(tmp_path.iterdir()) == [out]
    kept.write_text("tiles")
    assert status("render", "a.usda", out, "--checkpoint", kept) == 130
    assert "--resume" in capsys.readouterr().err


def test_explain(renderer, capsys):
    assert status("explain", "a.usda", "--effect", "shadows=off") == 0
    assert capsys.readouterr().out == "shadows off nothing can occlude\n"
    assert status("explain", "a.usda", "--json") == 0
    effects = json.loads(capsys.readouterr().out)["effects"]
    assert effects == {"shadows": {"enabled": False, "reason": "nothing can occlude", "prims": ["/World/Ball"]}}


PIPELINES = ["author", "bake", "compare", "contact-sheet", "publish", "turntable", "zoom"]


@pytest.mark.parametrize(
    "command", ["render", "explain", "simulate", "validate", "view", "demo", "cache", *PIPELINES]
)
def test_help_has_examples(command, capsys):
    assert status(command, "--help") == 0
    assert f"examples:\n  scratchwarp {command}" in capsys.readouterr().out


def test_render_vars_of_the_stage_choose_the_layers(tmp_path, renderer, capsys):
    """By our names or by other renderers'; the command line comes first, and what we lack is told."""
    names = [RenderVar("beauty", "Ci"), RenderVar("z", "z"), RenderVar("cat", "cats")]
    renderer.options = RenderOptions(products=(RenderProduct("/Render/P", "p", tuple(names)),))
    assert main(["render", "ball.usda", str(tmp_path / "a.npz")]) == 0
    assert set(image.read_layers(tmp_path / "a.npz")[0]) == {"color", "alpha", "depth"}
    assert "'cats'" in capsys.readouterr().err
    assert main(["render", "ball.usda", str(tmp_path / "b.npz"), "--aov", "alpha"]) == 0
    assert set(image.read_layers(tmp_path / "b.npz")[0]) == {"color", "alpha"}
