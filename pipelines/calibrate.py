"""Measure what units of work cost on this machine, as ``scratchwarp study --calibrate``, or what knobs leave.

    python -m scratchwarp.pipelines.calibrate                      # prices into the user's cache folder
    python -m scratchwarp.pipelines.calibrate costs.json           # into a file: those that are shipped are made so
    python -m scratchwarp.pipelines.calibrate errors.json --errors --stages gold patterns spoon_window

Demo stages are authored and rendered part by part; ``--stages`` takes others than the usual ones.
"""

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import scratchwarp as sw
from scratchwarp.pipelines.author_demo import author
from scratchwarp.render import bar
from scratchwarp.study import knob_errors
from scratchwarp.study.calibration import STAGES, calibrate

from .command import WrongUsage, script


def calibrated(
    quiet: bool = False, width: int = 96, file: Path | None = None, names: Sequence[str] = STAGES, cold: bool = True
) -> Path:
    """Author demo stages, render each part by part and write the prices; the file. None: that which all renders go by.
    ``cold``: compile one kernel with an empty cache, too."""
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(stage) for stage in author(folder, names=list(names))]
        scenes = [(made.stem, sw.read(made)) for made in files]
        with bar(quiet, "calibrate") as progress:
            return calibrate(scenes, file, width, progress, files[0] if cold else None)


def errors(file: Path, names: Sequence[str], width: int = 64, spp: int = 64, quiet: bool = False) -> Path:
    """Author demo stages, find what each value of each knob leaves there, and write it; the file."""
    with tempfile.TemporaryDirectory() as folder, bar(quiet, "errors") as progress:
        found, noises = {}, []
        for number, stage in enumerate(map(Path, author(folder, names=list(names)))):
            progress(number, len(names), f"errors of {stage.stem}")
            scene, settings = sw.read(stage), sw.Settings(width=width, spp=spp)
            noises.append(knob_errors.noise(scene, settings))
            for name, variant in knob_errors.variants(scene, settings).items():
                found[" ".join((stage.stem, name)).strip()] = knob_errors.left(*variant)
        return knob_errors.write(file, found, noises, progress)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What this script understands."""
    parser.add_argument("file", nargs="?", type=Path, help="where to write; of prices none is the user's own file")
    parser.add_argument("--errors", action="store_true", help="measure what knobs leave instead; FILE is needed")
    parser.add_argument("--stages", nargs="+", default=list(STAGES), metavar="NAME", help="demo stages to render")
    parser.add_argument("--width", type=int, default=96, help="of the images in pixels [96]")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")


def run(options: argparse.Namespace) -> list[Path]:
    """Measure, and return the file written."""
    if options.errors and options.file is None:
        raise WrongUsage("--errors needs a FILE")
    if options.errors:
        return [errors(options.file, options.stages, options.width, quiet=options.quiet)]
    return [calibrated(options.quiet, options.width, options.file, options.stages)]


main = script("calibrate", __doc__, add_arguments, run)

if __name__ == "__main__":
    sys.exit(main())
