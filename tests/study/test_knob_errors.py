"""What knobs leave."""

import pytest

import scratchwarp as sw
from scratchwarp.study.knob_errors import left, summed_up, worst

from ..render import scenes as S


def test_biases_of_stages_are_summed_up_by_what_most_stay_below():
    stages = [{"tables.rays": {"8": 0.1 * k, "16": 0.02, "32": 0.03}} for k in range(1, 6)]
    made = summed_up(stages)["tables.rays"]
    assert made["8"] == pytest.approx(0.42)  # four fifths of five
    assert made["16"] == made["32"] == pytest.approx(0.03) and made["512"] == 0.0  # it never rises


def test_of_one_stage_the_worst_counts():
    rows = [{"tables.rays": {"8": 0.2, "16": 0.1}}, {"tables.rays": {"8": 0.3, "16": 0.01}}, {"pathDepth": {"1": 0.5}}]
    assert worst(rows) == {"tables.rays": {"8": 0.3, "16": 0.1}, "pathDepth": {"1": 0.5}}


def test_ratios_of_noise_are_never_below_one():
    made = summed_up([{"lights.coneTaps": {"1": 1.2, "2": 0.9}}], 1.0)["lights.coneTaps"]
    assert made == {"1": 1.2, "2": 1.0, "64": 1.0}


SETTINGS = sw.Settings(width=12, height=12, spp=4, filter="box", tile=16, effects=S.EVERYTHING,
                       knobs={"tables.resolution": 32})  # fmt: skip


def test_what_knobs_leave_is_measured_where_they_do_something():
    """More bounces leave less of deep grooves; cone taps do nothing under an even dome."""
    world = S.scene([S.sphere(8, 16)], [S.scratched(S.lambert(0.3), depth=75.0)], [S.dome()])
    found = left(world, SETTINGS, ("tables.bounces", "lights.coneTaps"))
    bounces = list(found.bias["tables.bounces"].values())
    assert bounces[0] > 10.0 * bounces[-1] >= 0.0 and list(found.bias) == ["tables.bounces"] and not found.noisier
