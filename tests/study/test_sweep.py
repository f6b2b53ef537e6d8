"""Sweeps of error against time, on a ball of a few pixels."""

import csv
import json
import re
from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.study.measurement import Measurement, Notebook
from scratchwarp.study.measures import flip, rel_mse
from scratchwarp.study.report import Report

from ..render import scenes as S

SETTINGS = sw.Settings(
    width=12, height=12, spp=4, filter="box", tile=16, effects=S.EVERYTHING, knobs={"tables.resolution": 32}
)
LADDERS = {"spp": (1, 4, 16), "tables.bounces": (1, 3, 2000)}


def world():
    return S.scene([S.sphere(8, 16)], [S.scratched(S.lambert(0.3), depth=75.0)], [S.dome()])


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    report = sw.study.sweep(world(), LADDERS, repeats=2, settings=SETTINGS, folder=folder)
    report.write(folder)
    return report, folder


def test_every_setting_is_rendered_in_every_round(done):
    report, _ = done
    assert [row.name for row in report.rows] == ["defaults", "spp=1", "spp=16", "tables.bounces=1", "tables.bounces=3"]
    assert all(row.rounds == 2 and row.seconds > 0.0 and row.fastest <= row.slowest for row in report.rows)
    assert report.about["seeds"] == [0, 1]
    assert report.about["reference"]["tables.bounces"] == 2000 and report.about["reference"]["spp"] == 256


def test_errors_fall_towards_the_reference(done):
    """Noise of independent samples falls to a quarter with four times as many; two thirds are asked for."""
    report, _ = done
    spp = [row.error for row in report.knob_rows("spp")]
    assert 0.7 * spp[0] > spp[1] and 0.7 * spp[1] > spp[2] > 1e-6
    bias = [row.bias for row in report.knob_rows("tables.bounces") if row.bias is not None]
    assert len(bias) == 2 and bias[0] > bias[1] > 0.0


def test_tables_have_an_error_of_their_own(done):
    """More bounces bring the table closer to that of 2000; samples do not touch it."""
    report, _ = done
    found = {row.name: row.table for row in report.rows}
    assert found["spp=16"] is None
    assert found["tables.bounces=1"] > found["tables.bounces=3"] > found["defaults"] == 0.0


def test_a_knob_falls_or_does_not(done):
    report, _ = done
    assert report.falls("spp") and report.falls("tables.bounces")
    rising = tuple(replace(row, bias=1.0 / row.bias if row.bias else None) for row in report.rows)
    assert not replace(report, rows=rising).falls("tables.bounces")


def test_what_the_plan_takes_has_no_place_among_the_values():
    """With "auto" 16 wavelengths are taken: their bias lies between those of 8 and 32, and the values fall all the
    same."""

    def one(value, bias, beside=None):
        knobs = {} if value == "auto" else {"diffraction.wavelengths": value}
        return Measurement(knobs, 0, {"trace": 1.0}, 1.0, 0.01, bias, beside=beside)

    found = [one("auto", None), one(4, 0.3), one(8, 0.1), one(32, 0.01), one(64, None, beside=0.05)]
    about = {"defaults": {"diffraction.wavelengths": "auto"}}
    report = Report(Report.rows_of(found), about, np.zeros((1, 1, 3)))
    assert report.knob_rows("diffraction.wavelengths")[0].bias == 0.05
    assert report.falls("diffraction.wavelengths")
    found[2] = one(8, 0.4)
    assert not Report(Report.rows_of(found), about, report.reference).falls("diffraction.wavelengths")


def one(knob, value, default, bias=None, error=0.01, unsure=0.0, beside=None):
    knobs = {} if value == default else {knob: value}
    return Measurement(knobs, 0, {"trace": 1.0}, 1.0, error, bias, beside=beside, unsure=unsure)


def falls(knob, default, rows):
    return Report(Report.rows_of(rows), {"defaults": {knob: default}}, np.zeros((1, 1, 3))).falls(knob)


@pytest.mark.parametrize(("unsure", "good"), [(0.0005, False), (0.007, True)])
def test_the_noise_of_biases_counts(unsure, good):
    """Few bright pixels carry both biases: 0.0219 after 0.0167 is no rise where each is known to 0.007."""
    knob, default = "scratches.coverageFilter", "sample"
    rows = [one(knob, "sample", default), one(knob, "pixel", default, 0.0167, unsure=unsure)]
    rows.append(one(knob, "point", default, beside=0.0219, unsure=unsure))
    assert falls(knob, default, rows) == good


