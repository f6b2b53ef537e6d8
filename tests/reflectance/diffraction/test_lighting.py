"""Radiance under area lights: identities, accuracy of each method, and the reference against samples."""

import numpy as np
import pytest

from scratchwarp import diffraction, profiles

from . import brute_force
from .brute_force import big_m, unit
from .light_cases import centers, polygons, scratches, view

PolygonLight, SphereLight, Scratch = diffraction.PolygonLight, diffraction.SphereLight, diffraction.Scratch
radiance = diffraction.radiance
EVERYWHERE = SphereLight([0.0, 0.0, 0.0], 1.0)


def _full_lobe(s, wavelength, omega_o):
    """L = (W / (sqrt(pi) sigma)) e^{-s_b^2 / sigma^2} |D|^2 dM / pi over the whole line, light from everywhere."""
    c, d = np.cos(s.azimuth), np.sin(s.azimuth)
    along, across = omega_o[:, 0] * c + omega_o[:, 1] * d, omega_o[:, 1] * c - omega_o[:, 0] * d
    half = np.sqrt(1.0 - along**2)
    k = 2.0 * np.pi * s.width / (wavelength * 1e-3)
    lobe = (big_m(k * (across + half)) - big_m(k * (across - half))) / np.pi
    share = s.width / (np.sqrt(np.pi) * s.coherence_radius) * np.exp(-((s.offset / s.coherence_radius) ** 2))
    return share * brute_force.depth_power(s.depth, wavelength) * lobe


def test_furnace():
    s, wavelength = scratches(300, offset=np.linspace(-90.0, 90.0, 300))
    wo = centers(300)
    expected = _full_lobe(s, wavelength, wo)
    closed = radiance(EVERYWHERE, wo, s, wavelength, method="closed-form")
    np.testing.assert_allclose(closed, expected, rtol=1e-9)
    # the half circle changes over the Gaussian, the more the closer the view is to the axis
    c, d = np.cos(s.azimuth), np.sin(s.azimuth)
    across = np.abs(wo[:, 0] * c + wo[:, 1] * d) < 0.7
    np.testing.assert_allclose(radiance(EVERYWHERE, wo, s, wavelength)[across], expected[across], rtol=1e-3)
    reference = radiance(EVERYWHERE, wo[:5], Scratch(2.0, 1.0), 500.0, method="quadrature")
    np.testing.assert_allclose(radiance(EVERYWHERE, wo[:5], Scratch(2.0, 1.0), 500.0), reference, rtol=1e-6)


def test_neither_wavelength_nor_coherence_radius_changes_the_mean_over_a_footprint():
    # L = (W l / A_P) |D|^2 dM / pi; lambda alone stands in |D|^2 and in the argument of M
    wo, light = unit([0.1, 0.3, 1.0]), PolygonLight([[-0.5, -1, 1], [0.7, -1, 1], [0.6, 0.9, 1], [-0.8, 0.8, 1.2]])
    means = []
    for sigma in (20.0, 60.0, 200.0):
        offset = np.linspace(-8.0, 8.0, 1601) * sigma
        values = radiance(light, wo, Scratch(2.0, 0.7, 0.3, offset, sigma), 500.0, method="closed-form")
        means.append(np.trapezoid(values, offset))
    np.testing.assert_allclose(means, means[0], rtol=1e-9)
    full = [
        np.trapezoid(radiance(EVERYWHERE, wo, Scratch(2.0, 0.7, 0.3, at, sigma), 500.0, method="closed-form"), at)
        for sigma in (20.0, 60.0)
        for at in [np.linspace(-8.0, 8.0, 1601) * sigma]
    ]
    c, d = np.cos(0.3), np.sin(0.3)
    along, across = wo[0] * c + wo[1] * d, wo[1] * c - wo[0] * d
    half, k = np.sqrt(1.0 - along**2), 2.0 * np.pi * 2.0 / 0.5
    lobe = (big_m(k * (across + half)) - big_m(k * (across - half))) / np.pi
    np.testing.assert_allclose(full, 2.0 * brute_force.depth_power(0.7, 500.0) * lobe, rtol=1e-9)


