"""The images that the command ``render`` makes of a stage: one, or one for each frame, each resumed where it was."""

import argparse
from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import arguments
from .arguments import UsageError

if TYPE_CHECKING:
    from .render import Control, Film
    from .scene import Settings


class Shot(NamedTuple):
    """An image to make: its frame (None: the stage's own time), file, and checkpoint."""

    frame: float | None
    out: str
    checkpoint: str | None


def shots(args: argparse.Namespace) -> list[Shot]:
    """The images asked for; UsageError where the command line does not add up, OSError where one cannot be written."""
    from . import image
    from .frames import is_numbered, numbered, parse_frames

    if args.resume and not args.checkpoint:
        raise UsageError("--resume needs --checkpoint FILE")
    if Path(args.out).suffix.lower() not in image.SUFFIXES:
        raise UsageError(f"OUT {args.out!r} ends in none of {', '.join(image.SUFFIXES)}")
    try:
        frames: list[float | None] = [*parse_frames(args.frames)] if args.frames else [None]
        for name, what in ((args.out, "OUT"), (args.checkpoint, "--checkpoint")):
            if name and len(frames) > 1 and not is_numbered(name):
                raise UsageError(f"{what} {name!r} is one file for {len(frames)} frames; write ### in it")
        found = [Shot(f, numbered(args.out, f), args.checkpoint and numbered(args.checkpoint, f)) for f in frames]
    except ValueError as error:
        raise UsageError(str(error)) from error
    for shot in found:
        image.check_writable(shot.out)
        folder = Path(shot.checkpoint or shot.out).parent
        if not folder.is_dir():
            raise FileNotFoundError(f"{shot.checkpoint}: cannot be written, there is no folder {folder}")
    return found


def render(
    args: argparse.Namespace,
    asked: Sequence[Shot],
    settings: "Settings",
    view: Any,
    control: "Control",
    say: Callable[[str], None],
    warn: Callable[[Sequence[str], set[str], bool], None],
) -> Iterator[dict[str, Any]]:
    """Make the images and yield what there is to say of each: image, frame, warnings, stats, what was predicted.

    A snapshot lies beside its image. Checkpoints of frames that are done go when all are done, so that ``--resume``
    leaves those frames alone.
    """
    import scratchwarp as sw

    from .plan.cost import forecast
    from .render import AOVS, Farm, bar, checkpoint
    from .render.farm import workers_of
    from .render.target import reached

    told: set[str] = set()
    layers = arguments.listed(",".join(args.aov))
    unknown = sorted(set(layers) - set(AOVS))
    if unknown:
        raise UsageError(f"--aov {unknown[0]!r} is not one of {', '.join(AOVS)}")
    if args.scheduler:
        try:
            workers_of(args.scheduler)
        except ValueError as error:
            raise UsageError(f"--scheduler {error}") from None
    with Farm(args.scheduler, args.maxMemory) if args.scheduler else nullcontext() as farm:
        for shot in asked:
            scene = sw.read(args.stage, frame=shot.frame, **arguments.reading(args))
            warn(scene.warnings, told, args.quiet)
            plan = sw.make_plan(scene, settings)
            warn(plan.warnings, told, args.quiet)
            if args.resume and Path(shot.out).exists() and checkpoint.is_finished(shot.checkpoint or "", scene, plan):
                warn((f"{shot.out} is done already",), told, args.quiet)
                continue
            asked_for, foreign = scene.options.layers(AOVS)
            missing = [f"{args.stage}: a render var asks for {source!r}, which is no layer" for source in foreign]
            warn(missing, told, args.quiet)
            aovs = layers or list(asked_for) or None

            def show(film: "Film", out: str = shot.out, aovs: list[str] | tuple[str, ...] | None = aovs) -> None:
                beside = str(Path(out).with_suffix(f".snapshot{Path(out).suffix}"))
                sw.write(film, beside, aovs=aovs, view=view)
                if not args.quiet:
                    say(f"snapshot {beside}")

            predicted = forecast(scene, plan) if args.cost or args.json else None
            how: dict[str, Any] = {"checkpoint": shot.checkpoint, "resume": args.resume, "keep": True}
            with bar(args.quiet, Path(shot.out).name) as progress:
                film = sw.render(scene, plan, progress=progress, farm=farm, control=control, snapshot=show, **how)
            warn(film.warnings, told, args.quiet)
            sw.write(film, shot.out, aovs=aovs, view=view)
            if shot.checkpoint and len(asked) > 1:
                checkpoint.finish(shot.checkpoint)
            elif shot.checkpoint:
                Path(shot.checkpoint).unlink(missing_ok=True)
            if plan.settings.max_error is not None and not args.quiet:
                stats, samples = film.stats, int(film.metadata["scratchwarp:spp"])
                say(f"{shot.out}: {reached(samples, stats['error'], stats['halving'])}")
            if args.cost and predicted is not None and not args.json:
                say(f"{shot.out}:\n{predicted.text(film.stats)}")
            warnings = tuple(dict.fromkeys(scene.warnings + plan.warnings + film.warnings))
            row = {"image": shot.out, "frame": shot.frame, "warnings": warnings, "stats": dict(film.stats)}
            yield row | ({"predicted": predicted.record()} if predicted else {})
    for shot in asked:
        if shot.checkpoint:
            Path(shot.checkpoint).unlink(missing_ok=True)
