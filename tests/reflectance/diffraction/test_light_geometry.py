"""Lights cut by slices: shapes that must agree, and the hard cases of geometry with their right values."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from scratchwarp import diffraction

from . import brute_force
from .brute_force import big_m, unit
from .light_cases import centers, polygons, scratches, view

PolygonLight, SphereLight, Scratch = diffraction.PolygonLight, diffraction.SphereLight, diffraction.Scratch
radiance = diffraction.radiance
METHODS = ["slices", "closed-form", "quadrature"]
UP = np.array([0.0, 0.0, 1.0])


def _on_the_line(light, wo, s, wavelength):
    """Eq. 27 with bounds found by walking along the line xi_1 = 0 in steps of 3e-5."""
    c, d = np.cos(s.azimuth), np.sin(s.azimuth)
    along, across = wo[0] * c + wo[1] * d, wo[1] * c - wo[0] * d
    psi = (np.arange(100_000) + 0.5) / 100_000 * np.pi - np.pi / 2
    length = np.sqrt(1.0 - along**2)
    u, v = -along, length * np.sin(psi)
    w = np.stack((u * c - v * d, u * d + v * c, length * np.cos(psi)), axis=-1)
    lit = light(w).astype(int)
    start, stop = (np.flatnonzero(np.diff(np.concatenate(([0], lit, [0]))) == step) for step in (1, -1))
    edges = length * np.sin((np.stack((start, stop)) / 100_000 - 0.5) * np.pi) + across
    k = 2e3 * np.pi / wavelength
    lobe = np.sum(big_m(k * s.width * edges[1]) - big_m(k * s.width * edges[0])) / np.pi
    share = s.width / (np.sqrt(np.pi) * s.coherence_radius)
    return share * brute_force.depth_power(s.depth, wavelength) * lobe, edges


def test_bounds_that_the_printed_equations_miss():
    # exponent +-1 of Eq. 35 gives q0 = 0.7441 for a disk of radius 0.45, which subtends atan(R / d); and the sphere
    s = Scratch(3.0, 1.2, 0.4)
    center = np.array([-0.3, 0.35, 0.9])
    disk = 0.45 / np.sqrt(1.0 + 0.45**2 / (center @ center))
    for radius, q0 in ((disk, 0.0577), (0.45, 0.0128)):
        expected, edges = _on_the_line(brute_force.inside_sphere(center, radius), UP, s, 500.0)
        np.testing.assert_allclose(edges[0], q0, atol=2e-4)
        value = radiance(SphereLight(center, radius), UP, s, 500.0, method="closed-form")
        np.testing.assert_allclose(value, expected, rtol=2e-4)
    # tangent, from 0.19996 to 0.20004: where C = A, and nothing is left in float32
    wo = unit([0.18678126, 0.29611074, 0.93671297])
    light = SphereLight(UP, 0.3 / np.sqrt(1.09))
    value, exact = (radiance(light, wo, s, 500.0, method=m) for m in ("closed-form", "quadrature"))
    along, across = wo @ [np.cos(0.4), np.sin(0.4), 0.0], wo @ [-np.sin(0.4), np.cos(0.4), 0.0]
    np.testing.assert_allclose(across, 0.2, atol=1e-6)
    chord = np.sqrt(max(0.09 / 1.09 - along**2, 0.0))  # half of what is lit of the line
    k = 4e0 * np.pi * 3.0
    share = 3.0 / (np.sqrt(np.pi) * 60.0) * brute_force.depth_power(1.2, 500.0) / np.pi
    np.testing.assert_allclose(value, share * np.diff(big_m(k * (across + np.array([-chord, chord])))), atol=1e-9)
    assert chord < 1e-4 and exact > 0.0
    # small lights, by solid angle: the interval's length is 2 R / d
    for ratio in (1e-2, 1e-4, 1e-6, 1e-8):
        wo = unit([0.0, 0.3, 1.0])
        value = radiance(SphereLight([0.0, 0.1, 1.0], ratio), wo, Scratch(), 500.0, method="closed-form")
        q = wo[1] + 0.1 / np.hypot(1.0, 0.1)
        size = 2.0 * ratio / np.hypot(1.0, 0.1) * np.cos(np.arctan(0.1))
        flat = 2.0 * (3.0 / 0.5) ** 2 * np.sinc(6.0 * q) ** 2 * brute_force.depth_power(1.2, 500.0) * size
        np.testing.assert_allclose(value, flat * np.sqrt(np.pi) / (60.0 * 4.0 * np.pi), rtol=max(30 * ratio, 1e-6))


def test_many_shapes_on_the_line():
    rng = np.random.default_rng(5)
    for i in range(12):
        s = Scratch(rng.uniform(0.8, 6.0), rng.uniform(0.8, 6.0), rng.uniform(0.0, 6.0))
        wo = centers(20, 7)[i]
        corners = polygons(20, 1.2, 3 + i % 5 * 2, seed=40, star=0.5)[i]
        expected, _ = _on_the_line(brute_force.inside_polygon(corners), wo, s, 500.0)
        value = radiance(PolygonLight(corners), wo, s, 500.0, method="closed-form")
        np.testing.assert_allclose(value, expected, rtol=1e-3, atol=1e-6)


def test_a_star_of_triangles_is_the_star():
    s = Scratch(2.0, 1.1, 0.3)
    outer = polygons(3, 0.5, 8, seed=11)
    inner = 0.4 * outer + 0.6 * outer.mean(axis=1, keepdims=True)
    tips = np.stack((outer, np.roll(inner, -1, axis=1), inner), axis=2)  # [3, 8, 3, 3], skewed
    wo = view(unit(outer.mean(axis=1)), 0.02, Scratch(2.0, 1.1, 0.3 * np.ones(3)))
    pieces = radiance(PolygonLight(tips), wo[:, None], s, 500.0, slices=32)
    assert pieces.shape == (3, 8)
    middle = radiance(PolygonLight(inner), wo, s, 500.0, slices=32)
    outline = np.stack((outer, np.roll(inner, -1, axis=1)), axis=2).reshape(3, 16, 3)
    whole = radiance(PolygonLight(outline), wo, s, 500.0, slices=32)
    np.testing.assert_allclose(pieces.sum(axis=1) + middle, whole, rtol=1e-6)
    assert np.all(whole > 0.0)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(["small-angle", "angle-dependent"]))
def test_invariances(seed, phase):
    rng = np.random.default_rng(seed)
    width, depth, azimuth, wavelength = rng.uniform([0.8, 0.0, -4.0, 400.0], [6.0, 6.0, 4.0, 750.0])
    s = Scratch(width, depth, azimuth)
    size, sides = rng.choice([0.01, 0.1, 1.0]), int(rng.integers(3, 9))
    corners = polygons(1, size, sides, seed=seed, star=rng.uniform(0.3, 1.0))[0]
    wo = view(unit(corners.mean(axis=0))[None], rng.normal(0.0, 2e-3), Scratch(width, depth, [azimuth]), seed)[0]
    value = radiance(PolygonLight(corners), wo, s, wavelength, phase)
    close = {"rtol": 1e-7, "atol": 1e-13}
    assert value >= 0.0
    for changed in (37.0 * corners, corners[::-1], np.roll(corners, 2, axis=0)):
        np.testing.assert_allclose(radiance(PolygonLight(changed), wo, s, wavelength, phase), value, **close)
    # a corner more on an edge, and one twice
    more = np.insert(corners, 1, 0.3 * corners[0] + 0.7 * corners[1], axis=0)
    twice = np.repeat(corners, 2, axis=0)
    for changed in (more, twice):
        np.testing.assert_allclose(
            radiance(PolygonLight(changed), wo, s, wavelength, phase, slices=24),
            radiance(PolygonLight(corners), wo, s, wavelength, phase, slices=24), rtol=1e-5, atol=1e-11,
        )  # fmt: skip
    c, d = np.cos(1.1), np.sin(1.1)
    turn = np.array([[c, d, 0.0], [-d, c, 0.0], [0.0, 0.0, 1.0]])
    turned = Scratch(width, depth, azimuth + 1.1)
    np.testing.assert_allclose(radiance(PolygonLight(corners @ turn), wo @ turn, turned, wavelength, phase), value,
                               rtol=1e-6, atol=1e-12)  # fmt: skip
    half = Scratch(width, depth, azimuth + np.pi)
    np.testing.assert_allclose(radiance(PolygonLight(corners), wo, half, wavelength, phase), value,
                               rtol=1e-6, atol=1e-12)  # fmt: skip
    # sigma, W, D and lambda together
    double = Scratch(2 * width, 2 * depth, azimuth, 0.0, 120.0)
    np.testing.assert_allclose(radiance(PolygonLight(corners), wo, double, 2 * wavelength, phase), value, **close)
    center, radius = unit(corners.mean(axis=0)), rng.choice([0.005, 0.1, 0.9])
    ball = radiance(SphereLight(center, radius), wo, s, wavelength, phase)
    far = SphereLight(37.0 * center, 37.0 * radius)
    np.testing.assert_allclose(radiance(far, wo, s, wavelength, phase), ball, **close)
    # more light is never less, an invisible scratch is dark
    bigger = radiance(SphereLight(center, 1.05 * radius), wo, s, wavelength, phase, slices=24)
    assert bigger >= radiance(SphereLight(center, radius), wo, s, wavelength, phase, slices=24) * (1 - 1e-4)
    dark = Scratch(width, wavelength * 1e-3, azimuth)
    assert radiance(SphereLight(center, radius), wo, dark, wavelength) < 1e-15


@pytest.mark.parametrize("method", METHODS)
def test_what_cannot_be_seen_gives_nothing(method):
    s, wo = Scratch(azimuth=0.2), unit([0.1, 0.2, 1.0])

    def dark(light, view=wo):
        return radiance(light, view, s, 500.0, method=method) == 0.0

    square = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
    assert dark(SphereLight([0.2, 0.3, -0.5], 0.5)) and dark(SphereLight([0.2, 0.3, -0.6], 0.5))
    assert dark(SphereLight([0.0, 0.0, 1.0], 0.0)) and dark(SphereLight([0.0, 0.0, 0.0], 0.0))
    assert dark(PolygonLight(square - [0, 0, 1])) and dark(PolygonLight(square))
    assert dark(SphereLight(UP, 0.5), unit([0.1, 0.2, -1.0])) and dark(SphereLight(UP, 0.5), [0.0, 1.0, 0.0])
    assert dark(PolygonLight(square + UP), unit([0.1, 0.2, -1.0]))
    # edge-on, through the point or beside it; no area; all corners one
    upright = square[:, [0, 2, 1]] + [0, 0, 1.5]
    assert dark(PolygonLight(upright)) and dark(PolygonLight(upright * 0.1))
    assert dark(PolygonLight(upright + [5.0, 0, 0]))
    assert dark(PolygonLight([[0, 0, 1], [1, 0, 1], [2, 0, 1]])) and dark(PolygonLight([[0.3, 0.1, 1.0]] * 4))
    assert dark(PolygonLight([[0, 0, 0], [0, 0, 0], [0, 0, 0]]))


def test_lights_around_the_point_and_touching_it():
    s, wo = Scratch(2.0, 0.9, 0.2), unit([0.1, 0.2, 1.0])
    everywhere = radiance(SphereLight([0.0, 0.0, 0.0], 1.0), wo, s, 500.0)
    for center, radius in (([0.3, -0.2, 0.1], 0.5), ([0.0, 0.0, -0.4], 0.4), ([0.0, 0.0, 1.0], 1.0)):
        assert radiance(SphereLight(center, radius), wo, s, 500.0) == everywhere
    almost = radiance(SphereLight([0.0, 0.0, 1.0], 1.0 - 1e-9), wo, s, 500.0)
    np.testing.assert_allclose(almost, everywhere, rtol=1e-4)
    # a wide ceiling, and the same with a corner below the horizon
    ceiling = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * 1e6 + UP
    np.testing.assert_allclose(radiance(PolygonLight(ceiling), wo, s, 500.0), everywhere, rtol=1e-4)
    # a wall, seen from its foot: half of everything, from either side
    wall = np.array([[1e-6, -1e6, -1e6], [1e-6, 1e6, -1e6], [1e-6, 1e6, 1e6], [1e-6, -1e6, 1e6]])
    across = Scratch(2.0, 0.9, 0.0)
    total = radiance(SphereLight([0, 0, 0], 1.0), wo, across, 500.0)
    sides = [radiance(PolygonLight(wall * [sign, 1, 1]), wo, across, 500.0) for sign in (1.0, -1.0)]
    np.testing.assert_allclose(sum(sides), total, rtol=1e-3)
    assert sides[0] < 1e-6 * total < sides[1]


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
def test_sizes_from_atoms_to_stars(scale):
    s, wo = Scratch(azimuth=0.2), unit([-0.2, 0.2, 1.0])
    reference = radiance(SphereLight([0.2, 0.3, 1.0], 0.05), wo, s, 500.0)
    value = radiance(SphereLight(scale * np.array([0.2, 0.3, 1.0]), scale * 0.05), wo, s, 500.0)
    np.testing.assert_allclose(value, reference, rtol=1e-9)
    corners = scale * np.array([[0.1, 0.1, 1.0], [0.4, 0.1, 1.0], [0.2, 0.5, 1.1]])
    expected = radiance(PolygonLight(corners / scale), wo, s, 500.0)
    np.testing.assert_allclose(radiance(PolygonLight(corners), wo, s, 500.0), expected, rtol=1e-9)


def test_corners_and_edges_exactly_on_the_line():
    s, wo = Scratch(2.0, 0.9), unit([0.0, 0.2, 1.0])  # the line xi_1 = 0 is x = 0
    cases = {
        "corner": [[0, 0.1, 1], [0.3, 0.2, 1], [0.3, -0.4, 1]],
        "two corners": [[0, -0.3, 1], [0.3, 0.1, 1], [0, 0.4, 1], [-0.2, 0.1, 1]],
        "edge": [[0, -0.3, 1], [0, 0.4, 1], [0.3, 0.1, 1]],
        "edge of a concave one": [[0, -0.3, 1], [0, 0.4, 1], [-0.3, 0.6, 1], [0.3, 0.6, 1], [0.3, -0.5, 1]],
        "corner on the horizon": [[0, -0.3, 0], [0, 0.4, 1], [0.3, 0.1, 1]],
    }
    for name, corners in cases.items():
        light = PolygonLight(np.array(corners, float))
        exact = radiance(light, wo, s, 500.0, method="quadrature")
        np.testing.assert_allclose(radiance(light, wo, s, 500.0), exact, rtol=1e-2, err_msg=name)
        np.testing.assert_allclose(radiance(light, wo, s, 500.0, slices=40), exact, rtol=1e-6, err_msg=name)
        # odd rules put a node right on it
        for nodes in (1, 3):
            assert 0.0 < radiance(light, wo, s, 500.0, slices=nodes) < 3.0 * exact
    # halves on both sides of an edge on the line are the whole
    left, right = (np.array([[0, -0.3, 1], [0, 0.4, 1], [x, 0.5, 1], [x, -0.2, 1]], float) for x in (-0.3, 0.3))
    whole = np.array([[-0.3, -0.2, 1], [0, -0.3, 1], [0.3, -0.2, 1], [0.3, 0.5, 1], [0, 0.4, 1], [-0.3, 0.5, 1]])
    parts = [radiance(PolygonLight(p), wo, s, 500.0) for p in (left, right)]
    np.testing.assert_allclose(sum(parts), radiance(PolygonLight(whole), wo, s, 500.0), rtol=1e-2)


def test_lights_along_the_scratch():
    # the axis itself in the light: rho -> 0, |u| -> 1
    s = Scratch(2.0, 0.9)
    for light in (SphereLight([1.0, 0.0, 0.02], 0.1), SphereLight([1.0, 0.0, 0.0], 0.3), SphereLight([1, 0, -0.2], 0.3),
                  PolygonLight([[1.0, -0.3, -0.3], [1.0, 0.3, -0.3], [1.0, 0.2, 0.3]])):  # fmt: skip
        for wo in (unit([-0.99, 0.0, 0.14]), unit([-0.999, 0.02, 0.02]), unit([-0.97, 0.1, 0.2])):
            exact = radiance(light, wo, s, 500.0, method="quadrature")
            np.testing.assert_allclose(radiance(light, wo, s, 500.0, slices=64), exact, rtol=1e-5, atol=1e-13)
            np.testing.assert_allclose(radiance(light, wo, s, 500.0), exact, rtol=2e-2, atol=1e-12)


def test_slivers_and_disks():
    s, wo = Scratch(2.0, 0.9, 0.1), unit([-0.1, 0.2, 1.0])
    for height in (1e-2, 1e-4, 1e-7):
        sliver = PolygonLight([[-0.5, 0.1, 1.0], [0.6, 0.1 + height, 1.0], [0.6, 0.1, 1.0]])
        exact = radiance(sliver, wo, s, 500.0, method="quadrature")
        assert exact > 0.0
        np.testing.assert_allclose(radiance(sliver, wo, s, 500.0, slices=32), exact, rtol=1e-5)
    angle = 2.0 * np.pi * np.arange(128) / 128
    disk = 0.1 * np.stack((np.cos(angle), np.sin(angle), 0.0 * angle), axis=-1) + UP
    sphere = radiance(SphereLight(UP, np.sin(np.arctan(0.1))), wo, s, 500.0)
    np.testing.assert_allclose(radiance(PolygonLight(disk), wo, s, 500.0), sphere, rtol=2e-3)  # area: 4e-4


def test_random_input_never_fails():
    s, wavelength = scratches(2000, 13)
    rng = np.random.default_rng(14)
    wo = unit(rng.normal(size=(2000, 3)))
    scale = 10.0 ** rng.uniform(-6, 3, (2000, 1))
    ball = SphereLight(rng.normal(size=(2000, 3)), 10.0 ** rng.uniform(-6, 1, 2000))
    corners = rng.normal(size=(2000, 1, 3)) + scale[:, None] * rng.normal(size=(2000, 5, 3))
    for light in (ball, PolygonLight(corners[:, :3])):
        for phase in ("small-angle", "angle-dependent"):
            value = radiance(light, wo, s, wavelength, phase)
            assert np.all(np.isfinite(value)) and np.all(value >= 0.0) and np.all(value[wo[:, 2] <= 0.0] == 0.0)
            assert value.max() <= 4.0 * 6.0 / (np.sqrt(np.pi) * 60.0) * 1.01  # |D|^2 and the whole lobe
