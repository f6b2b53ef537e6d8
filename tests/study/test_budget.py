"""Budgets of a study: by a clock that the test moves, the reference made cheaper, values that it cannot judge."""

import json
from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.plan.knobs import KNOBS
from scratchwarp.study import order, reference, shots, sweeping
from scratchwarp.study.measures import rel_mse
from scratchwarp.study.page import page
from scratchwarp.study.report import Report
from scratchwarp.study.study import Study

from ..render import scenes as S
from .test_sweep import SETTINGS, world

LADDERS = {"spp": (1, 4, 16), "tables.bounces": (1, 3, 2000), "tables.resolution": (16, 32, 64)}


class Slow:
    """A machine on which a render of ``n`` samples and tables of ``r`` bins takes 1 + n / 8 + r / 16 seconds."""

    def __init__(self, monkeypatch):
        self.now, self.renders = 0.0, []
        take = shots.Shots.take
        monkeypatch.setattr(sweeping.Guess, "of", lambda guess, knobs, times=1: times * self.price(guess.shots, knobs))

        def slow(own, knobs, seed, *args, **how):
            self.now += self.price(own, knobs)
            self.renders.append((dict(knobs), seed))
            return take(own, knobs, seed, *args, **how)

        monkeypatch.setattr(shots.Shots, "take", slow)

    def price(self, own, knobs):
        plan = own.planned(knobs)
        bins = plan.tables[0].resolution
        return (1.0 + plan.settings.spp / 8.0 + bins / 16.0) * (plan.settings.width / 12.0) ** 2

    def __call__(self):
        return self.now


@pytest.fixture
def slow(monkeypatch):
    return Slow(monkeypatch)


def study(slow, budget, **how):
    slow.now = 0.0
    scene = replace(world(), seconds=0.0)
    return sw.study.sweep(scene, LADDERS, repeats=2, settings=SETTINGS, budget=budget, clock=slow, **how)


def test_a_budget_is_kept_and_used(slow):
    """A study of everything would take 200 s and more: 90 are kept, and nine tenths of them are used."""
    report = study(slow, 90.0)
    assert 0.85 * 90.0 < slow.now <= 90.0
    assert report.about["budget"] == 90.0 and report.about["seconds"] <= 90.0
    assert {n for row in report.rows for n in row.knobs} == set(LADDERS) and not report.about["unmeasured"]


def test_the_reference_is_made_cheaper_for_a_budget_and_says_so(slow):
    report = study(slow, 60.0)
    wanted, taken = report.about["shrunk"]["spp"]
    assert (wanted, taken) == (256, report.about["reference"]["spp"]) and taken < wanted
    halves = [own for own, seed in slow.renders if seed >= reference.SEED]
    assert len(halves) == 2 and sum(own["spp"] for own in halves) == taken
    text = page(report)
    assert f"spp {taken} in place of 256" in text and "noise of its samples" in text
    assert all(16 not in row.knobs.values() or taken >= 32 for row in report.rows)
    long = study(slow, 5000.0)
    assert not long.about["shrunk"] and "made cheaper" not in page(long)


def test_a_budget_that_is_too_short_says_what_is_needed(slow):
    with pytest.raises(ValueError, match=r"3 s is too short: .* take about \d+ s at 12x12 pixels"):
        study(slow, 3.0)


def test_fewer_pixels_fit(slow):
    report = study(slow, 60.0, widths=(48, 24, 12))
    assert report.about["size"][0] == 12 and slow.now <= 60.0
    assert study(slow, 3000.0, widths=(48, 24, 12)).about["size"][0] == 48


def test_an_interrupted_study_has_the_same_reference_though_the_machine_is_slower(slow, tmp_path, monkeypatch):
    first = study(slow, 60.0, folder=tmp_path)
    (notes,) = tmp_path.glob("measurements.jsonl")
    lines = notes.read_text().splitlines()
    assert json.loads(lines[0])["budget"] == 60.0
    notes.write_text("\n".join(lines[:3]) + "\n")
    slow.renders.clear()
    monkeypatch.setattr(slow, "price", lambda own, knobs: 5.0)
    again = study(slow, 60.0, folder=tmp_path)
    assert again.about["reference"] == first.about["reference"]
    assert not [seed for _, seed in slow.renders if seed >= reference.SEED]
    assert np.array_equal(again.reference, first.reference) and again.floor == first.floor
    known = {row.name: row.error for row in first.rows}
    assert all(known.get(row.name, row.error) == row.error for row in again.rows if row.rounds == 1)
    study(slow, 90.0, folder=tmp_path)  # another budget begins anew
    assert [seed for _, seed in slow.renders if seed >= reference.SEED]


def test_the_reference_shrinks_in_order_and_no_further_than_needed():
    """Samples first, then the knob that saves most, never below ``lowest``; what is left goes to samples."""
    best = {"spp": 256, "tables.resolution": 512, "tables.rays": 512, "pathDepth": 16}
    lowest = {"spp": 16, "tables.resolution": 256, "tables.rays": 128, "pathDepth": 8}
    asked = []

    def cost(own):
        asked.append(own)
        return own["spp"] / 16.0 + own["tables.resolution"] * own["tables.rays"] / 8192.0

    assert reference.shrunk(best, lowest, cost, 48.0, 64, 16) == best  # exactly what it costs
    assert reference.shrunk(best, lowest, cost, 40.0, 64, 16) == {**best, "spp": 128}
    half = reference.shrunk(best, lowest, cost, 24.0, 64, 16)
    assert half["tables.resolution"] * half["tables.rays"] == 512 * 256 and half["spp"] == 128
    assert half["pathDepth"] == 16  # it saves nothing
    least = reference.shrunk(best, lowest, cost, 1.0, 64, 16)
    assert least == {**lowest, "pathDepth": 16}
    assert reference.shrunk(best, lowest, cost, 24.0, 64, 16) == half


