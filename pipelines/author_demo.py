"""Write the demo stages: ball.usda, kettle.usda, panel.usda and plain.usda, and on request those that diffract.

They are the stages of the README's picture, of the tests and of the benchmarks. To be asked for with --only: fine
scratches that diffract on spoon, spoon_star, spoon_window, spoon_dome, disc and vinyl; the materials gold, painted,
plastic and wood; patterns, shallow and steep; zoom, four decades of distance; grooves one by one on
grooves_parallel and grooves_crossing, both with a twin _true of real triangles, grooved_sphere, vinyls, roof, column.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from .command import script
from .demo_ball import ball
from .demo_disc import disc
from .demo_engraved import column, roof, vinyls
from .demo_grooved_sphere import grooved_sphere
from .demo_grooves import grooves_crossing, grooves_crossing_true, grooves_parallel, grooves_parallel_true
from .demo_kettle import kettle
from .demo_materials import gold, painted, plastic, wood
from .demo_panel import panel
from .demo_patterns import patterns
from .demo_plain import plain
from .demo_spoon import spoon, spoon_dome, spoon_star, spoon_window
from .demo_vinyl import vinyl
from .demo_zoom import zoom

__all__ = ["DEFAULT", "STAGES", "author", "ball", "disc", "kettle", "main", "panel", "plain", "spoon", "vinyl"]

STAGES: dict[str, Callable[[Path, float], Path]] = {
    "ball": ball,
    "kettle": kettle,
    "panel": panel,
    "plain": plain,
    "spoon": spoon,
    "spoon_star": spoon_star,
    "spoon_window": spoon_window,
    "spoon_dome": spoon_dome,
    "disc": disc,
    "vinyl": vinyl,
    "gold": gold,
    "painted": painted,
    "plastic": plastic,
    "wood": wood,
    "patterns": patterns,
    "zoom": zoom,
    "grooves_parallel": grooves_parallel,
    "grooves_parallel_true": grooves_parallel_true,
    "grooves_crossing": grooves_crossing,
    "grooves_crossing_true": grooves_crossing_true,
    "grooved_sphere": grooved_sphere,
    "vinyls": vinyls,
    "roof": roof,
    "column": column,
}
DEFAULT = ("ball", "kettle", "panel", "plain")


def author(out_dir: Path | str, detail: float = 1.0, names: Sequence[str] = DEFAULT) -> list[Path]:
    """Write ``names`` into ``out_dir`` and return their paths; files of an earlier run are replaced.

    Args:
        out_dir: folder, made when it is not there.
        detail: scales the number of faces and curve points; 0.1 makes small stages for tests.
        names: some of ``STAGES``.

    Raises:
        ValueError: an unknown name, or a detail that is not positive.
        OSError: the folder cannot be written.
    """
    unknown = [name for name in names if name not in STAGES]
    if unknown:
        raise ValueError(f"names has {unknown[0]!r}, expected some of {', '.join(STAGES)}")
    if not 0 < detail <= 16:
        raise ValueError(f"detail is {detail}, expected a value in (0, 16]")
    return [STAGES[name](Path(out_dir) / f"{name}.usda", detail) for name in names]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What this script understands."""
    parser.add_argument("out_dir", type=Path, help="folder to write into; made when it is not there")
    parser.add_argument("--detail", type=float, default=1.0, help="scales the number of faces [1]")
    parser.add_argument(
        "--only", nargs="+", choices=tuple(STAGES), default=DEFAULT, metavar="NAME",
        help=f"write only these of {', '.join(STAGES)}",
    )  # fmt: skip


def run(options: argparse.Namespace) -> list[Path]:
    """Write the stages."""
    return author(options.out_dir, options.detail, options.only)


main = script(
    "author_demo", __doc__, add_arguments, run,
    "python -m scratchwarp.pipelines.author_demo stages --only ball --detail 2",
)  # fmt: skip

if __name__ == "__main__":
    sys.exit(main())
