"""The command line: one thin function a sub-command.

Exit status: 0 done, 1 the input is at fault (one message), 2 wrong usage, 130 interrupted with the checkpoint kept.
"""

import argparse
import json
import os
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from . import arguments
from .arguments import UsageError

Command = argparse.Namespace


def main(argv: Sequence[str] | None = None) -> int:
    """Run one sub-command and return its exit status; argparse itself leaves with 2 on wrong usage."""
    args = arguments.parser().parse_args(argv)
    try:
        if args.command in COMMANDS:
            _start_warp()
        status = COMMANDS.get(args.command, pipeline)(args)
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        _interrupted(args)
        return 130
    except BrokenPipeError:  # the reader, such as head, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except Exception as error:
        if os.environ.get("SCRATCHWARP_DEBUG"):
            traceback.print_exc()
        if isinstance(error, UsageError):
            _say(f"{args.command}: error: {error}; see scratchwarp {args.command} --help")
            return 2
        expected = isinstance(error, ValueError | OSError | ImportError)
        hint = "" if expected else f" [{type(error).__name__}; a fault of scratchwarp: SCRATCHWARP_DEBUG=1 shows where]"
        _say(f"error: {error}{hint}")
        return 1


def render(args: Command) -> int:
    """STAGE to one image, or to one for each frame."""
    from . import shots
    from .render import signals

    settings, view, jobs = arguments.settings(args), _view(args), shots.shots(args)
    with signals(lambda: _interrupted(args)) as control:
        for row in shots.render(args, jobs, settings, view, control, _say, _warn):
            if args.json:
                print(json.dumps(row, default=_plain), flush=True)
            elif not args.quiet:
                print(row["image"], flush=True)
    return 0


def explain(args: Command) -> int:
    """Print which effects STAGE calls for, and why; what they cost where asked for."""
    import scratchwarp as sw

    from .plan.cost import forecast, slow

    scene = sw.read(args.stage, **arguments.reading(args))
    _warn(scene.warnings, set(), args.quiet)
    plan = sw.make_plan(scene, arguments.settings(args))
    laid: dict[str, int] = {}
    if "grooves" in plan.effects and plan.on("grooves"):
        from .kernels.groove_memory import described, taken

        laid = taken(scene, plan)
    predicted = forecast(scene, plan)
    cost, long = predicted if args.cost else None, [said] if (said := slow(predicted, plan)) else []
    _warn(long, set(), args.quiet)
    if args.json:
        effects = {n: {"enabled": e.enabled, "reason": e.reason, "prims": e.prims} for n, e in plan.effects.items()}
        warnings = [*scene.warnings, *plan.warnings, *long]
        row = {"stage": args.stage, "warnings": warnings, "effects": effects}
        row |= {"grooves": laid} if laid else {}
        print(json.dumps(row | ({"cost": cost.record()} if cost else {}), default=_plain))
    else:
        print(plan.explain() + (f"\n{described(laid, plan)}" if laid else "") + (f"\n\n{cost.text()}" if cost else ""))
    return 0


def simulate(args: Command) -> int:
    """Write the table of a profile, or those of a stage's layers, to EXR, NPZ or (as a picture) PNG."""
    import numpy as np

    from . import image, profiles, sections
    from .frames import is_numbered, numbered

    found, store = sections.cross_sections(args), profiles.store()
    if args.plot and len(found) > 1 and not is_numbered(args.plot):
        raise UsageError(f"--plot {args.plot} is one file for {len(found)} tables: choose one by --layer, or write ###")
    if len(found) > 1 and not is_numbered(args.out):
        names = "; ".join(name for name, _, _ in found)
        raise UsageError(
            f"{args.source} asks for {len(found)} tables ({names}): choose one by --layer, or write ### in OUT"
        )
    for number, (name, profile, fresnel) in enumerate(found, 1):
        out = numbered(args.out, float(number))
        plot = args.plot and numbered(args.plot, float(number))
        for path in (out, plot):
            if path:
                image.check_writable(path)
        table = profiles.simulate(
            profile,
            resolution=args.resolution,
            rays=args.rays,
            fresnel=fresnel,
            incidence=args.incidence,
            sampler=args.sampler,
            max_bounces=args.maxBounces,
            seed=args.seed,
            theta_model=args.thetaModel,
            polarised=args.polarised,
            store=store,
        )
        layers = {"mirror": table.mirror, **{f"bounce{i + 1}": part for i, part in enumerate(table.by_bounce)}}
        if table.normal is not None and table.gamma is not None:
            layers |= {"rho": table.normal, "gamma": table.gamma}
        if out.endswith(".png"):
            layers = {"color": profiles.picture(table, profile)}
        elif out.endswith(".npz"):
            layers |= {"angles": table.angles, "weights": table.weights, "lost": table.lost}
        header = {"Software": "scratchwarp", "scratchwarp:profile": name, **table.metadata}
        image.write_layers(layers, out, header)
        if plot:
            image.write_layers({"color": profiles.picture(table, profile)}, plot, header)
        if not args.quiet:
            print(f"{out}: {name}, {table.rays} rays, largest loss {float(np.max(table.lost)):.2g}", flush=True)
    return 0


