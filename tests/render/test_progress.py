import io
import sys

import pytest

from scratchwarp.render.progress import bar, speed


class Terminal(io.StringIO):
    def isatty(self):
        return True


def run(quiet):
    with bar(quiet, "ball.exr") as progress:
        for done in (0, 50, 100):
            progress(done, 100, "trace")


def test_a_terminal_sees_a_bar(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    run(quiet=False)
    assert "ball.exr trace" in sys.stderr.getvalue() and "100%" in sys.stderr.getvalue()


@pytest.mark.parametrize(("stream", "quiet"), [(Terminal, True), (io.StringIO, False)])
def test_quiet_and_pipes_see_nothing(monkeypatch, stream, quiet):
    monkeypatch.setattr(sys, "stderr", stream())
    run(quiet)
    assert sys.stderr.getvalue() == ""


def test_speed():
    shown = [speed(s) for s in (None, 12.0, 1500.0, 2.5e6, 3e9)]
    assert shown == ["", "12 samples/s", "1.5 k samples/s", "2.5 M samples/s", "3 G samples/s"]
