"""Each stable formulation, turned back to its naive form, fails its test: ``test_terms.py::test_stable[NAME]``."""

from pathlib import Path

import pytest

import scratchwarp

from .test_terms import ALL

PACKAGE = Path(scratchwarp.__file__).parent


@pytest.mark.parametrize("name", ALL)
def test_the_naive_form_misses_what_the_stable_one_meets(name):
    term = ALL[name]
    values = term.naively()
    assert term.off(values).max() > 1.0, (values, term.expected())
    file, function = term.where.split(":")
    assert f"def {function}(" in (PACKAGE / file).read_text()
