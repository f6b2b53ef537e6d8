"""The farm: the bits of one machine, whoever renders what, in whatever order, and whoever dies."""

import os
import signal
import sys
import threading
import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.kernels import kernel_key
from scratchwarp.render import Control, Farm, beside, side_by_side
from scratchwarp.render.farm import TASKS_A_WORKER, grouped, workers_of
from scratchwarp.render.farm_data import packed
from scratchwarp.render.tiles import tiles
from scratchwarp.render.trace import Job

from . import scenes as S


def planned(**settings):
    world = S.scene([S.sphere(8, 16)], [S.scratched(depth=75.0)], [S.dome()])
    knobs = {"tables.resolution": 32, "tables.bounces": 1}
    settings = {"width": 48, "height": 48, "spp": 4, "tile": 8, "filter": "box", "knobs": knobs, **settings}
    return world, sw.make_plan(world, sw.Settings(effects=S.EVERYTHING, **settings))


def test_four_workers_one_killed_in_the_middle(tmp_path, monkeypatch):
    """Also with passes to a target, and with a checkpoint, which one machine then takes up."""
    pytest.importorskip("distributed")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(p for p in sys.path if p))
    world, plan = planned()
    first = sw.render(world, plan)
    world, plan = planned(spp=2, max_error=first.stats["error"] / 14.0)
    alone = sw.render(world, plan)
    assert alone.stats["samples"] > 2 * 48 * 48 and not alone.warnings
    file = tmp_path / "part"
    with Farm("local:4") as farm:
        killed = []

        def kill(done, total, what):
            if what == "trace" and 3 * done > total and not killed:
                killed.append(next(iter(farm.client.run(os.getpid).values())))
                os.kill(killed[0], signal.SIGKILL)

        film = sw.render(world, plan, farm=farm, progress=kill)
        assert killed

        def stop(done, total, what):
            if what == "trace" and 2 * done > total:
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            sw.render(world, plan, farm=farm, progress=stop, checkpoint=file)
    resumed = sw.render(world, plan, checkpoint=file, resume=True)
    for name, values in alone.aovs.items():
        np.testing.assert_array_equal(film[name], values, err_msg=name)
        np.testing.assert_array_equal(resumed[name], values, err_msg=name)
    for name in ("samples", "rays", "error", "invalid_samples"):
        assert film.stats[name] == alone.stats[name]
    assert film.warnings == alone.warnings and film.stats["kernels_launched"] > 0


def test_frames_go_out_beside_one_another(monkeypatch):
    """The camera moves; a worker is killed in the middle; what frames have in common is sent once."""
    pytest.importorskip("distributed")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(p for p in sys.path if p))
    monkeypatch.setattr("scratchwarp.render.farm_data.PART", 1024)
    world, plan = planned()
    frames = [
        replace(world, camera=replace(world.camera, transform=S.place(0, 0, (0.1 * i, 0, 0)).transform))
        for i in range(5)
    ]
    plans = [sw.make_plan(frame, plan.settings) for frame in frames]
    alone = [sw.render(frame, its) for frame, its in zip(frames, plans, strict=True)]
    assert not np.array_equal(alone[0]["color"], alone[4]["color"])
    under, most, sent, killed = set(), [], [], []
    with Farm("local:2") as farm:
        scatter = farm.client.scatter

        def noted(data, **how):
            sent.append(len(data))
            return scatter(data, **how)

        monkeypatch.setattr(farm.client, "scatter", noted)

        def maker(i):
            def progress(done, total, what):
                most.append(len(under))
                if i == 2 and what == "trace" and 2 * done > total and not killed:
                    killed.append(next(iter(farm.client.run(os.getpid).values())))
                    os.kill(killed[0], signal.SIGKILL)

            def make(control):
                under.add(i)
                try:
                    return i, sw.render(frames[i], plans[i], farm=farm, control=control, progress=progress)
                finally:
                    under.discard(i)

            return make

        films = list(side_by_side(farm, map(maker, range(5))))
        assert farm.flying == 0
    assert killed and [i for i, _ in films] == list(range(5))
    for (_, film), wanted in zip(films, alone, strict=True):
        for name, values in wanted.aovs.items():
            np.testing.assert_array_equal(film[name], values, err_msg=name)
    assert 2 <= max(most) <= beside.AHEAD
    (mesh,) = packed(world, plan, [], kernel_key(world, plan), "cpu").parts.values()
    assert 1 <= sent.count(len(mesh)) <= 2  # again where the workers that had it died


def test_images_beside_one_another_come_in_order_and_a_failure_stops_those_after_it():
    farm = SimpleNamespace(memory=None, largest=1)
    begun, stopped = [], []

    def maker(i, fails=-1):
        def make(control):
            begun.append(i)
            control.handed.set()
            if i == fails:
                raise ValueError("frame 2 is at fault")
            if fails >= 0 and i > fails:
                stopped.append(control.stop.wait(10.0))
            time.sleep(0.05 * (3 - i % 3))
            return i

        return make

    assert list(side_by_side(farm, map(maker, range(20)))) == list(range(20))
    farm.largest = 1e15  # no memory: two at a time all the same
    assert list(side_by_side(farm, map(maker, range(4)))) == list(range(4))
    farm.largest = 1
    made = side_by_side(farm, [maker(i, 2) for i in range(8)])
    assert [next(made), next(made)] == [0, 1]
    with pytest.raises(ValueError, match="frame 2"):
        next(made)
    assert all(stopped)
    control, seen = Control(), threading.Event()

    def waits(mine):
        seen.set()
        assert mine.snapshot.wait(10.0) and mine.stop.wait(10.0)

    def ask():
        seen.wait(10.0)
        control.snapshot.set()
        time.sleep(0.3)
        control.stop.set()

    threading.Thread(target=ask).start()
    with pytest.raises(KeyboardInterrupt):
        next(side_by_side(farm, [waits], control))


def test_tiles_go_together_but_not_all_of_them():
    jobs = [Job(tile, 0, 1) for tile in tiles(320, 320, 8)]
    for threads in (1, 4, 1000):
        groups = grouped(jobs, threads)
        assert [job for group in groups for job in group] == jobs
        assert len(groups) >= min(len(jobs), TASKS_A_WORKER * threads)
    assert len(grouped(jobs, 1)) < 60
    assert all(len(group) == 1 for group in grouped([Job(tile, 0, 1 << 16) for tile in tiles(64, 64, 8)], 1))
    assert grouped([], 3) == []


def test_addresses():
    assert [workers_of(a) for a in ("local:4", "tcp://farm:8786", "tls://10.0.0.1:8786")] == [4, 0, 0]
    for wrong in ("local:0", "local", "local:-1", "local:many", "farm:8786", "tcp://farm", "http://farm:80", ""):
        with pytest.raises(ValueError, match="is not local:N"):
            Farm(wrong)


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ImportError, match=r"scratchwarp\[farm\]"):
        Farm("local:2")


def test_nobody_answers(monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr("scratchwarp.render.farm.WAIT", 0.3)
    with pytest.raises(OSError, match="tcp://127.0.0.1:9: does not answer"):
        Farm("tcp://127.0.0.1:9")