def test_albedo_of_scratched_area():
    # widths and depths even over 0.8 to 6 um: 1.97, 1.96, 1.95 at the normal, 1.41, 1.32, 1.26 at 80 degrees
    # averaged over azimuths; midpoints of 64 widths, depths and 8 azimuths
    at = 0.8 + 5.2 * (np.arange(64) + 0.5) / 64
    s = Scratch(at[:, None, None], at[:, None], np.pi * (np.arange(8) + 0.5) / 8)
    share = s.width / (np.sqrt(np.pi) * 60.0)
    for angle, expected in ((0.0, (1.97, 1.96, 1.95)), (80.0, (1.41, 1.32, 1.26))):
        wo = [0.0, np.sin(np.radians(angle)), np.cos(np.radians(angle))]
        for wavelength, value in zip((400.0, 550.0, 700.0), expected, strict=True):
            albedo = np.mean(radiance(EVERYWHERE, wo, s, wavelength, method="closed-form") / share)
            np.testing.assert_allclose(albedo, value, rtol=0.03)


CONVEX = [[-0.05, -0.3, 1.0], [0.3, -0.25, 1.1], [0.1, 0.5, 0.9]]
STAR = [[0.0, -0.5, 1], [0.1, -0.1, 1], [0.5, 0.0, 1], [0.1, 0.1, 1], [0.0, 0.5, 1], [-0.1, 0.1, 1], [-0.5, 0.0, 1],
        [-0.1, -0.1, 1]]  # fmt: skip
LOW = [[0.5, -0.4, -0.3], [0.6, 0.5, 0.2], [0.5, 0.5, 0.8]]


@pytest.mark.parametrize(
    ("light", "inside"),
    [
        (SphereLight([0.1, 0.2, 1.0], 0.3), brute_force.inside_sphere([0.1, 0.2, 1.0], 0.3)),
        (SphereLight([0.4, 0.1, -0.1], 0.3), brute_force.inside_sphere([0.4, 0.1, -0.1], 0.3)),
        (SphereLight([0.0, 0.3, -0.02], 0.29), brute_force.inside_sphere([0.0, 0.3, -0.02], 0.29)),
        (PolygonLight(CONVEX), brute_force.inside_polygon(CONVEX)),
        (PolygonLight(STAR), brute_force.inside_polygon(STAR)),
        (PolygonLight(LOW), brute_force.inside_polygon(LOW)),
    ],
    ids=["sphere", "sphere low", "wide sphere low", "triangle", "star", "triangle low"],
)
@pytest.mark.parametrize("phase", ["small-angle", "angle-dependent"])
def test_reference_against_samples(light, inside, phase):
    s, wavelength, dependent = Scratch(1.5, 0.9, 0.5), 500.0, phase == "angle-dependent"
    center = unit(light.center if isinstance(light, SphereLight) else light.vertices.mean(axis=0))
    c, d = np.cos(0.5), np.sin(0.5)
    u = -(center[0] * c + center[1] * d) + 4e-4
    v = 0.2
    wo = np.array([u * c - v * d, u * d + v * c, np.sqrt(1.0 - u * u - v * v)])

    def across(xi2, g):
        depth = np.abs(1.0 - np.exp(2j * np.pi / 0.5 * 0.9 * (g if dependent else 2.0))) ** 2
        return (1.5 / 0.5 * np.sinc(1.5 / 0.5 * xi2)) ** 2 * depth

    sampled = brute_force.sampled_radiance(inside, wo, 0.5, 60.0, wavelength, across)
    value = radiance(light, wo, s, wavelength, phase, method="quadrature")
    # 2^15 Sobol points of an integrand with a jump: error about 2^(-15 * 3/4) = 4e-4 of its greatest value
    np.testing.assert_allclose(value, sampled, rtol=4e-3)
    np.testing.assert_allclose(radiance(light, wo, s, wavelength, phase, slices=64), value, rtol=1e-6)


