"""Render a stage from ever nearer: the camera goes towards what the middle of the picture shows."""

import argparse
import sys
from collections.abc import Iterator
from typing import Any

from . import camera_moves
from .command import Command, Report, WrongUsage

Array = Any  # of NumPy, which loads when a pipeline runs


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp zoom`` understands."""
    camera_moves.add_arguments(parser, frames=12)
    parser.add_argument("--to", type=float, default=0.01, help="last distance, as a share of the first [0.01]")


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into; ValueError and OSError where the input is at fault."""
    if not 1e-6 <= options.to <= 1e6:
        raise WrongUsage(f"--to {options.to} is not in [1e-6, 1e6]")

    def moves(scene: Any, about: Array, count: int) -> Iterator[Any]:
        return camera_moves.approach(scene, about, count, options.to)

    return camera_moves.run(options, moves)


COMMAND = Command(
    name="zoom",
    says="render a stage from ever nearer",
    examples=("scratchwarp zoom worn.usda near.###.png --frames 9 --to 0.02 -w 240 --sheet near.png",),
    add_arguments=add_arguments,
    run=run,
    renders=True,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
