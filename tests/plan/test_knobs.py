"""Knobs: each is declared once, and does what it says."""

import pytest

import scratchwarp as sw
from scratchwarp.kernels.assemble import kernel_key
from scratchwarp.plan.effects import EFFECTS
from scratchwarp.plan.knobs import KNOBS, acting, by_quality, checked
from scratchwarp.scene import Wave
from scratchwarp.scene.knob import Knob

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
    return s.spp, s.cone_taps, s.max_depth, s.model, tables, {n for n in EFFECTS if made.on(n)}, key


@pytest.mark.parametrize("name", [n for n in KNOBS if not n.startswith("diffraction") and "farField" not in n])
def test_every_value_of_a_knob_changes_the_plan(name):
    path = {"integrator": "path"} if name == "pathDepth" else {}
    others = {"lights.cones": "both"} if name == "tables.theta" else {}
    found = [seen(plan(others | {name: value}, **path)) for value in KNOBS[name].values if value != "auto"]
    assert all(found.count(one) == 1 for one in found)


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


def test_a_quality_turns_all_knobs_that_are_not_turned_otherwise():
    draft, final = plan(quality="draft"), plan(quality="final", knobs={"tables.rays": 16})
    assert (draft.settings.spp, draft.tables[0].resolution, draft.settings.cone_taps) == (4, 128, 4)
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
