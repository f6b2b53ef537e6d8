"""Only what the scene calls for: for each effect a scene with and one without it. Off, it leaves no code, no table, no
memory and no launch; on, it changes the image only where it should.

A new effect without a line in ``effect_cases`` fails here.
"""

import importlib
from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from unittest import mock

import numpy as np
import pytest
import warp as wp

import scratchwarp as sw
from scratchwarp.kernels import assemble, kernel_key
from scratchwarp.plan.effects import EFFECTS
from scratchwarp.render.renderer import simulate_tables

from .effect_cases import CASES, FIELDS
from .test_code import EVERYTHING

SETTINGS = {"width": 24, "height": 12, "spp": 4, "filter": "box", "knobs": {"tables.resolution": 16, "tables.rays": 8}}
# what a wave of scratches, or grooves, need data for in any case
WAVED = [n for n in vars(EVERYTHING) if n.startswith("glint")]
GROOVED = [n for n in vars(EVERYTHING) if n.startswith("groove")]


def allocated(value, seen=None):
    """Bytes of all arrays of a kernel's arguments."""
    seen = set() if seen is None else seen
    if isinstance(value, wp.array):
        new = value.ptr not in seen
        seen.add(value.ptr)
        return value.capacity if new else 0
    names = getattr(getattr(value, "_cls", None), "vars", ())
    return sum(allocated(getattr(value, name), seen) for name in names)


def planned(scene, extra):
    # these scenes are near enough for what is seen as a table to be laid out
    effects = {"grooves.handover": False, **extra.get("effects", {})}
    plan = sw.make_plan(scene, sw.Settings(**{**SETTINGS, **extra, "effects": effects}))
    tables, simulated = simulate_tables(plan, 1)
    launched = []
    launch = wp.launch
    with mock.patch.object(wp, "launch", lambda *a, **k: (launched.append(a), launch(*a, **k))[1]):
        built = assemble(scene, plan, tables)
    memory = sum(allocated(value) for value in built.inputs)
    return SimpleNamespace(plan=plan, key=built.key, tables=simulated, memory=memory, launched=len(launched))


@cache
def both(name, folder):
    """What an effect's two scenes are rendered by."""
    case = CASES[name]
    made = []
    for scene, extra in ((case.with_it, case.only_with), (case.without, {})):
        scene = scene(folder) if callable(scene) else scene
        made.append((scene, planned(scene, {**case.settings, **extra})))
    return made


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("measured")


def test_every_effect_is_here():
    assert set(CASES) == set(EFFECTS) == set(FIELDS)


@pytest.mark.parametrize("name", CASES)
def test_off_leaves_nothing(name, folder):
    (_, with_it), (_, without) = both(name, folder)
    case = CASES[name]
    assert with_it.plan.on(name) and not without.plan.on(name)
    changed = {n for n in vars(with_it.key) if getattr(with_it.key, n) != getattr(without.key, n)}
    assert changed == set(FIELDS[name].split())
    # what is off is what a key without anything has
    for field in changed - {"lights", "distributions", "responses", "directed", "textures", "preview", "measured"}:
        other = ("glint_bands", "glint_lookup", "glint_fringes", "glint_method", "glint_footprint")
        if field not in (*other, "closed_form"):
            assert not getattr(without.key, field)
    assert with_it.tables - without.tables == case.tables
    if case.grows is not None:
        assert (with_it.memory > without.memory) if case.grows else (with_it.memory == without.memory)
    assert with_it.launched >= without.launched or case.grows is None


@pytest.mark.parametrize("name", [n for n in CASES if CASES[n].where == "left" and not n.startswith("lights")])
def test_forced_off_leaves_nothing_either(name, folder):
    """The same scene with the effect forced off: code, a table or data of its own are gone, and nothing came but the
    tables that stand in for what was to diffract or to be laid out."""
    (scene, with_it), _ = both(name, folder)
    off = planned(scene, {**CASES[name].settings, "effects": {name: False}})
    assert not off.plan.on(name)
    gone = [n for n in FIELDS[name].split() if getattr(off.key, n) != getattr(with_it.key, n)]
    bounces = [max((t.max_bounces for t in x.plan.tables), default=0) for x in (off, with_it)]
    assert gone or off.tables < with_it.tables or off.memory < with_it.memory or bounces[0] < bounces[1]
    if not name.startswith(("diffraction", "grooves")):
        assert off.tables <= with_it.tables
        assert CASES[name].grows is None or off.memory <= with_it.memory


def image(scene, plan):
    """The image by one kernel that holds the code of nearly everything, compiled without optimisation."""
    assembling = importlib.import_module("scratchwarp.kernels.assemble")
    rendering = importlib.import_module("scratchwarp.render.renderer")
    real, loaded = kernel_key, rendering.loaded

    def everything(scene, plan):
        key = real(scene, plan)
        kept = {name: getattr(key, name) for name in (*WAVED, *GROOVED, "orthographic", "filter", "sum_coverage")}
        return replace(EVERYTHING, **kept)

    def unoptimised(*args):
        with mock.patch.object(wp.config, "optimization_level", 0):
            return loaded(*args)

    with (
        mock.patch.object(assembling, "kernel_key", everything),
        mock.patch.object(rendering, "kernel_key", everything),
        mock.patch.object(rendering, "loaded", unoptimised),
    ):
        return sw.render(scene, plan)


SHOWN = [n for n in CASES if CASES[n].where and not n.startswith(("diffraction", "grooves"))]


@pytest.mark.parametrize("name", SHOWN)
def test_on_changes_only_where_it_should(name, folder):
    (scene, with_it), (bare, without) = both(name, folder)
    on, off = image(scene, with_it.plan), image(bare, without.plan)
    where = CASES[name].where
    changed = (on["color"] != off["color"]).any(-1)
    left, right = on["primId"] == 0, on["primId"] == 1
    assert changed[left].any()
    if where == "left":
        assert not changed[right].any()
    if where == "light":
        for layer in ("alpha", "depth", "normal", "albedo", "P", "primId"):
            np.testing.assert_array_equal(on[layer], off[layer], err_msg=layer)
    assert on.stats["kernels_launched"] == off.stats["kernels_launched"]
