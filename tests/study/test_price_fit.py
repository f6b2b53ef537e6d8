"""Prices fitted to made-up measurements; nothing is timed."""

import numpy as np
import pytest

from scratchwarp.plan.cost.models import shipped
from scratchwarp.plan.cost.work import Work
from scratchwarp.study.calibration import Sample, prices
from scratchwarp.study.price_fit import LEAST, fitted, known_prices, machine_speed

KNOWN = {"camera": 1000.0, "base": 200.0, "rect": 400.0, "dome": 500.0, "rays": 300.0, "lines": 300.0, "lens": 20.0}
SLOWER = 3.0
TRUE = {unit: SLOWER * ns * (5.0 if unit == "rect" else 1.0) for unit, ns in KNOWN.items()}


def seconds(row, true):
    return sum(1e-9 * true[unit] * n for unit, n in row.items())


def measurements(rng, number=16):
    """Every third has a rect light that takes most of its time, every third lines and rays, always two to one."""
    rows = []
    for k in range(number):
        row = {"camera": 1e6, "base": 1e6 * rng.uniform(0.5, 2.0), "dome": 1e6 * rng.uniform(0.0, 2.0)}
        if k % 3 == 0:
            row["rect"] = 1e6 * rng.uniform(1.0, 4.0)
        if k % 3 == 1:
            row["rays"] = 1e6 * rng.uniform(2.0, 8.0)
            row["lines"] = 2.0 * row["rays"]
        rows.append(row)
    return rows


def test_a_machine_three_times_slower_with_one_price_of_its_own():
    """The price that measurements hang on is found; those that none tells apart, and those that none has, are three
    times the known ones. The prior, 0.03 of a measurement's weight, pulls log 5 at six measurements by less than
    0.03 / 6 over the squared share of about a half: a twentieth or so."""
    rows = measurements(np.random.default_rng(5))
    taken = [seconds(row, TRUE) for row in rows]
    assert machine_speed(rows, taken, KNOWN) == pytest.approx(SLOWER, rel=0.05)
    found = fitted([*rows, {"camera": 1e6, "base": 1e6, "lens": 0.0}], [*taken, 3.6], known=KNOWN)
    assert found["rect"] == pytest.approx(TRUE["rect"], rel=0.1)
    assert all(found[unit] == pytest.approx(TRUE[unit], rel=0.1) for unit in ("camera", "base", "dome"))
    assert all(found[unit] == pytest.approx(TRUE[unit], rel=0.1) for unit in ("rays", "lines"))
    assert found["lens"] == pytest.approx(TRUE["lens"], rel=0.05)


def test_units_that_nothing_tells_apart_do_not_take_one_anothers_share():
    """Rays and lines nearly two to one where prices are fitted, ten to one on another stage; times are off by up to
    a quarter. With prices from the measurements alone one of the two often falls to nothing."""
    rng, off = np.random.default_rng(11), []
    for _ in range(20):
        rows = measurements(rng)
        for row in rows:
            if "rays" in row:
                row["lines"] *= rng.uniform(0.9, 1.1)
        taken = [seconds(row, TRUE) * np.exp(rng.uniform(-0.25, 0.25)) for row in rows]
        found = fitted(rows, taken, known=KNOWN)
        other = {"camera": 1e6, "base": 1e6, "rays": 4e6, "lines": 4e7}
        off.append(seconds(other, found) / seconds(other, TRUE))
        assert min(found.values()) > 0.0
    assert 0.7 < min(off) and max(off) < 1.4  # the quarter, the prior and what rays take


def test_a_price_may_move_as_far_as_it_must():
    """One of a hundredth and one of a hundred times, each alone in four measurements."""
    true = {"a": 1.0, "b": 10000.0, "c": 100.0}
    known = dict.fromkeys(true, 100.0)
    rows = [{unit: 1e6 * k} for unit in true for k in (1, 2, 3, 4)]
    found = fitted(rows, [seconds(row, true) for row in rows], known=known, speed=1.0)
    assert all(found[unit] == pytest.approx(ns, rel=0.05) for unit, ns in true.items())  # 100^(0.03 / 4) = 1.035


def test_without_measurements_prices_are_those_known():
    assert fitted([], []) == {} and machine_speed([], []) == 1.0
    assert fitted([{}], [1.0]) == {}
    known, own = known_prices(), shipped().nanoseconds
    assert known["camera"] == own["camera"] and min(known.values()) > 0.0
    assert known["grooves.rays"] >= LEAST * 300.0  # none is held at 0 for good


def test_all_prices_follow_the_machine():
    """Stages made up from the shipped prices, on a machine three times slower whose tables are ten times slower: tables
    and their cells tell of themselves, domes and what no stage has of the machine."""
    known = known_prices()
    slow = {unit: SLOWER * ns for unit, ns in known.items()}
    slow |= {unit: 10.0 * known[unit] for unit in ("tables.table", "tables.cell")}
    rng, samples = np.random.default_rng(3), []
    for k in range(8):
        each = {("", "camera"): 1.0, ("", "base"): rng.uniform(0.3, 1.0), ("", "lights.dome"): float(k % 2)}
        table = {("", "tables.table"): 1.0, ("", "tables.cell"): 10.0 ** (3 + k % 4)}
        build = {("", "build.triangles"): 1e4, ("", "build.kernel"): 1.0}
        made = Work(1e6, each, table, build, 0.5 * (k % 2))

        def sum_of(units):
            return sum(1e-9 * slow[unit] * n for (_, unit), n in units.items())

        later = 1.0 + shipped().indirect * made.indirect
        camera = 1e-9 * slow["camera"]
        trace = 1e6 * (camera + (sum_of(each) - camera) * later)
        samples.append(Sample(str(k), made, ((table, sum_of(table)),), sum_of(build), trace))
    found, indirect, spread = prices(samples)
    assert indirect == pytest.approx(shipped().indirect, rel=0.1) and spread < 1.05
    assert set(known) <= set(found)
    for unit, ns in found.items():
        assert ns == pytest.approx(slow[unit], rel=0.15), unit