@pytest.mark.parametrize("ends", [(-30.0, 55.0), (10.0, np.inf), (-12.0, -2.0), (200.0, 260.0)])
def test_ends_under_lights(ends):
    s, wavelength = scratches(4, ends=ends)
    for light, axis in (
        (SphereLight(centers(4), 0.005), centers(4)),
        (PolygonLight(polygons(4, 0.1, 4)), unit(polygons(4, 0.1, 4).mean(axis=1))),
    ):
        wo = view(axis, 2e-3, s)
        reference = radiance(light, wo, s, wavelength, method="quadrature")
        # 64 nodes under a lobe whose fringes reach far: 1 % where the light is wide, and all of them
        np.testing.assert_allclose(radiance(light, wo, s, wavelength), reference, rtol=1e-2, atol=1e-12)
        np.testing.assert_allclose(radiance(light, wo, s, wavelength, slices=32), reference, rtol=1e-3, atol=1e-12)
    # the ends' share of energy is what is left under light from everywhere
    endless, wo = Scratch(s.width, s.depth, s.azimuth), centers(4)
    x0, x1 = (np.clip(end / 60.0, -9.0, 9.0) for end in ends)
    x = np.linspace(x0, x1, 20001)
    share = np.trapezoid(np.exp(-x * x), x) / np.sqrt(np.pi)
    kept = radiance(EVERYWHERE, wo, s, wavelength, method="closed-form")
    whole = radiance(EVERYWHERE, wo, endless, wavelength, method="closed-form")
    np.testing.assert_allclose(kept, share * whole, rtol=1e-7, atol=1e-15)


# (light, relative error of 4 slices where there is light to speak of: median, worst)
CLASSES = {
    "1 mm sphere": (lambda: _sphere(0.001, 0.0), 1e-3, 1e-2),
    "5 mm sphere, centre": (lambda: _sphere(0.005, 0.0), 2e-3, 1e-2),
    "5 mm sphere, inside": (lambda: _sphere(0.005, 0.7), 5e-4, 1e-2),
    "5 mm sphere, tangent": (lambda: _sphere(0.005, 1.0), 3e-3, 1e-2),
    "5 mm sphere, missed": (lambda: _sphere(0.005, 1.2), 3e-3, 1e-2),
    "5 mm sphere, cut by the horizon": (lambda: _sphere(0.005, 0.3, True), 3e-3, 1e-2),
    "5 cm sphere": (lambda: _sphere(0.05, 0.3), 1e-4, 1e-2),
    "large sphere": (lambda: _sphere(0.6, 0.3), 1e-6, 1e-2),
    "small triangle": (lambda: _polygon(0.004, 3), 1e-3, 1e-2),
    "triangle": (lambda: _polygon(0.3, 3), 1e-5, 1e-2),
    "quad": (lambda: _polygon(0.02, 4), 1e-3, 1e-2),
    "star": (lambda: _polygon(0.3, 10, star=0.4), 1e-5, 1e-2),
    "corner on the line": (lambda: _polygon(0.3, 4, corner=True), 1e-5, 3.5e-2),
}
COUNT = 40


def _sphere(radius, at, low=False):
    s, wavelength = scratches(COUNT)
    c = centers(COUNT)
    if low:
        c[:, 2] = 0.0
        c = unit(c)
        c[:, 2] = np.random.default_rng(8).uniform(-0.8, 0.8, COUNT) * radius
    return SphereLight(c, radius), view(unit(c), at * radius * np.ones(COUNT), s), s, wavelength


def _polygon(size, corners, star=1.0, corner=False):
    s, wavelength = scratches(COUNT)
    vertices = polygons(COUNT, size, corners, star=star)
    at = np.random.default_rng(9).uniform(-0.3, 0.3, COUNT) * size
    axis = vertices[:, 0] if corner else vertices.mean(axis=1)
    return PolygonLight(vertices), view(unit(axis), 0.0 * at if corner else at, s), s, wavelength


@pytest.mark.parametrize("name", CLASSES)
def test_accuracy_of_slices(name):
    make, median, worst = CLASSES[name]
    case = make()
    reference = radiance(*case, method="quadrature")
    seen = reference > 1e-8
    assert seen.sum() > COUNT // 3
    error = np.abs(radiance(*case) - reference)[seen] / reference[seen]
    assert np.median(error) < median and error.max() < worst, (np.median(error), error.max())
    many = radiance(*case, slices=48)
    np.testing.assert_allclose(many[seen], reference[seen], rtol=1e-6)
    np.testing.assert_allclose(many, reference, rtol=1e-4, atol=1e-12)


