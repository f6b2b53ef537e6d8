"""Export the look of scratched materials for other renderers, and say how far each is from our own picture.

OUT_DIR/preview/look.usda       a layer over the stage with baked UsdPreviewSurface networks
OUT_DIR/materialx/look.mtlx     OpenPBR and standard_surface materials with baked maps
OUT_DIR/mitsuba/scene.xml       the scene for Mitsuba 3, with a BSDF that evaluates our tables
OUT_DIR/index.html, export.json, pictures
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from . import pictures
from .command import Command, Report, WrongUsage

Array = Any  # of NumPy, which loads when a pipeline runs

TARGETS = ("preview", "materialx", "mitsuba")
REPORT = "export.json"
BLUR = 0.5  # degrees: lights that Mitsuba has to sample never lie on a cone
HOW = {
    "preview": "rendered by scratchwarp without the scratches, from the layer and its textures",
    "materialx": "anisotropic GGX over Schlick's Fresnel with the baked maps, rendered by Mitsuba 3",
    "mitsuba": "rendered by Mitsuba 3 with the exported BSDF",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp export`` understands."""
    parser.add_argument("stage", metavar="STAGE", help="USD file; it stays as it is")
    parser.add_argument("out", metavar="OUT_DIR", help="folder; one that was exported before is replaced")
    parser.add_argument("--to", nargs="+", choices=TARGETS, default=list(TARGETS), help="[all three]")
    parser.add_argument("--material", metavar="PATTERN", default="", help="path or name with * and ? [all scratched]")
    parser.add_argument("--texels", type=int, default=512, help="of the longer side of baked maps [512]")
    parser.add_argument("--density", type=float, default=0.0, help="texels a metre of surface, in place of --texels")
    parser.add_argument("--variants", metavar="SET", default="", help="preview: textures of each variant, such as wear")
    parser.add_argument(
        "--blur", type=float, metavar="DEGREES", help="mitsuba: of the cones of scratches [0 under domes, else 0.5]"
    )
    parser.add_argument("--no-pictures", action="store_true", help="no pictures, no differences")
    pictures.add_rendering(parser, width=192, spp=64)


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into; ValueError and OSError where the input is at fault."""
    from scratchwarp.stage.open import gathered_diagnostics
    from scratchwarp.stage.reading import Warnings
    from scratchwarp.whole import whole

    from .asset_folder import replaced

    if not 1 <= options.texels <= 16384:
        raise WrongUsage(f"--texels {options.texels} is not in [1, 16384]")
    if not 0.0 <= options.density < float("inf"):
        raise WrongUsage(f"--density {options.density} is below 0")
    if options.blur is not None and not 0.0 <= options.blur <= 30.0:
        raise WrongUsage(f"--blur {options.blur} is not in [0, 30]")
    targets = [name for name in TARGETS if name in options.to]
    heard = Warnings()  # what USD says of the asset, render and validate say
    with gathered_diagnostics(options.stage, heard), replaced(Path(options.out), options.stage, REPORT) as folder:
        record = _export(options, folder, targets)
        with whole(folder / REPORT) as draft:
            draft.write_text(json.dumps(record, indent=1, default=str) + "\n", encoding="utf-8")
    lines = []
    for name in targets:
        made = record["targets"][name]
        lines.append(f"{options.out}/{name}/{made['file']}  {_said(made)}")
        lines += [f"warning: {note}" for note in made["notes"]]
    return Report({"out": options.out, **record}, tuple(lines))


def _export(options: argparse.Namespace, folder: Path, targets: Sequence[str]) -> dict[str, Any]:
    """Write everything into ``folder`` and return what export.json says."""
    import scratchwarp as sw
    from scratchwarp import image

    from .baked_look import plan_tables
    from .export_preview import scratched

    scene = sw.read(options.stage, camera=options.camera)
    settings = pictures.settings(options)
    numbers = scratched(scene, options.material)
    record: dict[str, Any] = {
        "stage": Path(options.stage).name,
        "materials": [scene.materials[n].path for n in numbers],
        "spp": options.spp,
        "targets": {},
    }
    shown: dict[str, Array] = {}
    if not options.no_pictures:
        shown["ours"] = pictures.film(scene, options, "ours")["color"]
        image.write_layers({"color": shown["ours"]}, folder / "ours.png")
    plan = plan_tables(scene, settings)
    for name in targets:
        made, draw = _WRITERS[name](options, folder / name, scene, plan, numbers)
        record["targets"][name] = made
        if not options.no_pictures:
            pixels, why = draw()
            _compare(folder, name, made, shown, pixels, why)
    if not options.no_pictures:
        rows = [(name, _said(made)) for name, made in record["targets"].items()]
        rows += [("samples a pixel", f"{options.spp}, of Mitsuba {_more(options.spp)}")]
        pictures.write_page(folder / "index.html", pictures.page("Exported looks", shown, rows))
    return record


def _compare(folder: Path, name: str, made: dict[str, Any], shown: dict[str, Array], pixels: Array, why: str) -> None:
    """Measure one picture against ours and keep both."""
    from scratchwarp import image

    from .compare import measure

    if pixels is None:
        made["difference"] = None
        made["notes"].append(f"no picture: {why}")
        return
    numbers, extra = measure(shown["ours"], pixels)
    made["difference"] = numbers
    shown[f"{name}: {HOW[name]}"] = pixels
    shown[f"{name}: difference from ours, 8 times"] = extra["difference"]
    image.write_layers({"color": pixels}, folder / f"{name}.png")
    image.write_layers({"color": extra["difference"]}, folder / f"{name}_difference.png")
    if "flip" in extra:
        shown[f"{name}: FLIP"] = extra["flip"]


def _said(made: dict[str, Any]) -> str:
    """The difference of one target in words."""
    numbers = made.get("difference")
    if not numbers:
        return "difference not measured"
    flip = "" if numbers["flip"] is None else f", FLIP {numbers['flip']:.4g}"
    return f"relMSE {numbers['relMSE']:.4g}, relative RMSE {numbers['relRMSE']:.3g}{flip}"


def _more(spp: int) -> int:
    return max(4 * spp, 64)


Draw = Callable[[], tuple[Array, str]]


def _preview(
    options: argparse.Namespace, folder: Path, scene: Any, plan: Any, numbers: Sequence[int]
) -> tuple[dict[str, Any], Draw]:
    import scratchwarp as sw

    from .export_preview import without_scratches, write

    folder.mkdir()
    target = folder / "look.usda"
    records, notes = write(
        options.stage, target, pictures.settings(options), options.texels, options.density, options.material,
        options.variants,
    )  # fmt: skip
    if not records:
        raise ValueError(f"{options.stage}: none of its scratched materials can be given a baked surface: {notes[-1]}")

    def draw() -> tuple[Array, str]:
        with tempfile.TemporaryDirectory() as place:
            session = without_scratches(target, [row["material"] for row in records], Path(place))
            there = sw.read(target, camera=options.camera, session_layer=str(session))
            return pictures.film(there, options, "preview")["color"], ""

    return {"file": target.name, "materials": records, "notes": notes, "how": HOW["preview"]}, draw


def _materialx(
    options: argparse.Namespace, folder: Path, scene: Any, plan: Any, numbers: Sequence[int]
) -> tuple[dict[str, Any], Draw]:
    from .baked_look import lay_out, nearest
    from .export_materialx import write
    from .mitsuba_run import render

    folder.mkdir()
    looks = [lay_out(scene, plan, number, options.texels, options.density) for number in numbers]
    pairs = [(look, nearest(look, plan.tables)) for look in looks]
    records, notes = write(pairs, folder / "look.mtlx")

    def draw() -> tuple[Array, str]:
        from .export_mitsuba import write_scene

        with tempfile.TemporaryDirectory() as place:
            rough = dict(zip(numbers, (near for _, near in pairs), strict=True))
            write_scene(scene, plan, (), Path(place), options.texels, options.density, rough=rough)
            return render(Path(place), _more(options.spp))

    return {"file": "look.mtlx", "materials": records, "notes": notes, "how": HOW["materialx"]}, draw


def _mitsuba(
    options: argparse.Namespace, folder: Path, scene: Any, plan: Any, numbers: Sequence[int]
) -> tuple[dict[str, Any], Draw]:
    import math

    from scratchwarp.render import bar
    from scratchwarp.render.renderer import simulate_tables
    from scratchwarp.scene import DomeLight

    from .export_mitsuba import write_scene
    from .mitsuba_run import render

    with bar(options.quiet or options.json, "tables") as progress:
        tables, _ = simulate_tables(plan, plan.settings.threads or 1, progress)
    settings = plan.settings
    depth = settings.max_depth if settings.integrator == "path" else 1
    degrees = options.blur
    if degrees is None:
        degrees = 0.0 if all(isinstance(light, DomeLight) for light in scene.lights) else BLUR
    blur = math.radians(degrees)
    notes, layers = write_scene(scene, plan, tables, folder, options.texels, options.density, blur, depth)
    made = {"file": "scene.xml", "notes": notes, "how": HOW["mitsuba"], "blur_degrees": degrees, "layers": layers}
    return made, lambda: render(folder, _more(options.spp))


_WRITERS = {"preview": _preview, "materialx": _materialx, "mitsuba": _mitsuba}

COMMAND = Command(
    name="export",
    says="export scratched looks as UsdPreviewSurface, MaterialX and a Mitsuba 3 scene",
    examples=(
        "scratchwarp export worn.usda exported",
        "scratchwarp export worn.usda exported --to preview --density 20000 --variants wear",
        "scratchwarp export worn.usda exported --to mitsuba --blur 0.5 -w 256 --spp 256 --json",
    ),
    add_arguments=add_arguments,
    run=run,
    renders=True,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
