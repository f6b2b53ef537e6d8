"""Samples against hits: the same light, the same density, all of it."""

import numpy as np
import pytest
import warp as wp
from scipy import stats

from scratchwarp import lights
from scratchwarp.lights.light_device import Light, LightArrays, LightHit
from scratchwarp.lights.mesh_device import mesh_light_hit

from .light_cases import ORIGIN, SEEN, packed_mesh, sphere_directions

wp.set_module_options({"enable_backward": False})

POINTS = np.array([[0.0, 0.0, 0.0], [0.25, -0.1, 0.02], [-0.4, 0.3, -0.5]])
LOWEST_P = 1e-4  # fixed seeds


@pytest.mark.parametrize("name", SEEN)
def test_hit_finds_what_was_sampled(name):
    u = np.random.default_rng(1).random((20000, 2))
    for x in POINTS:
        s = lights.sample(SEEN[name], x, u)
        found = s["pdf"] > 0
        h = lights.hit(SEEN[name], x, s["wi"][found])
        np.testing.assert_allclose(np.linalg.norm(s["wi"], axis=-1), 1.0, atol=2e-6)
        met = h["distance"] >= 0
        # a sample on the rim may be missed by rounding: 1e-7 of a direction over the light's angular size
        assert met.mean() > (0.995 if name in ("sun", "far_sphere", "far_rect", "far_disk") else 0.9995)
        # sample and hit each err by some 1e-6; grazing the side of a sphere or cylinder that is the square root
        np.testing.assert_allclose(h["distance"][met], s["distance"][found][met], rtol=2e-3)
        # cells of an image have steps, which a direction near an edge may fall on either side of
        step = np.abs(h["pdf"][met] / s["pdf"][found][met] - 1.0) > 1e-3
        assert step.mean() < (2e-3 if name == "image" else 1e-9)
        np.testing.assert_allclose(h["radiance"][met], s["radiance"][found][met], rtol=2e-3, atol=1e-4)


def _cells(w, axis, drop):
    """Index among 4 x 8 cells of equal solid angle of the cap around an axis, 1 - cos at most ``drop``."""
    other = np.linalg.svd(axis[None])[2][1:]
    turn = np.arctan2(w @ other[0], w @ other[1])
    chord2 = ((w - axis) ** 2).sum(-1)
    return np.clip(2 * chord2 / drop, 0, 3).astype(int) * 8 + np.clip((turn / np.pi + 1) * 4, 0, 7).astype(int)


@pytest.mark.parametrize("name", SEEN)
@pytest.mark.parametrize("x", POINTS[:2], ids=str)
def test_density_is_that_of_the_samples(name, x):
    """Shares of samples in cells against the integral of the density over them, by uniform directions in a cap."""
    light = SEEN[name]
    count = 200_000
    s = lights.sample(light, x, np.random.default_rng(2).random((count, 2)))
    found = s["pdf"] > 0
    if not found.any():
        assert (lights.hit(light, x, sphere_directions(2000))["distance"] < 0).all()
        return
    axis = s["wi"][found].mean(0, dtype=float)
    axis = axis / np.linalg.norm(axis)
    drop = min(((s["wi"][found] - axis) ** 2).sum(-1).max() / 2 * 1.2 + 1e-12, 2.0)  # a rim around the light
    rng = np.random.default_rng(3)
    h, t = drop * rng.random(count), 2 * np.pi * rng.random(count)
    other = np.linalg.svd(axis[None])[2][1:]
    ring = np.sqrt(h * (2 - h))
    w = (ring * np.cos(t))[:, None] * other[0] + (ring * np.sin(t))[:, None] * other[1] + (1 - h)[:, None] * axis
    density = lights.hit(light, x, w)["pdf"].astype(float) * 2 * np.pi * drop
    drawn, asked = _cells(s["wi"][found], axis, drop), _cells(w, axis, drop)
    z2, cells = 0.0, 0
    for cell in range(32):
        share = (drawn == cell).sum() / count
        values = np.where(asked == cell, density, 0.0)
        if (drawn == cell).sum() > 50 and (values > 0).sum() > 50:
            variance = share * (1 - share) / count + values.var() / count
            z2 += (share - values.mean()) ** 2 / variance
            cells += 1
    assert cells >= 3
    assert stats.chi2.sf(z2, cells) > LOWEST_P
    assert abs(density.mean() - found.mean()) < 5 * density.std() / np.sqrt(count) + 1e-5  # float32 of the density


