"""Sizes that leave nothing of a layer and an up axis that USD does not know: said by the reader and the validator."""

import pytest

from scratchwarp import stage
from scratchwarp.scene import StageError
from scratchwarp.stage.validation import validate

from .test_layer import PROFILE, VEE, layer, scratched

LAYER = "scratch:layer:fine:"
SIZES = [
    ("float {0}width = 0", "width", "invisible"),
    ("float {0}length = 0", "length", "as long as they are wide"),
    ("float {0}coverage = 0", "coverage", "invisible"),
    ("float {0}depth = 0", "depth", "flat"),
    ('float {0}pitch = 0\nuniform token {0}distribution = "linear"', "pitch", "invisible"),
]


@pytest.mark.parametrize(("body", "name", "said_of_it"), SIZES)
def test_sizes_of_nothing_are_said(read, write, said, body, name, said_of_it):
    text = scratched(PROFILE + body.format(LAYER) + "\n", children=VEE)
    scene = read(text)
    said(scene, "/mat layer 'fine'", f"{name}", said_of_it)
    assert layer(scene)
    found = [f for f in validate(write(text), core=False) if name in str(f)]
    assert found, validate(write(text), core=False)


def test_other_layers_are_silent(read, write):
    text = scratched(PROFILE, children=VEE)
    assert not any("layer 'fine'" in w for w in read(text).warnings)
    assert not validate(write(text), core=False)


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("float {0}profileVariation = 0.5", ("profileVariation", "without profileEnd")),
        ("rel {0}profileEnd = </mat/Vee>", ("profileEnd", "without profileVariation")),
        ("float {0}variationLength = 500", ("variationLength", "no effect")),
    ],
)
def test_variations_that_vary_nothing(write, body, words):
    found = validate(write(scratched(PROFILE + body.format(LAYER) + "\n", children=VEE)), core=False)
    assert len(found) == 1 and all(w in str(found[0]) for w in words), found


def test_an_unknown_up_axis(write):
    path = write(scratched(PROFILE, children=VEE), up="X")
    with pytest.raises(StageError, match=r"stage.usda: upAxis is 'X'; author 'Y' or 'Z'"):
        stage.read(path)
    assert any("upAxis is 'X'" in str(f) for f in validate(path, core=False))