@pytest.mark.parametrize(
    ("size", "corners", "low", "beyond", "worst"),
    [
        # (corners 0: a sphere); share of views whose error is more than 1 %, and the greatest error
        (0.001, 0, False, 0.0, 2e-3),
        (0.005, 0, False, 0.0, 5e-3),
        (0.6, 0, False, 0.0, 5e-3),
        (0.005, 0, True, 0.005, 0.1),
        (0.1, 0, True, 0.005, 0.1),
        (0.02, 3, False, 0.02, 0.3),
        (0.3, 4, False, 0.01, 0.1),
        (0.02, 3, True, 0.01, 0.3),
    ],
)
def test_almost_every_view_is_within_one_percent(size, corners, low, beyond, worst):
    # 1,500 random views each, in the light's fringes and beside it, against 64 slices: 1e-6
    count = 1500
    s, wavelength = scratches(count, 5)
    rng = np.random.default_rng(7)
    c = centers(count, 6)
    vertices = polygons(count, size, max(corners, 3), 6)
    if low:
        c[:, 2] = 0.0
        c = unit(c)
        c[:, 2] = rng.uniform(-0.95, 1.2, count) * size
        vertices[..., 2] -= (vertices[..., 2].mean(axis=1) - rng.uniform(-0.3, 0.3, count) * size)[:, None]
    light = PolygonLight(vertices) if corners else SphereLight(c, size)
    axis = unit(vertices.mean(axis=1)) if corners else unit(c)
    wo = view(axis, rng.uniform(-1.4, 1.4, count) * size, s, 8)
    reference = radiance(light, wo, s, wavelength, slices=64)
    seen = reference > 1e-8
    assert seen.sum() > count // 5
    error = np.abs(radiance(light, wo, s, wavelength)[seen] / reference[seen] - 1.0)
    assert np.mean(error > 1e-2) <= beyond and error.max() < worst, (np.mean(error > 1e-2), error.max())


def test_closed_form_is_as_wrong_as_known():
    # a 3 um scratch, the view that looks at the middle of the light: its error in percent for three wavelengths
    table = {0.001: (53, 95, 154), 0.002: (11, 24, 47), 0.005: (1.3, 2.6, 5.3), 0.01: (0.3, 0.6, 1.2)}
    waves, s = [400.0, 549.0, 750.0], Scratch(3.0, 0.37)
    center = unit([0.2, 0.1, 1.0])
    wo = unit([-0.2, 0.1, np.sqrt(1.05 - 0.05)])
    wo = np.array([-center[0], wo[1], np.sqrt(1.0 - center[0] ** 2 - wo[1] ** 2)])
    for ratio, percent in table.items():
        light = SphereLight(center, ratio)
        closed = radiance(light, wo, s, waves, method="closed-form")
        exact = radiance(light, wo, s, waves, method="quadrature")
        np.testing.assert_allclose(100.0 * (closed / exact - 1.0), percent, rtol=0.15, atol=0.06)
    # every edge more than 10 / (sigma k) away: 0.5 %
    s, wavelength = scratches(COUNT)
    center = centers(COUNT)
    light, wo = SphereLight(center, 0.2), view(center, 0.02, s)
    exact = radiance(light, wo, s, wavelength, slices=32)
    far = exact > 1e-4
    np.testing.assert_allclose(radiance(light, wo, s, wavelength, method="closed-form")[far], exact[far], rtol=5e-3)


