"""The farm: the bits of one machine, whoever renders what, in whatever order, and whoever dies."""

import os
import signal
import sys

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.render import Farm
from scratchwarp.render.farm import TASKS_A_WORKER, grouped, workers_of
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
    world, plan = planned(max_error=first.stats["error"] / 3.0)
    alone = sw.render(world, plan)
    assert alone.stats["samples"] > first.stats["samples"]
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