def test_a_kernel_of_its_own_is_given_up_where_it_takes_too_long():
    """Any one knob of two keeps the kernel another: none of them saves anything alone."""
    best = {"spp": 64, "diffraction.colors": "wavelengths", "diffraction.footprint": "exact"}
    lowest = {"spp": 16, "diffraction.colors": "auto", "diffraction.footprint": "gaussian"}

    def cost(own):
        return own["spp"] / 16.0 + (0.0 if all(own[n] == lowest[n] for n in own if n != "spp") else 30.0)

    assert reference.shrunk(best, lowest, cost, 40.0, 64, 16) == best
    assert reference.shrunk(best, lowest, cost, 20.0, 64, 16) == {**lowest, "spp": 64}


def test_values_that_a_cheaper_reference_cannot_judge_are_left_out():
    rays = KNOBS["tables.rays"].values
    assert reference.within(rays, "tables.rays", 128, 512, 128) == (8, 16, 32, 64, 128)
    assert reference.within(rays, "tables.rays", 512, 512, 128) == rays
    assert reference.within((1, 4, 16, 64), "spp", 64, 256, 16) == (1, 4, 16)
    assert reference.within((1, 4, 64), "spp", 64, 256, 64) == (1, 4, 64)  # the default stays
    cones = KNOBS["lights.cones"].values
    assert reference.within(cones, "lights.cones", "closed", "both", "closed") == cones


def test_every_knob_has_its_cheapest_value_before_any_has_a_second():
    ladders = {"tables.rays": (8, 32, 128, 512), "spp": (1, 4, 16, 64), "pathDepth": (1, 8)}
    defaults = {"tables.rays": 128, "spp": 16, "pathDepth": 8}
    first, second, third = order.levels(ladders, defaults, {"tables.rays": 512, "spp": 256, "pathDepth": 8})
    assert first == (({"spp": 1},), ({"pathDepth": 1},), ({"tables.rays": 512}, {"tables.rays": 8}))
    every = [own for level in (first, second, third) for unit in level for own in unit]
    assert len(every) == 3 + 3 + 1 and {"spp": 64} in [unit[0] for unit in second]


def test_errors_below_the_noise_of_the_reference_are_marked(slow):
    report = study(slow, 90.0)
    noisy = Report(report.rows, {**report.about, "floor": 0.6 * report.rows[0].error}, report.reference)
    assert noisy.covered(report.rows[0]) and not report.covered(report.rows[0])
    assert 0.0 < report.floor < report.rows[0].error
    assert "class='covered'" in page(noisy) and "class='covered'" not in page(report)
    assert [row["covered"] for row in noisy.record()["rows"]][0]


def test_what_renders_share_changes_no_image():
    """Tables and device data of the defaults serve others: the images are those of ``render`` alone."""
    own = shots.Shots(world(), replace(SETTINGS, knobs={"tables.resolution": 32}))
    own.take({}, 0)
    for knobs in ({"spp": 2}, {"tables.bounces": 1}, {"lights.coneTaps": 2}, {"tables.resolution": 16}, {}):
        plan = sw.make_plan(world(), replace(SETTINGS, knobs={**SETTINGS.knobs, **knobs}, seed=3))
        assert np.array_equal(own.take(knobs, 3).image, sw.render(world(), plan)["color"]), knobs
    assert own.take({"spp": 2}, 0).seconds["simulate"] >= own.stock.simulated  # as if it were alone


def test_the_defaults_have_a_bias_of_each_knob(slow):
    """Against the knob at its value in the reference with the same samples, by brute force."""
    report = study(slow, 90.0, reference={"tables.resolution": 64})
    base = next(row for row in report.knob_rows("tables.resolution") if not row.knobs)
    images = [sw.render(world(), sw.make_plan(world(), replace(SETTINGS, knobs={"tables.resolution": bins})))["color"]
              for bins in (32, 64)]  # fmt: skip
    assert base.bias == pytest.approx(rel_mse(*images)) and base.bias > 0.0
    assert next(row for row in report.rows if not row.knobs).bias is None


def test_the_reference_leaves_grooves_to_themselves():
    """A reference of full tables alone would judge grooves that are laid out by tables."""
    tabled = Study(world(), SETTINGS, None, None, None)
    assert tabled.best["scratches.model"] == "fullTable"
    laid = S.scene([S.sphere(8, 16)], [S.scratched(S.lambert(0.3), depth=75.0, model="groove")], [S.dome()])
    grooved = Study(laid, SETTINGS, None, None, None)
    assert grooved.shots.plan.on("grooves") and "scratches.model" not in grooved.best


def test_a_default_is_what_the_stage_or_the_settings_say():
    assert Study(world(), replace(SETTINGS, max_depth=3), None, None, None).default("pathDepth") == 3
    assert Study(world(), replace(SETTINGS, cone_taps=4), None, None, None).default("lights.coneTaps") == 4
    assert Study(world(), SETTINGS, None, None, None).default("spp") == 4
