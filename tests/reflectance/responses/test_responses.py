"""Responses over solid angle, by the device functions that the renderer calls: chi-square, furnace, reciprocity, and
what each says beside the models that it is made of."""

import numpy as np
import pytest

from scratchwarp import mdf, optics, profiles, stencils
from scratchwarp.reflectance.responses import RESPONSES, facets, normal_response, query
from scratchwarp.scene import NormalMap, Texture

from . import checks
from .checks import directions, hemisphere

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


def test_every_response_is_tested():
    assert {case.name for case, _ in CASES.values()} | {"utia", "merl", "rgl"} == set(RESPONSES)


@pytest.mark.parametrize("name", CASES)
def test_chi_square(name):
    checks.chi_square(*CASES[name])


@pytest.mark.parametrize("name", CASES)
def test_furnace(name):
    """The square root is not bounded."""
    checks.furnace(*CASES[name], bounded=name != "filtered map")


@pytest.mark.parametrize("name", [n for n in CASES if n != "plain map"])
def test_reciprocity(name):
    checks.reciprocity(*CASES[name])


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
