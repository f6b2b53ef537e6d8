"""Single terms in the renderer's arithmetic at their hardest inputs, against float64.

Tolerances are those of float32 (2^-24 of each step of a term), float64 where the device's are; looser ones are said in
``terms``: what the inputs themselves hold, rounded to float32.
"""

import pytest

from .late_terms import LATE
from .terms import TERMS

ALL = {**TERMS, **LATE}


@pytest.mark.parametrize("name", ALL)
def test_stable(name):
    term = ALL[name]
    values = term.run()
    assert term.off(values).max() <= 1.0, (values, term.expected())
