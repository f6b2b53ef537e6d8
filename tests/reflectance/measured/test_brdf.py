"""Interpolation of measured BRDFs: nodes, seams, grazing, reciprocity; MERL by hand, RGL against Mitsuba."""

import mitsuba as mi
import numpy as np
import pytest

from scratchwarp import measured

from .synthetic import direction, grid, rgl_fields, smooth, write_merl, write_tensors


@pytest.fixture(scope="module")
def rough():
    """Random values, negative ones among them."""
    return measured.Brdf.from_values(np.random.default_rng(1).normal(0.3, 0.3, (288, 288, 3)))


def _pairs(count, seed=2):
    rng = np.random.default_rng(seed)
    return (direction(rng.uniform(0, 1.5, count), rng.uniform(-np.pi, np.pi, count)) for _ in range(2))


def test_nodes_of_the_grid(rough):
    w = grid()[48:]
    value = rough.evaluate(w[:, None], w[None])
    # float32: a direction off by 1e-7 moves by 1e-6 cells between values that differ by about 1
    np.testing.assert_allclose(value, np.maximum(np.asarray(rough)[48:, 48:], 0.0), atol=2e-5)


def test_linear_between_nodes(rough):
    wi = direction(np.radians(37.5), np.radians(11.25))
    wo = grid()[48 * 3 + 5]
    table = np.maximum(np.asarray(rough), 0.0)
    around = [48 * it + ip for it in (2, 3) for ip in (1, 2)]
    np.testing.assert_allclose(rough.evaluate(wi, wo), table[around, 48 * 3 + 5].mean(axis=0), atol=1e-5)


def test_no_seams(rough):
    """Across phi = 0, across the pole and beyond the last theta nothing jumps."""
    wo = direction(0.8, 0.3)
    for theta in (0.4, 1.2):
        sides = rough.evaluate(direction(theta, np.array([-1e-5, 1e-5, 2 * np.pi - 1e-5, np.pi, -np.pi])), wo)
        np.testing.assert_allclose(sides[0], sides[1], atol=1e-3)
        np.testing.assert_allclose(sides[0], sides[2], atol=1e-3)
        np.testing.assert_allclose(sides[3], sides[4], atol=1e-4)
    pole = rough.evaluate(direction(np.full(9, 1e-6), np.linspace(-3, 3, 9)), wo)
    np.testing.assert_allclose(pole, np.broadcast_to(rough.evaluate((0, 0, 1), wo), pole.shape), atol=1e-4)
    held = rough.evaluate(direction(np.radians([75.0, 80.0, 89.9]), 0.7), wo)
    np.testing.assert_allclose(held[1:], held[:1].repeat(2, axis=0), atol=1e-4)


def test_not_negative_and_reciprocal_on_request(rough):
    wi, wo = _pairs(3000)
    there, back = rough.evaluate(wi, wo), rough.evaluate(wo, wi)
    assert np.all(there >= 0) and np.abs(there - back).max() > 0.1
    both = rough.evaluate(wi, wo, reciprocal=True)
    np.testing.assert_allclose(both, 0.5 * (there + back), atol=1e-6)
    np.testing.assert_allclose(both, rough.evaluate(wo, wi, reciprocal=True), atol=1e-6)
    assert not np.any(rough.evaluate(-wi, wo)) and not np.any(rough.evaluate(wi, -wo))


def test_a_smooth_brdf_is_met_between_the_nodes():
    w = grid()
    brdf = measured.Brdf.from_values(smooth(w[:, None], w[None]))
    wi, wo = _pairs(3000)
    inside = (wi[:, 2] > np.cos(np.radians(75))) & (wo[:, 2] > np.cos(np.radians(75)))
    error = brdf.evaluate(wi, wo)[inside] - smooth(wi, wo)[inside]
    # second differences of the lobe: (0.13 rad)^2 / 8 times a curvature of about 0.5 / 0.25^2, twice over
    assert np.abs(error).max() < 0.06 and np.sqrt(np.mean(error**2)) < 0.01


