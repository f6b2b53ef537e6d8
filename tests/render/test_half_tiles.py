"""Tiles that were at work when a checkpoint was written."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.render import checkpoint

from . import scenes as S


def test_half_done_tiles_in_a_checkpoint_start_again(tmp_path):
    """What other threads had added to their tiles, or one tile had when it was interrupted, does not count twice."""
    world = S.scene([S.sphere(8, 16)], [S.scratched()], [S.dome()])
    settings = {"width": 48, "height": 32, "spp": 2, "tile": 16, "threads": 1, "filter": "box"}
    plan = sw.make_plan(world, sw.Settings(effects=S.EVERYTHING, **settings))
    file = tmp_path / "part"

    def stop(done, total, what):
        if what == "trace" and done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.render(world, plan, progress=stop, checkpoint=file)
    with np.load(file) as stored:
        sums = {name.removeprefix("sum_"): stored[name].copy() for name in stored.files if name.startswith("sum_")}
        key, finished = str(stored["key"]), stored["finished"]
    assert finished.tolist() == [True] + [False] * 5
    for values in sums.values():
        values[16:] += 3
    checkpoint.save(file, key, finished, sums)
    resumed, at_once = sw.render(world, plan, checkpoint=file, resume=True), sw.render(world, plan)
    for name, values in at_once.aovs.items():
        np.testing.assert_array_equal(resumed[name], values)


def test_tables_of_another_accuracy_are_another_render(tmp_path):
    world = S.scene([S.sphere(8, 16)], [S.scratched()], [S.dome()])
    once = {**S.EVERYTHING, "scratches.interreflection": False}
    settings = {"width": 32, "height": 32, "spp": 1, "filter": "box", "tile": 16}

    def stop(done, total, what):
        if what == "trace" and done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        plan = sw.make_plan(world, sw.Settings(effects=S.EVERYTHING, **settings))
        sw.render(world, plan, progress=stop, checkpoint=tmp_path / "part")
    other = sw.make_plan(world, sw.Settings(effects=once, **settings))
    with pytest.raises(ValueError, match="of another"):
        sw.render(world, other, checkpoint=tmp_path / "part", resume=True)
