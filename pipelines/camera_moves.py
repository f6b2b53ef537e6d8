"""Pictures from a camera that moves about what the middle of the picture shows, or of geometry that turns."""

import argparse
import itertools
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

from . import pictures
from .command import Report, WrongUsage

Array = Any  # of NumPy, which loads when a pipeline runs


def add_arguments(parser: argparse.ArgumentParser, frames: int) -> None:
    """What every move understands."""
    parser.add_argument("stage", metavar="STAGE", help="USD file")
    parser.add_argument("out", metavar="OUT", help="image.####.png, .exr or .npz; ### stands for the frame number")
    parser.add_argument("--frames", type=int, default=frames, help=f"how many [{frames}]")
    parser.add_argument(
        "--target", type=float, nargs=3, metavar=("X", "Y", "Z"),
        help="what to move about, in metres [what the middle of the picture shows]",
    )  # fmt: skip
    parser.add_argument("--sheet", metavar="FILE", help="all frames in one picture, too")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="a Dask farm: tcp://HOST:PORT, or local:N workers here")
    pictures.add_rendering(parser)


def turned(matrix: Array, about: Array, axis: Array, angle: float) -> Array:
    """A camera's matrix [4, 4] turned by ``angle`` radians, counter-clockwise about the line through ``about`` along
    ``axis`` (Rodrigues' formula)."""
    import numpy as np

    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.eye(4)
    turn[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    turn[:3, 3] = about - turn[:3, :3] @ about
    return turn @ matrix


def moved(matrix: Array, about: Array, factor: float) -> Array:
    """A camera's matrix [4, 4] with its distance from ``about`` multiplied by ``factor``."""
    import numpy as np

    made = np.array(matrix, np.float64)
    made[:3, 3] = about + factor * (made[:3, 3] - about)
    return made


def orbit(scene: Any, about: Array, count: int) -> Iterator[Any]:
    """The scene from ``count`` cameras on one whole turn about the up axis."""
    import numpy as np

    for i in range(count):
        matrix = turned(scene.camera.transform, about, scene.up, 2 * np.pi * i / count)
        yield replace(scene, camera=replace(scene.camera, transform=matrix))


def spin(scene: Any, about: Array, count: int, only: str = "") -> Iterator[Any]:
    """The scene ``count`` times on one whole turn of its geometry about the up axis; camera and lights stay, and so do
    the meshes that are lights.

    ``only``: path of a prim, of which all instances below it turn alone. ValueError where there are none, or where the
    scene has curves in space, which belong to no instance.
    """
    import numpy as np

    path = only.rstrip("/")
    turning = [
        one.light < 0 and (not path or one.path == path or one.path.startswith(f"{path}/")) for one in scene.instances
    ]
    if not any(turning):
        where = f" at or below {only}" if only else ""
        raise ValueError(f"{scene.path}: there is no geometry{where} to turn")
    if path and any(curves.space == "object" for curves in scene.curves):
        raise ValueError(f"{scene.path}: curves in space turn with everything only; leave out --object")
    for i in range(count):
        turn = turned(np.eye(4), about, scene.up, 2 * np.pi * i / count)
        instances = tuple(
            replace(one, transform=turn @ one.transform) if mine else one
            for one, mine in zip(scene.instances, turning, strict=True)
        )
        curves = tuple(
            replace(one, points=one.points @ turn[:3, :3].T + turn[:3, 3]) if one.space == "object" else one
            for one in scene.curves
        )
        yield replace(scene, instances=instances, curves=curves)


def approach(scene: Any, about: Array, count: int, last: float) -> Iterator[Any]:
    """The scene from ``count`` cameras whose distances fall evenly in their logarithm, to ``last`` of the first."""
    camera = scene.camera
    for i in range(count):
        factor = last ** (i / max(count - 1, 1))
        lens = {"near": camera.near * factor, "focus_distance": camera.focus_distance * factor}
        yield replace(scene, camera=replace(camera, transform=moved(camera.transform, about, factor), **lens))


def middle(scene: Any) -> Array:
    """What the middle of the picture shows, in metres relative to the scene's origin; ValueError where that is
    nothing."""
    import numpy as np

    import scratchwarp as sw

    camera = scene.camera
    narrow = replace(
        camera, horizontal_aperture=1e-3 * camera.horizontal_aperture, vertical_aperture=1e-3 * camera.vertical_aperture
    )
    seen = replace(scene, camera=narrow)
    film = sw.render(seen, sw.make_plan(seen, sw.Settings(width=1, height=1, spp=1)))
    if film["primId"][0, 0] < 0:
        raise ValueError(f"{scene.path}: the middle of the picture shows nothing; say what to move about by --target")
    return np.asarray(film["P"][0, 0], np.float64) - scene.origin


def run(options: argparse.Namespace, moves: Callable[[Any, Array, int], Iterator[Any]]) -> Report:
    """Render and write every frame of a move; raises ValueError and OSError where the input is at fault."""
    import numpy as np

    import scratchwarp as sw
    from scratchwarp import image
    from scratchwarp.frames import is_numbered, numbered
    from scratchwarp.render.farm import workers_of

    if not 1 <= options.frames <= 10000:
        raise WrongUsage(f"--frames {options.frames} is not in [1, 10000]")
    if options.frames > 1 and not is_numbered(options.out):
        raise WrongUsage(f"OUT {options.out!r} is one file for {options.frames} frames; write ### in it")
    if options.scheduler:
        try:
            workers_of(options.scheduler)
        except ValueError as error:
            raise WrongUsage(f"--scheduler {error}") from None
    names = [numbered(options.out, float(i + 1)) for i in range(options.frames)]
    for name in itertools.chain(names, [options.sheet] if options.sheet else []):
        image.check_writable(name)
        pictures.check_out(name, [options.stage])
    scene = sw.read(options.stage, camera=options.camera)
    about = middle(scene) if options.target is None else np.asarray(options.target, np.float64) - scene.origin
    shots = []
    with frames(options, names, moves(scene, about, options.frames)) as made:
        for film in made:
            if options.sheet:
                shots.append(np.asarray(film["color"]))
    if options.sheet:
        image.write_layers({"color": pictures.grid(shots)}, options.sheet)
        names.append(options.sheet)
    return Report({"stage": options.stage, "target": (about + scene.origin).tolist(), "images": names}, tuple(names))


@contextmanager
def frames(options: argparse.Namespace, names: Sequence[str], scenes: Iterator[Any]) -> Iterator[Iterator[Any]]:
    """Yield the films of ``scenes``, each written to its name, in their order; several at a time on a farm."""
    import scratchwarp as sw
    from scratchwarp import image
    from scratchwarp.render import Farm, bars, side_by_side

    with (
        bars(options.quiet or options.json) as begin,
        Farm(options.scheduler) if options.scheduler else nullcontext() as farm,
    ):

        def maker(name: str, scene: Any) -> Callable[[Any], Any]:
            def make(control: Any) -> Any:
                progress = begin(Path(name).name)
                plan = sw.make_plan(scene, pictures.settings(options))
                film = sw.render(scene, plan, progress=progress, farm=farm, control=control)
                image.write(film, name)
                progress(1, 1, "done")
                return film

            return make

        makers = map(maker, names, scenes)
        yield side_by_side(farm, makers) if farm else (make(None) for make in makers)
