"""The file of what knobs leave, from nothing: stages are rendered at every value of every knob, and summed up.

What is measured is kept line by line beside the file, so that the same call goes on after an interruption.
"""

import datetime
import json
import os
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from ..plan.cost.models import FORMAT, user_errors
from ..plan.knobs import KNOBS
from ..render.described import scene_digest
from ..render.progress import Progress, silent
from ..scene import Scene, Settings
from ..scene.digest import digest
from ..whole import whole
from .error_cases import Case, cases
from .knob_errors import MEASURED, Left, Rows, left, noise, summed_up, worst
from .report import machine

NOISE = "noise"
"""What a line of the noise of a stage says instead of a knob."""


class Lines:
    """Measurements so far, one a line: of a case (its digest) and a knob, or ``NOISE``."""

    def __init__(self, file: Path) -> None:
        self.file = file
        file.parent.mkdir(parents=True, exist_ok=True)
        lines = file.read_text(encoding="utf-8").splitlines() if file.is_file() else []
        self.rows = {(row["case"], row["what"]): row["found"] for row in map(_loaded, lines) if row is not None}
        with whole(file) as draft:  # without a line that an interruption cut off
            rows = ({"case": case, "what": what, "found": found} for (case, what), found in self.rows.items())
            draft.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")

    def add(self, case: str, what: str, found: Any) -> None:
        """Keep a measurement."""
        self.rows[case, what] = found
        with self.file.open("a", encoding="utf-8") as stream:
            stream.write(json.dumps({"case": case, "what": what, "found": found}) + "\n")
            stream.flush()
            os.fsync(stream.fileno())


def calibrate_errors(
    stages: Iterable[tuple[str, Scene]],
    file: Path | None = None,
    width: int = 48,
    spp: int = 32,
    progress: Progress = silent,
    knobs: Iterable[str] = MEASURED,
) -> Path:
    """Measure what knobs leave on stages and on what ``cases`` makes of them, and write it; the file.

    ``stages``: (name, scene). ``file``: None for the user's own, which error targets go by from then on. ``width`` in
    pixels and ``spp`` of all images.
    """
    target = file or user_errors()
    lines = Lines(target.with_name(f"{target.name}.part"))
    known = [(name, scene) for name, scene in stages]
    jobs: list[tuple[Case, str, str]] = []
    stage_of: dict[str, str] = {}
    for name, scene in known:
        for number, case in enumerate(cases(name, scene, Settings(width=width, spp=spp), tuple(knobs))):
            stage_of[case.name] = name
            own = digest(scene_digest(case.scene), case.settings, machine()["versions"])
            jobs += [(case, own, what) for what in ((NOISE, *case.knobs) if number == 0 else case.knobs)]
    for done, (case, own, what) in enumerate(jobs):
        progress(done, len(jobs), f"{case.name}: {what}")
        if (own, what) not in lines.rows:
            scene, settings = case.scene, case.settings
            lines.add(own, what, noise(scene, settings) if what == NOISE else asdict(left(scene, settings, (what,))))
    progress(len(jobs), len(jobs), "errors")
    found: dict[str, Left] = {}
    noises = []
    for case, own, what in jobs:
        row = lines.rows[own, what]
        if what == NOISE:
            noises.append(row)
            continue
        one = found.setdefault(case.name, Left())
        one.bias.update(row["bias"])
        one.noisier.update(row["noisier"])
    about = {"width": width, "spp": spp}
    write(target, {name: own for name, own in found.items() if own.bias}, noises, about, stage_of)
    lines.file.unlink()
    return target


def write(
    file: Path, stages: dict[str, Left], noises: Iterable[list[float]], about: dict[str, Any], stage_of: dict[str, str]
) -> Path:
    """Write what was measured.

    ``stages``: by the name of the case; ``noises``: as ``noise`` gives them; ``about``: what else is noted;
    ``stage_of``: case -> stage, of whose cases the worst counts.
    """
    known = [found for found in noises if found[2] > 0.0]
    powers = [np.log(found[0] / found[2]) / np.log(16.0) for found in known]
    groups: dict[str, list[Left]] = {}
    for name, found in stages.items():
        groups.setdefault(stage_of[name], []).append(found)
    bias = summed_up(worst(found.bias for found in own) for own in groups.values())
    noisier = summed_up((worst(found.noisier for found in own) for own in groups.values()), 1.0)
    record: dict[str, Any] = {
        "format": FORMAT,
        **machine(),
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        **about,
        "stages": {name: sorted(found.bias) for name, found in stages.items()},
        "bias": _rounded({name: bias[name] for name in KNOBS if name in bias}),
        "noisier": _rounded(noisier),
        "noise": [float(np.median([8.0 * found[1] for found in known])), float(np.clip(np.median(powers), 0.8, 1.5))],
    }
    with whole(file) as draft:
        draft.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return file


def _rounded(rows: Rows) -> Rows:
    return {name: {value: float(f"{number:.3g}") for value, number in own.items()} for name, own in rows.items()}


def _loaded(line: str) -> Any:
    """A line, or None where an interruption cut it off."""
    try:
        return json.loads(line)
    except ValueError:
        return None
