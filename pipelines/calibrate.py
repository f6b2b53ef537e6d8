"""Measure what units of work cost on this machine: ``scratchwarp study --calibrate``."""

import tempfile
from pathlib import Path

import scratchwarp as sw
from scratchwarp.pipelines.author_demo import author
from scratchwarp.render import bar
from scratchwarp.study.calibration import STAGES, calibrate


def calibrated(quiet: bool = False, width: int = 96) -> Path:
    """Author demo stages, render each part by part and write the prices; the file, which all renders go by."""
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(stage) for stage in author(folder, names=list(STAGES))]
        scenes = [(file.stem, sw.read(file)) for file in files]
        first = next(file for file in files if file.stem == STAGES[0])
        with bar(quiet, "calibrate") as progress:
            return calibrate(scenes, width=width, progress=progress, compile_stage=first)