def view(args: Command) -> int:
    """Open a window on STAGE, on one profile or on a measured BRDF, or write the picture of one."""
    from . import profiles, viewers
    from .frames import parse_frames

    try:
        frames = parse_frames(args.frame) if args.frame else [None]
    except ValueError as error:
        raise UsageError(str(error)) from error
    if len(frames) != 1:
        raise UsageError(f"--frame {args.frame!r} is {len(frames)} frames; a window shows one")
    options = {"width": args.imageWidth, "spp": args.spp}
    given = {name: value for name, value in options.items() if value is not None}
    reading = {"frame": frames[0], "camera": args.camera}
    reading |= {"max_memory": args.maxMemory} if args.maxMemory else {}
    if Path(args.stage).suffix.lower() in viewers.BRDFS:
        if given or args.profile is not None or args.depth is not None or args.frame or args.camera or args.web:
            raise UsageError("a measured BRDF has neither frames nor cameras nor profiles; give --screenshot alone")
        viewers.view_brdf(args.stage, args.screenshot)
        return 0
    if args.stage == "lobe":
        if given or args.profile is not None or args.depth is not None or args.frame or args.camera or args.web:
            raise UsageError("the lobe of one scratch has neither a stage nor profiles; give --screenshot alone")
        viewers.view_lobe(args.screenshot)
        return 0
    if args.web:
        if args.profile is not None or args.screenshot or args.depth is not None:
            raise UsageError("--web shows a whole stage; leave out --profile, --depth and --screenshot")
        named = {"host": args.host, "port": args.port, "save": args.save, "session_layer": args.sessionLayer}
        given |= {name: value for name, value in named.items() if value is not None}
        viewers.view_web(args.stage, browse=args.browse, **reading, **given)
        return 0
    for name in ("host", "port", "save", "sessionLayer"):
        if getattr(args, name) is not None:
            raise UsageError(f"--{name} is of the view in the browser; add --web")
    if args.profile is None and args.stage not in profiles.shape_names():
        if args.depth is not None:
            raise UsageError("--depth is of one profile; add --profile")
        viewers.view(args.stage, args.screenshot, **reading, **given)
        return 0
    if given:
        raise UsageError("--imageWidth and --spp are of the rendered image, which the window of a profile has not")
    viewers.view_profile(args.stage, args.screenshot, layer=args.profile or "", depth=args.depth, **reading)
    return 0


def fit(args: Command) -> int:
    """Fit stencils to MEASURED, write them as a material, and report how close they and their rivals come."""
    from .pipelines import measured_material
    from .reflectance import measured
    from .render import bar
    from .study import fit_candidates, fit_report

    if Path(args.out).suffix.lower() not in measured_material.SUFFIXES:
        raise UsageError(f"OUT {args.out!r} ends in none of {', '.join(measured_material.SUFFIXES)}")
    if args.modes is not None and not 1 <= args.modes <= 12:
        raise UsageError(f"--modes {args.modes} is not in [1, 12]")
    if args.material is not None and Path(args.measured).suffix.lower() not in measured_material.STAGES:
        raise UsageError("--material is of a USD stage")
    brdf, notes = measured_material.brdf_of(args.measured, args.material)
    rivals = measured.RIVALS if args.report and not args.no_refine else ()
    with bar(args.quiet, Path(args.measured).name) as progress:
        found = fit_candidates.candidates(
            brdf, args.modes, not args.no_refine, args.retro, rivals=rivals, progress=progress
        )
    ours, name = found[0], Path(args.measured).name
    measured_material.author(ours.model, args.out, comment=f"Fitted to {name} by scratchwarp.")
    written = [args.out]
    if args.report:
        how = "directly" if args.no_refine else "and refined by least squares"
        notes = [f"Highlight stencils fitted to {name}, {how}.", *notes]
        if args.no_refine:
            notes.append("Rival models are fitted by least squares too, and were left out with it.")
        written.append(str(fit_report.write(args.report, f"{name}: a fit", brdf, found, notes)))
    if args.json:
        rows = [fit_report.record(one) for one in found]
        print(json.dumps({"written": written, "candidates": rows}, default=_plain), flush=True)
    elif not args.quiet:
        print("\n".join([fit_report.table(found), *written]), flush=True)
    return 0


