"""Render a stage from all around: the camera goes about what the middle of the picture shows, or geometry turns."""

import argparse
import sys
from collections.abc import Iterator
from typing import Any

from . import camera_moves
from .command import Command, Report, WrongUsage

Array = Any  # of NumPy, which loads when a pipeline runs


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp turntable`` understands."""
    camera_moves.add_arguments(parser, frames=24)
    parser.add_argument("--turn", choices=("camera", "object"), default="camera", help="which turns [camera]")
    parser.add_argument("--object", default="", metavar="PATH", help="with --turn object: what is below this alone")


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into; ValueError and OSError where the input is at fault."""
    if options.object and options.turn != "object":
        raise WrongUsage("--object is of --turn object; add that")
    if options.turn == "camera":
        return camera_moves.run(options, camera_moves.orbit)

    def moves(scene: Any, about: Array, count: int) -> Iterator[Any]:
        return camera_moves.spin(scene, about, count, options.object)

    return camera_moves.run(options, moves)


COMMAND = Command(
    name="turntable",
    says="render a stage from all around",
    examples=(
        "scratchwarp turntable worn.usda turn.###.png --frames 36 -w 240",
        "scratchwarp turntable worn.usda turn.###.png --turn object --object /World/geo/cup --target 0 0.05 0",
        "scratchwarp turntable worn.usda turn.###.exr --frames 8 --target 0 0.05 0 --sheet turn.png",
    ),
    add_arguments=add_arguments,
    run=run,
    renders=True,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
