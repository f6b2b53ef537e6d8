"""Rendering to an error target."""

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.render import Control, target
from scratchwarp.render.target import remaining, until

from . import scenes as S


def world():
    return S.scene([S.sphere(8, 16)], [S.scratched(depth=75.0)], [S.dome()])


def shoot(**settings):
    knobs = {"tables.resolution": 32, "tables.bounces": 1}
    return S.shoot(world(), width=12, height=12, knobs=knobs, **settings)


def test_the_estimate_is_the_mean_square_error_of_independent_samples():
    """Of 64 x 64 pixels of 16 samples: the ratio of two sums of 4096 squares is within 5 sqrt(2 / 4096) = 0.11 of 1."""
    rng = np.random.default_rng(1)
    samples = 1.0 + rng.normal(0.0, 0.3, (16, 64, 64))
    color = np.repeat(samples.sum(0)[..., None], 3, axis=-1)
    sums = {"color": color, "square": (samples**2).sum(0), "invalid": np.zeros((64, 64))}
    truth = ((samples.mean(0) - 1.0) ** 2).mean() / 1.01
    assert remaining(sums, 16) == pytest.approx(truth, rel=0.12)
    assert remaining(sums, 1) == float("inf")


def noisy(counts):
    """``sums`` and ``more`` of an image of 48 x 48 pixels of independent samples with spread 0.5 about 1."""
    rng = np.random.default_rng(3)
    sums = {"color": np.zeros((48, 48, 3)), "square": np.zeros((48, 48)), "invalid": np.zeros((48, 48))}

    there = [0]
    passes = []

    def more(samples):
        count = samples - there[0]
        if there[0]:
            passes.append((sums["color"].copy(), there[0]))
        there[0] = samples
        counts.append(samples)
        drawn = 1.0 + rng.choice([-0.5, 0.5], (count, 48, 48))
        sums["color"] += drawn.sum(0)[..., None]
        sums["square"] += (drawn**2).sum(0)

    return sums, passes, more


def test_samples_are_added_until_the_target_or_the_most():
    seen = []
    sums, passes, more = noisy(seen)
    more(2)
    more(4)
    assert until(None, 4, lambda: sums, lambda: passes, more)[0] == 4 and seen == [2, 4]
    samples, error = until(0.01, 4, lambda: sums, lambda: passes, more)
    # 0.25 / n / 1.01 of independent samples: 25 are needed; passes go in steps of at most a half
    assert 24 <= samples <= 36 and 0.005 < error <= 0.01
    assert seen[-1] == samples and seen == sorted(set(seen))
    sums, passes, more = noisy(seen)
    more(2)
    assert until(1e-12, 2, lambda: sums, lambda: passes, more)[0] == 2 * target.MOST
    assert until(1e-12, 128, lambda: sums, lambda: passes, more, most=200)[0] == 200
    assert target.begins(1) == [1] and target.begins(2) == [1, 2] and target.begins(64) == [16, 32, 64]


def test_passes_grow_by_parts_and_skip_what_is_surely_too_few():
    count, seen = 1, []
    while count < 100:
        seen.append(count)
        count = target.later(count)
    assert seen == [1, 2, 3, 4, 6, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 56, 64, 80, 96]
    assert target.later(37) == 40 and target.later(100) == 112
    assert target.ahead(4, 0.4, 0.1, 1000) == 8 and target.ahead(4, 0.11, 0.1, 1000) == 6
    assert target.ahead(16, 50.0, 0.1, 1000) == 32 and target.ahead(16, 50.0, 0.1, 19) == 19


def test_one_bright_sample_counts_as_noise_and_not_as_a_bright_pixel():
    """Of 16 samples one is 400: an error of 25 at that pixel, that is 24^2 / (48^2 1.01 ...) and more over the image;
    were the pixel's own luminance taken for true, it would be at most 1 / 48^2."""
    sums = {"color": np.full((48, 48, 3), 16.0), "square": np.full((48, 48), 16.0), "invalid": np.zeros((48, 48))}
    sums["color"][20, 20] += 384.0
    sums["square"][20, 20] += 400.0**2 - 1.0
    assert remaining(sums, 16) > 0.5 * 24.0**2 / 48.0**2


def test_what_passes_changed_tells_the_error():
    """Of pixels whose samples are alike within each half but differ between the halves, the mean of the halves is off
    by 0.2^2 / 2 of them all; the spread of the samples tells a fifteenth of it. Sums of 2304 squares of +-1 and 0, at
    even odds, are known to 1 / sqrt(2304) = 2 %; one and a half of that and a sixteenth are added."""
    rng = np.random.default_rng(1)
    first, second = (1.0 + 0.2 * rng.choice([-1.0, 1.0], (48, 48)) for _ in range(2))
    color = np.repeat((8 * first + 8 * second)[..., None], 3, -1)
    sums = {"color": color, "square": 8 * first**2 + 8 * second**2, "invalid": np.zeros((48, 48))}
    before = np.repeat(8 * first[..., None], 3, -1)
    found = remaining(sums, 16, [(before, 8)])
    assert found == pytest.approx(0.02 / 1.01 * (1.0 + 1.5 / 48) * 17 / 16, rel=0.1)
    assert remaining(sums, 16) < found / 10.0


