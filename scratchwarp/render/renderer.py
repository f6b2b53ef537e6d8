"""render: simulate the plan's tables, build its kernel, trace its tiles."""

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import warp as wp

from ..kernels import Parts, assemble, kernel_key
from ..plan import EffectPlan
from ..profiles import Table
from ..scene import Scene
from ..scene.digest import digest
from . import baked, develop
from .canvas import Canvas
from .checkpoint import Checkpoint
from .described import described
from .film import Film
from .interrupt import Control
from .launch import loaded
from .progress import Progress, silent
from .tables import simulate_tables
from .target import MOST, begins, halving, noted, on_scale, says, until
from .trace import Job, Threads, Tracer

if TYPE_CHECKING:
    from .farm import Farm


def render(
    scene: Scene,
    plan: EffectPlan,
    progress: Progress | None = None,
    checkpoint: str | Path | None = None,
    resume: bool = False,
    device: str = "cpu",
    keep: bool = False,
    farm: "Farm | None" = None,
    control: Control | None = None,
    snapshot: Callable[[Film], None] | None = None,
    tables: dict[tuple[Any, ...], Table] | None = None,
    parts: Parts | None = None,
) -> Film:
    """Render a planned scene.

    Args:
        progress: called with (done, total, what) as work proceeds.
        checkpoint: file that every finished tile is kept in as it ends; removed at the end unless ``keep``.
        resume: go on from ``checkpoint`` when it exists; the image has the same bits as one rendered at once.
        device: Warp device.
        farm: workers that trace the tiles, in place of this process.
        control: ends the render or asks for snapshots, from another thread or a signal handler.
        snapshot: is given the image as it is whenever ``control`` asks; pixels without samples are black and
            transparent.
        tables: those of another render by ``identity``, which need not be simulated; replaced by those of this one.
        parts: what was built for another render of this scene; what is the same is taken from there. Both without
            ``farm``.

    With ``max_error``, samples are added until the error estimated from them is below it (see ``target``), and stats
    say what it came to.

    The image does not depend on ``threads``, ``tile`` or ``farm``. Raises ValueError on a checkpoint of another render,
    KeyboardInterrupt where ``control`` stops it.
    """
    progress, control = progress or silent, control or Control()
    settings = plan.settings
    threads, spp = settings.threads or 1, settings.spp or 1
    limit, left, most = settings.max_error, 0.0, MOST * spp
    if limit is not None and plan.aim is not None:
        spp, limit, left = plan.aim.first, plan.aim.noise, plan.aim.bias
    wp.config.log_level = max(wp.config.log_level, wp.LOG_WARNING)
    wp.init()
    clock, cpu = time.perf_counter(), time.process_time()
    bake = baked.find(scene.path)
    earlier = farm.tables if farm else tables
    simulated_tables, tables_simulated = simulate_tables(plan, threads, progress, bake, earlier)
    simulated = time.perf_counter()
    key = kernel_key(scene, plan)
    about = described(scene, plan, key)
    if farm is None:
        built = assemble(scene, plan, simulated_tables, device, parts, progress)
        kernel, fresh = loaded(key, device, progress)
        trace: Tracer = Threads(kernel, built, plan, device, control)
    else:
        # workers on this machine find the kernel compiled
        fresh = farm.local and loaded(key, device, progress)[1]
        trace = farm.tracer(scene, plan, simulated_tables, key, device, control, digest(about))
    compiled = time.perf_counter()

    x0, x1, y0, y1 = plan.window
    canvas = Canvas(x1 - x0, y1 - y0, settings.tile, remembers=limit is not None)
    disk = None
    if checkpoint is not None:
        begin = Checkpoint.resume if resume else Checkpoint
        disk = begin(checkpoint, about, canvas.tiles, canvas.sums)
        canvas.samples[:] = disk.samples

    def film(samples: int | np.ndarray, error: float, ended: float) -> Film:
        images = develop.aovs(canvas.sums, scene, samples)
        invalid, total = int(canvas.sums["invalid"].sum()), canvas.done
        warnings = trace.warnings + plan.warnings + (tuple(bake.warnings) if bake else ())
        if invalid:
            warnings += (f"{invalid} of {total} samples were not finite and were left out",)
        stats: dict[str, Any] = {
            "read": scene.seconds,
            "plan": plan.seconds,
            "simulate": simulated - clock,
            "compile": compiled - simulated,
            "trace": ended - compiled,
            "write": 0.0,
            "rays": int(canvas.sums["rays"].sum()),
            "samples": total,
            "kernels_compiled": int(fresh),
            "kernels_launched": trace.launches,
            "tables_simulated": tables_simulated,
            "invalid_samples": invalid,
            "error": error,
            "bias": left,
            "halving": halving(ended - compiled, error, left, 2.0 if plan.aim is None else plan.aim.halved),
            **trace.numbers,
        }
        seconds = time.process_time() - cpu + trace.cpu
        header = develop.metadata(scene, plan, digest(about), ended - clock, seconds)
        header |= {"scratchwarp:spp": int(np.max(samples)), **noted(error)}
        return Film(images, stats, header, plan.size, plan.window, warnings)

    def to(samples: int) -> None:
        """Trace what is missing to ``samples`` of every pixel."""

        def done(job: Job, sums: Mapping[str, np.ndarray]) -> None:
            canvas.put(job, sums, disk)
            progress(canvas.done, canvas.pixels * samples, "trace")
            if control.snapshot.is_set():
                control.snapshot.clear()
                if snapshot is not None:
                    snapshot(film(canvas.samples_of_pixels(), float("inf"), time.perf_counter()))

        progress(canvas.done, canvas.pixels * samples, "trace")
        trace(canvas.jobs(samples), done)

    begun = int(canvas.samples.max(initial=0))
    try:
        first = begins(spp) if limit is not None else [spp]
        for count in sorted({n for n in (begun, *first) if n >= max(begun, 1)}):
            to(count)
        samples, error = until(limit, max(spp, begun), lambda: canvas.sums, canvas.passes, to, most)
        error += left
    finally:
        if disk is not None:
            disk.close()
        if not control.stop.is_set():
            trace.close()
    if checkpoint is not None and not keep:
        Path(checkpoint).unlink(missing_ok=True)
    traced = time.perf_counter()
    made = film(samples, error, traced)
    if limit is not None:
        scaled = on_scale(made["variance"], made["color"], error - left)
        made = replace(made, aovs={**made.aovs, "error": scaled})
    said = says(settings.max_error, samples, error, traced - compiled, left)
    return replace(made, warnings=made.warnings + said)