def study(args: Command) -> int:
    """Measure what accuracy costs on STAGE and write a report of it, or measure this machine's prices."""
    from . import studies

    text, record = studies.run(args, lambda warnings: _warn(warnings, set(), args.quiet))
    if args.json or not args.quiet:
        print(record if args.json else text, flush=True)
    return 0


def scratchmap(args: Command) -> int:
    """Make a seamless normal map of scratches."""
    from .pipelines import scratch_map

    try:
        written = scratch_map.run(args)
    except ValueError as error:
        raise UsageError(str(error)) from error
    if not args.quiet:
        print(*written, sep="\n", flush=True)
    return 0


def pipeline(args: Command) -> int:
    """Run one of the pipelines."""
    from .pipelines import command, commands

    asked = commands.COMMANDS[args.command]
    if asked.renders:
        _start_warp()
    try:
        return command.show(asked.run(args), args)
    except command.WrongUsage as error:
        raise UsageError(str(error)) from error


def demo(args: Command) -> int:
    """Author the demo stages in OUT_DIR and render each to EXR and PNG."""
    import scratchwarp as sw

    from .pipelines.author_demo import DEFAULT, STAGES, author
    from .render import bar

    names = args.only or DEFAULT
    for name in names:
        if name not in STAGES:
            raise UsageError(f"--only {name!r} is none of {', '.join(STAGES)}")
    settings = sw.Settings(width=args.imageWidth, spp=args.spp, threads=args.threads)
    Path(args.out).mkdir(parents=True, exist_ok=True)
    told: set[str] = set()
    for stage in author(args.out, names=names):
        stage = Path(stage)
        scene = sw.read(stage)
        with bar(args.quiet, stage.stem) as progress:
            film = sw.render(scene, sw.make_plan(scene, settings), progress=progress)
        _warn(scene.warnings + film.warnings, told, args.quiet)
        for out in (stage.with_suffix(".exr"), stage.with_suffix(".png")):
            sw.write(film, out)
            if not args.quiet:
                print(out, flush=True)
    return 0


def cache(args: Command) -> int:
    """Say what is kept on disk between runs, or clear it."""
    import warp

    from . import profiles

    store, kernels = profiles.store(), Path(str(warp.config.kernel_cache_dir))
    if args.clear:
        store.clear()
    if args.clearKernels:
        warp.clear_kernel_cache()
    files = [path for path in kernels.rglob("*") if path.is_file()]
    print(f"tables   {store.count:6d} files {store.size / 1e6:9.1f} MB  {store.path}")
    print(f"kernels  {len(files):6d} files {sum(path.stat().st_size for path in files) / 1e6:9.1f} MB  {kernels}")
    return 0


def _interrupted(args: Command) -> None:
    """Say what is left of a command that was interrupted."""
    kept = getattr(args, "checkpoint", None)
    if kept and "#" not in kept and not Path(kept).exists():  # nothing was rendered yet
        kept = None
    says = f"{kept} is kept, add --resume to go on" if kept else "no file was left half written"
    if getattr(args, "kept", None):
        says = f"what was measured is kept in {args.kept}; the same command goes on"
    _say(f"interrupted; {says}")


def _view(args: Command) -> Any:
    from . import image

    try:
        return image.color_view(args.colorCorrectionMode, args.display, args.view)
    except ValueError as error:
        raise UsageError(str(error)) from error


def _warn(warnings: Sequence[str], told: set[str], quiet: bool) -> None:
    """Print each warning that was not printed before."""
    for warning in warnings:
        if warning not in told and not quiet:
            _say(f"warning: {warning}")
        told.add(warning)


def _start_warp() -> None:
    from .render.quiet import start_warp

    start_warp()


def _say(text: str) -> None:
    print(f"scratchwarp: {text}", file=sys.stderr, flush=True)


def _plain(value: Any) -> Any:
    """What JSON does not know, as what it knows."""
    return value.tolist() if hasattr(value, "tolist") else str(value)


COMMANDS = {run.__name__: run for run in (render, explain, simulate, view, study, fit, scratchmap, demo, cache)}
