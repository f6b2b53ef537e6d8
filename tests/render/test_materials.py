"""The demo materials and patterns: reciprocal, sampled as they say, and never brighter than what lights them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

import scratchwarp as sw
from scratchwarp import profiles
from scratchwarp.pipelines import author_demo
from scratchwarp.scene import DomeLight

NAMES = ("gold", "painted", "plastic", "wood", "patterns", "kettle", "ball")


@pytest.fixture(scope="module")
def plans(tmp_path_factory):
    """name -> (scene, plan) of small demo stages."""
    found = {}
    for path in author_demo.author(tmp_path_factory.mktemp("stages"), 0.1, NAMES):
        scene = sw.read(path)
        found[path.stem] = scene, sw.make_plan(scene)
    return found


@pytest.fixture(scope="module")
def tables(plans):
    """Every table that the stages ask for, at 48 bins: label -> (profile, table)."""
    found = {}
    for _, plan in plans.values():
        for t in plan.tables:
            assert t.profile is not None
            found[t.users[0]] = t.profile, profiles.simulate(t.profile, resolution=48, rays=256, fresnel=t.fresnel)
    assert len(found) >= 8
    return found


def test_tables_are_reciprocal(tables):
    """rho(phi_o, phi_i) = rho(phi_i, phi_o) on every cone, but for rims on flat ground, which catch light that crossed
    no opening. Fresnel factors are those of the rays met, 256 in a cell: 1 % of a row's energy."""
    checked = 0
    for label, (profile, table) in tables.items():
        if profile.reciprocal:
            checked += 1
            for theta in (0.0, 0.6, 1.3):
                rho = table.slice(theta).reshape(48, 48, -1)
                odd = np.abs(rho - rho.swapaxes(0, 1)) * (table.weights[:, None] * table.weights)[..., None]
                assert odd.sum() / (table.weights.sum() * rho.shape[-1]) < 0.02, (label, theta)
    assert checked >= 4


def test_tables_lose_and_gain_nothing(tables):
    """All of a mirror's light leaves, from any direction it came; with Fresnel never more than came, on any cone."""
    for label, (_, table) in tables.items():
        assert np.allclose(table.weights @ table.mirror, 1.0, atol=1e-4), label
        for theta in (0.0, 0.6, 1.3, np.pi / 2):
            energy = np.tensordot(table.weights, table.slice(theta), 1)
            assert np.all(np.isfinite(energy)) and energy.min() >= 0.0 and energy.max() <= 1.0 + 1e-4, (label, theta)


def test_samples_of_every_table_follow_its_density(tables):
    """Chi-square over bins, 2e4 samples; significance 1e-4 for some 30 draws."""
    edges = np.linspace(-np.pi / 2, np.pi / 2, 49)
    for label, (_, table) in tables.items():
        for phi_o in (-1.2, 0.1, 0.9):
            u = np.random.default_rng(7).random(20000)
            phi_i, density = table.sample(np.full(u.shape, phi_o), u)
            assert np.all(density > 0.0)
            fine = edges[:-1, None] + np.diff(edges)[:, None] * np.linspace(1e-4, 1 - 1e-4, 9)
            expected = 20000 * np.diff(edges) * np.trapezoid(table.pdf(phi_o, fine), np.linspace(0, 1, 9), axis=1)
            observed = np.histogram(phi_i, edges)[0]
            kept = expected > 5
            chi2 = ((observed[kept] - expected[kept]) ** 2 / expected[kept]).sum()
            assert stats.chi2.sf(chi2, max(kept.sum() - 1, 1)) > 1e-4, (label, phi_o)


@pytest.mark.parametrize("name", ["gold", "wood"])
def test_no_material_shines_brighter_than_its_surroundings(plans, name):
    """Under a dome of radiance 1, every path integrated, no pixel exceeds 1 but for noise; none is negative."""
    scene, _ = plans[name]
    lit = replace(scene, lights=(DomeLight(path="/dome", radiance=np.ones(3)),))
    film = sw.render(lit, sw.make_plan(lit, sw.Settings(width=16, height=12, spp=128, integrator="path", max_depth=16)))
    color = film["color"]
    assert film.stats["invalid_samples"] == 0 and color.min() >= 0.0
    assert color.max() < 1.1 and color.mean() < 1.0
