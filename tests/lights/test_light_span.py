"""Scratch-cone intervals against rays along the cone."""

import numpy as np
import pytest

from scratchwarp import lights

from .light_cases import ORIGIN, SEEN, UP, cylinder, dome, packed_mesh, rect, sphere

HALF_PI = np.pi / 2
# lights whose interval is exact; the others' outlines contain the light
TIGHT = ("distant", "sun", "sphere", "far_sphere", "rect", "tilted", "sheared", "near_rect", "far_rect")


def frames(count, light, x, seed=0):
    """Random u, n and sin_theta, of cones that pass near the light, at it or anywhere."""
    rng = np.random.default_rng(seed)
    n = rng.normal(size=(count, 3)) + 2 * UP
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    u = np.cross(n, rng.normal(size=(count, 3)))
    u /= np.linalg.norm(u, axis=-1, keepdims=True)
    w = lights.sample(light, x, rng.random((count, 2)))["wi"].astype(float)
    spread = np.where(np.arange(count) % 2, 0.0, 0.3)
    aim = np.clip((w * u).sum(-1) + spread * rng.normal(size=count), -0.999, 0.999)
    return u, n, aim


def along(u, n, sin_theta, phi):
    """Directions of a cone, float64, shape of phi (leading dimension that of u) with 3 at the end."""
    v = np.cross(n, u)
    cosine = np.sqrt(1 - sin_theta**2)[:, None, None]
    across = np.sin(phi)[..., None] * v[:, None] + np.cos(phi)[..., None] * n[:, None]
    return sin_theta[:, None, None] * u[:, None] + cosine * across


@pytest.mark.parametrize("name", SEEN)
def test_nothing_lies_outside(name):
    light, grid = SEEN[name], np.linspace(-HALF_PI, HALF_PI, 1501)
    x = ORIGIN
    u, n, sin_theta = frames(200, light, x)
    lo, hi, ok = lights.span(light, x, u, n, sin_theta)
    assert (lo[ok] <= hi[ok]).all() and (lo[ok] >= -HALF_PI - 1e-6).all() and (hi[ok] <= HALF_PI + 1e-6).all()
    met = lights.hit(light, x, along(u, n, sin_theta, np.broadcast_to(grid, (200, 1501))))["distance"] >= 0
    assert met.any(1).sum() > (20 if name in ("sun", "far_sphere", "far_rect", "far_disk") else 50)
    assert ok[met.any(1)].all()
    outside = met & ~((grid >= lo[:, None] - 1e-6) & (grid <= hi[:, None] + 1e-6) & ok[:, None])
    assert not outside.any()


@pytest.mark.parametrize("name", TIGHT)
def test_both_ends_touch_the_light(name):
    """The light begins within 2e-3 of the interval's width of its ends, tangent cones aside."""
    light = SEEN[name]
    u, n, sin_theta = frames(400, light, ORIGIN, seed=1)
    lo, hi, ok = lights.span(light, ORIGIN, u, n, sin_theta)
    ok &= hi - lo > (1e-3 if name not in ("sun", "far_sphere") else 3e-4)
    assert ok.sum() > 40
    inset = np.concatenate([[0.0], np.geomspace(1e-5, 2e-3, 40)]) * (hi - lo)[ok, None] + 1e-6
    for phi in (lo[ok, None] + inset, hi[ok, None] - inset):
        met = lights.hit(light, ORIGIN, along(u[ok], n[ok], sin_theta[ok], phi))["distance"] >= 0
        assert met.any(1).mean() > 0.99


@pytest.mark.parametrize("name", ["disk", "near_disk", "far_disk", "cylinder", "near_cylinder", "end_on"])
def test_outlines_waste_little(name):
    """Mean share of the intervals that the light fills: what sampling them uniformly wastes."""
    light = SEEN[name]
    u, n, sin_theta = frames(200, light, ORIGIN, seed=2)
    lo, hi, ok = lights.span(light, ORIGIN, u, n, sin_theta)
    aimed = ok & (np.arange(200) % 2 == 1)
    phi = lo[aimed, None] + (hi - lo)[aimed, None] * np.linspace(0, 1, 401)
    met = lights.hit(light, ORIGIN, along(u[aimed], n[aimed], sin_theta[aimed], phi))["distance"] >= 0
    assert met.mean() > (0.4 if name == "end_on" else 0.75)


