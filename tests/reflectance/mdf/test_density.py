"""Distributions of facet normals and their deformation: closed forms, geometry in float64, integrals, hard cases."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from scratchwarp import mdf


def _disk(radii=400, angles=240, power=1.0):
    """Midpoints of the disk, sin theta with theta uniform, as normals; and the areas of their cells."""
    t, phi = np.meshgrid((np.arange(radii) + 0.5) / radii, (np.arange(angles) + 0.5) / angles, indexing="ij")
    theta, phi = 0.5 * np.pi * t**power, 2 * np.pi * phi
    h = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    dtheta = 0.5 * np.pi * power * t ** (power - 1.0) / radii
    return h, np.sin(theta) * np.cos(theta) * dtheta * 2 * np.pi / angles


def _points(count=500, seed=1):
    rng = np.random.default_rng(seed)
    r, phi = np.sqrt(rng.random(count)), 2 * np.pi * rng.random(count)
    return np.stack([r * np.cos(phi), r * np.sin(phi)], axis=-1)


def _rim(c, p):
    """R by bisection along the ray from c through p: shares nothing with the closed form."""
    low, high = np.zeros(len(p)), np.full(len(p), 1e9)
    for _ in range(200):
        middle = 0.5 * (low + high)
        inside = np.linalg.norm(c + middle[:, None] * (p - c), axis=-1) < 1.0
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return c + low[:, None] * (p - c)


def test_closed_forms():
    theta, phi = np.meshgrid(np.linspace(0.01, 1.5, 30), np.linspace(-3, 3, 11), indexing="ij")
    h = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    c2, s2 = np.cos(phi) ** 2, np.sin(phi) ** 2
    expected = np.sqrt(201 * 11) / (2 * np.pi) * np.cos(theta) ** (200 * c2 + 10 * s2)
    np.testing.assert_allclose(mdf.ashikhmin_shirley(h, 200, 10), expected, rtol=1e-11)
    shape = np.exp(-(np.tan(theta) ** 2) * (c2 / 0.04 + s2 / 0.25)) / (np.pi * 0.1)
    np.testing.assert_allclose(mdf.ward(h, 0.2, 0.5), shape, rtol=1e-11)
    np.testing.assert_allclose(mdf.beckmann(h, 0.2, 0.5), shape / np.cos(theta) ** 4, rtol=1e-11)
    e = c2 / 0.04 + s2 / 0.25
    ggx = 1 / (np.pi * 0.1 * (np.sin(theta) ** 2 * e + np.cos(theta) ** 2) ** 2)
    np.testing.assert_allclose(mdf.ggx(h, 0.2, 0.5), ggx, rtol=1e-11)


def test_sharp_lobes_keep_their_digits():
    """With e = 1e5 a rounded cosine would be off by 1e-11; near the pole log(cos) is -theta^2 / 2 - theta^4 / 12."""
    theta = np.array([1e-9, 1e-5, 1e-3, 1e-2])
    h = np.stack([np.sin(theta), 0 * theta, np.cos(theta)], axis=-1)
    log = -(theta**2) / 2 - theta**4 / 12 - theta**6 / 45
    peak = mdf.ashikhmin_shirley((0, 0, 1), 1e5, 1e5)
    np.testing.assert_allclose(mdf.ashikhmin_shirley(h, 1e5, 1e5) / peak, np.exp(1e5 * log), rtol=1e-12)
    np.testing.assert_allclose(peak, 100001 / (2 * np.pi), rtol=1e-14)


@pytest.mark.parametrize("kind", ["linear", "sqrt"])
@pytest.mark.parametrize("length", [0.1, 0.5, 0.9, 0.999])
def test_inverse_deform_is_the_geometry_of_the_paper(kind, length):
    c, p = length * np.array([0.6, -0.8]), _points()
    rim = _rim(c, p)
    ratio = np.linalg.norm(rim - p, axis=-1) / np.linalg.norm(rim - c, axis=-1)
    ratio = np.sqrt(ratio) if kind == "sqrt" else ratio
    # bisection and the closed form each lose about 1e-15 / (1 - |c|); the root of it near the rim
    atol = 1e-11 if kind == "linear" else 3e-6
    np.testing.assert_allclose(mdf.inverse_deform(p, c, kind=kind), p - ratio[:, None] * c, atol=atol)


@given(x=st.floats(-0.7, 0.7), y=st.floats(-0.7, 0.7), a=st.floats(0, 6.3), length=st.floats(0, 0.999))
@settings(max_examples=60, deadline=None)
def test_linear_deformation_is_inverted(x, y, a, length):
    c = length * np.array([np.cos(a), np.sin(a)])
    # rounding of the moved point is magnified by at most 1 / (1 - |c|) = 1e3
    np.testing.assert_allclose(mdf.inverse_deform(mdf.deform((x, y), c), c), (x, y), atol=1e-12)


@pytest.mark.parametrize("length", [0.0, 0.5, 0.999, 1.0])
def test_the_centre_moves_to_delta(length):
    c = length * np.array([0.8, 0.6])
    np.testing.assert_allclose(mdf.inverse_deform(c, c), 0.0, atol=1e-15)
    h = np.array([*c, np.sqrt(max(1 - length**2, 0.0))])
    if h[2] > 0:
        np.testing.assert_allclose(mdf.deformed(h, c, 1e5, 30), mdf.ashikhmin_shirley((0, 0, 1), 1e5, 30), rtol=1e-9)


@pytest.mark.parametrize("exponents", [(20, 20), (200, 10), (50, 2)])
def test_linear_deformation_keeps_the_projected_integral(exponents):
    ex, ey = exponents
    h, area = _disk(power=1.3)
    # of z^(e + 1) dz over the closed form of the azimuths
    exact = np.sqrt((ex + 1) * (ey + 1) / ((ex + 2) * (ey + 2)))
    for length in (0.0, 0.5, 0.9):
        d = mdf.deformed(h, length * np.array([0.6, 0.8]), ex, ey)
        # midpoint rule with 400 x 240 cells, second order in the width of the cells
        np.testing.assert_allclose(np.sum(d * area), exact, rtol=1e-3)
    d = mdf.ashikhmin_shirley(h, ex, ey)
    np.testing.assert_allclose(np.sum(d * area / h[..., 2]), 1.0, rtol=1e-3)


def test_square_root_loses_energy_and_leaves_the_disk():
    """Figures of an independent implementation: 0.885 at 0.5 and 0.713 at 0.9 for (20, 20), against 0.9545."""
    h, area = _disk()
    for length, expected in ((0.5, 0.885), (0.9, 0.713)):
        d = mdf.deformed(h, (length, 0.0), 20, 20, kind="sqrt")
        np.testing.assert_allclose(np.sum(d * area), expected, atol=1e-3)
        p = mdf.inverse_deform(h[..., :2], (length, 0.0), kind="sqrt")
        assert np.all(d[np.linalg.norm(p, axis=-1) > 1.0] == 0.0) and np.any(np.linalg.norm(p, axis=-1) > 1.0)


@pytest.mark.parametrize("distribution", mdf.DISTRIBUTIONS)
def test_hard_cases_are_finite(distribution):
    theta = np.array([0.0, 1e-8, 0.5, 1.57, np.pi / 2, 2.0])
    h = np.stack([np.sin(theta), 0 * theta, np.cos(theta)], axis=-1)
    wide = (1e5, 0.0) if distribution == "ashikhmin-shirley" else (1e-3, 10.0)
    for delta in ((0, 0), (0.999, 0), (1, 0), (0, -1), (1e-12, 0)):
        for kind in mdf.KINDS:
            d = mdf.deformed(h, delta, *wide, kind=kind, distribution=distribution)
            assert np.all(np.isfinite(d)) and np.all(d >= 0)
            assert not np.any(d[h[:, 2] <= 0])


def test_broadcasting():
    h = np.zeros((4, 1, 3)) + [0, 0, 1]
    assert mdf.ashikhmin_shirley(h, np.ones(5), 1).shape == (4, 5)
    assert mdf.deformed(h, np.zeros((5, 2)), 1, 1).shape == (4, 5)
    assert mdf.inverse_deform(np.zeros((3, 1, 2)), np.zeros((2, 2))).shape == (3, 2, 2)


def test_bad_input_is_named():
    up = (0, 0, 1)
    with pytest.raises(ValueError, match="delta.*1.5"):
        mdf.deformed(up, (1.5, 0), 10, 10)
    with pytest.raises(ValueError, match="delta"):
        mdf.inverse_deform((0, 0), (0.8, 0.8))
    with pytest.raises(ValueError, match="p must be no longer"):
        mdf.inverse_deform((1.2, 0), (0, 0))
    with pytest.raises(ValueError, match="h must be unit"):
        mdf.ward((0, 0, 2), 0.1, 0.1)
    with pytest.raises(ValueError, match="ax.*-1"):
        mdf.ward(up, -1, 0.1)
    with pytest.raises(ValueError, match="ey.*nan"):
        mdf.ashikhmin_shirley(up, 1, np.nan)
    with pytest.raises(ValueError, match="kind.*cubic"):
        mdf.deformed(up, (0, 0), 1, 1, kind="cubic")
    with pytest.raises(ValueError, match="broadcast"):
        mdf.ashikhmin_shirley(np.zeros((2, 3)) + up, np.ones(3), 1)
