"""render: simulate the plan's tables, build its kernel, trace its tiles."""

import time
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import warp as wp

from .. import __version__, profiles
from ..kernels import Assembled, assemble
from ..plan import EffectPlan, TablePlan
from ..scene import Scene
from ..scene.digest import digest
from . import baked, develop
from . import checkpoint as checkpoints
from .baked import Baked, Oven
from .film import Film
from .launch import SAMPLES_A_LAUNCH, SUMS, film_arrays, launcher, loaded
from .progress import Progress, silent
from .target import noted, says, until
from .tiles import Tile, run, tiles

# Seconds between checkpoints.
CHECKPOINT_EVERY = 10.0


def _simulated(
    table: TablePlan, profile: profiles.Profile, threads: int, store: Baked | Oven | None = None
) -> profiles.Table:
    """The table of one cross-section, as ``table`` asks for it."""
    if table.source == "facets":
        return profiles.facet_table(profile, table.fresnel, table.resolution, table.theta_model)
    return profiles.simulate(
        profile,
        resolution=table.resolution,
        rays=table.rays,
        fresnel=table.fresnel,
        max_bounces=table.max_bounces,
        theta_model=table.theta_model,
        sampler=table.sampler,
        incidence=table.incidence,
        threads=threads,
        store=store,
    )


def simulate_table(
    table: TablePlan,
    threads: int,
    known: dict[tuple[Any, ...], profiles.Table] | None = None,
    store: Baked | Oven | None = None,
) -> profiles.Table:
    """One of the plan's profile tables; ``known``: the cross-sections simulated for the table before, which it may
    share, replaced by its own; ``store``: tables baked before, or an oven that keeps them."""
    if not table.parts:
        return _simulated(table, table.profile, threads, store)
    known = {} if known is None else known
    how = (table.max_bounces, table.resolution, table.rays, table.sampler, table.incidence)
    asked = (table.source, table.fresnel, table.theta_model, *how)
    made: dict[tuple[Any, ...], profiles.Table] = {}
    for profile, _ in table.parts:
        key = (profile.token, asked)
        made[key] = made.get(key) or known.get(key) or _simulated(table, profile, threads, store)
    known.clear()
    known.update(made)
    return profiles.mixture([made[p.token, asked] for p, _ in table.parts], [share for _, share in table.parts])


def simulate_tables(
    plan: EffectPlan, threads: int, progress: Progress = silent, store: Baked | Oven | None = None
) -> tuple[list[profiles.Table], int]:
    """The plan's profile tables, in order, and how many of them had to be simulated."""
    simulated = 0
    made: list[profiles.Table] = []
    known: dict[tuple[Any, ...], profiles.Table] = {}
    for number, table in enumerate(plan.tables):
        progress(number, len(plan.tables), "simulate")
        made.append(simulate_table(table, threads, known, store))
        simulated += store is None or table.source == "facets" or not store.note(table.users)
    if plan.tables:
        progress(len(plan.tables), len(plan.tables), "simulate")
    return made, simulated


