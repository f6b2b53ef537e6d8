"""Responses over solid angle, by the device functions that the renderer calls: chi-square, furnace, reciprocity, and
what each says beside the models that it is made of."""

import numpy as np
import pytest
from scipy import stats

from scratchwarp import mdf, optics, profiles, stencils
from scratchwarp.reflectance.responses import RESPONSES, facets, normal_response, query
from scratchwarp.scene import NormalMap, Texture

LOWEST_P = 1e-4
IRON = optics.Conductor((2.9, 2.6, 2.3), (3.1, 2.9, 2.7))


def tilted(x, y, size=8):
    """A texture of one normal."""
    n = np.array([x, y, np.sqrt(1 - x * x - y * y)])
    return Texture("/n", np.broadcast_to([*(0.5 * n + 0.5), 1.0], (size, size, 4)))


def scratches(size=64):
    n = mdf.scratch_map(size, density=60, length=0.4, width=0.05, depth=0.25, direction=0.5, spread=0.2)
    return Texture("/s", np.concatenate([0.5 * n + 0.5, np.ones((size, size, 1))], axis=-1))


TWO = stencils.Model(
    (
        stencils.Mode(0.4, 0.4, 0.9, 0.02, 0.05, 0.5, 9.0, (1.0, 0.8, 0.5)),
        stencils.Mode(1.5, 0.5, 0.9, 0.0, 0.05, 0.3, 14.0, (0.3, 0.6, 1.0)),
    ),
    beta=0.3,
    background=0.2,
    k=1.5,
    specular_alpha=30.0,
)
WIDE = ((0.1, 0.0), (0.02, 0.08))
CASES = {
    "lobe": (query.Queried("ashikhminShirley", mdf.Lobe("ashikhmin-shirley", 300.0, 4.0)), {}),
    "stencils": (query.Queried("stencils", TWO), {}),
    "map": (query.Queried("normalMap", NormalMap(0)), {"textures": (tilted(0.3, -0.5),)}),
    "plain map": (
        query.Queried("normalMap", NormalMap(0, deformation="none", facets="beckmann")),
        {"textures": (tilted(0.3, -0.5),)},
    ),
    "filtered map": (
        query.Queried("normalMap", NormalMap(0, facets="ggx", deformation="sqrt")),
        {"textures": (scratches(),), "uv": (0.3, 0.6), "footprint": WIDE},
    ),
}


def directions(theta, phi):
    return np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), -1)


def hemisphere(n):
    """Midpoints uniform in z and phi, and their solid angle."""
    z, phi = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n * 2 * np.pi - np.pi, indexing="ij")
    return directions(np.arccos(z), phi), 2 * np.pi / n**2


def test_every_response_is_tested():
    assert {case.name for case, _ in CASES.values()} == set(RESPONSES)


@pytest.mark.parametrize("name", CASES)
def test_chi_square(name):
    response, where = CASES[name]
    wo, bins, sub = directions(0.6, 0.7), 8, 50
    wi, weight, pdf = query.sample(response, wo, np.random.default_rng(5).random((60_000, 3)), **where)
    grid, cell = hemisphere(bins * sub)
    density = query.evaluate(response, grid, wo, **where)[1].astype(float)
    expected = 6e4 * cell * density.reshape(bins, sub, bins, sub).sum(axis=(1, 3)).ravel()
    w = wi[pdf > 0]
    counts = np.histogram2d(w[:, 2], np.arctan2(w[:, 1], w[:, 0]), bins, [[0, 1], [-np.pi, np.pi]])[0].ravel()
    keep = expected > 50
    # the midpoint rule leaves 1 % in a cell of the narrow lobes: that much is allowed on top of the noise
    excess = np.maximum(np.abs(counts - expected)[keep] - 0.01 * expected[keep], 0.0)
    assert keep.sum() > 8
    assert stats.chi2.sf(np.sum(excess**2 / expected[keep]), keep.sum()) > LOWEST_P
    value, again = query.evaluate(response, w, wo, **where)
    # float32: a half vector is off by 1e-7, the slope of log D at most 300 a radian
    np.testing.assert_allclose(pdf[pdf > 0], again, rtol=3e-3)
    np.testing.assert_allclose(weight[pdf > 0] * again[:, None], value * w[:, 2:], rtol=5e-3, atol=1e-6)


@pytest.mark.parametrize("name", CASES)
def test_furnace(name):
    """No view reflects more than came, but by the square root, which is not bounded."""
    response, where = CASES[name]
    for theta in (0.0, 0.8, 1.4, 1.55):
        weight = query.sample(response, directions(theta, 2.0), np.random.default_rng(6).random((20_000, 3)), **where)[
            1
        ]
        assert np.isfinite(weight).all() and (weight >= 0).all()
        mean = weight.mean(0, dtype=float)
        if name != "filtered map":
            assert (mean <= 1.0 + 4 * weight.std(0) / np.sqrt(20_000)).all()
        assert theta > 0.0 or mean.max() > 0.05


@pytest.mark.parametrize("name", [n for n in CASES if n != "plain map"])
def test_reciprocity(name):
    response, where = CASES[name]
    rng = np.random.default_rng(7)
    wi, wo = (directions(np.arccos(rng.uniform(0.05, 1, 500)), rng.uniform(-3, 3, 500)) for _ in range(2))
    there, back = (query.evaluate(response, a, b, **where)[0] for a, b in ((wi, wo), (wo, wi)))
    np.testing.assert_allclose(there, back, rtol=2e-3, atol=1e-6)
    assert there.max() > 0.0


