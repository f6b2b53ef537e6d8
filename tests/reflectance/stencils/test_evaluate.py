"""The stencil model: against the equations in float64, symmetries, hard cases, energy, records."""

from dataclasses import replace

import numpy as np
import pytest

from scratchwarp import stencils
from scratchwarp.reflectance.stencils import Mode, Model

from .brute_force import brdf, direction
from .models import MODELS, ONE, THREE, TWO


def _directions(count, seed, steepest=1.5):
    rng = np.random.default_rng(seed)
    return direction(rng.uniform(0, steepest, count), rng.uniform(-np.pi, np.pi, count))


VARIANTS = {
    **MODELS,
    "binary": replace(TWO, mask="binary"),
    "retro": replace(TWO, retro=True),
    "given half-width": TWO.edit(1, half_width=0.02),
    "translucent": replace(THREE, beta=1.0),
    "negative kd": ONE.edit(0, kd=-0.1),
}


@pytest.mark.parametrize("name", VARIANTS)
def test_values_are_those_of_the_equations(name):
    wi, wo = _directions(4000, 1), _directions(4000, 2)
    expected = brdf(VARIANTS[name], wi, wo)
    value = stencils.evaluate(VARIANTS[name], wi, wo)
    # float32: |H . U| is off by 1e-7, the mask rises by at most 0.75 / (0.15 w) a unit of it, powers by alpha
    np.testing.assert_allclose(value, expected, rtol=1e-4, atol=1e-5)
    assert np.ptp(value) > 0.1


@pytest.mark.parametrize("name", VARIANTS)
def test_reciprocal_and_the_same_after_half_a_turn(name):
    wi, wo = _directions(1000, 3), _directions(1000, 4)
    for conserving in (False, True):
        forth = stencils.evaluate(VARIANTS[name], wi, wo, energy_conserving=conserving)
        back = stencils.evaluate(VARIANTS[name], wo, wi, energy_conserving=conserving)
        np.testing.assert_allclose(forth, back, rtol=1e-4, atol=1e-6)
        turned = stencils.evaluate(VARIANTS[name], wi * [-1, -1, 1], wo * [-1, -1, 1], energy_conserving=conserving)
        np.testing.assert_allclose(forth, turned, rtol=1e-4, atol=1e-6)


def test_the_axis_is_where_the_scratches_run():
    """Light and view in the plane across the axis have every half vector on the ridge."""
    model = replace(ONE, k=0.0)
    across = model.modes[0].azimuth + 0.5 * np.pi
    wi, wo = direction(0.9, across), direction(np.array([0.1, 0.5, 1.2]), across)
    mode = model.modes[0]
    scale = mode.a + mode.b / (wi[2] * wo[:, 2])
    expected = (mode.kd + mode.ks * scale**mode.alpha)[:, None] * mode.color
    np.testing.assert_allclose(stencils.evaluate(model, wi, wo), expected, rtol=1e-4)


def test_hard_cases_are_finite():
    wi = direction(np.array([0.0, 0.3, 1.3, 1.57, np.pi / 2])[:, None], np.linspace(-3, 3, 13))
    wo = direction(np.array([0.0, 1.309, 1.5707]), 0.4)[:, None, None]
    sharp = Mode(0.4, 0.7, 1.0, 0.1, 0.0, 1.0, 1e5)
    explosive = Mode(0.4, 0.1, 1.0, 0.1, 0.0, 1.0, 14.0)
    for modes in ((sharp,), (explosive,), (sharp, replace(sharp, azimuth=0.4 + 0.5 * np.pi)), (sharp, sharp)):
        for width in (0.0, 0.5, 1.0):
            for alpha in (0.0, modes[0].alpha):
                model = Model(tuple(replace(m, width=width, alpha=alpha) for m in modes), 0.5, 0.1, 10.0, 1e5)
                value = stencils.evaluate(model, wi, wo)
                assert np.all(np.isfinite(value)) and np.all(value >= 0)
    value = stencils.evaluate(Model((explosive,)), wi, wo, energy_conserving=True)
    assert np.all(np.isfinite(value)) and np.all(value >= 0)


def test_a_sharp_highlight_keeps_its_digits():
    """(1 - s)^alpha = e^(-alpha s) for small s: from 1 - s in float32 it would be off by 6e-8 alpha = 0.6 %."""
    mode = Mode(0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1e5)
    s = np.linspace(0.0, 3e-5, 7)
    h = np.stack([s, 0 * s, np.sqrt(1 - s * s)], axis=-1)
    value = stencils.evaluate(Model((mode,)), h, h)[:, 0]
    # s itself is rounded to 6e-8 of its value, 2e-7 of the exponent
    np.testing.assert_allclose(value, np.exp(1e5 * np.log1p(-s)), rtol=1e-5)