def test_alternatives_have_no_place_in_the_order():
    """Mirrors are close on metals and far off on dielectrics, and in neither case are the others out of order; they are
    where the dearest value is worse than an alternative, or where they rise themselves."""
    knob, default = "scratches.model", "table"

    def models(mirror, tabulated=1e-3, table=1e-8):
        rows = [one(knob, "table", default), one(knob, "ashikhminShirley", default, 0.01)]
        rows += [one(knob, "tabulatedNdf", default, tabulated), one(knob, "mirror", default, mirror)]
        return [*rows, one(knob, "singleBounce", default, 1e-5), one(knob, "fullTable", default, beside=table)]

    assert falls(knob, default, models(1.0)) and falls(knob, default, models(5e-4))
    assert not falls(knob, default, models(1.0, tabulated=0.05))  # the tenth is one of those in order
    assert not falls(knob, default, models(1e-6, table=0.002))
    knob, default = "lights.cones", "closed"
    noisy = [one(knob, value, default, error=e) for value, e in (("closed", 0.16), ("lights", 0.17), ("cones", 16.0))]
    assert falls(knob, default, noisy)
    noisy[0] = one(knob, "closed", default, error=17.9)
    assert not falls(knob, default, noisy)


def test_the_front_is_what_nothing_beats(done):
    front = done[0].pareto()
    assert front and all(a.seconds <= b.seconds and a.error >= b.error for a, b in zip(front, front[1:], strict=False))


def test_files_say_the_same_and_need_no_network(done):
    report, folder = done
    page = (folder / "report.html").read_text()
    assert not re.search(r"""(src|href)=["'](?!data:)""", page) and "http" not in page.replace("http://www.w3.org", "")
    for text in ("<svg", "data:image/png;base64,", "spp=16", "Seeds", "Raymond", "processors"):
        assert text in page
    rows = json.loads((folder / "report.json").read_text())["rows"]
    assert [row["error"] for row in rows] == [row.error for row in report.rows]
    with (folder / "report.csv").open() as stream:
        assert [row["name"] for row in csv.DictReader(stream)] == [row.name for row in report.rows]
    assert {p.name for p in folder.glob("*.png")} >= {"reference.png", "defaults.png", "spp=16.png"}


def test_an_interrupted_study_goes_on(done, tmp_path, monkeypatch):
    _, folder = done
    lines = (folder / "measurements.jsonl").read_text().splitlines()
    (tmp_path / "measurements.jsonl").write_text("\n".join([*lines[:-1], lines[-1][:20]]))
    reference = next((folder / ".images").glob("*-reference.npz"))
    (tmp_path / reference.name).write_bytes(reference.read_bytes())
    measured = []
    add = Notebook.add
    monkeypatch.setattr(Notebook, "add", lambda self, row: (measured.append(row), add(self, row)))
    again = sw.study.sweep(world(), LADDERS, repeats=2, settings=SETTINGS, folder=tmp_path)
    assert [(dict(row.knobs), row.repeat) for row in measured] == [({"tables.bounces": 3}, 1)]
    assert [row.error for row in again.rows] == [row.error for row in done[0].rows]


def test_the_joint_search_turns_several(tmp_path):
    report = sw.study.sweep(world(), {"spp": (1, 4), "tables.bounces": (1, 2000)}, {"spp": 8}, 1, SETTINGS, budget=60.0)
    assert {"spp": 1, "tables.bounces": 1} in [dict(row.knobs) for row in report.rows]


@pytest.mark.parametrize(
    ("knobs", "repeats", "says"),
    [(("glitter",), 1, "'glitter'; the knobs are"), ({"spp": (0,)}, 1, "spp is 0"), (("spp",), 0, "repeats")],
)
def test_what_cannot_be_is_said(knobs, repeats, says):
    with pytest.raises(ValueError, match=says):
        sw.study.sweep(world(), knobs, repeats=repeats, settings=SETTINGS)


def test_measures():
    rng = np.random.default_rng(0)
    reference = rng.uniform(0.2, 1.0, (8, 8, 3))
    off = reference * (1.0 + 0.1 * rng.choice([-1.0, 1.0], (8, 8, 1)))
    # a grey image off by a tenth everywhere: 0.01 r^2 / (r^2 + 0.01 m^2)
    grey = np.full((8, 8, 3), 0.5)
    assert rel_mse(1.1 * grey, grey) == pytest.approx(0.01 / 1.01)
    assert rel_mse(7 * off, 7 * reference) == pytest.approx(rel_mse(off, reference))
    assert rel_mse(grey, 0.0 * grey) == 0.0
    assert flip(reference, reference) in (0.0, None)


def test_a_slow_moment_of_the_machine_does_not_count():
    """Everything in the second round took five times as long: seconds are those of the median round all the same."""
    rows = [Measurement({}, n, {"trace": t}, t, 0.1) for n, t in enumerate((1.0, 5.0, 1.0))]
    rows += [Measurement({"spp": 64}, n, {"trace": 2 * t}, t, 0.01) for n, t in enumerate((1.0, 5.0, 1.0))]
    base, finer = Report.rows_of(rows)
    assert (base.seconds, finer.seconds, finer.slowest) == (1.0, 2.0, 2.0)
    assert base.front and finer.front
