"""Single paths: closed forms of the V groove and the semicircle, a float64 tracer, and the cases where a naive tracer
fails."""

import numpy as np
import pytest

from scratchwarp import profiles

UNDERCUT = np.array([[0, 0], [0.3, 0.0], [0.1, -0.4], [0.9, -0.4], [0.7, 0.0], [1, 0]])
# between plateaus, since the brute-force tracer cannot tell the two faces of a wall without thickness apart
STEPS = np.array(
    [
        [0, 0],
        [0.02, 0],
        [0.02, -0.3],
        [0.4, -0.3],
        [0.4, -0.7],
        [0.6, -0.7],
        [0.6, -0.2],
        [0.97, -0.2],
        [0.97, 0],
        [1, 0],
    ]
)


def rough(seed, count=40, bulge=0.0):
    """A random height field of ``count`` facets."""
    rng = np.random.default_rng(seed)
    x = np.linspace(0, 1, count + 1)
    z = -0.4 * np.sin(np.pi * x) ** 2 + rng.normal(0, 0.02, count + 1) + bulge * np.cos(6 * np.pi * x)
    z[[0, -1]] = bulge
    return np.stack((x, z), axis=1)


def v_groove_paths(alpha, phi_i):
    """(phi_o, weight) of every path in a V groove of facet slope alpha, by unfolding: images of the wedge are turned
    by psi = pi - 2 alpha.

    Rays that meet the left facet first; those that meet the right one are their mirror images under phi -> -phi.
    """
    found = []
    psi = np.pi - 2 * alpha
    for mirror in (1, -1):
        phi = mirror * phi_i
        count = int(np.ceil(np.pi / psi)) + 2
        sigma = [np.sin(phi + (j + 0.5) * psi) if phi + (j + 0.5) * psi < np.pi else 0.0 for j in range(count)]
        low, high = max(0.0, np.sin(phi - psi / 2)), max(sigma[0], 0.0)
        edges = [high]
        for k in range(1, count):
            upper, lower = min(edges[-1], high), min(max(sigma[k], low, 0.0), edges[-1])
            edges.append(lower)
            if upper > lower:
                exit_angle = 2 * k * alpha - phi if k % 2 else phi - 2 * k * alpha + np.pi
                exit_angle = (exit_angle + np.pi) % (2 * np.pi) - np.pi
                found.append((mirror * exit_angle, (upper - lower) / (2 * np.sin(psi / 2) * np.cos(phi)), k))
    return found


@pytest.mark.parametrize("degrees", [5, 20, 33, 45, 52, 65, 78])
def test_v_groove_matches_unfolding(degrees):
    """Every exit angle within 1e-5 rad and its share of rays within 2 / N."""
    alpha = np.radians(degrees)
    profile = profiles.shape("vGroove", depth=0.5 * np.tan(alpha))
    count = 20000
    x = (np.arange(count) + 0.5) / count
    for phi_i in np.radians([-80.3, -41.7, -12.1, 0.4, 28.3, 61.9, 84.7]):
        rays = profiles.trace(profile, phi_i, x)
        expected = v_groove_paths(alpha, phi_i)
        assert sum(weight for _, weight, _ in expected) == pytest.approx(1.0, abs=1e-9)
        for angle, _, bounces in expected:
            # two paths may leave together; both then count
            together = sum(w for a, w, k in expected if abs(a - angle) < 1e-9 and k == bounces)
            found = np.mean((np.abs(rays.phi_o - angle) < 1e-5) & (rays.bounces == bounces))
            # a boundary on either side of the rays of one path, each within one ray
            assert found == pytest.approx(together, abs=2.0 / count), (degrees, phi_i, angle)


