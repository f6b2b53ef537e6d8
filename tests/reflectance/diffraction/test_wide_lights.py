"""Domes as integrals over a half circle, and colours of wide lights without sampled wavelengths."""

import numpy as np
import pytest

from scratchwarp import diffraction, profiles
from scratchwarp.reflectance.diffraction.color import spectral_samples

from .brute_force import unit
from .light_cases import centers, scratches

DomeLight, PolygonLight, SphereLight, Scratch = (
    diffraction.DomeLight,
    diffraction.PolygonLight,
    diffraction.SphereLight,
    diffraction.Scratch,
)
radiance = diffraction.radiance


def test_an_even_dome_is_a_sphere_around_the_point():
    s, wavelength = scratches(60, offset=np.linspace(-60.0, 60.0, 60))
    wo = centers(60)
    around = radiance(SphereLight([0.0, 0.0, 0.0], 1.0), wo, s, wavelength, method="closed-form")
    np.testing.assert_allclose(radiance(DomeLight([[1.0]]), wo, s, wavelength), around, rtol=1e-9)
    np.testing.assert_allclose(radiance(DomeLight(np.full((5, 7), 2.5)), wo, s, wavelength), 2.5 * around, rtol=1e-9)
    assert radiance(DomeLight([[1.0]]), [0.0, 0.6, -0.8], Scratch(), 500.0) == 0.0


@pytest.mark.parametrize("phase", ["small-angle", "angle-dependent"])
@pytest.mark.parametrize("profile", [None, profiles.shape("vGroove")], ids=["rectangle", "vGroove"])
def test_domes_against_the_reference(phase, profile):
    # smooth enough that nothing changes over the Gaussian: cells of 0.7 degrees, radiance changing by 4 % a cell
    row, column = np.meshgrid(np.linspace(0, np.pi, 256), np.linspace(0, 2 * np.pi, 512), indexing="ij")
    dome = DomeLight(1.0 + 0.9 * np.cos(3.0 * row) * np.sin(2.0 * column + 0.4))
    s = Scratch(2.0, 1.1, 0.7, 20.0, profile=profile)
    for wo in (unit([0.1, 0.2, 1.0]), unit([-0.6, 0.5, 0.5])):
        exact = radiance(dome, wo, s, 520.0, phase, method="quadrature")
        np.testing.assert_allclose(radiance(dome, wo, s, 520.0, phase), exact, rtol=6e-3)


def test_a_bright_cell_is_a_polygon():
    # one cell of a coarse dome is a wide light: bounded by two great circles and by polygons along two small ones
    values = np.zeros((6, 8))
    values[1, 2] = 1.0
    polar, around = np.linspace(30.0, 60.0, 40), np.linspace(90.0, 135.0, 40)
    edge = [(polar, np.full(40, 90.0)), (np.full(40, 60.0), around), (polar[::-1], np.full(40, 135.0))]
    edge.append((np.full(40, 30.0), around[::-1]))
    a, b = (np.radians(np.concatenate([part[i] for part in edge])) for i in (0, 1))
    outline = np.stack([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)], axis=-1)
    middle = unit([np.sin(np.pi / 4) * np.cos(1.96), np.sin(np.pi / 4) * np.sin(1.96), np.cos(np.pi / 4)])
    s = Scratch(1.4, 0.9, 1.96)  # along the azimuth of the cell: the line crosses it from side to side
    wo = unit([-middle[0], -middle[1], middle[2]])
    exact = radiance(PolygonLight(outline), wo, s, 500.0)
    # cut into 256 parts: both edges may be half a part off, of an interval of 70
    np.testing.assert_allclose(radiance(DomeLight(values), wo, s, 500.0), exact, rtol=2e-2)


def test_wide_lights_in_one_look_up():
    rng = np.random.default_rng(5)
    width, depth = rng.uniform(0.3, 6.0, 300), rng.uniform(0.0, 6.0, 300)
    q0 = rng.uniform(-1.9, 1.5, 300)
    q1 = q0 + rng.uniform(0.05, 0.5, 300)
    # a rectangle from q0 to q1 across the line, seen from above: densely summed
    at, weights = spectral_samples(400)
    inside = (q0 > -0.95) & (q1 < 0.95)
    lo, hi = (q[inside] / np.sqrt(1.0 - q[inside] ** 2) for q in (q0, q1))
    one = np.ones(inside.sum())
    corners = np.stack(
        [np.stack([x * one, y, one], axis=-1) for x, y in ((-0.4, lo), (0.4, lo), (0.4, hi), (-0.4, hi))], axis=1
    )
    s = Scratch(width[inside, None], depth[inside, None], 0.0, 25.0)
    dense = radiance(PolygonLight(corners[:, None]), [0.0, 0.0, 1.0], s, at, method="closed-form") @ weights
    value = diffraction.wide_rgb(width[inside], depth[inside], q0[inside], q1[inside], offset=25.0)
    whole = width[inside, None] / (np.sqrt(np.pi) * 60.0)  # of the lobe, |D|^2 = 1
    assert np.abs((value - dense) / whole).max() < 3e-4
    np.testing.assert_allclose(value, dense, atol=3e-4 * whole.max())
    # an interval is the sum of its parts, and the other way round the negative
    middle = 0.5 * (q0 + q1)
    parts = diffraction.wide_rgb(width, depth, q0, middle) + diffraction.wide_rgb(width, depth, middle, q1)
    np.testing.assert_allclose(parts, diffraction.wide_rgb(width, depth, q0, q1), atol=1e-12)
    np.testing.assert_allclose(diffraction.wide_rgb(width, depth, q1, q0), -diffraction.wide_rgb(width, depth, q0, q1))
    assert diffraction.wide_rgb(2.0, 0.0, -0.5, 0.5).max() < 1e-12


def test_wide_scratches_beyond_the_table():
    # 40 um: fringes of 0.01 have washed out, and a light of half the sky takes the whole lobe but 1 / x
    at, weights = spectral_samples(3000)
    light = PolygonLight([[-0.4, -0.5, 1.0], [0.4, -0.5, 1.0], [0.4, 0.7, 1.0], [-0.4, 0.7, 1.0]])
    dense = radiance(light, [0.0, 0.0, 1.0], Scratch(40.0, 1.3), at, method="closed-form") @ weights
    q0, q1 = -0.5 / np.hypot(1.0, 0.5), 0.7 / np.hypot(1.0, 0.7)
    np.testing.assert_allclose(diffraction.wide_rgb(40.0, 1.3, q0, q1), dense, rtol=1e-3)


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda: DomeLight([[1.0, -1.0]]), "values"),
        (lambda: DomeLight([1.0, 1.0]), "values"),
        (lambda: diffraction.wide_rgb(1.0, 9.0, 0.0, 1.0), "depth"),
        (lambda: diffraction.wide_rgb(-1.0, 1.0, 0.0, 1.0), "width"),
        (lambda: diffraction.wide_rgb(1.0, 1.0, 0.0, 1.0, coherence_radius=0.0), "coherence_radius"),
    ],
)
def test_wrong_arguments_are_named(call, name):
    with pytest.raises(ValueError, match=name):
        call()
