"""Compare two stages or images: FLIP, difference, relative mean square error, and a web page that shows them."""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from . import pictures
from .command import Command, Report

Array = Any  # of NumPy, which loads when a pipeline runs


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp compare`` understands."""
    parser.add_argument("reference", metavar="REFERENCE", help="USD stage, which is rendered, or image file")
    parser.add_argument("other", metavar="OTHER", help="the same")
    parser.add_argument("out", metavar="OUT_DIR", help="folder for index.html, compare.json and pictures")
    parser.add_argument("--boost", type=float, default=8.0, help="of the difference image [8]")
    parser.add_argument("--maxError", type=float, metavar="RELMSE", help="status 1 where relMSE is above this")
    pictures.add_rendering(parser)


def measure(reference: Array, other: Array, boost: float = 8.0) -> tuple[dict[str, float | None], dict]:
    """Numbers (relMSE, relRMSE = root mean square difference over root mean square of the reference, mean and largest
    absolute difference, FLIP or None) and pictures (name -> linear [h, w, 3])."""
    import numpy as np

    from scratchwarp.study import differences

    off = np.abs(other.astype(np.float64) - reference) if reference.shape == other.shape else None
    error = differences.relative_mse(reference, other)
    found = differences.flip(reference, other)
    assert off is not None  # relative_mse has checked the sizes
    whole = max(float(np.sqrt(np.mean(reference.astype(np.float64) ** 2))), 1e-30)
    numbers = {
        "relMSE": error,
        "relRMSE": float(np.sqrt(np.mean(off**2))) / whole,
        "mean": float(off.mean()),
        "largest": float(off.max()),
        "flip": found and found[1],
    }
    shown = {"difference": differences.boosted(reference, other, boost)}
    if found:
        shown["flip"] = found[0]
    return numbers, shown


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into; ValueError and OSError where the input is at fault."""
    from scratchwarp import image
    from scratchwarp.whole import whole

    reference, other = (pictures.picture(source, options) for source in (options.reference, options.other))
    numbers, shown = measure(reference, other, options.boost)
    folder = Path(options.out)
    folder.mkdir(parents=True, exist_ok=True)
    figures = {"reference": reference, "other": other, **shown}
    for name, pixels in figures.items():
        target = folder / f"{name}.png"
        pictures.check_out(target, (options.reference, options.other))
        image.write_layers({"color": pixels}, target)
    record = {"reference": options.reference, "other": options.other, **numbers}
    with whole(folder / "compare.json") as draft:
        draft.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    without = "not measured: the extra study has flip-evaluator"
    text = {k: without if v is None else f"{v:.6g}" for k, v in numbers.items()}
    captions = {
        f"reference: {options.reference}": reference,
        f"other: {options.other}": other,
        f"difference, {options.boost:g} times": shown["difference"],
    } | ({"FLIP": shown["flip"]} if "flip" in shown else {})
    pictures.write_page(folder / "index.html", pictures.page("Compared", captions, list(text.items())))
    failed = options.maxError is not None and not numbers["relMSE"] <= options.maxError
    lines = [f"{name:<8} {value}" for name, value in text.items()]
    if failed:
        lines.append(f"relMSE is above {options.maxError:g}")
    return Report(record | {"failed": failed}, (*lines, str(folder / "index.html")), int(failed))


COMMAND = Command(
    name="compare",
    says="compare two stages or images: FLIP, difference, relMSE, a web page",
    examples=(
        "scratchwarp compare cup.usda worn.usda compared -w 320 --spp 64",
        "scratchwarp compare yesterday.exr today.exr compared --maxError 0.001 --json",
    ),
    add_arguments=add_arguments,
    run=run,
    renders=True,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