def test_semicircle_matches_its_closed_form():
    """Exit angle and cosine of rays into half a circle: K = ceil((eta - phi + pi/2) / (pi - 2 eta)) equal
    reflections."""
    profile = profiles.shape("round", depth=0.5, segments=256)
    rng = np.random.default_rng(1)
    phi, u = rng.uniform(-1.4, 1.4, 20000), rng.uniform(-1, 1, 20000)
    eta = np.arcsin(u * np.cos(phi))
    swap = np.where(eta < 0, -1.0, 1.0)
    eta, turned = np.abs(eta), phi * swap
    quotient = (eta - turned + np.pi / 2) / (np.pi - 2 * eta)
    count = np.ceil(quotient)
    exit_angle = swap * ((np.pi + turned - count * (np.pi + 2 * eta) + np.pi) % (2 * np.pi) - np.pi)
    rays = profiles.trace(profile, phi, 0.5 + 0.5 * u)
    same = rays.bounces == count
    # arcs differ from the circle by h^4 or so, which moves the place where one more reflection begins
    assert same.mean() > 0.9995
    few = same & (count <= 6)
    # quadratic arcs over 0.7 degrees have normals within (h / 2)^3 / 6 = 4e-8 rad of the circle's; float32 adds 1e-7
    # rad
    # a reflection, and distances near the rim are known to 1e-7 / cos(eta)
    error = np.abs(rays.phi_o - exit_angle)[few] * np.cos(eta[few])
    assert error.max() < 2e-5
    np.testing.assert_allclose(np.abs(rays.cosines[few, 0]), np.cos(eta[few]), atol=2e-5)


CASES = {
    "undercut": (UNDERCUT, False),
    "undercut alone": (UNDERCUT, True),
    "undercut, bulging": (UNDERCUT + [[0, 0], [0, 0.1], [0, 0], [0, 0], [0, 0.05], [0, 0]], False),
    "vertical walls": (STEPS, False),
    "rough": (rough(1), False),
    "bulging": (rough(2, bulge=0.1), False),
    "bulging alone": (rough(2, bulge=0.1), True),
    "box": (np.array([[0, 0], [0.1, 0], [0.1, -1.0], [0.9, -1.0], [0.9, 0], [1, 0]]), False),
    "ends of different height": (rough(8) + np.linspace([0, 0], [0, 0.25], 41), False),
    "ends of different height, undercut": (UNDERCUT + [[0, -0.2], [0, 0], [0, 0], [0, 0], [0, 0], [0, 0.1]], False),
    "sunk, alone": (rough(3) - (0, 0.1), True),
}


@pytest.mark.parametrize("name", CASES)
def test_paths_agree_with_float64_brute_force(brute_force, name):
    """float32 paths leave where float64 paths of an unrelated tracer leave, except where rounding picks another
    facet."""
    points, isolated = CASES[name]
    rng = np.random.default_rng(5)
    x, phi = rng.random(4000), rng.uniform(-1.5, 1.5, 4000)
    truth, bounces, _ = brute_force.trace(points, phi, x, isolated=isolated)
    rays = profiles.trace(profiles.Profile(points, isolated), phi, x)
    assert np.all(rays.bounces >= 1)
    same = rays.bounces == bounces
    close = same & (np.abs(rays.phi_o - truth) < 1e-5)
    # a path may take the other side of a vertex when it passes within 1e-7 of it: 8 facets an end, a few bounces
    assert close.mean() > 0.998
    assert same.mean() > 0.998