@pytest.mark.parametrize("power", (1.0, 1.25, 1.5))
def test_samples_that_lie_more_evenly_leave_less(power):
    """Errors squared that fall as n^-p: each state of the image is a Brownian walk in n^-p. The estimate is between
    the truth and that of independent samples, and within 15 % of the truth, doubt aside: the ratio of two changes, of
    4096 pixels each, is known to 3 %, which two standard errors of p make of it."""
    rng = np.random.default_rng(2)
    left = 0.01 * rng.normal(0.0, 1.0, (64, 64))
    counts, states = (32, 16, 8), []
    for n, more in zip(counts, (0.0, *counts), strict=False):
        left = left * (not more or 1.0)
        if more:
            left = left + 0.01 * 32 ** (0.5 * power) * rng.normal(0.0, np.sqrt(n**-power - more**-power), (64, 64))
        states.append((np.repeat((n * (1.0 + left))[..., None], 3, -1), n))
    sums = {"color": states[0][0], "square": np.zeros((64, 64)), "invalid": np.zeros((64, 64))}
    found = remaining(sums, 32, states[1:]) / (1.0 + 1.0 / 32)
    assert 0.9 < found / (1e-4 / 1.01) < 1.3
    alone = remaining(sums, 32, states[1:2]) / (1.0 + 1.0 / 32)
    assert alone == pytest.approx(1e-4 / 1.01 * (2**power - 1.0), rel=0.12)


def test_says():
    assert "not reached" in target.says(0.1, 8, 0.2, 1.0)[0] and not target.says(0.2, 8, 0.1, 1.0)


def test_a_film_with_a_target_is_the_film_of_as_many_samples():
    """But for the footprint of samples, which is that of the first pass: here nothing depends on it."""
    first = shoot(spp=4)
    asked = first.stats["error"] / 10.0  # evenly spread samples leave far less than their spread says
    made = shoot(spp=4, max_error=asked)
    count = made.metadata["scratchwarp:spp"]
    assert made.stats["error"] <= asked and 6 <= count <= 32 and not made.warnings
    assert made.stats["samples"] == 144 * count
    again = shoot(spp=4, max_error=asked, threads=3, tile=5)
    assert all(np.array_equal(made[name], again[name]) for name in made)
    # the layer is on the scale of the estimate that ended the render
    seen = made["color"].astype(float) @ (0.2126, 0.7152, 0.0722)
    relative = made["error"].astype(float) ** 2 / (seen**2 + target.FLOOR * seen.mean() ** 2)
    noise = made.stats["error"] - made.stats["bias"]
    assert relative.mean() == pytest.approx(noise, rel=1e-4)
    assert np.array_equal(first["error"], np.sqrt(first["variance"]))
    assert (made["error"] < first["error"]).mean() > 0.5


def test_a_render_to_a_target_chooses_knobs_and_goes_on_after_an_interruption(tmp_path):
    """To the same bits, wherever it was stopped: after the first pass, in the middle of a later one, at the end of one.
    A crop of it stops by itself."""
    scene = world()
    knobs = {"tables.bounces": 1}  # what is lost makes noise: a mirror under an even sky has none
    asked = sw.Settings(width=24, height=24, tile=8, threads=1, filter="box", max_error=0.03, effects=S.EVERYTHING,
                        knobs=knobs)  # fmt: skip
    plan = sw.make_plan(scene, asked)
    whole = sw.render(scene, plan)
    assert plan.aim.first == 2 < whole.metadata["scratchwarp:spp"]
    assert plan.aim.bias < whole.stats["error"] <= 0.03
    file = tmp_path / "part"
    for stop in (5, 9, 13, 18):
        control = Control()
        count = [0]

        def progress(done, total, what, control=control, count=count, stop=stop):
            count[0] += what == "trace"
            if count[0] > stop:
                control.stop.set()

        with suppress(KeyboardInterrupt):
            sw.render(scene, plan, progress=progress, checkpoint=file, control=control, keep=True)
        assert control.stop.is_set()
        again = sw.render(scene, plan, checkpoint=file, resume=True)
        assert again.metadata["scratchwarp:spp"] == whole.metadata["scratchwarp:spp"]
        assert all(np.array_equal(whole[name], again[name]) for name in whole)
    part = sw.make_plan(scene, replace(asked, crop=(0.25, 0.75, 0.25, 0.75)))
    assert sw.render(scene, part).stats["error"] <= 0.03


def test_half_of_an_error_costs_what_it_costs():
    """Of noise alone as much again; with a fourth of bias, 3 / 1 times as many samples; other knobs where none do."""
    assert target.halving(10.0, 0.1) == pytest.approx(10.0)
    assert target.halving(10.0, 0.1, 0.025) == pytest.approx(20.0)
    assert target.halving(10.0, 0.1, 0.06, 3.0) == pytest.approx(30.0)
    assert target.halving(10.0, float("inf")) == 10.0
