"""Simulate the tables of a stage once, compute its coverage, and keep both beside it; renders find them, and notice
when they are stale."""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .command import Command, Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp bake`` understands."""
    parser.add_argument("stage", metavar="STAGE", help="USD file; cup.usda is baked into the folder cup.bake")
    parser.add_argument("--variants", metavar="SET", help="every variant of this set, such as wear [the chosen]")
    parser.add_argument("--quality", help="of the renders to come: draft, preview, final or reference")
    parser.add_argument("--maxError", type=float, help="of the renders to come")


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into; ValueError and OSError where the input is at fault."""
    import scratchwarp as sw
    from scratchwarp.plan.coverage import FILE, bake_folder, text_of, thresholds_of
    from scratchwarp.render import bar
    from scratchwarp.render.baked import SUFFIX, Oven
    from scratchwarp.render.tables import simulate_tables
    from scratchwarp.whole import whole

    settings = sw.Settings(quality=options.quality, max_error=options.maxError)
    oven, plans = Oven(bake_folder(options.stage)), []
    for scene in scenes(options):
        plan = sw.make_plan(scene, settings)
        plans.append(plan)
        with bar(options.quiet or options.json, Path(options.stage).name) as progress:
            simulate_tables(plan, plan.settings.threads or 1, progress, oven)
    if not oven.files:
        raise ValueError(f"{options.stage}: no scratch layer of it needs a table; there is nothing to bake")
    thresholds = thresholds_of(plans)
    with whole(oven.folder / FILE) as draft:
        draft.write_text(text_of(thresholds), encoding="utf-8")
    oven.close({"stage": Path(options.stage).name, "scratchwarp": sw.__version__})
    size = sum((oven.folder / f"{key}{SUFFIX}").stat().st_size for key in oven.files)
    record = {"folder": str(oven.folder), "tables": len(oven.files), "bytes": size, "layers": sorted(oven.users)}
    record["thresholds"] = len(thresholds)
    return Report(record, (f"{oven.folder}: {len(oven.files)} tables, {size / 1e6:.1f} MB",))


def scenes(options: argparse.Namespace) -> Iterator[Any]:
    """The scenes to bake for: the stage as it is, or with every variant of a set."""
    import scratchwarp as sw

    from .contact_sheet import sessions

    if not options.variants:
        yield sw.read(options.stage)
        return
    for _, session in sessions(options.stage, options.variants):
        yield sw.read(options.stage, session_layer=session)


COMMAND = Command(
    name="bake",
    says="simulate the tables and coverage of a stage once and keep them beside it",
    examples=("scratchwarp bake worn.usda", "scratchwarp bake worn.usda --variants wear --quality final --json"),
    add_arguments=add_arguments,
    run=run,
    renders=True,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
