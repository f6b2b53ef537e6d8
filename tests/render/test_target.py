"""Rendering to an error target."""

import numpy as np
import pytest

from scratchwarp.render import target
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


def test_samples_are_doubled_until_the_target_or_the_most():
    passes = []
    dark = {"color": np.ones((2, 2, 3)), "square": np.full((2, 2), 5.0), "invalid": np.zeros((2, 2))}
    assert until(None, 4, lambda: dark, lambda *a: passes.append(a))[0] == 4 and not passes
    assert until(1e-12, 2, lambda: dark, lambda *a: passes.append(a))[0] == 2 * target.MOST
    assert passes[:3] == [(2, 2), (4, 4), (8, 8)]
    assert "not reached" in target.says(0.1, 8, 0.2, 1.0)[0] and not target.says(0.2, 8, 0.1, 1.0)


def test_a_film_with_a_target_is_the_film_of_as_many_samples():
    """But for the footprint of samples, which is that of the first pass: here nothing depends on it."""
    first = shoot(spp=4)
    asked = first.stats["error"] / 3.0
    made = shoot(spp=4, max_error=asked)
    count = made.metadata["scratchwarp:spp"]
    assert made.stats["error"] <= asked and count in (8, 16, 32) and not made.warnings
    assert made.stats["samples"] == 144 * count
    again = shoot(spp=4, max_error=asked, threads=3, tile=5)
    assert all(np.array_equal(made[name], again[name]) for name in made)
    assert np.array_equal(made["error"], np.sqrt(made["variance"]))
    assert (made["error"] < first["error"]).mean() > 0.5
