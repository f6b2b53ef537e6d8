"""What the command line understands: usdrecord's names and short forms first, the renderer's own after them."""

import argparse
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .scene import Settings
    from .scene.knob import Value


_PURPOSES = ("default", "render", "proxy", "guide")


class UsageError(Exception):
    """The command line asks for something that does not exist; exit status 2."""


def add_stage(parser: argparse.ArgumentParser, optional: bool = False) -> None:
    """STAGE and which part of it to read."""
    parser.add_argument(
        "stage", metavar="STAGE", nargs="?" if optional else None, help="USD file: .usda, .usdc, .usd or .usdz"
    )
    group = parser.add_argument_group("what is read")
    group.add_argument("--camera", "-cam", metavar="NAME", help="camera prim, by path or name")
    group.add_argument(
        "--purposes", metavar="LIST", default="", help="purposes besides default and render: guide, proxy; with commas"
    )
    group.add_argument("--mask", metavar="PATHS", default="", help="read only these prims; with commas")
    group.add_argument("--sessionLayer", "--session", metavar="FILE", help="USD layer laid over the stage")
    add_memory(group)
    group.add_argument("--renderSettingsPrimPath", "-rs", metavar="PATH", help="RenderSettings prim to follow")


def add_memory(parser: argparse._ActionsContainer) -> None:
    """How much memory what is read may take."""
    parser.add_argument(
        "--max-memory", dest="maxMemory", metavar="SIZE", type=_size, help="of meshes and images: 8G [most of it]"
    )


def add_settings(parser: argparse.ArgumentParser) -> None:
    """How to render; what is left out, the stage's render settings decide."""
    group = parser.add_argument_group("how it is rendered (left out: as the stage says)")
    group.add_argument("--imageWidth", "-w", type=int, metavar="PIXELS", help="height follows from the aspect [640]")
    group.add_argument("--imageHeight", type=int, metavar="PIXELS")
    group.add_argument("--spp", type=int, help="samples a pixel [16]")
    group.add_argument("--seed", type=int, help="of every random choice [0]")
    group.add_argument("--quality", help="draft, preview, final or reference")
    group.add_argument("--maxError", type=float, help="double the samples until relMSE is estimated below this")
    group.add_argument("--integrator", help="direct or path")
    group.add_argument("--maxDepth", type=int, help="surfaces that a path may meet")
    group.add_argument("--coneTaps", type=int, help="look-ups into a dome's image along the cone of a scratch [16]")
    group.add_argument("--filter", help="box, gaussian or blackmanHarris")
    group.add_argument("--filterWidth", type=float, metavar="PIXELS", help="full width of the filter")
    group.add_argument(
        "--crop", type=float, nargs=4, metavar=("X0", "X1", "Y0", "Y1"), help="part of the image, 0 to 1 from top left"
    )
    group.add_argument("--model", metavar="NAME", help="of all scratches: table, ashikhminShirley, ...")
    group.add_argument("--threads", type=int, help="worker threads [all cores]; the image does not depend on it")
    group.add_argument("--tileSize", type=int, default=32, metavar="PIXELS", help="edge [32]")
    group.add_argument(
        "--effect", action="append", default=[], metavar="NAME=on|off", help="force an effect that explain lists"
    )
    group.add_argument(
        "--knob", action="append", default=[], metavar="NAME=VALUE", help="turn an approximation; docs/accuracy.md"
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
            cone_taps=args.coneTaps,
            filter=args.filter,
            filter_width=args.filterWidth,
            crop=tuple(args.crop) if args.crop else None,
            threads=args.threads,
            tile=args.tileSize,
            effects=dict(_effect(text) for text in args.effect),
            model=args.model,
            knobs=dict(_knob(text) for text in args.knob),
        )
    except ValueError as error:
        raise UsageError(str(error)) from error


def reading(args: argparse.Namespace) -> dict[str, Any]:
    """Keywords of ``read`` that say which part of the stage is meant; UsageError on a purpose that is none."""
    purposes = tuple(dict.fromkeys(("default", "render", *listed(args.purposes))))
    for name in purposes:
        if name not in _PURPOSES:
            raise UsageError(f"--purposes {name!r} is not one of {', '.join(_PURPOSES)}")
    return {
        "camera": args.camera,
        "purposes": purposes,
        "session_layer": args.sessionLayer,
        "mask": listed(args.mask) or None,
        "render_settings": args.renderSettingsPrimPath,
        "default_time": getattr(args, "defaultTime", False),
        "max_memory": args.maxMemory,
    }


