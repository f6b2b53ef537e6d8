"""Publish a stage as an asset: an entry file with a payload, everything it needs beside it, a package and checksums."""

import argparse
import sys
from pathlib import Path
from typing import Any

from .command import Command, Report, WrongUsage


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp publish`` understands."""
    parser.add_argument("stage", metavar="STAGE", help="USD file with a default prim; it stays as it is")
    parser.add_argument("out", metavar="OUT_DIR", help="folder of the asset; one that was published before is replaced")
    parser.add_argument("--name", help="of the asset: letters, digits and _ [that of STAGE]")
    parser.add_argument("--assetVersion", default="1", metavar="TEXT", help="of the asset [1]")
    parser.add_argument(
        "--kind", choices=("component", "assembly"), default="component",
        help="of the asset; models in a component become subcomponents [component]",
    )  # fmt: skip
    parser.add_argument("--thumbnail", metavar="FILE", help="PNG or JPEG [rendered]")
    parser.add_argument("--no-thumbnail", action="store_true", help="none")
    parser.add_argument("--no-usdz", action="store_true", help="no package")
    parser.add_argument("--no-preview", action="store_true", help="no baked UsdPreviewSurface looks of scratches")
    parser.add_argument("--texels", type=int, default=512, help="of the longer side of baked maps [512]")
    parser.add_argument("--imageWidth", "-w", type=int, default=256, metavar="PIXELS", help="of the thumbnail [256]")
    parser.add_argument("--spp", type=int, default=16, help="samples a pixel of the thumbnail [16]")


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into; ValueError and OSError where the input is at fault."""
    from scratchwarp.stage.open import gathered_diagnostics
    from scratchwarp.stage.reading import Warnings

    from . import pictures
    from .asset_folder import build, replaced, thumbnail_file

    if options.thumbnail and options.no_thumbnail:
        raise WrongUsage("--thumbnail and --no-thumbnail exclude each other")
    name = options.name or Path(options.stage).stem.replace("-", "_").replace(".", "_")
    drawn = None
    if options.thumbnail:
        drawn = thumbnail_file(options.thumbnail)
    elif not options.no_thumbnail:
        options.quality, options.camera = None, None

        def drawn(entry: Path, target: Path) -> None:
            from scratchwarp import image

            image.write_layers({"color": pictures.picture(entry, options)}, target)

    if not 1 <= options.texels <= 16384:
        raise WrongUsage(f"--texels {options.texels} is not in [1, 16384]")
    notes: list[str] = []

    def bake(payload: Path) -> tuple[Path, list[str]]:
        import scratchwarp as sw

        from .export_preview import write
        from .put_on import VARIANT_SET

        if not any(material.layers for material in sw.read(payload).materials):
            return payload, []
        over = payload.with_name(f"{payload.stem}_preview.usda")
        records, said = write(payload, over, sw.Settings(), options.texels, variants=VARIANT_SET)
        notes.extend(said)
        return over if records else payload, [row["material"] for row in records]

    heard = Warnings()  # missing files are in the manifest, once
    with gathered_diagnostics(options.stage, heard), replaced(Path(options.out), options.stage) as folder:
        look = None if options.no_preview else bake
        how: dict[str, Any] = {"usdz": not options.no_usdz, "bake": look, "kind": options.kind}
        manifest = build(options.stage, folder, name, options.assetVersion, drawn, **how)
    lines = [f"{options.out}/{row['path']}  {row['bytes']} bytes" for row in manifest["files"]]
    lines += [f"warning: {path} cannot be found and is left out" for path in manifest["missing"]]
    lines += [f"warning: {note}" for note in notes]
    return Report({"out": options.out, **manifest}, tuple(lines))


COMMAND = Command(
    name="publish",
    says="publish a stage as an asset that needs nothing outside its folder",
    examples=(
        "scratchwarp publish worn.usda published/cup --name cup --assetVersion 1.2",
        "scratchwarp publish worn.usda published/cup --thumbnail photo.png --json",
    ),
    add_arguments=add_arguments,
    run=run,
    renders=True,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
