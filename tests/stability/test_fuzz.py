"""Some stages damaged at random, and those that once failed; ``fuzz`` runs any number of them."""

import sys

import numpy as np
import pytest

from .apart import Apart
from .fuzz import FINE
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
    2013: "grooves two hundred times as wide as they were apart left a ray without the pieces near it",
    2057: "a layer of grooves had curves without points",
    2253: "the same as 2057",
    2612: "the lobe of a cross-section of 64 facets was summed at each of a thousand places for each scratch",
    2650: "the same as 2612",
    3085: "millions of scratches followed a map of directions before a few of them told that they are far too many",
    3258: "an instancer's indices were a word",
    3346: "the same of a bell, twice a material",
    3355: "the same as 3085",
    3385: "the file of a texture was a string",
    3442: "the file of a light was true or false",
    3594: "the same as 3442",
    3600: "the same as 3258",
    3604: "the file of a light was a vector",
    3887: "a mesh's counts of corners were a file",
    4624: "a surface that glowed at 3e38 lit another one",
}


@pytest.fixture(scope="module")
def apart():
    """A process that may hang or crash."""
    process = Apart()
    yield process
    process.close()


@pytest.mark.parametrize("seed", [*range(100, 100 + STAGES), *ONCE])
def test_damaged_stages(tmp_path, seed, apart):
    """One kernel is compiled; what needs another is built but not traced."""
    outcome = apart.run(seed, tmp_path)
    assert outcome.what in FINE, outcome


@pytest.mark.parametrize(
    ("does", "what"),
    [("while True: pass", "hang"), ("os.kill(os.getpid(), 11)", "crash"), ("print(line, flush=True)", "image")],
)
def test_a_stage_that_never_ends_is_a_failure(tmp_path, does, what):
    """Reported, and the next one has a process of its own."""
    script = "import json, os, sys\nfor line in sys.stdin:\n seed = json.loads(line)[0]\n"
    script += " line = json.dumps({'seed': seed, 'what': 'image'})\n " + does
    process = Apart((sys.executable, "-c", script), patience=1)
    assert [process.run(seed, tmp_path).what for seed in (5, 6)] == [what, what]
    process.close()


def test_the_same_number_is_the_same_stage():
    texts = [mutate(rng, stage(rng)) for rng in (np.random.default_rng(7), np.random.default_rng(7))]
    assert texts[0] == texts[1]


def test_stages_have_one_of_everything():
    text = "".join(stage(np.random.default_rng(seed)) for seed in range(60))
    for made in (*GEOMETRY.values(), *(v for k, v in LIGHTS.items() if k != "even sky")):
        assert made.splitlines()[1 if made.startswith("\n") else 0] in text
    assert all(made.splitlines()[1].strip() in text for made in SURFACES.values())
