"""The uniform grid over strips: nothing is missed, little is listed twice, cells follow the rule asked for."""

import numpy as np
import pytest

from scratchwarp.scratches import grid


def strips(count, seed=1, length=0.3, width=0.01):
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, np.pi, count)
    half = np.stack([np.full(count, length / 2), rng.uniform(0.5, 1.5, count) * width / 2], 1)
    return grid.strip_table(rng.uniform(0, 1, (count, 2)), np.stack([np.cos(angle), np.sin(angle)], 1), half)


@pytest.mark.parametrize("cell", [0.004, 0.05, 3.0])
def test_every_point_finds_its_strips(cell):
    """A cell lists exactly the strips that touch it: all points of each strip lie in cells that list it."""
    table = strips(40)
    made = grid.build(table, cell=cell)
    starts, items = made.data.starts.numpy(), made.entries()
    rng = np.random.default_rng(2)
    held = set()
    for k, strip in enumerate(table):
        u, v = rng.uniform(-1, 1, (2, 400)) * strip["half"][:, None]
        along = strip["along"]
        p = strip["center"] + u[:, None] * along + v[:, None] * np.array([-along[1], along[0]])
        i, j = np.clip(((p - made.data.origin) / made.cell).astype(int), 0, np.array(made.shape) - 1).T
        for c in set(j * made.shape[0] + i):
            assert k in items[starts[c] : starts[c + 1]]
            held.add((c, k))
    assert made.listed == len(items) and made.longest == np.diff(starts).max()
    if cell == 0.05:  # 400 points hit nearly every cell of a strip 0.3 long
        assert len(held) > 0.9 * made.listed


def test_rules_and_memory():
    table = strips(200)
    paper, ours = grid.build(table, rule="width"), grid.build(table)
    np.testing.assert_allclose(paper.cell, 2 * table["half"][:, 1].mean(), rtol=1e-12)
    assert ours.cell >= paper.cell and ours.memory <= paper.memory
    assert "cells" in str(ours) and "kB" in str(ours)
    assert grid.cell_size(table, footprint=0.5) >= 0.5
    assert grid.build(table[:0]).shape == (1, 1)
    with pytest.raises(ValueError, match="rule"):
        grid.cell_size(table, rule="finest")
