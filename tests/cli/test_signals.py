"""Signals to a render that is under way, in a process of its own.

However little of the machine is left to them: the limits of time only end what hangs, and a render that is to be seen
before its end asks for that itself, for it may be over before this process gets to run again.
"""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from scratchwarp import image
from scratchwarp.cli import main
from scratchwarp.pipelines.author_demo import author

ASKING = """
import os, pathlib, signal, sys, threading, time
from scratchwarp.cli import main

part, snapshot = map(pathlib.Path, sys.argv[1:3])

def ask():
    while not snapshot.exists():
        if part.exists():
            os.kill(os.getpid(), signal.SIGUSR1)
        time.sleep(0.05)

threading.Thread(target=ask, daemon=True).start()
sys.exit(main(sys.argv[3:]))
"""


def until(true, process, seconds=600.0):
    ends = time.monotonic() + seconds
    while not true():
        assert process.poll() is None and time.monotonic() < ends, process.communicate()[1]
        time.sleep(0.02)


@pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="this system has no SIGUSR1")
def test_a_snapshot_then_the_end_then_the_rest(tmp_path, capsys):
    """SIGUSR1 shows the tiles that are there; SIGTERM ends with the checkpoint; --resume makes the rest of it."""
    (stage,) = author(tmp_path / "stages", detail=0.1, names=["plain"])
    out, part, snapshot = tmp_path / "a.exr", tmp_path / "a.part", tmp_path / "a.snapshot.exr"
    command = [sys.executable, "-m", "scratchwarp", "render", str(stage), str(out), "-w", "96", "--threads", "2"]
    command += ["--checkpoint", str(part), "--resume", "--spp"]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    process = subprocess.Popen([*command, "100000"], stderr=subprocess.PIPE, text=True, env=env)
    until(part.exists, process)
    process.send_signal(signal.SIGUSR1)
    process.send_signal(signal.SIGTERM)
    said = process.communicate(timeout=600)[1]
    assert process.returncode == 130 and f"{part} is kept" in said, said
    assert part.exists() and not out.exists()
    assert main([*command[3:], "60"]) == 1
    assert "spp is 60 here and 100000 there" in capsys.readouterr().err
    part.unlink()
    asking = [sys.executable, "-c", ASKING, str(part), str(snapshot), *command[3:], "60"]
    process = subprocess.Popen(asking, stderr=subprocess.PIPE, text=True, env=env)
    said = process.communicate(timeout=600)[1]
    assert process.returncode == 0 and f"snapshot {snapshot}" in said, said
    assert not part.exists()
    seen, whole = image.read_layers(snapshot)[0], image.read_layers(out)[0]
    there = seen["alpha"] > 0
    assert 0.05 < there.mean() < 1.0
    np.testing.assert_array_equal(seen["color"][there], whole["color"][there])
