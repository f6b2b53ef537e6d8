"""Scratches of one layer that differ: what the device draws against the distribution that the tables are made for."""

import numpy as np
import pytest
import warp as wp

from scratchwarp.scratches import variation
from scratchwarp.scratches.layer_device import LayerHit
from scratchwarp.scratches.variation_device import (
    VariationData,
    along_scratch,
    drawn_stretch,
    stretch,
    varied_table,
)

wp.set_module_options({"enable_backward": False})
N = 40000


@wp.kernel
def draws(v: VariationData, along: float, width: float, power: float, out: wp.array2d(dtype=float)):
    i = wp.tid()
    scratch = wp.uint32(i) * wp.uint32(1640531535)
    out[i, 0] = along_scratch(scratch, wp.uint32(5), along)
    out[i, 1] = along_scratch(scratch, wp.uint32(5), along + 1.0e-3)
    out[i, 2] = drawn_stretch((float(i) + 0.5) / float(out.shape[0]), width, power)
    out[i, 3] = stretch(scratch, along, width)
    hit = LayerHit()
    hit.scratch = scratch
    hit.along = along
    hit.stretch = out[i, 3]
    out[i, 4] = float(varied_table(100, v, hit, scratch ^ wp.uint32(77)))


def run(v=None, along=0.0, width=0.5, power=2.0):
    out = wp.zeros((N, 5), dtype=float, device="cpu")
    wp.launch(draws, dim=N, inputs=[v or VariationData(), along, width, power, out], device="cpu")
    return out.numpy().astype(float).T


@pytest.mark.parametrize("along", [0.0, 0.3, -17.8])
def test_what_changes_along_a_scratch_is_uniform_over_all_of_them(along):
    """Kolmogorov-Smirnov: sqrt(N) D exceeds 2 once in 1500."""
    value, near, _, wide, _ = run(along=along)
    for sample in (value, (wide - 0.5) / 1.0):
        distance = np.abs(np.sort(sample) - (np.arange(N) + 0.5) / N).max()
        assert distance * np.sqrt(N) < 2.0
    # a triangle wave climbs 2 a wavelength, its wobble adds at most 3/4 of that
    assert np.abs(near - value).max() < 1e-3 * 2 * 1.76 + 1e-5


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_drawn_widths_are_weighted_by_what_they_cover(power):
    _, _, drawn, _, _ = run(width=0.6, power=power)
    t = (np.arange(200000) + 0.5) / 100000 - 1.0
    share = (1 + 0.6 * t) ** power
    for moment in (1, 2, 3):
        expected = (share * (1 + 0.6 * t) ** moment).sum() / share.sum()
        assert (drawn**moment).mean() == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize(("width", "depth"), [(0.0, 0.9), (0.5, 0.0), (0.4, 0.6), (1.0, 1.0)])
def test_tables_share_the_scratches_among_them(width, depth):
    """How often the device takes each table is what the table's hat weighs: 5 sigma of the binomial, and 1e-2 for the
    bins of the histogram that hats are weighed by. Here every scratch counts alike (power 0)."""
    angles, shares = variation.spread(0.3, width, depth, 0)
    made = variation.axis(angles, shares)
    v = VariationData()
    v.aspects, v.blends, v.low, v.scale = made.count, 1, made.low, (made.count - 1) / (made.high - made.low)
    v.aspect, v.depth = 0.3, depth
    taken = np.bincount(run(v, width=width)[4].astype(int) - 100, minlength=made.count) / N
    held = np.array([sum(s for _, s in part) for part in made.parts])
    assert held.sum() == pytest.approx(1.0, abs=2e-2)
    assert np.abs(taken - held).max() < 5 * np.sqrt(0.25 / N) + 1e-2
    # neighbours' highlights are no further apart than asked for, unless there would be too many
    step = 2 * (made.high - made.low) / (made.count - 1)
    assert step <= variation.STEP + 1e-9 or made.count == variation.MOST_NODES
    coarse = variation.axis(angles, shares, 0.03)
    assert coarse.count < made.count or made.count in (2, variation.MOST_NODES)


def test_scratches_that_are_alike_need_one_table():
    assert variation.axis(*variation.spread(0.3, 0.0, 0.0, 2)) is None
    assert variation.axis(*variation.spread(0.3, 0.0, 1e-4, 2)) is None
    assert variation.axis(*variation.spread(0.0, 0.5, 0.5, 2)) is None
    assert variation.blends(0.0) == (((0.0, 1.0),),)


def test_blends_share_the_way():
    made = variation.blends(0.6)
    held = [sum(s for _, s in way) for way in made]
    # uniform over three intervals: the outer hats are halves
    assert np.array(held) / sum(held) == pytest.approx([1 / 6, 1 / 3, 1 / 3, 1 / 6], abs=1e-12)
    assert max(part for way in made for part, _ in way) == pytest.approx(0.6)
