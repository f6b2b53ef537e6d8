"""Knobs: each is declared once, and does what it says."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.kernels import geometry, grooves
from scratchwarp.kernels.assemble import camera_data, kernel_key
from scratchwarp.plan.effects import EFFECTS
from scratchwarp.plan.knobs import KNOBS, acting, by_quality, checked
from scratchwarp.scene import Profile, Wave
from scratchwarp.scene.knob import Knob
from scratchwarp.scene.output import RenderOptions

from ..render import scenes as S

WORLD = S.scene([S.sphere(8, 16)], [S.scratched(fresnel="exact", material="conductor", metal="gold")], [S.dome()])


def plan(knobs=None, **settings):
    return sw.make_plan(WORLD, sw.Settings(width=8, height=8, knobs=knobs or {}, **settings))


def seen(made):
    """Everything of a plan that a knob may change."""
    s = made.settings
    tables = [
        (t.resolution, t.rays, t.sampler, t.incidence, t.max_bounces, t.theta_model, t.source, t.fresnel)
        for t in made.tables
    ]
    key = kernel_key(WORLD, made)
    footprint = camera_data(WORLD, made).footprint
    return s.spp, s.cone_taps, s.max_depth, s.model, footprint, tables, {n for n in EFFECTS if made.on(n)}, key


@pytest.mark.parametrize(
    "name", [n for n in KNOBS if not n.startswith(("diffraction", "grooves")) and "farField" not in n]
)
def test_every_value_of_a_knob_changes_the_plan(name):
    path = {"integrator": "path"} if name == "pathDepth" else {}
    others = {"lights.cones": "both"} if name == "tables.theta" else {}
    found = [seen(plan(others | {name: value}, **path)) for value in KNOBS[name].values if value != "auto"]
    assert all(found.count(one) == 1 for one in found)


APPROXIMATIONS = {
    "table resolution": "tables.resolution",
    "rays": "tables.rays",
    "sampler": "tables.sampler",
    "bounces": "tables.bounces",
    "bounces in grooves": "grooves.bounces",
    "cross-sections of grooves": "grooves.section",
    "theta model": "tables.theta",
    "wavelengths": "diffraction.wavelengths",
    "look-up tables": "diffraction.colors",
    "light slices": "diffraction.slices",
    "light samples along cones": "lights.coneTaps",
    "footprint method": "diffraction.footprint",
    "coverage filter": "scratches.coverageFilter",
    "segment lookup": "diffraction.segmentLookup",
    "groove ellipse or axis": "grooves.footprint",
    "stencil far field": "scratches.farField",
    "path depth": "pathDepth",
    "samples a pixel": "spp",
}


def test_every_approximation_has_a_knob():
    """Each with a way from cheap to the reference, and something that it acts on."""
    for what, name in APPROXIMATIONS.items():
        assert name in KNOBS, what
        knob = KNOBS[name]
        assert len(set(knob.values)) == len(knob.values) >= 2 and knob.reference == knob.values[-1], what


@pytest.mark.parametrize("name", list(KNOBS))
def test_declarations_hold_together(name):
    knob = KNOBS[name]
    assert knob.name == name and knob.error and set(knob.effects) <= set(EFFECTS)
    assert all(set(on) <= set(EFFECTS) for on in knob.switches.values())
    assert not knob.switches or set(knob.switches) == set(knob.values)
    assert [knob.checked(str(value)) for value in knob.values] == list(knob.values)


def test_the_default_is_what_a_plan_has_without():
    for name in acting(plan()):
        assert seen(plan({name: KNOBS[name].default}, model="table")) == seen(plan(model="table"))


def test_colours_of_diffraction_are_those_asked_for():
    from scratchwarp.plan.knobs import turned_wave

    wave = Wave(samples=5)
    assert turned_wave(wave, {"diffraction.wavelengths": "auto"}) is wave
    made = turned_wave(wave, {"diffraction.wavelengths": 8, "diffraction.colors": "rgb"})
    assert (made.samples, made.sampling) == (8, "rgb")


def test_every_switch_changes_what_diffracts():
    """Footprints, lights and look-ups of scratches that diffract are compiled in or left out."""
    layer = replace(S.scratched().layers[0], distribution="random", density=1e-4, width=2.0, depth=0.5)
    waved = replace(S.scratched(), wave=Wave(), layers=(layer,))
    sun = replace(S.dome(), path="/dome")
    world = S.scene([S.plane()], [waved], [sun])
    for name in ("diffraction.lights", "diffraction.footprint", "diffraction.segmentLookup"):
        plans = [sw.make_plan(world, sw.Settings(width=8, height=8, knobs={name: v})) for v in KNOBS[name].values]
        keys = [kernel_key(world, made) for made in plans if name in acting(made)]
        assert len(set(keys)) >= (2 if name == "diffraction.segmentLookup" else 3), name


def test_grooves_have_the_lines_and_bounces_asked_for():
    layer = replace(S.scratched().layers[0], distribution="linear", pitch=200.0, model="groove")
    crossed = replace(layer, name="cross", angle=1.0)
    world = S.scene([S.plane()], [replace(S.scratched(), layers=(layer, crossed))], [S.dome()])

    def built(**knobs):
        plan = sw.make_plan(world, sw.Settings(width=8, height=8, spp=4, knobs=knobs))
        shape = geometry.pack(world, True, False, {}, "cpu")
        return grooves.pack(world, plan, kernel_key(world, plan), shape).arrays, plan

    arrays, plan = built()
    assert {n for n in KNOBS if n.startswith("grooves")} <= set(acting(plan))
    assert (arrays.slices, arrays.bounces) == (12, 8)
    arrays, _ = built(**{"grooves.lines": 192, "grooves.bounces": 2})
    assert (arrays.slices, arrays.bounces) == (48, 2)
    assert not built(**{"grooves.footprint": "axis"})[1].on("grooves.crossings")


def test_grooves_have_the_cross_sections_asked_for():
    """65 points of a semicircle: all of them unless a draft or a knob asks for fewer, which the plan says."""
    x = np.linspace(0.0, 1.0, 65)
    arc = np.stack([x, -np.sqrt(np.maximum(1.0 - (2.0 * x - 1.0) ** 2, 0.0))], 1)
    layer = replace(
        S.scratched().layers[0], distribution="linear", pitch=200.0, width=100.0, depth=50.0, model="groove",
        profile=Profile("/p", shape="points", points=arc),
    )  # fmt: skip
    world = S.scene([S.plane()], [replace(S.scratched(), layers=(layer,))], [S.dome()])

    def facets(**asked):
        made = sw.make_plan(world, sw.Settings(width=8, height=8, **asked))
        return len(made.grooves[0].layers[0].section) - 1, made.explain()

    assert facets()[0] == 64 and "of 64 facets" not in facets()[1]
    assert facets(quality="reference")[0] == 64 and facets(quality="draft", knobs={"grooves.section": 0})[0] == 64
    few, text = facets(quality="draft")
    assert 14 <= few <= 24 and f"{few} of 64 facets, off by at most 0.002 of the width (0.2 um)" in text
    assert facets(knobs={"grooves.section": 20})[0] < few < facets(quality="preview")[0] < 40


def test_the_stage_turns_knobs_and_the_user_goes_before_it():
    options = RenderOptions(path="/rs", knobs=(("spp", "3"), ("tables.rays", "64"), ("pathDepth", "2")))
    world = replace(WORLD, options=options)
    made = sw.make_plan(world, sw.Settings(width=8, height=8, quality="draft"))
    assert (made.tables[0].rays, made.settings.max_depth) == (64, 2)
    assert made.settings.spp == 4  # a quality asked for by the user
    assert sw.make_plan(world, sw.Settings(width=8, height=8)).settings.spp == 3
    assert sw.make_plan(world, sw.Settings(width=8, height=8, spp=5)).settings.spp == 5
    wrong = replace(world, options=RenderOptions(path="/rs", knobs=(("glitter", "1"),)))
    with pytest.raises(ValueError, match="/rs: knobs names 'glitter'"):
        sw.make_plan(wrong, sw.Settings(width=8, height=8))


def test_a_quality_turns_all_knobs_that_are_not_turned_otherwise():
    draft, final = plan(quality="draft"), plan(quality="final", knobs={"tables.rays": 16})
    assert (draft.settings.spp, draft.settings.cone_taps) == (4, 4)
    preview, best = plan(quality="preview"), plan(quality="reference")
    bins = [made.tables[0].resolution for made in (draft, preview, final, best)]
    assert bins == sorted(bins) and bins[0] < bins[2] < bins[3] == 512  # by the models; reference takes the most
    assert "combinations" in draft.numbers["quality"] and "quality" not in best.numbers
    part = plan(quality="draft", crop=(0.0, 0.5, 0.0, 0.5))
    assert (part.tables[0].resolution, part.tables[0].rays) == (draft.tables[0].resolution, draft.tables[0].rays)
    assert (final.settings.spp, final.tables[0].rays) == (128, 16)
    assert plan(quality="final", spp=3).settings.spp == 3
    assert by_quality(None) == {}
    assert "tables.rays=16" in final.explain()


@pytest.mark.parametrize(
    ("knobs", "says"),
    [
        ({"glitter": 1}, "'glitter'; the knobs are spp"),
        ({"spp": 0}, "spp is 0; it has 1, 2"),
        ({"spp": "many"}, "spp is 'many'"),
        ({"tables.sampler": "sobol"}, "it has random, stratified, beam"),
        ({"tables.theta": "gamma"}, "turn lights.cones"),
    ],
)
def test_what_cannot_be_says_what_can(knobs, says):
    with pytest.raises(ValueError, match=says):
        plan(knobs)


def test_texts_and_other_numbers_are_taken():
    assert checked({"spp": "16", "tables.rays": 100, "tables.resolution": "48"}) == {
        "spp": 16,
        "tables.rays": 100,
        "tables.resolution": 48,
    }


def test_a_knob_checks_itself():
    with pytest.raises(ValueError, match="default 3 is none of"):
        Knob(name="x", values=(1, 2), default=3, error="e", sets="table.x")
    with pytest.raises(ValueError, match="either sets something or switches"):
        Knob(name="x", values=(1, 2), default=2, error="e")
