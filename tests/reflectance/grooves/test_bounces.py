"""Light that goes from facet to facet: retro-reflection, furnaces, reciprocity, Snell, total reflection."""

import numpy as np
import pytest

from scratchwarp import grooves, optics

from .test_footprints import FAR, RIDGE, RIM, X60, X90, V, towards

GOLD = optics.Conductor((0.14, 0.37, 1.44), (4.4, 2.77, 1.95))
AREA = ([0, 0], [0.4, 0.1], [-0.1, 0.4])


def test_a_right_angle_sends_light_back():
    """Two mirrors at 90 degrees across x: what meets both returns, its part along the groove mirrored to -u."""
    o = towards(25, 20)
    ends = grooves.trace(grooves.Pattern(X90[1:], V), *AREA, o, GOLD, samples=128)
    twice = (ends.met == 2) & (np.hypot(*ends.position[:, :2].T) < 10)
    assert ends.left.all() and not ends.inside.any() and 40 < twice.sum() < 128
    np.testing.assert_allclose(ends.direction[twice], np.tile(o * [1, -1, 1], (twice.sum(), 1)), atol=1e-9)
    first, second = np.array([1, 0, 1]) @ o / np.sqrt(2), np.array([-1, 0, 1]) @ o / np.sqrt(2)
    expected = GOLD.reflectance(first) * GOLD.reflectance(second)
    np.testing.assert_allclose(ends.weight[twice], np.tile(expected, (twice.sum(), 1)), rtol=1e-5)


@pytest.mark.parametrize("profile", [V, RIM])
def test_white_furnaces(profile):
    """A white surface sends on whatever comes."""
    g = grooves.Pattern(X60, profile)
    o = np.array([towards(10, 0), towards(70, 130)])
    ends = grooves.trace(g, *AREA, o, grooves.Diffuse(1.0), bounces=200, samples=64)
    assert ends.left.all()
    np.testing.assert_allclose(ends.weight, 1.0)


def test_rough_facets_are_drawn_as_they_reflect():
    """The mean weight is the integral of BRDF times cosine: 1,024 draws against a quadrature."""
    g = grooves.Pattern([], [])
    o = towards(55, 20)
    drawn = grooves.trace(g, *AREA, o, grooves.GGX(0.4, GOLD), bounces=1, samples=1024).weight.mean(0)
    z, phi = (np.arange(200) + 0.5) / 200, 2 * np.pi * np.arange(200) / 200
    r = np.sqrt(1 - z * z)[:, None]
    i = np.stack([r * np.cos(phi), r * np.sin(phi), np.broadcast_to(z[:, None], (200, 200))], -1)
    value = grooves.radiance(g, *AREA, o, i, grooves.GGX(0.4, GOLD)).mean((0, 1)) * 2 * np.pi
    np.testing.assert_allclose(drawn, value, rtol=5e-3)


def test_bounces_are_reciprocal():
    """BRDF of wide parallel grooves: L / cos(i) is the same with view and light changed; 0.5 % of noise a direction."""
    g = grooves.Pattern([[[k, -FAR], [k, FAR]] for k in range(-30, 31)], V)
    o, i = np.array([towards(35, 10), towards(60, 80)]), np.array([towards(50, 170), towards(20, 30)])
    wide = ([0.2, 0], [20, 0], [0, 0.1])
    for bounces in (1, 3):
        there = grooves.radiance(g, *wide, o, i, grooves.Diffuse(0.9), bounces=bounces, samples=4096)
        back = grooves.radiance(g, *wide, i, o, grooves.Diffuse(0.9), bounces=bounces, samples=4096)
        np.testing.assert_allclose(there / i[:, 2], back / o[:, 2], rtol=0.015)
    direct = grooves.radiance(g, *wide, o, i, grooves.Diffuse(0.9))
    assert np.all(there > direct * 1.05)


def test_glass():
    """Index 1 is not there, through ridges too; flat ground refracts by Snell; total reflection loses nothing."""
    o = towards(40, 70)
    gone = grooves.trace(grooves.Pattern(X60, RIDGE), *AREA, o, optics.Dielectric(1.0), bounces=40, samples=64)
    assert gone.left.all() and gone.inside.all()
    np.testing.assert_allclose(gone.direction, np.tile(-o, (64, 1)), atol=1e-6)
    flat = grooves.trace(grooves.Pattern([], []), *AREA, o, optics.Dielectric(1.5), samples=64)
    sine = np.hypot(*flat.direction[flat.inside][:, :2].T)
    np.testing.assert_allclose(sine, np.sin(np.radians(40)) / 1.5, rtol=1e-6)
    assert (flat.direction[~flat.inside, 2] > 0).all() and 0 < (~flat.inside).sum() < 12
    ridge = grooves.trace(grooves.Pattern(X60, RIDGE), *AREA, o, optics.Dielectric(1.5), bounces=200, samples=256)
    assert ridge.left.all() and (ridge.weight == 1).all() and (ridge.met > 2).any()


def test_senseless_counts():
    for name in ("bounces", "samples"):
        with pytest.raises(ValueError, match=name):
            grooves.trace(grooves.Pattern(X60, V), *AREA, towards(0, 0), GOLD, **{name: 0})
