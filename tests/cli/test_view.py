import pytest

from scratchwarp import viewers
from scratchwarp.cli import main


@pytest.fixture
def shown(monkeypatch):
    calls = []
    monkeypatch.setattr(viewers, "view", lambda *args, **options: calls.append((*args, options)))
    return calls


def test_screenshot(shown):
    argv = ["view", "a.usda", "--screenshot", "a.png", "-f", "12.5", "-cam", "Close", "-w", "200", "--spp", "2"]
    assert main(argv) == 0
    assert shown == [("a.usda", "a.png", {"frame": 12.5, "camera": "Close", "width": 200, "spp": 2})]


def test_the_window_decides_what_is_left_out(shown):
    assert main(["view", "a.usda"]) == 0
    assert shown == [("a.usda", None, {"frame": None, "camera": None})]


@pytest.mark.parametrize("frame", ["1:3", "x"])
def test_a_window_shows_one_frame(shown, capsys, frame):
    assert main(["view", "a.usda", "--frame", frame]) == 2
    assert not shown


def test_help_lists_the_keys(capsys):
    with pytest.raises(SystemExit):
        main(["view", "--help"])
    said = capsys.readouterr().out
    assert all(f"  {key}  {what}" in said for key, what in (*viewers.KEYS.items(), *viewers.PROFILE_KEYS.items()))


@pytest.mark.parametrize(
    ("argv", "source", "layer", "depth"),
    [
        (["a.usda", "--profile"], "a.usda", "", None),
        (["a.usda", "--profile", "fine", "--depth", "0.3"], "a.usda", "fine", 0.3),
        (["quartic"], "quartic", "", None),
    ],
)
def test_one_profile(monkeypatch, argv, source, layer, depth):
    calls = []
    monkeypatch.setattr(viewers, "view_profile", lambda *args, **options: calls.append((*args, options)))
    assert main(["view", *argv]) == 0
    assert calls == [(source, None, {"layer": layer, "depth": depth, "frame": None, "camera": None})]


@pytest.mark.parametrize("argv", [["a.usda", "--depth", "1"], ["quartic", "--spp", "2"]])
def test_options_of_the_other_window_are_refused(shown, capsys, argv):
    assert main(["view", *argv]) == 2
    assert argv[1] in capsys.readouterr().err and not shown


def test_the_lobe_of_one_scratch(monkeypatch, capsys):
    calls = []
    monkeypatch.setattr(viewers, "view_lobe", lambda *args: calls.append(args))
    assert main(["view", "lobe", "--screenshot", "a.png"]) == 0
    assert calls == [("a.png",)]
    assert main(["view", "lobe", "--spp", "2"]) == 2
    assert "lobe" in capsys.readouterr().err and len(calls) == 1
