"""Render a scratched stage by every model that Raymond et al. (2016) compare theirs with, as their figure 7 does.

Writes one picture a model, and models.png: the pictures in a row, below each its difference from the reference, boosted
eight times. Prints how much light each model returns, and how far it is off, in shares of the reference.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .command import script

MODELS = ("ashikhminShirley", "tabulatedNdf", "singleBounce", "table", "mirror", "fullTable")
BOOST = 8.0


def compare(
    stage: Path | str, models: Sequence[str] = MODELS, reference: str = "fullTable", **settings: Any
) -> dict[str, np.ndarray]:
    """Model -> picture [h, w, 3] (linear) of ``stage``, all from the same samples; ``reference`` is the last.

    ``settings``: of ``scratchwarp.Settings``. Raises ValueError on an unknown model or a stage without scratches.
    """
    import scratchwarp as sw

    scene = sw.read(stage)
    made = {}
    for model in dict.fromkeys((*(m for m in models if m != reference), reference)):
        plan = sw.make_plan(scene, sw.Settings(model=model, **settings))
        if not any(plan.layers):
            raise ValueError(f"{stage}: nothing on it is scratched, so that there is nothing to compare")
        made[model] = np.asarray(sw.render(scene, plan)["color"])
    return made


def differences(pictures: dict[str, np.ndarray], reference: str) -> dict[str, tuple[float, float]]:
    """Model -> (mean, mean absolute difference) as shares of the mean of the reference."""
    wanted = pictures[reference].astype(float)
    whole = max(float(wanted.mean()), 1e-12)
    return {
        m: (float(p.mean(dtype=float)) / whole, float(np.abs(p - wanted).mean()) / whole) for m, p in pictures.items()
    }


def sheet(pictures: dict[str, np.ndarray], reference: str) -> np.ndarray:
    """Pictures in a row, differences below them."""
    wanted = pictures[reference]
    rows = [list(pictures.values()), [BOOST * np.abs(p - wanted) for p in pictures.values()]]
    return np.concatenate([np.concatenate(row, axis=1) for row in rows], axis=0).astype(np.float32)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What this script understands."""
    parser.add_argument("stage", type=Path, help="USD file")
    parser.add_argument("out", type=Path, help="folder for the pictures; made when missing")
    parser.add_argument("--models", default=",".join(MODELS), help=f"with commas [{','.join(MODELS)}]")
    parser.add_argument("--reference", default="fullTable", help="what the others are compared with [fullTable]")
    parser.add_argument("--width", type=int, default=320, help="pixels [320]")
    parser.add_argument("--spp", type=int, default=64, help="samples a pixel [64]")


def run(options: argparse.Namespace) -> list[str]:
    """Render, write and compare."""
    from scratchwarp import image

    models = [name for name in options.models.split(",") if name]
    pictures = compare(options.stage, models, options.reference, width=options.width, spp=options.spp)
    options.out.mkdir(parents=True, exist_ok=True)
    for name, picture in pictures.items():
        image.write_layers({"color": picture}, options.out / f"{name}.png", {})
    image.write_layers({"color": sheet(pictures, options.reference)}, options.out / "models.png", {})
    found = differences(pictures, options.reference)
    return [f"{name:<18} light {mean:6.3f}   difference {off:6.3f}" for name, (mean, off) in found.items()]


main = script(
    "compare_models", __doc__, add_arguments, run,
    "python -m scratchwarp.pipelines.compare_models demo/ball.usda models --width 240",
)  # fmt: skip

if __name__ == "__main__":
    sys.exit(main())
