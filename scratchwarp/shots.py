"""The images that the command ``render`` makes of a stage: one, or one for each frame, each resumed where it was."""

import argparse
from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import arguments
from .arguments import UsageError

if TYPE_CHECKING:
    from .render import Control, Farm, Film
    from .render.progress import Progress
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

    A farm makes several at a time. A snapshot lies beside its image. Checkpoints of frames that are done go when all
    are done, so that ``--resume`` leaves those frames alone.
    """
    from .render import AOVS, Farm, bars, side_by_side
    from .render.farm import workers_of

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

    with bars(args.quiet) as begin, Farm(args.scheduler, args.maxMemory) if args.scheduler else nullcontext() as farm:

        def made(shot: Shot, mine: "Control", tell: Callable[[Sequence[str]], None]) -> dict[str, Any] | None:
            progress = begin(Path(shot.out).name)
            row = _made(args, shot, len(asked), layers, settings, view, mine, farm, progress, say, tell)
            if len(asked) > 1:
                progress(1, 1, "done")
            return row

        if farm is None or len(asked) == 1:
            for shot in asked:
                row = made(shot, control, lambda warnings: warn(warnings, told, args.quiet))
                if row is not None:
                    yield row
        else:

            def maker(shot: Shot) -> Callable[["Control"], tuple[list[str], dict[str, Any] | None]]:
                def make(mine: "Control") -> tuple[list[str], dict[str, Any] | None]:
                    warnings: list[str] = []
                    row = made(shot, mine, warnings.extend)
                    return warnings, row

                return make

            for warnings, row in side_by_side(farm, map(maker, asked), control):
                warn(warnings, told, args.quiet)
                if row is not None:
                    yield row
    for shot in asked:
        if shot.checkpoint:
            Path(shot.checkpoint).unlink(missing_ok=True)


def _made(
    args: argparse.Namespace,
    shot: Shot,
    count: int,
    layers: Sequence[str],
    settings: "Settings",
    view: Any,
    control: "Control",
    farm: "Farm | None",
    progress: "Progress",
    say: Callable[[str], None],
    tell: Callable[[Sequence[str]], None],
) -> dict[str, Any] | None:
    """Make one of ``count`` images, write it, and return what there is to say of it; None where it is done already.
    ``tell`` gets its warnings."""
    import scratchwarp as sw

    from .plan.cost import forecast
    from .render import AOVS, checkpoint
    from .render.target import reached

    scene = sw.read(args.stage, frame=shot.frame, **arguments.reading(args))
    tell(scene.warnings)
    plan = sw.make_plan(scene, settings)
    tell(plan.warnings)
    if args.resume and Path(shot.out).exists() and checkpoint.is_finished(shot.checkpoint or "", scene, plan):
        tell((f"{shot.out} is done already",))
        return None
    asked_for, foreign = scene.options.layers(AOVS)
    tell([f"{args.stage}: a render var asks for {source!r}, which is no layer" for source in foreign])
    aovs = list(layers) or list(asked_for) or None

    def show(film: "Film") -> None:
        beside = str(Path(shot.out).with_suffix(f".snapshot{Path(shot.out).suffix}"))
        sw.write(film, beside, aovs=aovs, view=view)
        if not args.quiet:
            say(f"snapshot {beside}")

    predicted = forecast(scene, plan) if args.cost or args.json else None
    how: dict[str, Any] = {"checkpoint": shot.checkpoint, "resume": args.resume, "keep": True}
    film = sw.render(scene, plan, progress=progress, farm=farm, control=control, snapshot=show, **how)
    tell(film.warnings)
    sw.write(film, shot.out, aovs=aovs, view=view)
    if shot.checkpoint and count > 1:
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
    return row | ({"predicted": predicted.record()} if predicted else {})
