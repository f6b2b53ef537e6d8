"""Seen and lit shares of facets against rays cast by NumPy, closed forms and the sum rule."""

import numpy as np
import pytest

from scratchwarp import grooves

V = [[0, 0], [0.5, -0.5], [1, 0]]
BOX = [[0, 0], [0, -0.7], [1, -0.7], [1, 0]]
DOVETAIL = [[0, 0], [0.3, 0], [0.1, -0.6], [0.9, -0.5], [0.7, 0], [1, 0]]
RIM = [[0, 0], [0.1, 0.2], [0.2, 0.25], [0.5, -0.6], [0.8, 0.15], [0.9, 0.1], [1, 0]]
RIDGE = [[0, 0], [0.3, 0.9], [0.35, 0.9], [0.5, 0.2], [0.7, 0.5], [1, 0]]
MUSHROOM = [[0, 0], [0.4, 0], [0.4, 0.3], [0.2, 0.35], [0.5, 0.8], [0.85, 0.4], [0.6, 0.3], [0.6, -0.2], [1, 0]]
CAVE = [[0, 0], [-0.1, -0.3], [0.5, -0.6], [0.8, 0]]
SECTIONS = {"v": V, "box": BOX, "dovetail": DOVETAIL, "rim": RIM, "ridge": RIDGE, "mushroom": MUSHROOM, "cave": CAVE}
ANGLES = np.radians([-85.0, -61.3, -30.0, 0.0, 17.0, 45.5, 72.0, 84.0])


