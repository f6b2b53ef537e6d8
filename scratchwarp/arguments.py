"""What the command line understands: usdrecord's names and short forms first, the renderer's own after them."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .scene import Settings


class UsageError(Exception):
    """The command line asks for something that does not exist; exit status 2."""


def add_stage(parser: argparse.ArgumentParser) -> None:
    """STAGE and which part of it to read."""
    parser.add_argument("stage", metavar="STAGE", help="USD file: .usda, .usdc, .usd or .usdz")
    group = parser.add_argument_group("what is read")
    group.add_argument("--camera", "-cam", metavar="NAME", help="camera prim, by path or name")
    group.add_argument(
        "--purposes", metavar="LIST", default="", help="purposes besides default and render: guide, proxy; with commas"
    )
    group.add_argument("--mask", metavar="PATHS", default="", help="read only these prims; with commas")
    group.add_argument("--sessionLayer", "--session", metavar="FILE", help="USD layer laid over the stage")
    group.add_argument("--renderSettingsPrimPath", "-rs", metavar="PATH", help="RenderSettings prim to follow")


def add_settings(parser: argparse.ArgumentParser) -> None:
    """How to render; what is left out, the stage's render settings decide."""
    group = parser.add_argument_group("how it is rendered (left out: as the stage says)")
    group.add_argument("--imageWidth", "-w", type=int, metavar="PIXELS", help="height follows from the aspect [640]")
    group.add_argument("--imageHeight", type=int, metavar="PIXELS")
    group.add_argument("--spp", type=int, help="samples a pixel [16]")
    group.add_argument("--seed", type=int, help="of every random choice [0]")
    group.add_argument("--quality", help="draft, preview, final or reference")
    group.add_argument("--maxError", type=float, help="relative error to stop at")
    group.add_argument("--integrator", help="direct or path")
    group.add_argument("--maxDepth", type=int, help="surfaces that a path may meet")
    group.add_argument("--filter", help="box, gaussian or blackmanHarris")
    group.add_argument("--filterWidth", type=float, metavar="PIXELS", help="full width of the filter")
    group.add_argument(
        "--crop", type=float, nargs=4, metavar=("X0", "X1", "Y0", "Y1"), help="part of the image, 0 to 1 from top left"
    )
    group.add_argument("--threads", type=int, help="worker threads [all cores]; the image does not depend on it")
    group.add_argument(
        "--effect", action="append", default=[], metavar="NAME=on|off", help="force an effect that explain lists"
    )


def add_color(parser: argparse.ArgumentParser) -> None:
    """How a PNG shows scene-linear colours."""
    group = parser.add_argument_group("colours of a PNG")
    group.add_argument(
        "--colorCorrectionMode", "-color", choices=("disabled", "sRGB", "openColorIO"), default="sRGB", metavar="MODE",
        help="disabled (linear), sRGB (the default, no tone mapping) or openColorIO ($OCIO, else a built-in ACES)",
    )  # fmt: skip
    group.add_argument("--display", default="", metavar="NAME", help="OpenColorIO display [the configuration's]")
    group.add_argument("--view", default="", metavar="NAME", help="OpenColorIO view [the display's]")


def settings(args: argparse.Namespace) -> "Settings":
    """The Settings that the command line asks for; UsageError naming the argument that is out of range."""
    from .scene import Settings

    try:
        return Settings(
            width=args.imageWidth,
            height=args.imageHeight,
            spp=args.spp,
            seed=args.seed,
            quality=args.quality,
            max_error=args.maxError,
            integrator=args.integrator,
            max_depth=args.maxDepth,
            filter=args.filter,
            filter_width=args.filterWidth,
            crop=tuple(args.crop) if args.crop else None,
            threads=args.threads,
            effects=dict(_effect(text) for text in args.effect),
        )
    except ValueError as error:
        raise UsageError(str(error)) from error


def reading(args: argparse.Namespace) -> dict[str, Any]:
    """Keywords of ``read`` that say which part of the stage is meant."""
    return {
        "camera": args.camera,
        "purposes": tuple(dict.fromkeys(("default", "render", *listed(args.purposes)))),
        "session_layer": args.sessionLayer,
        "mask": listed(args.mask) or None,
        "render_settings": args.renderSettingsPrimPath,
    }


def cross_sections(args: argparse.Namespace) -> list[tuple[str, Any, Any]]:
    """(name, profile, reflector) of what ``simulate`` is given: the tables that a stage's plan asks for, a file of
    points (x, z), or the name of a shape. The reflector is None for a mirror.

    ValueError or OSError naming what is at fault; UsageError when it is none of the three.
    """
    import numpy as np

    from . import make_plan, optics, profiles, read

    if Path(args.source).suffix in (".usd", ".usda", ".usdc", ".usdz"):
        tables = make_plan(read(args.source)).tables
        if not tables:
            raise ValueError(f"{args.source}: no scratch layer of it needs a table")
        found = [(", ".join(table.users), table.profile, table.fresnel) for table in tables]
        return [row for row in found if args.layer is None or args.layer in row[0]] or found
    fresnel = optics.Conductor(*optics.metals.rgb(args.metal)) if args.metal else None
    if args.ior is not None:
        fresnel = optics.Dielectric(args.ior)
    if Path(args.source).is_file():
        try:
            points = np.loadtxt(args.source, delimiter="," if args.source.endswith(".csv") else None, ndmin=2)
            return [(args.source, profiles.Profile(points, isolated=args.isolated), fresnel)]
        except ValueError as error:
            raise ValueError(f"{args.source}: {error}") from None
    if args.source not in profiles.shape_names():
        known = ", ".join(profiles.shape_names())
        raise UsageError(f"{args.source!r} is neither a USD stage nor a file of points nor one of {known}")
    profile = profiles.shape(args.source, depth=args.depth, isolated=args.isolated)
    return [(args.source, profile, fresnel)]


def listed(text: str) -> tuple[str, ...]:
    """The words between commas or blanks."""
    return tuple(text.replace(",", " ").split())


def _effect(text: str) -> tuple[str, bool]:
    name, _, switch = text.partition("=")
    if not name or switch not in ("on", "off"):
        raise UsageError(f"--effect {text!r} is not NAME=on or NAME=off")
    return name, switch == "on"