def test_nothing_below_the_horizon():
    up, down = direction(0.4, 0.3), -direction(0.4, 0.3)
    assert not np.any(stencils.evaluate(TWO, down, up)) and not np.any(stencils.evaluate(TWO, up, down))


def _albedo(model, wo, nt=160, nphi=320):
    """Directional albedo by midpoints uniform in sin^2 theta."""
    t, phi = np.meshgrid((np.arange(nt) + 0.5) / nt, (np.arange(nphi) + 0.5) / nphi * 2 * np.pi, indexing="ij")
    wi = direction(np.arcsin(np.sqrt(t)), phi)
    return np.pi * stencils.evaluate(model, wi, wo, energy_conserving=True).mean(axis=(0, 1))


@pytest.mark.parametrize("theta", [0.0, 0.7, 1.2, 1.5])
def test_furnace(theta):
    """Far too bright a model: scaled until no view reflects more than 1, and dim ones are left alone."""
    bright = TWO.edit(0, ks=5.0, kd=0.6)
    for phi in (0.0, 0.5, 1.3, 2.1):
        # the table of factors is interpolated between 24 x 24 views and estimated from 2048 samples each
        assert np.all(_albedo(bright, direction(theta, phi)) < 1.02)
    assert _albedo(bright, direction(0.0, 0.0)).max() > 0.6  # not scaled to nothing


def test_conserving_leaves_the_measured_range_of_a_dim_model_alone():
    w = stencils.unfolded(ONE)
    np.testing.assert_array_equal(stencils.unfolded(ONE, energy_conserving=True), w)


def test_editing_is_replacing():
    wi, wo = _directions(200, 5), _directions(200, 6)
    turned = TWO
    for k in range(2):
        turned = turned.edit(k, azimuth=turned.modes[k].azimuth + 0.3)
    c, s = np.cos(0.3), np.sin(0.3)
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    np.testing.assert_allclose(
        stencils.evaluate(turned, wi @ turn, wo @ turn), stencils.evaluate(TWO, wi, wo), rtol=1e-4, atol=1e-5
    )
    swapped = TWO.edit(0, color=TWO.modes[1].color).edit(1, color=TWO.modes[0].color)
    assert swapped.modes[0].color == TWO.modes[1].color and TWO.modes[0].color == (0.3, 0.5, 0.9)
    narrow = stencils.unfolded(ONE.edit(0, width=0.85))
    assert np.mean(narrow > 0.05) < np.mean(stencils.unfolded(ONE) > 0.05)


def test_records_check_themselves():
    mode = Mode(0.0, 0.7, 1.0, 0.0, 0.1, 0.2, 9.0)
    assert mode.softness == pytest.approx(0.105) and mode.color == (1.0, 1.0, 1.0)
    assert Model(mode).modes == (mode,) and Model((mode, mode), beta=0.3).beta == (0.3,)
    for name, value in (("width", 1.2), ("alpha", -1), ("azimuth", np.nan), ("half_width", -0.1), ("kd", "x")):
        with pytest.raises(ValueError, match=name):
            replace(mode, **{name: value})
    with pytest.raises(ValueError, match="color"):
        replace(mode, color=(1, 2))
    for name, value in (("beta", 2.0), ("background", -1.0), ("k", np.inf), ("specular_alpha", -1), ("mask", "soft")):
        with pytest.raises(ValueError, match=name):
            Model((mode,), **{name: value})
    with pytest.raises(ValueError, match="modes"):
        Model(())
    with pytest.raises(ValueError, match="beta must be one number or 1"):
        Model((mode, mode), beta=(0.1, 0.2))
    with pytest.raises(ValueError, match="mode must be one of its 1 modes, got 3"):
        Model((mode,)).edit(3, kd=1.0)


def test_bad_input_is_named():
    with pytest.raises(ValueError, match="omega_i must be unit"):
        stencils.evaluate(ONE, (0, 0, 2), (0, 0, 1))
    with pytest.raises(ValueError, match="broadcast"):
        stencils.evaluate(ONE, np.zeros((2, 3)) + [0, 0, 1], np.zeros((3, 3)) + [0, 0, 1])
    with pytest.raises(ValueError, match="model must be"):
        stencils.evaluate(ONE.modes[0], (0, 0, 1), (0, 0, 1))