def test_the_papers_closed_form():
    # Eq. 27 with Eq. 29 written out, bounds of the quad on the line from its straight edges
    def n(q, k, sigma, w):
        x = k * w * q
        si = np.pi / 2 * np.tanh(x) - 0.66142739 * x / (1 + (x - np.sign(x) * 0.38272292) ** 2)
        si += np.sign(x) * (1 - np.cos(x)) / (1 + abs(x))
        return np.sqrt(np.pi) / (sigma * k) * (2 * si / (k * w) - 4 * np.sin(x / 2) ** 2 / (k**2 * w**2 * q))

    rng = np.random.default_rng(4)
    lo = rng.uniform(-0.8, 0.8, 200)
    hi = lo + rng.uniform(0.005, 0.5, 200)
    one = np.ones(200)
    corner = np.stack([(-0.3 * one, lo, one), (0.3 * one, lo, one), (0.3 * one, hi, one), (-0.3 * one, hi, one)])
    light = PolygonLight(np.moveaxis(corner, 2, 0))
    wo = unit(np.stack((0 * one, rng.uniform(-0.5, 0.5, 200), one), axis=-1))
    s, wavelength = Scratch(rng.uniform(0.8, 6.0, 200), 1.1), rng.uniform(400.0, 750.0, 200)
    k = 2e3 * np.pi / wavelength
    q = [v / np.hypot(1.0, v) + wo[:, 1] for v in (lo, hi)]
    common = 2 * s.width**2 * brute_force.depth_power(1.1, wavelength) / (wavelength * 1e-3) ** 2
    expected = common * (n(q[1], k, 60.0, s.width) - n(q[0], k, 60.0, s.width))
    value = radiance(light, wo, s, wavelength, method="closed-form-paper")
    np.testing.assert_allclose(value, expected, atol=1e-10 * expected.max())
    exact = radiance(light, wo, s, wavelength, method="closed-form")
    assert np.any(value < -1e-9) and np.all(exact >= 0.0)
    reversed_light = PolygonLight(light.vertices[:, ::-1])
    np.testing.assert_allclose(radiance(reversed_light, wo, s, wavelength, method="closed-form-paper"), value,
                               atol=1e-12 * expected.max())  # fmt: skip


@pytest.mark.parametrize(
    ("profile", "tolerance"),
    [
        (profiles.shape("rectangle"), 2e-5),
        (profiles.shape("vGroove", apex=0.3), 2e-5),
        (profiles.Profile([[0, 0], [2, -1], [3, -3], [7, 0.5], [8, 0]], isolated=True), 2e-5),
    ],
    ids=["rectangle", "vGroove", "points"],
)
def test_profiles_under_lights(profile, tolerance):
    plain, wavelength = scratches(10)
    s = Scratch(plain.width, plain.depth, plain.azimuth, profile=profile)
    for light, axis in (
        (SphereLight(centers(10), 0.1), centers(10)),
        (PolygonLight(polygons(10, 0.2, 5)), unit(polygons(10, 0.2, 5).mean(axis=1))),
    ):
        wo = view(axis, 0.01, s)
        reference = radiance(light, wo, s, wavelength, method="quadrature")
        # 32 Hermite cells a fringe: (2 pi / 32)^4 / 384 of the integral's fringes
        np.testing.assert_allclose(radiance(light, wo, s, wavelength, slices=32), reference, rtol=1e-4, atol=1e-9)
        dependent = radiance(light, wo, s, wavelength, "angle-dependent", slices=32)
        exact = radiance(light, wo, s, wavelength, "angle-dependent", method="quadrature")
        np.testing.assert_allclose(dependent, exact, rtol=1e-6)
        if profile.points.shape[0] == 4:
            np.testing.assert_allclose(reference, radiance(light, wo, plain, wavelength, method="quadrature"),
                                       rtol=1e-6)  # fmt: skip
    closed = radiance(EVERYWHERE, wo, s, wavelength, method="closed-form")
    np.testing.assert_allclose(radiance(EVERYWHERE, wo, s, wavelength), closed, rtol=1e-3)


def test_spread_depths_under_lights():
    s = Scratch(2.0, 1.2, depth_spread=0.1, roughness=0.03)
    wo, light = unit([-0.1, 0.3, 1.0]), SphereLight([0.1, 0.2, 1.0], 0.2)
    reference = radiance(light, wo, s, 550.0, method="quadrature")
    np.testing.assert_allclose(radiance(light, wo, s, 550.0, slices=32), reference, rtol=1e-6)
    dependent = radiance(light, wo, s, 550.0, "angle-dependent", method="quadrature")
    np.testing.assert_allclose(radiance(light, wo, s, 550.0, "angle-dependent", slices=32), dependent, rtol=1e-6)
