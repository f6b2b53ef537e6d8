"""Put scratches on an asset that exists: a preset, or attributes, in a USD layer over it."""

import argparse
import sys

from .command import Command, Report, WrongUsage


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp author`` understands."""
    parser.add_argument("asset", metavar="ASSET", nargs="?", help="USD file; it stays as it is")
    parser.add_argument("out", metavar="OUT", nargs="?", help="layer over it to write: .usda, .usdc or .usd")
    parser.add_argument("--preset", metavar="NAME", help="a look that --list lists, or a USD file with one")
    parser.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", dest="values",
        help="attribute of all layers (width=20), of one (brush.width=20), of profiles (profile.rim=0.2) or wave.NAME",
    )  # fmt: skip
    parser.add_argument("--layer", metavar="NAME", default="scratches", help="its name without a preset [scratches]")
    parser.add_argument("--material", metavar="PATTERN", default="", help="path or name with * and ? [the only one]")
    parser.add_argument("--wear", choices=("new", "used", "worn"), default="used", help="what is chosen [used]")
    parser.add_argument(
        "--surface", action="store_true", help="the preset's base surface, too [the asset's is kept where it has one]"
    )
    parser.add_argument("--list", action="store_true", help="list the presets and end")


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into; ValueError and OSError where the input is at fault."""
    from scratchwarp.stage.open import gathered_diagnostics
    from scratchwarp.stage.reading import Warnings

    from . import looks
    from .put_on import put_on

    if options.list:
        known = {name: looks.about(path) for name, path in looks.presets().items()}
        return Report(known, tuple(f"{name:<20} {says}" for name, says in known.items()))
    if not options.asset or not options.out:
        raise WrongUsage("give ASSET and OUT, or --list")
    if not options.preset and not options.values:
        raise WrongUsage("give --preset NAME, --set NAME=VALUE or both; --list lists the presets")
    if options.surface and not options.preset:
        raise WrongUsage("--surface is of a preset; add --preset NAME")
    look = looks.read_preset(looks.preset_path(options.preset)) if options.preset else looks.plain_look(options.layer)
    look = looks.with_values(look, options.values)
    with gathered_diagnostics(options.asset, Warnings()):  # what USD says of the asset, reading it says again
        made = put_on(options.asset, options.out, look, options.material, options.wear, options.surface)
    rows = [{"path": path, "layers": layers} for path, layers in made.items()]
    wear = options.wear if look.wear else None
    record = {"out": options.out, "asset": options.asset, "preset": options.preset, "wear": wear, "materials": rows}
    return Report(record, (options.out, *(f"  {path}: {', '.join(layers)}" for path, layers in made.items())))


COMMAND = Command(
    name="author",
    says="put scratches on an asset, in a layer over it",
    examples=(
        "scratchwarp author --list",
        "scratchwarp author kettle.usda scratched.usda --preset kitchen-steel --material '*steel*'",
        "scratchwarp author cup.usda worn.usda --preset worn-brass --surface --wear worn --set handling.width=80",
        "scratchwarp author cup.usda lines.usda --set distribution=linear --set width=20 --set profile.shape=round",
    ),
    add_arguments=add_arguments,
    run=run,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
