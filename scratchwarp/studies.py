"""What the command ``study`` does: a sweep and its report, or this machine's prices."""

import argparse
import time
from collections.abc import Callable, Sequence

from . import arguments
from .arguments import UsageError

WIDTHS = (160, 128, 96, 64, 48)
"""Pixels that the image of a study is wide unless others are asked for; the later ones where a budget needs it."""


def run(args: argparse.Namespace, warn: Callable[[Sequence[str]], None]) -> tuple[str, str]:
    """(what there is to say, the same as JSON) of a study or a calibration; UsageError on wrong usage."""
    begun = time.perf_counter()
    import json

    import scratchwarp as sw

    from .pipelines import calibrate
    from .study import command

    names, budget = asked(args)
    if args.calibrate:
        file = calibrate.errors(args.quiet) if args.errors else calibrate.calibrated(args.quiet)
        return str(file), json.dumps({"errors" if args.errors else "prices": str(file)})
    scene = sw.read(args.stage, **arguments.reading(args))
    warn(scene.warnings)
    args.kept = args.out
    widths = () if args.imageWidth else WIDTHS
    args.imageWidth = args.imageWidth or WIDTHS[0]
    settings = arguments.settings(args)
    written = command.run(scene, names, args.repeats, settings, budget, args.out, args.quiet, widths, begun)
    return written.text, written.json


def asked(args: argparse.Namespace) -> tuple[tuple[str, ...] | None, float | None]:
    """(knobs or None for all, budget in seconds or None); UsageError on a knob or a time that is none."""
    from .plan.knobs import KNOBS

    names = arguments.listed(args.knobs)
    for name in names:
        if name not in KNOBS:
            raise UsageError(f"--knobs {name!r} is not one of {', '.join(KNOBS)}")
    if args.calibrate:
        if args.stage:
            raise UsageError("--calibrate renders stages of its own; leave out STAGE and OUT_DIR")
        return None, None
    if args.errors:
        raise UsageError("--errors is what --calibrate measures; write study --calibrate --errors")
    if not args.stage or not args.out:
        raise UsageError("STAGE and OUT_DIR are needed, or --calibrate alone")
    if args.repeats < 1:
        raise UsageError(f"--repeats {args.repeats} is not 1 or more")
    if not args.budget:
        return names or None, None
    unit = {"s": 1.0, "m": 60.0, "h": 3600.0}.get(args.budget[-1])
    try:
        seconds = float(args.budget[:-1] if unit else args.budget) * (unit or 1.0)
    except ValueError:
        seconds = 0.0
    if not 0.0 < seconds < 1e9:
        raise UsageError(f"--budget {args.budget!r} is no time: write 90s, 10m or 2h")
    return names or None, seconds