@pytest.mark.parametrize("radius", [1e-1, 1e-3, 1e-5, 1e-6])
def test_samples_of_small_lights_lie_inside(radius):
    """Down to lights that float32 directions barely resolve, including their rims, where the cone is tangent."""
    center = np.array([0.4, -0.3, 1.0])
    normal = -center / np.linalg.norm(center)
    ex = np.cross(normal, UP)
    ex *= radius / np.linalg.norm(ex)
    shapes = [
        sphere(center=center, radius=radius),
        rect(center=center, ex=ex, ey=np.cross(normal, ex), normal=normal),
        cylinder(center=center, axis=3 * ex, radius=radius),
    ]
    for light in shapes:
        s = lights.sample(light, ORIGIN, np.random.default_rng(3).random((2000, 2)))
        w = s["wi"].astype(float)
        w /= np.linalg.norm(w, axis=-1, keepdims=True)
        rng = np.random.default_rng(4)
        u = np.cross(UP, rng.normal(size=(2000, 3)))
        u /= np.linalg.norm(u, axis=-1, keepdims=True)
        sin_theta = (w * u).sum(-1)
        lo, hi, ok = lights.span(light, ORIGIN, u, UP, sin_theta)
        phi = np.arctan2((w * np.cross(UP, u)).sum(-1), w[:, 2])
        assert ok.mean() > 0.9999
        # phi itself errs by the float32 direction over cos theta
        assert (np.maximum(lo - phi, phi - hi)[ok] < 4e-7 / np.sqrt(1 - sin_theta[ok] ** 2)).all()
        width = (hi - lo)[ok] * np.sqrt(1 - sin_theta[ok] ** 2)
        assert width.max() < 2.2 * 4 * radius + 4e-6


def test_horizon():
    u = np.array([1.0, 0.0, 0.0])
    below, half, above = (sphere(center=(0.1, z, z2), radius=0.5) for z, z2 in ((2.0, -0.51), (2.0, 0.0), (2.0, 0.6)))
    assert not lights.span(below, ORIGIN, u, UP, 0.0)[2]
    lo, hi, ok = lights.span(half, ORIGIN, u, UP, 0.0)
    assert ok and hi == pytest.approx(HALF_PI, abs=1e-6) and 0 < lo < hi
    lo, hi, ok = lights.span(above, ORIGIN, u, UP, 0.0)
    assert ok and hi < HALF_PI
    # the same light across the other way: mirrored
    left = lights.span(sphere(center=(0.1, -2.0, 0.6), radius=0.5), ORIGIN, u, UP, 0.0)
    assert (left[0], left[1]) == (pytest.approx(-hi, abs=1e-6), pytest.approx(-lo, abs=1e-6))


def test_light_on_the_scratch_axis():
    """The cone closes around the axis: all of it or nothing."""
    u = np.array([1.0, 0.0, 0.0])
    light = sphere(center=(2.0, 0.0, 0.0), radius=0.5)
    lo, hi, ok = lights.span(light, ORIGIN, u, UP, np.cos(0.2))
    assert ok and lo == pytest.approx(-HALF_PI) and hi == pytest.approx(HALF_PI)
    assert not lights.span(light, ORIGIN, u, UP, np.cos(0.3))[2]
    assert lights.span(light, ORIGIN, u, UP, 1.0)[2]
    assert not lights.span(light, ORIGIN, u, UP, -1.0)[2]


def test_whole_span_of_a_dome_and_none_of_a_point():
    lo, hi, ok = lights.span(dome(), ORIGIN, (0, 1, 0), UP, np.linspace(-1, 1, 5))
    assert ok.all() and np.allclose(lo, -HALF_PI) and np.allclose(hi, HALF_PI)
    assert not lights.span(sphere(point=True), ORIGIN, (1, 0, 0), UP, 0.2)[2]


def test_mesh_of_two_triangles_has_the_interval_of_its_rect():
    u, n, sin_theta = frames(300, rect(), ORIGIN, seed=5)
    expected, found = lights.span(rect(), ORIGIN, u, n, sin_theta), lights.span(packed_mesh(), ORIGIN, u, n, sin_theta)
    both = expected[2] & found[2]
    assert (expected[2] == found[2]).mean() > 0.99 and both.sum() > 100
    np.testing.assert_allclose(found[0][both], expected[0][both], atol=2e-5)
    np.testing.assert_allclose(found[1][both], expected[1][both], atol=2e-5)