@pytest.fixture(scope="module")
def merl(tmp_path_factory):
    path = tmp_path_factory.mktemp("merl") / "made.binary"
    h, d, p = np.meshgrid(np.arange(90) / 90, np.arange(90) / 90, np.arange(180) / 180, indexing="ij")
    value = 100.0 + 300.0 * np.exp(-4.0 * h) * (1.0 + 0.5 * d) * (1.0 + 0.1 * np.cos(2 * np.pi * p))
    write_merl(path, np.stack([value, 2 * value, np.where(h < 0.2, -1.0, value)]))
    return measured.load(path)


def test_merl_angles_and_scales(merl):
    """By vectors: theta_d and phi_d from the half vector and two axes beside it, no rotations."""
    wi, wo = _pairs(2000)
    h = (wi + wo) / np.linalg.norm(wi + wo, axis=-1, keepdims=True)
    tangent = np.stack([h[:, 0] * h[:, 2], h[:, 1] * h[:, 2], h[:, 2] ** 2 - 1], axis=-1)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    x, y = np.sum(wi * tangent, axis=-1), np.sum(wi * np.cross(h, tangent), axis=-1)
    th, td = np.arccos(h[:, 2]), np.arccos(np.sum(wi * h, axis=-1))
    half, difference = np.sqrt(2 * th / np.pi), 2 * td / np.pi
    value = 100 + 300 * np.exp(-4 * half) * (1 + 0.5 * difference) * (1 + 0.1 * np.cos(2 * np.arctan2(y, x)))
    inside = (half < 89 / 90) & (difference < 89 / 90)
    found = merl.evaluate(wi, wo)[inside]
    # second differences: 300 * 16 / 90^2 / 8 = 0.07 of 400 along h
    np.testing.assert_allclose(found[:, 0], value[inside] / 1500, rtol=1e-3)
    np.testing.assert_allclose(found[:, 1], 2 * value[inside] * 1.15 / 1500, rtol=1e-3)
    bright = half[inside] > 0.25
    np.testing.assert_allclose(found[bright, 2], (value[inside] * 1.66 / 1500)[bright], rtol=1e-3)
    assert np.all(found[half[inside] < 0.18, 2] == 0.0)


def test_merl_is_isotropic_and_finite_everywhere(merl):
    wi, wo = _pairs(500)
    c, s = np.cos(1.1), np.sin(1.1)
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    np.testing.assert_allclose(merl.evaluate(wi @ turn, wo @ turn), merl.evaluate(wi, wo), rtol=1e-4, atol=1e-6)
    hard = np.array([[0, 0, 1], [1, 0, 1e-7], [-1, 0, 1e-7], [0, 1, 1e-3]])
    hard = hard / np.linalg.norm(hard, axis=-1, keepdims=True)
    assert np.all(np.isfinite(merl.evaluate(hard[:, None], hard)))
    assert np.asarray(merl).shape == (288, 288, 3)


@pytest.mark.parametrize("azimuths", [[0.0], np.linspace(-np.pi, np.pi, 7), np.linspace(-np.pi, 0, 5)])
def test_rgl_is_what_mitsuba_makes_of_it(tmp_path, azimuths):
    """Isotropic, anisotropic, and half a turn measured; Mitsuba's wi is our omega_i, its value has the other cosine."""
    path = tmp_path / "made.bsdf"
    fields = rgl_fields(azimuths)
    if len(azimuths) == 1:
        fields["sigma"][:] = fields["sigma"][:1]  # isotropic; Mitsuba may turn both directions by half a turn
    write_tensors(path, fields)
    mi.set_variant("scalar_rgb")
    plugin = mi.load_dict({"type": "measured", "filename": str(path)})
    wi, wo = _pairs(60)
    expected = []
    for a, b in zip(wi, wo, strict=True):
        at = mi.SurfaceInteraction3f()
        at.wi = mi.ScalarVector3f(*a)
        expected.append(np.array(plugin.eval(mi.BSDFContext(), at, mi.ScalarVector3f(*b))))
    found = measured.load(path).evaluate(wi, wo) * wo[:, 2:]
    np.testing.assert_allclose(found, expected, rtol=1e-4)


def test_bad_input_is_named(rough):
    with pytest.raises(ValueError, match="omega_o must be unit"):
        rough.evaluate((0, 0, 1), (0, 0, 0.5))
    with pytest.raises(ValueError, match=r"values must have shape \[288, 288, 3\]"):
        measured.Brdf.from_values(np.zeros(3))
    with pytest.raises(ValueError, match="format.*x3d"):
        measured.Brdf("x3d", {})
