"""Footprints over very many scratches that diffract: those drawn are, on average, all of them."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.kernels import kernel_key
from scratchwarp.plan.crowds import crowded, crowds, groups
from scratchwarp.scene import DistantLight, PreviewSurface, Wave

from . import scenes
from .test_diffraction import straight_down, waves

LAID = {"distribution": "random", "density": 60.0, "width": 3.0, "length": 2000.0, "width_variation": 0.6, "curves": ()}
GREY = PreviewSurface(diffuse_color=(0.2, 0.2, 0.2), metallic=1.0, roughness=0.4)
SUN = DistantLight(path="/sun", radiance=(90.0, 80.0, 70.0), direction=(0.4, -0.2, -0.9), angle=0.05)
NAME = "diffraction.strands"


def world(**fields):
    floor = scenes.place(0, 0, (0, 0, -1))
    material = waves(surface=GREY, wave=Wave(samples=4), **{**LAID, **fields})
    return scenes.scene([scenes.plane(0.02)], [material], [SUN, scenes.dome(0.5)], [floor], straight_down(0.01))


def settings(strands, spp=4, **more):
    return sw.Settings(width=2, height=2, spp=spp, filter="box", knobs={NAME: strands}, **more)


def film(strands, spp=4, **more):
    scene = world()
    return sw.render(scene, sw.make_plan(scene, settings(strands, spp, **more)))


def test_those_drawn_are_on_average_all():
    """4 samples a pixel of some 2,000 scratches each, all summed, against 512 of 64 drawn: within four standard errors,
    and the spread over samples says how far they are off."""
    everything = film("all", effects={"diffraction.crowds": False})
    every = film("all")
    np.testing.assert_allclose(every["color"], everything["color"], rtol=2e-4)
    few = film(64, 512)
    error = np.sqrt(few["variance"].mean() / few["variance"].size)
    found, exact = few["color"].mean(), film("all", 16)["color"].mean()
    assert 0.0 < error < 0.02 * exact
    assert abs(found - exact) < 4.0 * error + 2e-3 * exact


def test_few_scratches_are_all_summed():
    """Near by each footprint holds few, whatever the plan expected of the whole image: not drawn from, the same sum."""
    scene = world(density=0.05)
    plans = [sw.make_plan(scene, settings(64, effects={"diffraction.crowds": on})) for on in (False, True)]
    films = [sw.render(scene, plan) for plan in plans]
    np.testing.assert_allclose(films[1]["color"], films[0]["color"], rtol=2e-4)


def test_the_plan_says_when():
    scene = world()
    plan = sw.make_plan(scene, settings(64))
    assert plan.on("diffraction.crowds") and "64 of them are drawn" in plan.effects["diffraction.crowds"].reason
    key = kernel_key(scene, plan)
    assert key.glint_crowds and key.glint_hierarchy and not key.glint_lists
    assert not sw.make_plan(world(density=0.05), settings(64)).on("diffraction.crowds")
    assert not sw.make_plan(scene, settings(4096, 64)).on("diffraction.crowds")


@pytest.mark.parametrize("coverage", [0.05, 0.4])
def test_crowds_are_counted_as_laid(coverage):
    """By coverage as by density: 1 - e^-(number times area)."""
    fields = {"density": 0.0, "coverage": coverage}
    dense = -np.log(1.0 - coverage) / (LAID["width"] * LAID["length"]) * 1e6
    plans = [sw.make_plan(world(**f), settings(64)) for f in (fields, {"density": dense})]
    counts = [crowds(world(), plan.waves, 1e-3, 0.02)[0] for plan in plans]
    assert counts[0] == pytest.approx(counts[1], rel=1e-6)
    # 1.128 mm wide, 2.6 of that is looked at, and what lies half beyond its ends
    assert counts[1] == pytest.approx(dense * 2.0 * 2.93 * (1.0 + 0.6 * 2.93 / 2.0), rel=1e-2)


def test_lists_of_huge_triangles_are_not_looked_through():
    """Two triangles under 24,000 scratches: a hierarchy finds those near by."""
    asked = sw.Settings(width=64, height=64, spp=16)
    dense, sparse = (sw.make_plan(world(density=d), asked).effects["diffraction.lists"] for d in (60.0, 0.06))
    assert not dense.enabled and "too many to look through" in dense.reason and sparse.enabled


def test_groups():
    asked = settings(1024)
    assert not crowded(2000.0, asked) and groups(2000.0, asked, 10**6) == 1
    assert groups(1e5, asked, 10**6) == 512 and groups(1e9, asked, 10**7) == 4096 and groups(1e9, asked, 100) == 8
