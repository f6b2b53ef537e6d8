"""Render a stage from all around: the camera goes about what the middle of the picture shows."""

import argparse
import sys
from collections.abc import Sequence

from . import camera_moves
from .command import Command, Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp turntable`` understands."""
    camera_moves.add_arguments(parser, frames=24)


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into; ValueError and OSError where the input is at fault."""
    return camera_moves.run(options, camera_moves.orbit)


COMMAND = Command(
    name="turntable",
    says="render a stage from all around",
    examples=(
        "scratchwarp turntable worn.usda turn.###.png --frames 36 -w 240",
        "scratchwarp turntable worn.usda turn.###.exr --frames 8 --target 0 0.05 0 --sheet turn.png",
    ),
    add_arguments=add_arguments,
    run=run,
    renders=True,
)


def main(argv: Sequence[str] | None = None) -> int:
    """Command line of this script."""
    return COMMAND.main(argv)


if __name__ == "__main__":
    sys.exit(main())