def first_hit(a, b, origin, direction, front=False):
    """(facet, parameter along the ray) nearest on each ray from ``origin`` along ``direction``, both [m, 2].

    ``front``: outer sides alone, for the walls between two boxes coincide.
    """
    e = b - a
    cross = direction[:, None, 0] * e[:, 1] - direction[:, None, 1] * e[:, 0]
    rel = a - origin[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (rel[..., 0] * e[:, 1] - rel[..., 1] * e[:, 0]) / cross
        u = (rel[..., 0] * direction[:, None, 1] - rel[..., 1] * direction[:, None, 0]) / cross
    t = np.where((u >= 0) & (u <= 1) & (t > 1e-9) & ((cross > 0) | (not front)), t, np.inf)
    return t.argmin(1), t.min(1)


def cast(points, theta_o, theta_i, periodic, count=4000):
    """The shares by rays through ``count`` midpoints of the base line."""
    p = np.asarray(points, float)
    width = p[-1, 0] - p[0, 0]
    copies = 13 if periodic else 0
    line = np.concatenate(
        [p[:-1] + [k * width, 0] for k in range(-copies, copies + 1)] + [p[-1:] + [copies * width, 0]]
    )
    if not periodic:
        line = np.concatenate([[[-50, 0]], line, [[51, 0]]])
    base = p[0, 0] + width * (np.arange(count) + 0.5) / count
    d_o = np.array([np.sin(theta_o), np.cos(theta_o)])
    start = np.stack([base, np.zeros(count)], 1) + d_o / d_o[1]  # from z = 1, above everything
    facet, t = first_hit(line[:-1], line[1:], start, np.broadcast_to(-d_o, start.shape), True)
    alive = np.isfinite(t)
    if theta_i is not None:
        d_i = np.array([np.sin(theta_i), np.cos(theta_i)])
        e = line[facet + 1] - line[facet]
        normal = np.stack([-e[:, 1], e[:, 0]], 1)
        point = start - np.where(alive, t, 0)[:, None] * d_o + 1e-9 * normal
        _, blocked = first_hit(line[:-1], line[1:], point, np.broadcast_to(d_i, point.shape))
        alive &= np.isinf(blocked) & (normal @ d_i > 0)
    own = (facet % (len(p) - 1)) if periodic else facet - 1
    return np.array([np.mean(alive & (own == j)) for j in range(len(p) - 1)])


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("name", SECTIONS)
def test_rays_see_the_same(name, periodic):
    """Midpoint rays miss an interval's end by up to half of 1 / 4000: up to 6 ends a facet."""
    points = SECTIONS[name]
    angles = ANGLES[1::3] if periodic else ANGLES[::2]
    for theta_o in angles:
        np.testing.assert_allclose(
            grooves.visibility(points, theta_o, periodic=periodic), cast(points, theta_o, None, periodic), atol=7.5e-4
        )
        got = grooves.visibility(points, theta_o, angles, periodic=periodic)
        for row, theta_i in zip(got, angles, strict=True):
            np.testing.assert_allclose(row, cast(points, theta_o, theta_i, periodic), atol=7.5e-4, err_msg=f"{theta_i}")


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("name", SECTIONS)
def test_shares_sum_to_one(name, periodic):
    angles = np.concatenate([np.linspace(-np.pi / 2, np.pi / 2, 181), [1.5707, -1.5707]])
    seen = grooves.visibility(SECTIONS[name], angles, periodic=periodic)
    assert np.all(seen >= 0)
    # At the clipped 90 degrees tan is 1e7: rounding of positions is magnified by as much.
    np.testing.assert_allclose(seen.sum(-1), 1.0, atol=1e-8)


def test_v_in_closed_form():
    """A V of slope 1 seen from theta: the far side takes (1 + tan) / 2, all from 45 degrees on."""
    theta = np.radians([0.0, 10.0, 30.0, 44.0, 46.0, 89.0])
    right = np.minimum((1 + np.tan(theta)) / 2, 1)
    expected = np.stack([right, 1 - right], -1)  # the left facet faces right
    np.testing.assert_allclose(grooves.visibility(V, theta, periodic=False), expected, atol=1e-12)
    np.testing.assert_allclose(grooves.visibility(V, -theta, periodic=False), expected[:, ::-1], atol=1e-12)


def test_box_is_seen_and_lit_where_both_reach():
    """The floor: the shadow covers d tan(i) from one side, the wall hides d tan(o) from the same or the other one."""
    o, i = np.radians(25.0), np.radians(40.0)
    hidden, dark = 0.7 * np.tan(o), 0.7 * np.tan(i)
    same = grooves.visibility(BOX, o, i)
    other = grooves.visibility(BOX, o, -i)
    np.testing.assert_allclose(same[1], 1 - max(hidden, dark), atol=1e-12)
    np.testing.assert_allclose(other[1], 1 - hidden - dark, atol=1e-12)


def test_light_and_view_change_places():
    """A facet's seen and lit area is that of the swapped directions; only the projection onto the base line differs."""
    o, i = np.radians([20.0, -50.0, 70.0]), np.radians([-35.0, -60.0, 40.0])
    for points in SECTIONS.values():
        edge = np.diff(np.asarray(points, float), axis=0)

        def spread(theta, edge=edge):
            return edge[:, 0] - edge[:, 1] * np.tan(theta)[:, None]

        for periodic in (True, False):
            if not periodic and np.asarray(points)[:, 1].max() > 0:
                continue  # what lies above the plane may project beyond the base line's ends
            there = grooves.visibility(points, o, i, periodic=periodic) * spread(i)
            back = grooves.visibility(points, i, o, periodic=periodic) * spread(o)
            np.testing.assert_allclose(there, back, atol=1e-12)


def test_doubled_vertices_and_flat_ground():
    seen = grooves.visibility([[0, 0], [0, 0], [1, 0], [1, 0], [2, -1], [2, -1], [3, 0]], 0.3)
    assert seen[0] == seen[2] == seen[4] == 0
    np.testing.assert_allclose(seen[[1, 3, 5]].sum(), 1)
    np.testing.assert_allclose(seen[1], 1 / 3)


@pytest.mark.parametrize(
    ("points", "word"),
    [
        ([[0, 0]], "shape"),
        ([[1, 0], [0, 0]], "left to right"),
        ([[0, np.nan], [1, 0]], "points"),
    ],
)
def test_senseless_points(points, word):
    with pytest.raises(ValueError, match=word):
        grooves.visibility(points, 0.0)
    with pytest.raises(ValueError, match="theta_o"):
        grooves.visibility(V, 1.6)
