"""One picture, or one web page, of many: stages, images, cameras of a stage, or its variants."""

import argparse
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from . import pictures
from .command import Command, Report, WrongUsage


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp contact-sheet`` understands."""
    parser.add_argument("sources", metavar="STAGE|IMAGE", nargs="+", help="USD stages, rendered, and image files")
    parser.add_argument("--out", "-o", required=True, metavar="OUT", help="sheet.png, .exr or .npz, or page.html")
    parser.add_argument("--columns", type=int, default=0, help="[as square as it gets]")
    parser.add_argument("--variants", metavar="SET", help="each stage once for each variant of this set, such as wear")
    pictures.add_rendering(parser, width=160)


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into; ValueError and OSError where the input is at fault."""
    from scratchwarp import image

    out = Path(options.out)
    if options.columns < 0:
        raise WrongUsage(f"--columns {options.columns} is below 0")
    web = out.suffix.lower() == ".html"
    if not web:
        image.check_writable(out)
    elif not out.parent.is_dir():
        raise FileNotFoundError(f"{out}: cannot be written, there is no folder {out.parent}")
    pictures.check_out(out, options.sources)
    cells: dict[str, Any] = {}
    for source in options.sources:
        is_stage = Path(source).suffix.lower() in pictures.STAGES
        if options.variants and is_stage:
            cells |= variants(source, options.variants, options)
        else:
            cells[source] = pictures.picture(source, options)
    if web:
        pictures.write_page(out, pictures.page("Contact sheet", cells))
    else:
        image.write_layers({"color": pictures.grid(list(cells.values()), options.columns)}, out)
    return Report({"out": str(out), "cells": list(cells)}, (str(out), *(f"  {name}" for name in cells)))


def variants(source: str, name: str, options: argparse.Namespace) -> dict[str, Any]:
    """"<stage> <variant>" -> picture, for each variant of a set; raises as ``sessions`` does."""
    return {
        f"{source} {choice}": pictures.picture(source, options, session_layer=session)
        for choice, session in sessions(source, name)
    }


def sessions(source: str, name: str) -> Iterator[tuple[str, str]]:
    """(variant, session layer that chooses it) for each variant of the set ``name`` on the stage's root prims; the
    layers are gone afterwards. ValueError where no root prim has the set."""
    from pxr import Sdf

    from scratchwarp.stage.open import open_stage

    stage = open_stage(source)
    roots = [p for p in stage.GetPseudoRoot().GetChildren() if name in p.GetVariantSets().GetNames()]
    if not roots:
        raise ValueError(f"{source}: no root prim has a variant set {name!r}")
    choices = dict.fromkeys(v for p in roots for v in p.GetVariantSets().GetVariantSet(name).GetVariantNames())
    known = [v for v in ("new", "used", "worn") if v in choices]
    with tempfile.TemporaryDirectory() as folder:
        for choice in dict.fromkeys((*known, *choices)):
            layer = Sdf.Layer.CreateNew(str(Path(folder) / f"{choice}.usda"))
            for root in roots:
                Sdf.CreatePrimInLayer(layer, root.GetPath()).variantSelections[name] = choice
            layer.Save()
            yield choice, layer.realPath


COMMAND = Command(
    name="contact-sheet",
    says="render stages, images or the variants of stages into one sheet",
    examples=(
        "scratchwarp contact-sheet cup.usda worn.usda photo.png --out sheet.png",
        "scratchwarp contact-sheet worn.usda --variants wear --out wear.html -w 240 --spp 32",
    ),
    add_arguments=add_arguments,
    run=run,
    renders=True,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
