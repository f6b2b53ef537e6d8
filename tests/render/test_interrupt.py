"""Renders that are ended in every way: none loses more than the tiles it was at."""

import json
import os
import signal
import subprocess
import sys
import textwrap
import threading

import pytest

from scratchwarp.render.interrupt import Control, signals

needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="children are made by fork")


def script(code, *argv, **options):
    """A process of its own on a piece of Python."""
    return subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(code), *map(str, argv)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)},
        **options,
    )


KILLED = """
    import importlib.util, json, os, random, signal, sys, time
    import numpy as np
    import scratchwarp as sw
    from scratchwarp.kernels import kernel_key
    from scratchwarp.render.canvas import Canvas
    from scratchwarp.render.checkpoint import Checkpoint
    from scratchwarp.render.described import described

    spec = importlib.util.spec_from_file_location("scenes", sys.argv[2])
    S = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(S)
    world = S.scene([S.sphere(8, 16)], [S.scratched(depth=75.0)], [S.dome()])
    how = {"width": 64, "height": 64, "tile": 8, "filter": "box", "threads": 1, "effects": S.EVERYTHING}
    how["knobs"] = {"tables.resolution": 32, "tables.bounces": 1}
    first = sw.render(world, sw.make_plan(world, sw.Settings(spp=32, **how)))
    plan = sw.make_plan(world, sw.Settings(spp=32, max_error=first.stats["error"] / 300.0, **how))
    whole, file = sw.render(world, plan), sys.argv[1]
    plan_samples = whole.metadata["scratchwarp:spp"]
    kept, dice = [], random.Random(int(sys.argv[3]))
    def written():
        return os.stat(file).st_mtime_ns if os.path.exists(file) else 0

    for _ in range(5):
        before = written()
        child = os.fork()
        if child == 0:
            sw.render(world, plan, checkpoint=file, resume=True, keep=True)
            time.sleep(1000)
        while written() == before and sum(n for _, n in kept[-1:]) < 64 * plan_samples:
            time.sleep(0.001)
        time.sleep(0.3 * whole.stats["trace"] * dice.random())
        os.kill(child, signal.SIGKILL)
        killed = os.WIFSIGNALED(os.waitpid(child, 0)[1])
        canvas = Canvas(64, 64, 8, remembers=True)
        about = described(world, plan, kernel_key(world, plan))
        if os.path.exists(file):
            kept.append((killed, int(Checkpoint.resume(file, about, canvas.tiles, canvas.sums).samples.sum())))
    begun = []
    film = sw.render(world, plan, checkpoint=file, resume=True, progress=lambda d, t, w: begun.append((w, d)))
    print(json.dumps({
        "same": all(np.array_equal(film[name], whole[name]) for name in whole),
        "kept": kept,
        "begun": next(done for what, done in begun if what == "trace"),
        "passes": whole.metadata["scratchwarp:spp"] // 32,
    }))
"""


@needs_fork
def test_killed_five_times_and_resumed(tmp_path):
    """With -9, at random moments of three passes: what is on disk only grows, and the image has the same bits."""
    scenes = os.path.join(os.path.dirname(__file__), "scenes.py")
    seed = int.from_bytes(os.urandom(4), "little")
    done, said = script(KILLED, tmp_path / "part", scenes, seed).communicate(timeout=300)
    found = json.loads(done.splitlines()[-1]) if done else {}
    assert found, said[-2000:]
    samples = [n for _, n in found["kept"]]
    assert found["same"] and found["passes"] >= 4, f"seed {seed}: {found}"
    assert samples == sorted(samples) and found["begun"] == 64 * samples[-1], f"seed {seed}: {found}"


BUSY = """
    import hashlib, sys
    from scratchwarp.render.interrupt import signals
    with signals(lambda: print("late", flush=True)):
        try:
            print("busy", flush=True)
            hashlib.pbkdf2_hmac("sha256", b"native", b"code", 1 << 30)  # for minutes, out of reach of Python
        except KeyboardInterrupt:  # the signal came before that
            hashlib.pbkdf2_hmac("sha256", b"native", b"code", 1 << 30)
"""


def test_native_code_does_not_keep_a_process_alive():
    process = script(BUSY)
    assert process.stdout.readline() == "busy\n"
    process.send_signal(signal.SIGTERM)
    out, said = process.communicate(timeout=60)
    assert process.returncode == 130 and out == "late\n" and said == ""


def test_a_signal_stops_and_is_forgotten():
    before = {n: signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)}
    with pytest.raises(KeyboardInterrupt), signals(lambda: None) as control:
        signal.raise_signal(signal.SIGTERM)
        raise AssertionError("it went on")
    assert control.stop.is_set() and not control.snapshot.is_set()
    assert before == {n: signal.getsignal(n) for n in before}


@pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="this system has no SIGUSR1")
def test_a_snapshot_is_asked_for():
    with signals(lambda: None) as control:
        signal.raise_signal(signal.SIGUSR1)
        assert control.snapshot.wait(10.0) and not control.stop.is_set()


def test_other_threads_have_no_signals():
    found = []

    def run():
        with signals(lambda: None) as control:
            found.append(control)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert isinstance(found[0], Control)