@pytest.mark.parametrize("seed", range(12))
def test_random_outlines_agree_with_brute_force(brute_force, seed):
    """Spiky, walled, tilted and shallow outlines, alone and repeated: nothing is lost that float64 does not follow
    for long."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 20))
    x = np.concatenate(([0.0], np.sort(rng.random(count)), [1.0]))
    if seed % 3 == 0:
        x = np.repeat(x, 2)[1:-1]
    points = np.stack((x, rng.normal(0.0, (0.01, 0.1, 0.5)[seed % 3], len(x))), axis=1)
    entry, phi = rng.random(1000), rng.uniform(-1.5, 1.5, 1000)
    alone = seed % 2 == 0
    truth, bounces, _ = brute_force.trace(points, phi, entry, isolated=alone, periods=20, max_bounces=200)
    rays = profiles.trace(profiles.Profile(points, alone), phi, entry)
    followed = bounces > 0
    assert followed.mean() > 0.98
    agree = (rays.bounces == bounces) & (np.abs(rays.phi_o - truth) < 1e-4)
    assert agree[followed].mean() > 0.995
    assert np.all(rays.bounces[followed] > 0)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_size_does_not_matter(scale):
    """Profiles are scaled before float32 sees them: the same bits at any size (powers of ten round differently:
    1e-6)."""
    x, phi = np.linspace(0.01, 0.99, 500), np.linspace(-1.4, 1.4, 500)
    here = profiles.trace(profiles.Profile(rough(4)), phi, x)
    there = profiles.trace(profiles.Profile(rough(4) * scale + (7.0 * scale, -3.0 * scale)), phi, x)
    close = np.abs(here.phi_o - there.phi_o) < 1e-5
    assert close.mean() > 0.99


def test_duplicated_points_change_nothing():
    """A facet of no length has no normal (0 / 0) and is dropped."""
    points = rough(6)
    doubled = np.repeat(points, 2, axis=0)
    x, phi = np.linspace(0.01, 0.99, 500), np.linspace(-1.4, 1.4, 500)
    np.testing.assert_array_equal(
        profiles.trace(profiles.Profile(points), phi, x).phi_o, profiles.trace(profiles.Profile(doubled), phi, x).phi_o
    )


def test_rays_through_vertices_are_kept():
    """Rays aimed exactly at the vertices, and straight down walls, hit one facet or the other: none falls through."""
    for points in (STEPS, UNDERCUT, rough(7)):
        profile = profiles.Profile(points)
        rays = profiles.trace(profile, 0.0, points[:, 0])
        assert np.all(rays.bounces >= 1)
        for corner in points:
            phi = np.arctan(np.linspace(-3, 3, 61))
            x = corner[0] - np.tan(phi) * corner[1]
            inside = (x > 0) & (x < 1)
            assert np.all(profiles.trace(profile, phi[inside], x[inside]).bounces >= 1)


def test_whispering_gallery_is_followed():
    """Along the wall of a semicircle light needs about pi / (pi - 2 eta) reflections: hundreds, none lost, each at
    the same cosine."""
    profile = profiles.shape("round", depth=0.5)
    eta = np.pi / 2 - np.array([0.05, 0.02, 0.008, 0.004])
    rays = profiles.trace(profile, 0.0, 0.5 + 0.5 * np.sin(eta))
    expected = np.ceil((eta + np.pi / 2) / (np.pi - 2 * eta))
    # the cosine is known to float32's error of the entry point over it, 6e-8 / 0.004
    assert np.abs(rays.bounces - expected).max() <= 1 + 0.01 * expected.max()
    met = np.abs(rays.cosines[-1, : rays.bounces[-1]])
    np.testing.assert_allclose(met, np.cos(eta[-1]), rtol=0.05)
    assert profiles.trace(profile, 0.0, 0.5 + 0.5 * np.sin(eta), max_bounces=10).bounces.tolist() == [-1] * 4


def test_rates_match_finite_differences():
    """The exit angle's rates along the base line and with the incidence, through several curved reflections."""
    profile = profiles.shape("quartic", depth=0.6)
    x, phi = np.linspace(0.2, 0.8, 41), np.full(41, 0.3)
    rays = profiles.trace(profile, phi, x)
    h = 2e-3
    for name, dx, dp in (("rate_x", h, 0.0), ("rate_phi", 0.0, h)):
        after, before = profiles.trace(profile, phi + dp, x + dx), profiles.trace(profile, phi - dp, x - dx)
        smooth = (after.bounces == rays.bounces) & (before.bounces == rays.bounces)
        numeric = (after.phi_o - before.phi_o) / (2 * h)
        rate = getattr(rays, name)
        # central differences: third derivative times h^2 / 6, up to 1e3 in x after two reflections; the arcs'
        # curvature jumps by a few percent
        good = np.abs(rate - numeric) < 0.1 * np.abs(numeric) + 0.2
        assert smooth.sum() > 25 and good[smooth].mean() > 0.9, name


def test_arguments_are_checked():
    """Each message names the argument."""
    profile = profiles.shape("flat")
    with pytest.raises(ValueError, match="phi_i"):
        profiles.trace(profile, 2.0, 0.5)
    with pytest.raises(ValueError, match="x must"):
        profiles.trace(profile, 0.0, 1.5)
