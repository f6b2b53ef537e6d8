"""Write the gallery of presets: each on a ball, a plate or a disc under the same lights, and all in one picture."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from pxr import UsdShade

from . import demo_shapes as shapes
from . import demo_usd as usd
from .command import Command, Report
from .demo_disc import ring
from .looks import presets, read_preset
from .put_on import put_on

# Presets whose patterns lie about the middle of the uv square, and flat ones; the others are shown on a ball.
DISCS = ("vinyl", "optical-disc", "lathe-turned")
PLATES = ("brushed-aluminium", "brushed-steel", "ground-steel", "kitchen-steel", "engraved-plate", "varnished-wood")


def blank(path: Path, name: str) -> Path:
    """The stage that the preset ``name`` is shown on, with the material /World/mtl/shown; centimetres."""
    stage = usd.new_stage()
    prim = UsdShade.Material.Define(stage, "/World/mtl/shown")
    slate = usd.material(stage, "slate", diffuseColor=(0.06, 0.06, 0.065), roughness=0.7)
    usd.mesh(stage, "table", shapes.lathe([[(60.0, 0.0), (0.0, 0.0)]], 48), slate, (0.0, -0.05, 0.0))
    if name in DISCS:
        usd.mesh(stage, "disc", ring(0.75, 5.8, 120, 8, 6.0), prim)
    elif name in PLATES:
        flat = shapes.sheet(lambda u, v: np.stack([11 * (u - 0.5), 0 * u, 11 * (0.5 - v)], axis=-1), 1, 1)
        usd.mesh(stage, "plate", flat, prim)
    else:
        usd.mesh(stage, "ball", shapes.sphere(4.2, (0.2, 0.5, 0.8), 48, 96), prim, (0.0, 4.2, 0.0))
    high = 3.6 if name not in DISCS + PLATES else 0.0
    if name in PLATES:  # mirrored in the middle, and no brighter than a smooth plate bears
        usd.sphere_light(stage, "bulb", (-3.0, 24.0, -27.0), 0.6, 150.0)
    else:
        usd.sphere_light(stage, "bulb", (9.0, 24.0, -14.0), 0.6, 900.0)
    usd.sphere_light(stage, "lamp", (-14.0, 20.0, 16.0), 0.8, 300.0, (1.0, 0.85, 0.7))
    usd.rect_light(stage, "window", (-22.0, 22.0, -16.0), (0.0, high, 0.0), (16.0, 16.0), 4.0, (0.86, 0.93, 1.0))
    usd.dome_light(stage, "ambient", 0.25, (0.85, 0.91, 1.0))
    usd.camera(stage, (0.0, 15.0 + high, 17.0), (0.0, high, 0.0))
    usd.settings(stage, 96, 96)
    return usd.save(stage, path, "A stage to show a preset on.")


def author(folder: Path | str, names: Sequence[str] = ()) -> list[Path]:
    """Write a stage for each preset (all without ``names``) into ``folder`` and return their paths; OSError where it
    cannot be written, ValueError on an unknown name."""
    target, known = Path(folder), presets()
    target.mkdir(parents=True, exist_ok=True)
    made = []
    for name in names or known:
        if name not in known:
            raise ValueError(f"preset {name!r} is none of {', '.join(known)}")
        asset, out = blank(target / f"{name}_blank.usda", name), target / f"{name}.usda"
        put_on(asset, out, read_preset(known[name]), "shown", surface=True)
        made.append(out)
    return made


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What this script understands."""
    from . import pictures

    parser.add_argument("folder", metavar="OUT_DIR", help="for stages and presets.png; made when missing")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="these presets alone")
    parser.add_argument("--columns", type=int, default=5, help="[5]")
    pictures.add_rendering(parser, width=160, spp=64)


def run(options: argparse.Namespace) -> Report:
    """Author, render and arrange; ValueError and OSError where something is at fault."""
    from scratchwarp import image

    from . import pictures

    stages = author(options.folder, options.only)
    shown = [pictures.picture(stage, options) for stage in stages]
    out = Path(options.folder) / "presets.png"
    image.write_layers({"color": pictures.grid(shown, options.columns)}, out)
    return Report({"out": str(out), "stages": [str(stage) for stage in stages]}, (str(out),))


COMMAND = Command(
    name="preset-gallery",
    says="write the gallery of presets: a stage and a picture of each",
    examples=("python -m scratchwarp.pipelines.preset_gallery gallery -w 240 --spp 128",),
    add_arguments=add_arguments,
    run=run,
    renders=True,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