def test_lobes_are_those_of_mdf_and_stencils():
    wi, wo = directions(np.linspace(0.1, 1.4, 9)[:, None], np.linspace(-3, 3, 7)), directions(0.9, 2.0)
    lobe = mdf.Lobe("ashikhmin-shirley", 50.0, 4.0)
    h = wi + wo
    cosine = np.clip((h * wo).sum(-1) / np.linalg.norm(h, axis=-1), 0, 1)
    wanted = mdf.evaluate(lobe, wi, np.broadcast_to(wo, wi.shape))[..., None] * IRON.reflectance(cosine)
    got = query.evaluate(query.Queried("ashikhminShirley", lobe, IRON), wi, wo)[0]
    # reflectances are tabulated at 65 cosines
    np.testing.assert_allclose(got, wanted, rtol=2e-3, atol=1e-6)
    got = query.evaluate(query.Queried("stencils", TWO), wi, wo)[0]
    np.testing.assert_allclose(got, stencils.evaluate(TWO, wi, wo, energy_conserving=True), rtol=1e-3, atol=1e-6)
    for deformation in ("linear", "sqrt"):
        for names in (("ashikhminShirley", "ashikhmin-shirley"), ("ward", "ward"), ("ggx", "ggx")):
            record = NormalMap(0, roughness=(0.4, 0.2), facets=names[0], deformation=deformation)
            got = query.evaluate(query.Queried("normalMap", record), wi, wo, textures=(tilted(0.3, -0.4),))[0][..., 0]
            x, y = (2 / 0.16 - 2, 2 / 0.04 - 2) if names[0] == "ashikhminShirley" else (0.4, 0.2)
            kind = "sqrt" if deformation == "sqrt" else "linear"
            wanted = mdf.evaluate(mdf.Lobe(names[1], x, y, kind), wi, np.broadcast_to(wo, wi.shape), (0.3, -0.4))
            np.testing.assert_allclose(got, wanted, rtol=5e-3, atol=1e-5)


def test_fit_to_slopes():
    """Facets of the fitted lobe tilt as much as the profile's."""
    for depth in (0.1, 0.3):
        line = profiles.shape("round", depth=depth).polyline()
        lobe = facets.fitted(line)
        edge = np.diff(line, axis=0)
        mean = np.average(edge[:, 1] ** 2 / (edge**2).sum(1), weights=edge[:, 0])
        assert lobe.x == facets.ALONG and 1 / (lobe.y + 3) == pytest.approx(mean, rel=1e-6)
    assert facets.fitted(np.array([[0.0, 0], [1, 0]])).y == facets.ALONG
    assert facets.fitted(np.array([[0.0, 0], [0.01, -5], [0.99, -5], [1, 0]])).y > 0.0


def test_pyramids_keep_means():
    """Of odd sizes, too; the widest footprint sees the mean normal and its whole variance."""
    rng = np.random.default_rng(8)
    pixels = np.concatenate([rng.uniform(0.3, 0.7, (37, 51, 2)), np.full((37, 51, 1), 0.95)], -1)
    fine = normal_response.moments(pixels)
    levels = normal_response.pyramid(fine)
    assert [level.shape[:2] for level in levels] == [(37, 51), (18, 25), (9, 12), (4, 6), (2, 3), (1, 1)]
    for level in levels:
        np.testing.assert_allclose(level.mean((0, 1)), fine.mean((0, 1)), rtol=1e-4, atol=1e-6)


def test_minified_maps_widen_the_lobe():
    """Grooves along u, seen from far: the lobe is as wide across them as their normals are, and stays narrow along."""
    t = np.arange(64) / 64
    y = 0.3 * np.sin(2 * np.pi * t)
    n = np.stack([np.zeros_like(y), y, np.sqrt(1 - y * y)], -1)
    grooves = Texture("/g", np.broadcast_to(np.append(0.5 * n + 0.5, np.ones((64, 1)), 1)[:, None], (64, 64, 4)))
    response = query.Queried("normalMap", NormalMap(0, facets="beckmann", roughness=(0.1, 0.1)))
    wi, cell = hemisphere(200)
    wo = np.array([0.0, 0.0, 1.0])
    h = wi + wo
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    far = {"textures": (grooves,), "footprint": ((1.0, 0.0), (0.0, 1.0))}
    f = query.evaluate(response, wi, wo, **far)[0][..., 0] * wi[..., 2]
    # the mean over points seen from near is what is seen from far
    near = np.mean(
        [
            query.evaluate(response, wi, wo, uv=(0.5, v), textures=(grooves,))[0][..., 0]
            for v in (np.arange(32) + 0.5) / 32
        ],
        axis=0,
    )
    near *= wi[..., 2]
    assert near.sum() * cell == pytest.approx(f.sum() * cell, rel=0.02) and f.sum() * cell > 0.85
    spread = [[(g * h[..., k] ** 2).sum() / g.sum() for k in (0, 1)] for g in (near, f)]
    # normals of a sine are not those of a Beckmann lobe: alike in their second moments, up to what the horizon hides
    np.testing.assert_allclose(spread[1], spread[0], rtol=0.06)
    assert spread[1][1] > 6 * spread[1][0]
