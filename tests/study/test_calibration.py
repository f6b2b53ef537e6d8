"""Prices fitted to measurements, and what knobs leave."""

import pytest

from scratchwarp.study.calibration import PRIOR, fitted
from scratchwarp.study.knob_errors import summed_up


def test_prices_are_found_and_never_below_zero():
    """Seconds made from known prices: the prior pulls by less than a tenth."""
    true = {"camera": 900.0, "base": 300.0, "shadows": 100.0}
    rows = [{"camera": 1e6, "base": b * 1e6, "shadows": s * 1e6} for b in (0.0, 0.5, 1.0, 2.0) for s in (0.0, 1.0, 4.0)]
    seconds = [1e-9 * sum(true[unit] * n for unit, n in row.items()) for row in rows]
    found = fitted(rows, seconds, ridge=1e-4)
    assert all(found[unit] == pytest.approx(ns, rel=0.1) for unit, ns in true.items())
    assert min(fitted(rows, [1e-9 * 5e5 * row["camera"] / 1e6 for row in rows]).values()) >= 0.0


def test_what_nothing_tells_is_the_prior():
    found = fitted([{"camera": 1e6, "lens": 0.0}], [1e-3])
    assert found["lens"] == pytest.approx(PRIOR["lens"], rel=1e-6)


def test_biases_of_stages_are_summed_up_by_what_most_stay_below():
    stages = [{"tables.rays": {"8": 0.1 * k, "16": 0.02, "32": 0.03}} for k in range(1, 6)]
    made = summed_up(stages)["tables.rays"]
    assert made["8"] == pytest.approx(0.42)  # four fifths of five
    assert made["16"] == made["32"] == pytest.approx(0.03) and made["512"] == 0.0  # it never rises