def render(
    scene: Scene,
    plan: EffectPlan,
    progress: Progress | None = None,
    checkpoint: str | Path | None = None,
    resume: bool = False,
    device: str = "cpu",
) -> Film:
    """Render a planned scene.

    Args:
        progress: called with (done, total, what) as work proceeds.
        checkpoint: file that finished tiles are kept in while rendering and after an interruption; removed at the end.
        resume: go on from ``checkpoint`` when it exists; the image has the same bits as one rendered at once.
        device: Warp device.

    With ``max_error``, the samples are doubled until the error estimated from them is below it (see ``target``), and
    stats say what it came to.

    The image does not depend on ``threads`` or ``tile``. Raises ValueError on a checkpoint of another render.
    """
    progress = progress or silent
    settings = plan.settings
    threads, spp = settings.threads or 1, settings.spp or 1
    wp.config.log_level = max(wp.config.log_level, wp.LOG_WARNING)
    wp.init()
    clock, cpu = time.perf_counter(), time.process_time()
    bake = baked.find(scene.path)
    tables, tables_simulated = simulate_tables(plan, threads, progress, bake)
    simulated = time.perf_counter()
    built = assemble(scene, plan, tables, device)
    kernel, fresh = loaded(built.key, device, progress)
    compiled = time.perf_counter()

    x0, x1, y0, y1 = plan.window
    width, height = x1 - x0, y1 - y0
    film = film_arrays(width, height, device)
    jobs = tiles(width, height, settings.tile)
    total = width * height * spp
    key = render_digest(scene, plan, built)
    on_cpu = wp.get_device(device).is_cpu
    finished = np.zeros(len(jobs), bool)
    views = {name: getattr(film, name).numpy() for name in SUMS} if on_cpu else {}
    if checkpoint and resume:
        empty = {name: view[0, 0].copy() for name, view in views.items()}
        stored = checkpoints.load(checkpoint, key, views)
        finished = finished if stored is None else stored
        for tile in (tile for tile, is_whole in zip(jobs, finished, strict=True) if not is_whole):
            # it may have been half done when the checkpoint was written
            for name, view in views.items():
                view[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = empty[name]
    position = {tile: i for i, tile in enumerate(jobs)}
    state = {"done": sum(t.width * t.height for t in jobs if finished[position[t]]) * spp, "launches": 0}
    state |= {"first": 0, "count": spp}
    last = [time.perf_counter()]

    def worker() -> Callable[[Tile], None]:
        launch = launcher(kernel, built, plan, film, device)

        def work(tile: Tile) -> None:
            start, count = state["first"], state["count"]
            for first in range(start, start + count, SAMPLES_A_LAUNCH):
                launch(tile, first, min(SAMPLES_A_LAUNCH, start + count - first))

        return work

    def done(tile: Tile) -> None:
        finished[position[tile]] = True
        state["done"] += tile.width * tile.height * state["count"]
        state["launches"] += -(-state["count"] // SAMPLES_A_LAUNCH)
        progress(state["done"], width * height * (state["first"] + state["count"]), "trace")
        if state["first"] == 0 and checkpoint and time.perf_counter() - last[0] > CHECKPOINT_EVERY:
            checkpoints.save(checkpoint, key, finished, views)
            last[0] = time.perf_counter()

    progress(state["done"], total, "trace")
    todo = [t for t in jobs if not finished[position[t]]]
    try:
        run(todo, [worker() for _ in range(max(1, min(threads if on_cpu else 1, len(todo))))], done)
    except BaseException:
        if checkpoint:
            checkpoints.save(checkpoint, key, finished, views)
        raise
    if not on_cpu:
        wp.synchronize_device(device)
    limit = settings.max_error
    if checkpoint and limit is not None:
        checkpoints.save(checkpoint, key, finished, views)  # passes to the target begin here, whatever stops them

    def sums_now() -> dict[str, Any]:
        return {name: getattr(film, name).numpy() for name in SUMS}

    def more(first: int, count: int) -> None:
        state["first"], state["count"] = first, count
        run(jobs, [worker() for _ in range(max(1, min(threads if on_cpu else 1, len(jobs))))], done)
        if not on_cpu:
            wp.synchronize_device(device)

    samples, error = until(limit, spp, sums_now, more)
    total = width * height * samples
    if checkpoint:
        Path(checkpoint).unlink(missing_ok=True)
    traced = time.perf_counter()

    sums = sums_now()
    images = develop.aovs(sums, scene, samples)
    invalid = int(sums["invalid"].sum())
    warnings = built.warnings + plan.warnings + (tuple(bake.warnings) if bake else ())
    warnings += says(limit, samples, error, traced - compiled)
    if invalid:
        warnings += (f"{invalid} of {total} samples were not finite and were left out",)
    stats: dict[str, Any] = {
        "read": scene.seconds,
        "plan": plan.seconds,
        "simulate": simulated - clock,
        "compile": compiled - simulated,
        "trace": traced - compiled,
        "write": 0.0,
        "rays": int(sums["rays"].sum()),
        "samples": total,
        "kernels_compiled": int(fresh),
        "kernels_launched": state["launches"],
        "tables_simulated": tables_simulated,
        "invalid_samples": invalid,
        "error": error,
        "halving": traced - compiled,
        **built.numbers,
    }
    header = develop.metadata(scene, plan, key, traced - clock, time.process_time() - cpu)
    header |= {"scratchwarp:spp": samples, **noted(error)}
    return Film(images, stats, header, plan.size, plan.window, warnings)


def render_digest(scene: Scene, plan: EffectPlan, built: Assembled) -> str:
    """Hash of everything that decides an image and its tiles."""
    settings = plan.settings
    x0, x1, y0, y1 = plan.window
    return digest(
        __version__,
        scene_digest(scene),
        settings.seed,
        settings.spp or 1,
        plan.size,
        plan.window,
        tiles(x1 - x0, y1 - y0, settings.tile)[0],
        plan.layers,
        plan.tables,
        plan.responses,
        built.key,
        settings.filter_width,
        settings.max_depth,
        settings.cone_taps,
        settings.knobs,
    )


def scene_digest(scene: Scene) -> str:
    """Hash of everything in the scene that decides an image."""
    decisive = [f.name for f in fields(scene) if f.name not in ("warnings", "seconds")]
    return digest(*(getattr(scene, name) for name in decisive))
