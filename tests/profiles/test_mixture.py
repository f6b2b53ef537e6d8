"""Averages of tables, and cross-sections between two others."""

import numpy as np
import pytest

from scratchwarp import optics, profiles

SMALL = {"resolution": 32, "rays": 64}


@pytest.mark.parametrize("fresnel", [None, optics.Dielectric(1.5, "exact"), optics.Schlick((0.9, 0.5, 0.2))])
def test_a_mixture_is_the_average_reflectance(fresnel):
    made = [
        profiles.simulate(profiles.shape("vGroove", depth=d), fresnel=fresnel, theta_model="table", **SMALL)
        for d in (0.1, 0.3, 0.9)
    ]
    mixed = profiles.mixture(made, (1.0, 2.0, 1.0))
    shares = (0.25, 0.5, 0.25)
    for theta in (0.0, 0.7, 1.5):
        expected = sum(s * t.slice(theta) for s, t in zip(shares, made, strict=True))
        assert np.abs(mixed.slice(theta) - expected).max() < 1e-5 * expected.max()
    assert mixed.weights @ mixed.mirror == pytest.approx(1.0 - mixed.lost, abs=1e-4)
    assert np.all(np.diff(mixed.cdf, axis=1) >= 0.0)


def test_one_table_is_itself_and_unlike_ones_do_not_mix():
    one = profiles.simulate(profiles.shape("quartic", depth=0.4), fresnel=optics.Dielectric(1.5, "exact"), **SMALL)
    same = profiles.mixture([one], [3.0])
    np.testing.assert_allclose(same.slice(0.5), one.slice(0.5), atol=1e-6)
    other = profiles.simulate(profiles.shape("quartic", depth=0.4), resolution=16, rays=64)
    with pytest.raises(ValueError, match="tables differ"):
        profiles.mixture([one, other], [1.0, 1.0])
    with pytest.raises(ValueError, match="shares"):
        profiles.mixture([one], [0.0])


def test_between_two_outlines():
    vee, box = profiles.shape("vGroove", depth=0.5), profiles.shape("rectangle", depth=0.5)
    assert profiles.between(vee, box, 0.0) is vee and profiles.between(vee, box, 1.0) is box
    for part in (0.25, 0.5, 0.75):
        middle = profiles.between(vee, box, part)
        assert middle.period == pytest.approx(1.0) and middle.points[:, 1].min() == pytest.approx(-0.5)
        assert middle.symmetric and not middle.overhangs
        # both walls move outwards
        outer = profiles.between(vee, box, part + 0.2).points
        depth = np.linspace(-0.45, -0.05, 9)
        left, right = (p[: len(p) // 2 + 1][::-1] for p in (middle.points, outer))
        assert (np.interp(depth, right[:, 1], right[:, 0]) < np.interp(depth, left[:, 1], left[:, 0])).all()
    deep = profiles.shape("vGroove", depth=1.0)
    np.testing.assert_allclose(profiles.between(vee, deep, 0.5).points[:, 1].min(), -0.75)
