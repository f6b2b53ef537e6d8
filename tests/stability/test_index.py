"""The tests that the index names exist, and the naive forms are told in the documentation."""

import ast
from functools import cache
from pathlib import Path

import pytest

from .index import HARD_CASES, rows
from .test_terms import ALL

TESTS = Path(__file__).resolve().parent.parent


@cache
def functions(path):
    return {n.name for n in ast.walk(ast.parse((TESTS / path).read_text())) if isinstance(n, ast.FunctionDef)}


@pytest.mark.parametrize("case", HARD_CASES)
def test_every_hard_case_has_its_tests(case):
    assert HARD_CASES[case]
    for test in HARD_CASES[case]:
        path, name = test.split("::")
        assert name in functions(path), test


def test_the_documentation_lists_the_stable_formulations():
    text = (TESTS.parent / "docs" / "stability.md").read_text(encoding="utf-8")
    missing = [name for name, term in ALL.items() if f"| {name} | `{term.where}` |" not in text]
    assert not missing


def test_the_documentation_lists_the_hard_cases():
    """What is missing, or of no use any more: ``python -m tests.stability.index`` prints them all."""
    text = (TESTS.parent / "docs" / "stability.md").read_text(encoding="utf-8").splitlines()
    assert [line for line in text if "::test_" in line and line.startswith("| ")] == rows()
