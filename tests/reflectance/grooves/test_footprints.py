"""Footprint means against marched true geometry, closed forms, and the invariances that any correct answer has."""

import numpy as np
import pytest

from scratchwarp import grooves, optics

from . import true_geometry as true

V = [[-0.5, 0], [0, -0.5], [0.5, 0]]
RIDGE = [[-0.4, 0], [0.1, 0.4], [0.4, 0]]
RIM = [[-0.5, 0], [-0.35, 0.15], [-0.2, -0.3], [0.3, -0.4], [0.4, 0.1], [0.5, 0]]
DOVETAIL = [[-0.3, 0], [-0.5, -0.4], [0.5, -0.4], [0.3, 0]]
FAR = 40.0
SIXTY = np.array([0.5, np.sqrt(0.75)]) * FAR
X90 = [[[-FAR, 0], [FAR, 0]], [[0, -FAR], [0, FAR]]]
X60 = [X90[0], [-SIXTY, SIXTY]]
END = [[[-FAR, 0], [0, 0]]]
CORNER = [[[-FAR, 0], [0, 0], SIXTY]]
FLAT = [[-0.5, 0.0], [-0.3, -0.4], [0.3, -0.4], [0.5, 0.0]]
ARC = np.linspace(-0.5, 0.5, 33)
ROUND = np.stack([ARC, -np.sqrt(np.maximum(0.25 - ARC**2, 0.0))], 1)  # 32 facets, which lie in boxes
STAR = [*X60, [[-SIXTY[0], SIXTY[1]], [SIXTY[0], -SIXTY[1]]]]
GEOMETRIES = {
    "parallel": (X90[:1], V, "cap"),
    "crossing 90": (X90, V, "cap"),
    "crossing 60": (X60, V, "cap"),
    "ridges": (X60, RIDGE, "cap"),
    "rims": (X60, RIM, "cap"),
    "end": (END, V, "cap"),
    "mitred end": (END, V, "mitre"),
    "corner": (CORNER, V, "cap"),
    "three": (STAR, V, "cap"),
    "three rims": (STAR, RIM, "cap"),
    "flat end": (END, FLAT, "cap"),
    "round": (X60, ROUND, "cap"),
}


