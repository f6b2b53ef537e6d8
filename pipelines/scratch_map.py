"""Make a seamless normal map of scratches, as Kang and Cho do: hemispheres engraved into a plane, stretched at random
or along a direction. Any renderer that knows UsdPreviewSurface can use it.
"""

import argparse
import math
import sys
from pathlib import Path
from typing import Any

from .command import script

_STAGES = (".usda", ".usdc", ".usd")


def author(out: Path | str, stage: Path | str | None = None, repeat: float = 1.0, **shape: Any) -> list[Path]:
    """Write the map, and a stage that shows it on a square metre of metal where ``stage`` names one.

    Args:
        out: .png (16 bits) or .exr (float); a normal n is kept as 0.5 n + 0.5.
        stage: .usda, .usdc or .usd; its texture reads ``out`` relative to it, repeated ``repeat`` times each way.
        shape: as ``scratchwarp.mdf.scratch_map`` has them: resolution, density, length, width, depth, direction
            [rad], spread [rad], variation, seed.

    Returns the files written. Raises ValueError naming the argument, OSError where a file cannot be written.
    """
    from scratchwarp import image, mdf

    from .scratch_plate import plate

    target = Path(out)
    if target.suffix.lower() not in image.NORMAL_SUFFIXES:
        raise ValueError(f"{target}: the suffix {target.suffix!r} is not one of {', '.join(image.NORMAL_SUFFIXES)}")
    if stage is not None and Path(stage).suffix.lower() not in _STAGES:
        raise ValueError(f"{stage}: the suffix {Path(stage).suffix!r} is not one of {', '.join(_STAGES)}")
    if not 0.0 < repeat <= 1e4:
        raise ValueError(f"repeat must lie in (0, 10000], got {repeat}")
    image.write_normals(mdf.scratch_map(**shape), target)
    return [target] if stage is None else [target, plate(Path(stage), target, repeat)]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What this script and ``scratchwarp scratchmap`` understand."""
    parser.add_argument("out", metavar="OUT", help="map.png (16 bits) or .exr (float)")
    parser.add_argument("--resolution", type=int, nargs="+", default=[512], metavar="N", help="pixels, or H W [512]")
    parser.add_argument("--density", type=float, default=200.0, help="scratches on the tile [200]")
    parser.add_argument("--length", type=float, default=0.2, help="of a scratch, in tiles [0.2]")
    parser.add_argument("--width", type=float, default=0.004, help="of a scratch, in tiles [0.004]")
    parser.add_argument("--depth", type=float, default=0.3, help="of a scratch, in widths [0.3]")
    parser.add_argument("--direction", type=float, metavar="DEGREES", help="counter-clockwise from +u [any direction]")
    parser.add_argument("--spread", type=float, default=0.0, metavar="DEGREES", help="to either side of it [0]")
    parser.add_argument("--variation", type=float, default=0.5, help="of length and depth, 0 to 1 [0.5]")
    parser.add_argument("--seed", type=int, default=0, help="[0]")
    parser.add_argument("--stage", metavar="FILE", help="a USD stage too: a metal plate with this map")
    parser.add_argument("--repeat", type=float, default=1.0, metavar="N", help="tiles across that plate [1]")


def run(options: argparse.Namespace) -> list[Path]:
    """What ``add_arguments`` were parsed into; raises as ``author`` does."""
    sides = options.resolution
    return author(
        options.out,
        options.stage,
        options.repeat,
        resolution=sides[0] if len(sides) == 1 else tuple(sides),
        density=options.density,
        length=options.length,
        width=options.width,
        depth=options.depth,
        direction=None if options.direction is None else math.radians(options.direction),
        spread=math.radians(options.spread),
        variation=options.variation,
        seed=options.seed,
    )


main = script(
    "scratch_map", __doc__, add_arguments, run,
    "python -m scratchwarp.pipelines.scratch_map worn.png --direction 0 --spread 5 --stage b.usda",
)  # fmt: skip

if __name__ == "__main__":
    sys.exit(main())