@pytest.mark.parametrize("name", ["sun", "far_sphere", "far_rect", "far_disk"])
def test_density_of_small_lights_is_one_over_their_solid_angle(name):
    """All of these fill so little that their density is constant within 1 %."""
    solid_angle = {
        "sun": 2 * np.pi * (1 - np.cos(np.radians(0.265))),
        "far_sphere": 2 * np.pi * (1 - np.sqrt(1 - 0.25 / 12500)),
        "far_rect": 1.2 * 8 / 89**1.5,
        "far_disk": 0.3 * np.pi * 8 / 89**1.5,
    }[name]
    s = lights.sample(SEEN[name], ORIGIN, np.random.default_rng(4).random((4096, 2)))
    assert (1 / s["pdf"]).mean() == pytest.approx(solid_angle, rel=5e-3)
    assert np.ptp(s["pdf"]) < 0.35 * s["pdf"].mean()


def test_mesh_light_density_is_uniform_over_its_area():
    mesh = packed_mesh()
    s = lights.sample(mesh, ORIGIN, np.random.default_rng(5).random((100_000, 2)))
    p = s["distance"][:, None] * s["wi"]
    np.testing.assert_allclose(p[:, 2], 0.8, atol=1e-6)
    np.testing.assert_allclose(s["pdf"], s["distance"] ** 3 / (0.8 * 1.2), rtol=1e-5)
    counts = np.histogram2d(p[:, 0], p[:, 1], bins=8, range=[[-0.3, 0.9], [-0.1, 0.9]])[0]
    assert counts.sum() == len(p)
    assert stats.chisquare(counts.ravel()).pvalue > LOWEST_P
    behind = lights.sample(mesh, np.array([0.0, 0.0, 2.0]), np.random.default_rng(6).random((100, 2)))
    assert (behind["pdf"] == 0).all()
    assert (lights.hit(mesh, ORIGIN, s["wi"][:10])["distance"] < 0).all()


@wp.kernel
def _mesh_hits(
    all_lights: wp.array[Light],
    arrays: LightArrays,
    w: wp.array[wp.vec3],
    distance: wp.array[float],
    normal: wp.vec3,
    out: wp.array[LightHit],
):
    i = wp.tid()
    out[i] = mesh_light_hit(arrays, all_lights[0], wp.vec3(0.0, 0.0, 0.0), w[i], distance[i], normal)


@pytest.mark.parametrize(("side", "lit"), [(-1.0, True), (1.0, False)])
def test_rays_that_meet_a_mesh_light_see_its_outside(side, lit):
    mesh = packed_mesh(radiance=(3.0, 2.0, 1.0))
    s = lights.sample(mesh, ORIGIN, np.random.default_rng(8).random((200, 2)))
    out = wp.zeros(200, dtype=LightHit, device="cpu")
    rays = [wp.array(s["wi"], dtype=wp.vec3, device="cpu"), wp.array(s["distance"], dtype=float, device="cpu")]
    inputs = [mesh.lights["mesh"], mesh.arrays, *rays, wp.vec3(0.0, 0.0, side)]
    wp.launch(_mesh_hits, 200, inputs=inputs, outputs=[out], device="cpu")
    found = out.numpy()
    assert ((found["distance"] >= 0) == lit).all()
    np.testing.assert_allclose(found["pdf"], s["pdf"] * lit, rtol=1e-5)
    np.testing.assert_allclose(found["radiance"], s["radiance"] * lit, rtol=1e-6)


def test_textured_dome_is_sampled_by_brightness():
    """The estimate of its whole light has little variance: radiance over density is nearly constant within a cell."""
    light = SEEN["image"]
    s = lights.sample(light, ORIGIN, np.random.default_rng(7).random((20000, 2)))
    ratio = s["radiance"].mean(-1) / s["pdf"]
    assert ratio.std() < 0.25 * ratio.mean()
    assert (s["radiance"].max(-1) > 0).mean() > 0.98
