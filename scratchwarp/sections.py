"""The cross-sections that the command ``simulate`` is given: of a stage, of a file of points, or by name."""

import argparse
from pathlib import Path
from typing import Any

from .arguments import UsageError


def cross_sections(args: argparse.Namespace) -> list[tuple[str, Any, Any]]:
    """(name, profile, reflector) of what ``simulate`` is given: the tables that a stage's plan asks for, a file of
    points (x, z), or the name of a shape. The reflector is None for a mirror.

    ValueError or OSError naming what is at fault; UsageError when it is none of the three.
    """
    import numpy as np

    from . import make_plan, optics, profiles, read

    _check_table(args)
    if Path(args.source).suffix in (".usd", ".usda", ".usdc", ".usdz"):
        tables = make_plan(read(args.source)).tables
        if not tables:
            raise ValueError(f"{args.source}: no scratch layer of it needs a table")
        found = [(", ".join(table.users), table.profile, table.fresnel) for table in tables]
        meant = [row for row in found if args.layer is None or args.layer in row[0]]
        if not meant:
            raise UsageError(f"--layer {args.layer!r} is none of {'; '.join(name for name, _, _ in found)}")
        return meant
    if args.metal and args.ior is not None:
        raise UsageError("--metal and --ior exclude each other")
    try:
        fresnel = optics.Conductor(*optics.metals.rgb(args.metal)) if args.metal else None
        if args.ior is not None:
            fresnel = optics.Dielectric(args.ior)
    except ValueError as error:
        raise UsageError(f"--metal or --ior: {error}") from None
    if Path(args.source).is_file():
        if not Path(args.source).read_bytes().strip():
            raise ValueError(f"{args.source}: the file is empty; write a point (x, z) in each line")
        try:
            points = np.loadtxt(args.source, delimiter="," if args.source.endswith(".csv") else None, ndmin=2)
            return [(args.source, profiles.Profile(points, isolated=args.isolated), fresnel)]
        except ValueError as error:
            raise ValueError(f"{args.source}: {error}") from None
    if args.source not in profiles.shape_names():
        known = ", ".join(profiles.shape_names())
        raise UsageError(f"{args.source!r} is neither a USD stage nor a file of points nor one of {known}")
    try:
        profile = profiles.shape(args.source, depth=args.depth, isolated=args.isolated)
    except ValueError as error:
        raise UsageError(str(error)) from None
    return [(args.source, profile, fresnel)]


def _check_table(args: argparse.Namespace) -> None:
    """UsageError where ``simulate`` is asked for a table or a file that cannot be."""
    from . import image, profiles

    if Path(args.out).suffix.lower() not in image.SUFFIXES:
        raise UsageError(f"OUT {args.out!r} ends in none of {', '.join(image.SUFFIXES)}")
    if args.thetaModel not in profiles.THETA_MODELS:
        raise UsageError(f"--thetaModel {args.thetaModel!r} is not one of {', '.join(profiles.THETA_MODELS)}")
    names = ("resolution", "rays", "incidence", "sampler", "seed")
    try:
        profiles.Request(max_bounces=args.maxBounces, **{name: getattr(args, name) for name in names})
    except ValueError as error:
        raise UsageError(str(error)) from None
