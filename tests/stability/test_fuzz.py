"""Some stages damaged at random, and those that once failed; ``fuzz`` runs any number of them."""

import numpy as np
import pytest

from .fuzz import FINE, plain, run_one
from .mutate import mutate
from .stages import GEOMETRY, LIGHTS, SURFACES, stage

STAGES = 30
# Stages that once failed, and by what.
ONCE = {
    4: "a scratched surface under a light with a specular multiplier did not compile",
    44: "a million grooves were laid out before they were counted",
    310: "a camera whose far plane is a millimetre away had no matrix of depths",
    1365: "a shape's displayColor was a file",
    1404: "a shape's displayColor was one number",
    2057: "a layer of grooves had curves without points",
}
_compiled: set = set()


@pytest.mark.parametrize("seed", [*range(100, 100 + STAGES), *ONCE])
def test_damaged_stages(tmp_path, seed):
    """One kernel is compiled; what needs another is built but not traced."""
    outcome = run_one(seed, tmp_path, _compiled, 1, plain)
    assert outcome.what in FINE, outcome


def test_the_same_number_is_the_same_stage():
    texts = [mutate(rng, stage(rng)) for rng in (np.random.default_rng(7), np.random.default_rng(7))]
    assert texts[0] == texts[1]


def test_stages_have_one_of_everything():
    text = "".join(stage(np.random.default_rng(seed)) for seed in range(60))
    for made in (*GEOMETRY.values(), *(v for k, v in LIGHTS.items() if k != "even sky")):
        assert made.splitlines()[1 if made.startswith("\n") else 0] in text
    assert all(made.splitlines()[1].strip() in text for made in SURFACES.values())
