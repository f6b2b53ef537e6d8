"""Tiles that were at work when a render was ended."""

import numpy as np
import pytest

import scratchwarp as sw

from . import scenes as S


def stop(done, total, what):
    if what == "trace" and done:
        raise KeyboardInterrupt


def test_a_tile_that_was_written_in_part_starts_again(tmp_path):
    """As kill -9 leaves it: whatever the length of the file, what is whole in it is used and the rest is rendered."""
    world = S.scene([S.sphere(8, 16)], [S.scratched()], [S.dome()])
    settings = {"width": 48, "height": 32, "spp": 2, "tile": 16, "threads": 1, "filter": "box"}
    plan = sw.make_plan(world, sw.Settings(effects=S.EVERYTHING, **settings))
    at_once = sw.render(world, plan)
    file = tmp_path / "part"
    with pytest.raises(KeyboardInterrupt):
        sw.render(world, plan, progress=lambda d, t, w: stop(3 * d > t, t, w), checkpoint=file)
    whole = file.read_bytes()
    for kept in (len(whole), len(whole) - 1, len(whole) - 5000, len(whole) // 2, 8000):
        file.write_bytes(whole[:kept])
        begun = []
        resumed = sw.render(
            world, plan, checkpoint=file, resume=True, progress=lambda d, t, w, b=begun: b.append((w, d))
        )
        first = next(done for what, done in begun if what == "trace")
        assert first % 512 == 0 and (first == 1536) == (kept == len(whole)), "tiles of 256 pixels"
        for name, values in at_once.aovs.items():
            np.testing.assert_array_equal(resumed[name], values)
    damaged = bytearray(whole)
    damaged[len(whole) - 100] ^= 1
    file.write_bytes(damaged)
    resumed = sw.render(world, plan, checkpoint=file, resume=True)
    np.testing.assert_array_equal(resumed["color"], at_once["color"])


def test_passes_to_a_target_go_on_where_they_were(tmp_path):
    """Ended within the second and the third pass, with some tiles a pass ahead."""
    world = S.scene([S.sphere(8, 16)], [S.scratched(depth=75.0)], [S.dome()])
    settings = {"width": 32, "height": 32, "spp": 2, "tile": 8, "filter": "box", "threads": 2, "effects": S.EVERYTHING}
    settings["knobs"] = {"tables.resolution": 32, "tables.bounces": 1}  # losing light, and so with noise
    first = sw.render(world, sw.make_plan(world, sw.Settings(**settings)))
    plan = sw.make_plan(world, sw.Settings(**settings, max_error=first.stats["error"] / 400.0))
    at_once = sw.render(world, plan)
    assert at_once.stats["samples"] >= 8 * 32 * 32
    file = tmp_path / "part"
    for limit in (2.5, 3.3, 4.9):

        def stop_at(done, total, what, limit=limit):
            if what == "trace" and done > limit * 1024:
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            sw.render(world, plan, checkpoint=file, resume=True, progress=stop_at)
    resumed = sw.render(world, plan, checkpoint=file, resume=True)
    assert resumed.stats["samples"] == at_once.stats["samples"] and len(resumed.warnings) == len(at_once.warnings)
    for name, values in at_once.aovs.items():
        np.testing.assert_array_equal(resumed[name], values)
    assert not file.exists()


def test_tables_of_another_accuracy_are_another_render(tmp_path):
    world = S.scene([S.sphere(8, 16)], [S.scratched()], [S.dome()])
    once = {**S.EVERYTHING, "scratches.interreflection": False}
    settings = {"width": 32, "height": 32, "spp": 1, "filter": "box", "tile": 16}
    with pytest.raises(KeyboardInterrupt):
        plan = sw.make_plan(world, sw.Settings(effects=S.EVERYTHING, **settings))
        sw.render(world, plan, progress=stop, checkpoint=tmp_path / "part")
    other = sw.make_plan(world, sw.Settings(effects=once, **settings))
    with pytest.raises(ValueError, match="other tables"):
        sw.render(world, other, checkpoint=tmp_path / "part", resume=True)