def towards(theta, phi):
    theta, phi = np.radians([theta, phi])
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def ellipse(long, short, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([long * c, long * s]), np.array([-short * s, short * c])


def scenes(count, seed=3, most=80.0):
    """Random footprints near the origin and directions within ``most`` degrees of the normal."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        o, i = (towards(rng.uniform(0, most), rng.uniform(0, 360)) for _ in range(2))
        yield rng.uniform(-0.3, 0.3, 2), *ellipse(*rng.uniform(0.2, 0.9, 2), rng.uniform(0, np.pi)), o, i


def height_of(paths, profile, ends):
    f = true.section(profile)
    parts = [true.straight(*p, f, ends) if len(p) == 2 else true.corner(*p, f) for p in paths]
    return true.together(*parts)


@pytest.mark.parametrize("name", GEOMETRIES)
def test_true_geometry_shows_the_same(name):
    """Relative RMSE below 0.5 %. Measured: 0.02 to 0.15 % with 20,000 rays; 4,000 rays err by some 0.2 % themselves."""
    paths, profile, ends = GEOMETRIES[name]
    g = grooves.Pattern(paths, profile, ends)
    height, z = height_of(paths, profile, ends), np.asarray(profile)[:, 1]
    got, expected = [], []
    for scene in scenes(3):
        for value, reflectance in ((true.diffuse, grooves.Diffuse(1.0)), (true.ggx(0.4), grooves.GGX(0.4))):
            expected.append(true.mean_radiance(height, min(z.min(), 0), max(z.max(), 1e-3), *scene, value, 4000))
            got.append(grooves.radiance(g, *scene, reflectance))
            if name not in ("parallel", "crossing 60"):
                break
    error = np.array(got) - expected
    assert np.sqrt(np.mean(error**2)) < 0.005 * np.sqrt(np.mean(np.square(expected)))


def stacked(count, seed=3, most=80.0):
    return [np.array(x) for x in zip(*scenes(count, seed, most), strict=True)]


def test_flat_ground_without_grooves():
    scene = stacked(5)
    for g in (
        grooves.Pattern([], []),
        grooves.Pattern(X60, [[-0.5, 0], [0.5, 0]]),
        grooves.Pattern([[[5, 5], [6, 6]]], V),
    ):
        np.testing.assert_allclose(
            grooves.radiance(g, *scene, grooves.Diffuse([0.5, 1, 0])), scene[4][:, 2:] / np.pi * [0.5, 1, 0], atol=1e-12
        )


def test_parallel_grooves_are_the_sum_of_visible_shares():
    """A footprint far wider than the period, across the grooves alone, against ``visibility`` of one period.

    The ellipse is narrow along the grooves; its chord ends are cut at 200 periods, so that cut periods weigh 1 %.
    """
    section = np.array([[0, 0], [0.2, -0.3], [0.5, -0.1], [0.6, -0.4], [1, 0]])
    g = grooves.Pattern([[[k, -FAR], [k, FAR]] for k in range(-105, 106)], [[-x, z] for x, z in section[::-1]])
    theta_o, theta_i = np.radians([10.0, -40.0, 65.0]), np.radians([-30.0, 35.0, 50.0])
    o, i = (np.stack([np.sin(t), 0 * t, np.cos(t)], -1) for t in (theta_o, theta_i))
    share = grooves.visibility(section, theta_o, theta_i, periodic=True)
    edge = np.diff(section, axis=0)
    normal = np.stack([-edge[:, 1], edge[:, 0]], 1) / np.linalg.norm(edge, axis=1, keepdims=True)
    expected = np.sum(share * np.maximum(normal @ i[:, [0, 2]].T, 0).T / np.pi, 1)
    got = grooves.radiance(g, [0, 0], [100, 0], [0, 0.1], o, i, grooves.Diffuse(1.0))
    np.testing.assert_allclose(got, expected, rtol=2e-3)


def test_chord_of_the_ellipse():
    """A deep slot hides its floor from a low light: the mean is what the exact chord leaves of the ground."""
    slot = [[-0.2, 0], [-0.2, -50], [0.2, -50], [0.2, 0]]
    g = grooves.Pattern(X90[1:], slot)
    o, i = towards(0, 0), towards(60, 0)
    q = 0.2 / 0.7
    hidden = 2 * (np.arcsin(q) + q * np.sqrt(1 - q * q)) / np.pi
    for axes in (([0.7, 0], [0, 0.3]), (*ellipse(0.7, 0.7, 0.3),)):
        got = grooves.radiance(g, [0, 0], *axes, o, i, grooves.Diffuse(1.0))
        np.testing.assert_allclose(got, (1 - hidden) * 0.5 / np.pi, rtol=1e-9)
    axis = grooves.radiance(g, [0, 0], [0.7, 0], [0, 0.3], o, i, grooves.Diffuse(1.0), chord="axis")
    np.testing.assert_allclose(axis, (1 - q) * 0.5 / np.pi, rtol=1e-9)


@pytest.mark.parametrize("name", [*GEOMETRIES, "dovetails"])
def test_turning_everything_changes_nothing(name):
    paths, profile, ends = GEOMETRIES.get(name, (X60, DOVETAIL, "cap"))
    turn = 0.7
    m = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    m3 = np.block([[m, np.zeros((2, 1))], [np.zeros((1, 2)), np.ones((1, 1))]])
    center, a1, a2, o, i = stacked(6)
    before = grooves.radiance(grooves.Pattern(paths, profile, ends), center, a1, a2, o, i, grooves.GGX(0.5))
    turned = grooves.Pattern([np.asarray(p) @ m.T for p in paths], profile, ends)
    after = grooves.radiance(turned, center @ m.T, a1 @ m.T, a2 @ m.T, o @ m3.T, i @ m3.T, grooves.GGX(0.5))
    np.testing.assert_allclose(after, before, rtol=1e-6)


def test_order_and_splitting_change_nothing():
    scene = stacked(6)
    for profile in (V, RIM, DOVETAIL):
        whole = grooves.radiance(grooves.Pattern(STAR, profile), *scene, grooves.Diffuse(1.0))
        other = grooves.radiance(grooves.Pattern(STAR[::-1], profile), *scene, grooves.Diffuse(1.0))
        split = [[[-FAR, 0], [-0.1, 0], [-0.1, 0], [FAR, 0]], *STAR[1:]]
        pieces = [[[-FAR, 0], [0.1, 0]], *STAR[1:], [[0.1, 0], [FAR, 0]]]
        # Lines over the footprint may run another way when the order changes.
        np.testing.assert_allclose(other, whole, rtol=2e-3)
        for paths in (split, pieces):
            again = grooves.radiance(grooves.Pattern(paths, profile), *scene, grooves.Diffuse(1.0))
            np.testing.assert_allclose(again, whole, rtol=2e-3)


def hard_cases():
    yield "tangent", [[[-FAR, 0], [FAR, 0]], [[-FAR, 1], [FAR, 1]], [[-FAR, 0.5], [FAR, 0.5]]], V, "cap"
    yield "same twice", [X90[0], X90[0]], V, "cap"
    yield "nearly the same", [X90[0], [[-FAR, 1e-9], [FAR, -1e-9]]], V, "cap"
    yield "three in one point", STAR, RIM, "mitre"
    yield "zero length", [[[0, 0], [0, 0]], [[-FAR, 0], [0, 0], [0, 0], [FAR, 0]]], V, "mitre"
    yield "crosses itself", [[[-2, 0], [2, 0], [0, 2], [0, -2]]], V, "mitre"
    yield "turns back", [[[-2, 0], [1, 0], [-2, 0]]], V, "cap"
    yield "loop", [[[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]], RIM, "cap"
    yield "tight arc", [[[0.2 * np.cos(a), 0.2 * np.sin(a)] for a in np.linspace(0, 3, 13)]], V, "mitre"
    yield "overhangs", X60, DOVETAIL, "mitre"
    yield "lopsided end", END, [[-0.2, 0], [0.4, -0.5], [0.7, 0]], "mitre"


@pytest.mark.parametrize(
    ("name", "paths", "profile", "ends"), hard_cases(), ids=lambda v: v if isinstance(v, str) else ""
)
def test_hard_cases_lose_nothing_and_are_continuous(name, paths, profile, ends):
    """Finite; a white furnace loses no ray (``found``); moved by 1e-6 the answer moves by as little."""
    g = grooves.Pattern(paths, profile, ends)
    center, a1, a2, o, i = stacked(8, most=89.0)
    center[0], a1[1], a2[1], a2[2] = 0.0, 0.0, 0.0, 0.0  # on the vertex, a point, a line
    a1[3], a2[3] = [1e-4, 0], [0, 1e-4]
    o[4], i[4] = towards(89.9, 0), towards(89.9, 180)  # grazing, along the first groove
    o[5], i[6] = towards(0, 0), towards(0, 0)
    got, found = grooves.footprint.means(g, center, a1, a2, o, i, grooves.Diffuse(1.0))
    np.testing.assert_allclose(found, 1.0, atol=1e-6)
    assert np.all(np.isfinite(got)) and np.all(got >= 0) and np.all(got <= 1 / np.pi + 1e-12)
    steady = np.array([k not in (1, 2, 3, 4) for k in range(8)])  # points may step over an edge, grazing light leaps
    moved = grooves.radiance(g, center + [1e-6, -1e-6], a1, a2, o, i, grooves.Diffuse(1.0))
    np.testing.assert_allclose(moved[steady], got[..., 0][steady], atol=2e-4)


def test_directions_below_the_plane():
    g = grooves.Pattern(X60, V)
    scene = ([0, 0], [0.5, 0], [0, 0.5])
    assert grooves.radiance(g, *scene, towards(120, 0), towards(10, 0), grooves.Diffuse(1.0)) == 0
    assert grooves.radiance(g, *scene, towards(10, 0), towards(120, 0), grooves.Diffuse(1.0)) == 0


def test_mirrors_see_a_light_of_the_suns_size():
    """From 30 to 30 degrees the ground reflects alone. Gold, one colour a channel."""
    gold = optics.Conductor((0.14, 0.37, 1.44), (4.4, 2.77, 1.95))
    g = grooves.Pattern(X90[1:], V)
    got = grooves.radiance(g, [0, 0], [1, 0], [0, 0.3], towards(30, 0), towards(30, 180), gold)
    disc = np.pi * np.sin(grooves.facet.SUN) ** 2
    ground = 1 - 2 * (np.arcsin(0.5) + 0.5 * np.sqrt(0.75)) / np.pi
    np.testing.assert_allclose(got, ground * gold.reflectance(np.cos(np.radians(30))) / disc, rtol=1e-5)
    rough = grooves.radiance(g, [0, 0], [1, 0], [0, 0.3], towards(30, 0), towards(30, 180), grooves.GGX(0.1, gold))
    assert rough.shape == (3,) and np.all(rough > 0)


def test_each_groove_may_have_its_own_material():
    """Shares of two crossing grooves and the ground, told apart by colour, add up to the whole."""
    red, green, blue = (grooves.Diffuse(np.eye(3)[k]) for k in range(3))
    g = grooves.Pattern([[[1, 1], [1, 1]], *X60], V)
    scene = stacked(4)
    parts = grooves.radiance(g, *scene, [blue, red, green], ground=blue)
    np.testing.assert_allclose(parts.sum(-1), grooves.radiance(g, *scene, grooves.Diffuse(1.0)), rtol=1e-12)
    assert np.all(parts >= 0) and np.all(parts.max(0) > 0)
    with pytest.raises(ValueError, match="ground"):
        grooves.radiance(g, *scene, [blue, red, green])
    with pytest.raises(ValueError, match="reflectance"):
        grooves.radiance(g, *scene, [blue, red], ground=blue)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: grooves.Pattern([[[0, 0], [1, 0]]], V, "round"), "ends"),
        (lambda: grooves.Pattern([[[0, 0], [1, 0]]], [V, V]), "profiles"),
        (lambda: grooves.Pattern([[0, 0]], V), r"paths\[0\]"),
        (lambda: grooves.Pattern([[[0, 0], [1, np.nan]]], V), r"paths\[0\]"),
        (lambda: grooves.Pattern([[[0, 0], [1, 0]]], [[[1, 0], [0, 0]]]), r"profiles\[0\]"),
        (lambda: grooves.Diffuse(1.5), "albedo"),
        (lambda: grooves.GGX(0.0), "alpha"),
    ],
)
def test_senseless_input(call, word):
    with pytest.raises(ValueError, match=word):
        call()
