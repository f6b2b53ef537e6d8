"""What laying grooves out takes, as ``explain`` tells it."""

import scratchwarp as sw
from scratchwarp.kernels.groove_memory import described, taken

from ..render import groove_geometry as sheets


def test_memory_is_told_by_part_and_cells_follow_the_knob():
    numbers = {}
    for rule in ("width", "balanced"):
        fields = {"distribution": "random", "width": 5.0, "depth": 2.0, "length": 2000.0, "coverage": 0.02}
        world = sheets.world(True, sheets.LAMBERT, 1.0, 0.0, **fields)
        plan = sw.make_plan(world, sw.Settings(width=8, height=8, spp=1, knobs={"grooves.cells": rule}))
        own = numbers[rule] = taken(world, plan)
        assert own["groove_bytes"] == sum(own[f"groove_{part}_bytes"] for part in ("path", "section", "grid"))
        assert rule in described(own, plan) and f"{own['groove_pieces']} pieces" in described(own, plan)
    # scratches of one size: a path, two corners and what it is made of, 68 bytes each
    paper, ours = numbers["width"], numbers["balanced"]
    assert ours["groove_pieces"] > 1000 and ours["groove_path_bytes"] < 70 * ours["groove_pieces"] + 1000
    assert 3 * ours["groove_grid_bytes"] < paper["groove_grid_bytes"]
    bare = sw.make_plan(world, sw.Settings(width=8, height=8, spp=1, effects={"grooves": False}))
    assert taken(world, bare) == {}
