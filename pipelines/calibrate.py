"""Measure what units of work cost on this machine, as ``scratchwarp study --calibrate``, or what knobs leave.

    python -m scratchwarp.pipelines.calibrate                      # prices into the user's cache folder
    python -m scratchwarp.pipelines.calibrate costs.json           # into a file: those that are shipped are made so
    python -m scratchwarp.pipelines.calibrate --errors             # what knobs leave, beside the user's prices
    python -m scratchwarp.pipelines.calibrate errors.json --errors # into a file
    python -m scratchwarp.pipelines.calibrate errors.json --errors --stages gold patterns --knobs lights.coneTaps

Demo stages are authored and rendered part by part; ``--stages`` takes others than the usual ones. Errors are kept as
they are measured in FILE.part: after an interruption the same command goes on where it stopped.
"""

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import scratchwarp as sw
from scratchwarp.pipelines.author_demo import author
from scratchwarp.render import bar
from scratchwarp.study import error_cases
from scratchwarp.study.calibration import STAGES, calibrate
from scratchwarp.study.error_calibration import calibrate_errors
from scratchwarp.study.knob_errors import MEASURED

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


def errors(
    quiet: bool = False,
    file: Path | None = None,
    names: Sequence[str] = error_cases.STAGES,
    width: int = 48,
    spp: int = 32,
    knobs: Sequence[str] = MEASURED,
) -> Path:
    """Author demo stages, find what each value of each knob leaves there, and write it; the file. None: that which all
    renders go by."""
    with tempfile.TemporaryDirectory() as folder, bar(quiet, "errors") as progress:
        files = [Path(stage) for stage in author(folder, names=list(names))]
        return calibrate_errors(((made.stem, sw.read(made)) for made in files), file, width, spp, progress, knobs)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What this script understands."""
    parser.add_argument("file", nargs="?", type=Path, help="where to write; none is the user's own file")
    parser.add_argument("--errors", action="store_true", help="measure what knobs leave instead of prices")
    parser.add_argument("--stages", nargs="+", metavar="NAME", help="demo stages to render [the usual ones]")
    parser.add_argument("--knobs", nargs="+", default=list(MEASURED), metavar="NAME", help="of --errors [all]")
    parser.add_argument("--width", type=int, help="of the images in pixels [96; of --errors 48]")
    parser.add_argument("--spp", type=int, default=32, help="samples a pixel of --errors [32]")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")


def run(options: argparse.Namespace) -> list[Path]:
    """Measure, and return the file written."""
    for name in options.knobs:
        if name not in MEASURED:
            raise WrongUsage(f"--knobs {name!r} is not one of {', '.join(MEASURED)}")
    if options.errors:
        names = options.stages or error_cases.STAGES
        return [errors(options.quiet, options.file, names, options.width or 48, options.spp, options.knobs)]
    return [calibrated(options.quiet, options.width or 96, options.file, options.stages or STAGES)]


main = script("calibrate", __doc__, add_arguments, run)

if __name__ == "__main__":
    sys.exit(main())
