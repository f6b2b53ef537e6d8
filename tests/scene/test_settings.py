"""Settings check themselves."""

import pytest

from scratchwarp import Settings


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("width", 1.5),
        ("spp", True),
        ("seed", -1),
        ("crop", (0, 1)),
        ("crop", "whole"),
        ("crop", (0.0, float("nan"), 0.0, 1.0)),
        ("effects", ["shadows"]),
        ("effects", {"shadows": "off"}),
        ("integrator", "bidirectional"),
    ],
)
def test_what_cannot_be_names_the_argument_and_the_value(name, value):
    shown = value["shadows"] if isinstance(value, dict) else value
    with pytest.raises(ValueError) as error:
        Settings(**{name: value})
    assert f"{name}" in str(error.value) and str(shown) in str(error.value)