def _size(text: str) -> float:
    from .scene.memory import parsed

    try:
        return parsed(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def listed(text: str) -> tuple[str, ...]:
    """The words between commas or blanks."""
    return tuple(text.replace(",", " ").split())


def _effect(text: str) -> tuple[str, bool]:
    from .plan.effects import EFFECTS

    name, _, switch = text.partition("=")
    if not name or switch not in ("on", "off"):
        raise UsageError(f"--effect {text!r} is not NAME=on or NAME=off")
    if name not in EFFECTS:
        raise UsageError(f"--effect {name!r} is not one of {', '.join(EFFECTS)}")
    return name, switch == "on"


def _knob(text: str) -> tuple[str, "Value"]:
    from .plan.knobs import checked

    name, _, value = text.partition("=")
    if not name or not value:
        raise UsageError(f"--knob {text!r} is not NAME=VALUE")
    try:
        return name, checked({name: value})[name]
    except ValueError as error:
        raise UsageError(f"--knob: {error}") from None


_EXAMPLES = {
    "": """scratchwarp demo out
  scratchwarp render ball.usda ball.exr -w 640 --spp 64
  scratchwarp explain ball.usda""",
    "render": """scratchwarp render ball.usda ball.exr -w 480 --spp 16
  scratchwarp render ball.usda ball.png -cam /World/Close -color openColorIO
  scratchwarp render shot.usda shot.####.exr --frames 101:110x3,115 --sessionLayer scratched.usda
  scratchwarp render ball.usda ball.exr --aov depth,normal --effect scratches.interreflection=off --json
  scratchwarp render ball.usda ball.exr --spp 4096 --checkpoint ball.part --resume
  scratchwarp render shot.usda shot.####.exr --frames 1:240 --scheduler tcp://farm:8786""",
    "explain": "scratchwarp explain ball.usda\n  scratchwarp explain ball.usda --cost --maxError 0.01\n"
    "  scratchwarp explain ball.usda --effect shadows=off --json",
    "simulate": """scratchwarp simulate quartic quartic.exr --depth 0.4 --plot quartic.png
  scratchwarp simulate groove.csv groove.png --metal gold --resolution 128
  scratchwarp simulate ball.usda tables.##.npz""",
    "view": "scratchwarp view ball.usda\n  scratchwarp view ball.usda --screenshot look.png --frame 12\n"
    "  scratchwarp view ball.usda --web --port 8765\n"
    "  scratchwarp view ball.usda --profile hairlines\n  scratchwarp view quartic\n  scratchwarp view lobe\n"
    "  scratchwarp view cloth.bin --screenshot cloth.png",
    "study": "scratchwarp study ball.usda ball_study --budget 10m\n"
    "  scratchwarp study ball.usda out --knobs spp,tables.resolution,tables.rays -w 96 --repeats 5\n"
    "  scratchwarp study --calibrate   # this machine's prices, which explain --cost and --maxError go by\n"
    "  scratchwarp study --calibrate --errors   # what knobs leave, which --maxError goes by",
    "fit": "scratchwarp fit cloth.bin cloth.usda --report cloth\n  scratchwarp fit paint.binary paint.usda --modes 1\n"
    "  scratchwarp fit kettle.usda far.usda --material brass   # scratches seen from far away",
    "scratchmap": "scratchwarp scratchmap hairlines.png --direction 0 --spread 4 --density 900\n"
    "  scratchwarp scratchmap worn.exr --resolution 1024 --stage worn.usda --repeat 3",
    "cache": "scratchwarp cache\n  scratchwarp cache --clear",
    "demo": "scratchwarp demo out\n  scratchwarp demo out -w 320 --spp 4\n  scratchwarp demo out --only spoon",
}


def parser() -> argparse.ArgumentParser:
    """The whole command line: ``args.command`` is the name of the function of ``cli`` to run."""
    from . import __version__
    from .pipelines import scratch_map
    from .pipelines.commands import COMMANDS
    from .viewers import BRDF_KEYS, KEYS, PROFILE_KEYS

    whole = argparse.ArgumentParser(
        prog="scratchwarp",
        description="Render scratched, brushed and grooved surfaces from USD stages.",
        epilog=f"examples:\n  {_EXAMPLES['']}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    whole.add_argument("--version", action="version", version=f"scratchwarp {__version__}")
    commands = whole.add_subparsers(dest="command", required=True, metavar="COMMAND")

    examples = _EXAMPLES | {name: "\n  ".join(c.examples) for name, c in COMMANDS.items()}

    def command(name: str, says: str, json_too: bool = False) -> argparse.ArgumentParser:
        made = commands.add_parser(
            name,
            help=says,
            description=f"{says[0].upper()}{says[1:]}.",
            epilog=f"examples:\n  {examples[name]}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        made.add_argument("--quiet", action="store_true", help="say nothing but errors")
        if json_too:
            made.add_argument("--json", action="store_true", help="print results as JSON")
        return made

    made = command("render", "render a stage to EXR, PNG or NPZ", json_too=True)
    add_stage(made)
    made.add_argument("out", metavar="OUT", help="image.exr, .png or .npz; ### stands for the frame number")
    when = made.add_mutually_exclusive_group()
    when.add_argument(
        "--frames", "-f", metavar="SPEC", help="101:110x3,115 is 101, 104, 107, 110 and 115 [the earliest]"
    )
    when.add_argument("--defaultTime", "-d", action="store_true", help="defaults, even of attributes with samples")
    made.add_argument("--aov", action="append", default=[], metavar="NAMES", help="layers written [the stage's vars]")
    made.add_argument("--checkpoint", metavar="FILE", help="keep finished tiles here while rendering")
    made.add_argument("--resume", action="store_true", help="start from the tiles of --checkpoint")
    made.add_argument(
        "--scheduler", metavar="ADDRESS", help="render on a Dask farm: tcp://HOST:PORT, or local:N workers here"
    )
    made.add_argument("--cost", action="store_true", help="say what it was predicted to take, and what it took")
    add_settings(made)
    add_color(made)

    made = command("explain", "say which effects a stage calls for, and why", json_too=True)
    add_stage(made)
    made.add_argument("--cost", action="store_true", help="predict the seconds of each effect, too")
    add_settings(made)

    made = command("simulate", "write the table of a profile, or those of a stage's layers")
    made.add_argument("source", metavar="PROFILE|STAGE", help="name of a shape, file of points (x, z), or USD file")
    made.add_argument("out", metavar="OUT", help="table.exr or .npz, or .png for a picture of it")
    made.add_argument("--layer", metavar="NAME", help="the layer of the stage that is meant")
    made.add_argument("--depth", type=float, default=0.5, help="of a named shape, in widths [0.5]")
    made.add_argument(
        "--isolated", action="store_true", help="alone in flat ground; a stage's profiles say it themselves"
    )
    made.add_argument("--metal", help="reflects as aluminium, gold, copper, silver, iron or brass [a mirror]")
    made.add_argument("--ior", type=float, help="reflects as a dielectric of this index")
    made.add_argument("--resolution", type=int, default=256, help="bins each way [256]")
    made.add_argument("--rays", type=int, default=512, help="rays for each bin of phi_i [512]")
    made.add_argument("--sampler", default="beam", help="beam, stratified or random [beam]")
    made.add_argument("--incidence", default="cell", help="cell or centre [cell]")
    made.add_argument("--maxBounces", type=int, default=2000, help="[2000]")
    made.add_argument("--thetaModel", default="gamma", help="gamma, quadratic, table or exact [gamma]")
    made.add_argument("--polarised", action="store_true", help="polarised products along the path")
    made.add_argument("--plot", metavar="FILE", help="a picture, too: bounces in red, green, blue above the profile")
    made.add_argument("--seed", type=int, default=0, help="[0]")

    made = command("view", "show a stage, its scratches, profiles and tables in a window")
    for title, keys in (("keys", KEYS), ("keys with --profile", PROFILE_KEYS), ("keys on a BRDF", BRDF_KEYS)):
        made.epilog = "\n".join([f"{made.epilog}\n", f"{title}:", *(f"  {key}  {what}" for key, what in keys.items())])
    made.add_argument(
        "stage", metavar="STAGE|SHAPE|BRDF|lobe",
        help="USD file, name of a shape, file of a measurement, or the word lobe: how one fine scratch diffracts",
    )  # fmt: skip
    made.add_argument(
        "--profile", nargs="?", const="", metavar="LAYER", help="a layer's profile alone, with sliders [first]"
    )
    made.add_argument("--depth", type=float, help="of that profile to begin with, in widths")
    made.add_argument("--screenshot", metavar="FILE", help="write this picture instead, without a display")
    made.add_argument("--frame", "-f", metavar="N", help="time code [the earliest]")
    made.add_argument("--camera", "-cam", metavar="NAME", help="camera prim, by path or name")
    made.add_argument("--imageWidth", "-w", type=int, metavar="PIXELS", help="of the rendered image in it")
    made.add_argument("--spp", type=int, help="samples a pixel of the rendered image in it")
    add_memory(made)
    web = made.add_argument_group("in the browser")
    web.add_argument("--web", action="store_true", help="print links that show the stage in browsers; Ctrl+C ends it")
    web.add_argument("--host", metavar="ADDRESS", help="to listen on [127.0.0.1, for this machine alone]")
    web.add_argument("--port", type=int, help="to listen on [any that is free]")
    web.add_argument("--browse", action="store_true", help="open the first link in this machine's browser")
    web.add_argument("--save", metavar="FILE", help="USD layer that edits are saved to [NAME.look.usda beside STAGE]")
    web.add_argument("--sessionLayer", "--session", metavar="FILE", help="USD layer laid over the stage")

    made = command("study", "measure what accuracy costs in time, and write a report of it", json_too=True)
    add_stage(made, optional=True)
    made.add_argument(
        "out", metavar="OUT_DIR", nargs="?", help="folder of the report; measurements in it are taken up again"
    )
    made.add_argument(
        "--calibrate", action="store_true", help="measure instead what work costs on this machine, for all renders"
    )
    made.add_argument(
        "--errors", action="store_true",
        help="with --calibrate: what each value of each knob leaves, for --maxError; goes on after an interruption",
    )  # fmt: skip
    made.add_argument(
        "--budget", metavar="TIME", help="90s, 10m or 2h: be done by then; first each knob alone, then several [none]"
    )
    made.add_argument("--knobs", metavar="NAMES", default="", help="with commas [all that act on the stage]")
    made.add_argument("--repeats", type=int, default=3, metavar="N", help="rounds of all settings [3]")
    add_settings(made)

    made = command("fit", "fit highlight stencils to a measured BRDF, written as a material", json_too=True)
    made.add_argument("measured", metavar="MEASURED", help="UTIA .bin, MERL .binary, RGL .bsdf, or a USD stage")
    made.add_argument("out", metavar="OUT", help="material.usda, .usdc or .usd")
    made.add_argument("--report", metavar="DIR", help="pictures, differences, metrics and rival models as a web page")
    made.add_argument("--material", metavar="NAME", help="of a stage, by path or name [the first with scratches]")
    made.add_argument("--modes", type=int, metavar="N", help="axes of anisotropy [as many as are found]")
    made.add_argument("--no-refine", action="store_true", help="the direct fit alone: no scipy, no rivals")
    made.add_argument("--retro", action="store_true", help="highlights return to the light")

    scratch_map.add_arguments(command("scratchmap", "make a seamless normal map of scratches"))

    for name, pipeline in COMMANDS.items():
        pipeline.add_arguments(command(name, pipeline.says, json_too=True))

    made = command("demo", "author the demo stages and render each to EXR and PNG")
    made.add_argument("out", metavar="OUT_DIR", help="folder for stages and images; made when missing")
    made.add_argument("--imageWidth", "-w", type=int, default=480, metavar="PIXELS", help="[480]")
    made.add_argument("--spp", type=int, default=8, help="samples a pixel [8]")
    made.add_argument("--threads", type=int, help="worker threads [all cores]")
    made.add_argument(
        "--only", nargs="+", metavar="NAME",
        help="these stages alone; spoon, spoon_star, spoon_window, spoon_dome, disc and vinyl only on request",
    )  # fmt: skip

    made = command("cache", "say what is kept on disk between runs, or clear it")
    made.add_argument("--clear", action="store_true", help="remove all simulated tables")
    made.add_argument("--clearKernels", action="store_true", help="remove Warp's kernels, those of other programs too")
    return whole
