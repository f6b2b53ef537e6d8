"""What units of work cost on this machine: stages are rendered, their work is counted, and prices are fitted.

Processor time is measured, not wall-clock time, so that other programs on the machine count little.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..kernels import assemble
from ..plan import make_plan
from ..plan.cost.models import FORMAT, shipped, user_file
from ..plan.cost.work import Work, of_table, work
from ..render.launch import film_arrays, launcher, loaded
from ..render.progress import Progress, silent
from ..render.tables import simulate_table
from ..render.tiles import run, tiles
from ..scene import Scene, Settings
from ..whole import whole
from .price_fit import fitted, known_prices, machine_speed
from .report import machine

STAGES = (
    "ball", "plain", "panel", "gold", "plastic", "patterns", "spoon", "spoon_window", "spoon_dome", "disc", "roof",
    "grooves_parallel", "grooves_crossing", "vinyls",
)  # fmt: skip
"""Demo stages that prices are fitted to; the others are for testing them."""
WIDER = 2
"""Samples a pixel of a second measurement where work depends on what a sample stands for."""
TABLE_SIZES = ((32, 16), (64, 128), (128, 32), (256, 16), (256, 512))
"""(resolution, rays) of tables that are measured besides the default."""
VARIANTS: tuple[dict[str, bool], ...] = (
    {},
    {"shadows": False},
    {"scratches": False},
    {"lights.dome": False},
    {"lights.rect": False},
    {"lights.sphere": False},
    {"lights.closedForm": False},
)


@dataclass(frozen=True)
class Sample:
    """One stage under one setting: what it did, and the processor seconds of simulating, building and tracing."""

    name: str
    counted: Work
    simulate: tuple[tuple[Mapping[tuple[str, str], float], float], ...]
    build: float
    trace: float


def measured(name: str, scene: Scene, settings: Settings) -> Sample:
    """Render a scene part by part."""
    plan = make_plan(scene, settings)
    plan = replace(plan, settings=replace(plan.settings, max_error=None))
    tables, simulated = [], []
    for table in plan.tables:
        start = time.process_time()
        tables.append(simulate_table(table, 1))
        simulated.append((of_table(table), time.process_time() - start))
    start = time.process_time()
    built = assemble(scene, plan, tables)
    build = time.process_time() - start
    kernel, _ = loaded(built.key, "cpu")
    x0, x1, y0, y1 = plan.window
    film = film_arrays(x1 - x0, y1 - y0, "cpu")
    launch = launcher(kernel, built, plan, film, "cpu")
    jobs = tiles(x1 - x0, y1 - y0, plan.settings.tile)
    launch(jobs[0], 0, 1)  # what the first launch alone takes
    start = time.process_time()
    run(jobs, [lambda tile: launch(tile, 0, plan.settings.spp or 1)], lambda tile: None)
    trace = time.process_time() - start
    return Sample(name, work(scene, plan), tuple(simulated), build, trace)


def measured_tables(scene: Scene) -> list[tuple[Mapping[tuple[str, str], float], float]]:
    """(units, processor seconds) of the first tables of a scene at other resolutions and numbers of rays."""
    plan = make_plan(scene, Settings(width=8, threads=1))
    rows: list[tuple[Mapping[tuple[str, str], float], float]] = []
    for table in plan.tables[:3]:
        for resolution, rays in TABLE_SIZES:
            sized = replace(table, resolution=resolution, rays=rays, parts=table.parts[:3])
            start = time.process_time()
            simulate_table(sized, 1)
            rows.append((of_table(sized), time.process_time() - start))
    return rows


def _plain(units: Mapping[tuple[str, str], float], factor: float = 1.0) -> dict[str, float]:
    made: dict[str, float] = {}
    for (_, unit), count in units.items():
        made[unit] = made.get(unit, 0.0) + factor * count
    return made


def prices(
    samples: Sequence[Sample], more_tables: Sequence[tuple[Mapping[tuple[str, str], float], float]] = ()
) -> tuple[dict[str, float], float, float]:
    """(nanoseconds of every unit, price of the work of later surfaces of paths, spread of predictions)."""

    def counted(s: Sample, later: float) -> dict[str, float]:
        units = _plain(s.counted.each, s.counted.samples)
        more = 1.0 + later * s.counted.indirect
        return {unit: n if unit.startswith("camera") else n * more for unit, n in units.items()}

    taken = [s.trace for s in samples]
    known, later, found = known_prices(), shipped().indirect, dict[str, float]()
    speed = machine_speed([counted(s, later) for s in samples], taken, known)
    for _ in range(4 if any(s.counted.indirect for s in samples) else 1):
        found = fitted([counted(s, later) for s in samples], taken, known=known, speed=speed)
        ratios = []
        for s in (s for s in samples if s.counted.indirect > 0.0):
            first = sum(1e-9 * found[u] * n for u, n in counted(s, 0.0).items())
            once = sum(1e-9 * found[u] * n for u, n in counted(s, 0.0).items() if not u.startswith("camera"))
            ratios.append(max(s.trace - first, 0.05 * once) / max(once * s.counted.indirect, 1e-12))
        later = float(np.median(ratios)) if ratios else later
    off = [abs(np.log(s.trace / max(sum(1e-9 * found[u] * n for u, n in counted(s, later).items()), 1e-9)))
           for s in samples]  # fmt: skip
    tables = [*more_tables, *(row for s in samples for row in s.simulate)]
    of_tables = fitted([_plain(units) for units, _ in tables], [row[1] for row in tables], known=known, speed=speed)
    build = fitted([_plain(s.counted.build) for s in samples], [s.build for s in samples], known=known, speed=speed)
    rest = {unit: speed * ns for unit, ns in known.items()}
    return {**rest, **found, **of_tables, **build}, later, float(np.exp(np.quantile(off, 0.9)))


def _depends(scene: Scene) -> list[bool]:
    """Of each material, whether its scratches are looked for under a footprint."""
    return [m.wave is not None or any(layer.model == "groove" for layer in m.layers) for m in scene.materials]


def efficiency() -> float:
    """Share of one thread's speed that each of all threads has, of arithmetic that fits the caches; at most 1."""
    return 0.9 if (os.cpu_count() or 1) > 1 else 1.0


def cold_compile(stage: str | Path, features: int) -> tuple[float, float]:
    """(seconds of compiling the smallest kernel, seconds a feature): a stage rendered with an empty kernel cache."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "scratchwarp", "render", str(stage), str(Path(folder) / "one.png"), "--json"]
        command += ["--quiet", "--imageWidth", "8", "--spp", "1"]
        environment = {**os.environ, "WARP_CACHE_PATH": str(Path(folder) / "kernels")}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        rows = [line for line in done.stdout.splitlines() if line.startswith("{")]
        if done.returncode or not rows:
            return 4.0, 0.3
        seconds = float(json.loads(rows[-1])["stats"]["compile"])
    return 0.3 * seconds, 0.7 * seconds / max(features, 1)


def calibrate(
    stages: Iterable[tuple[str, Scene]],
    file: Path | None = None,
    width: int = 96,
    progress: Progress = silent,
    compile_stage: str | Path | None = None,
) -> Path:
    """Measure stages and write the prices; the file. ``stages``: (name, scene); of the first, effects are switched off
    one at a time, too. ``compile_stage``: a stage to compile with an empty cache, None leaves that out."""
    known, samples = list(stages), []
    jobs: list[tuple[str, Scene, dict[str, bool], dict[str, Any]]] = []
    for number, (name, scene) in enumerate(known):
        for forced in VARIANTS if number == 0 else ({},):
            jobs.append((name, scene, forced, {"spp": 16}))
    jobs += [(name, scene, {}, {"spp": 8, "integrator": "path"}) for name, scene in known[:3]]
    wide = [(name, scene) for name, scene in known if any(_depends(scene))]
    jobs += [(name, scene, {}, {"spp": WIDER}) for name, scene in wide]
    for number, (name, scene, forced, more) in enumerate(jobs):
        progress(number, len(jobs), f"calibrate {name}")
        samples.append(measured(name, scene, Settings(width=width, threads=1, effects=forced, **more)))
    progress(len(jobs), len(jobs), "calibrate")
    found, indirect, spread = prices(samples, [row for _, scene in known for row in measured_tables(scene)])
    cold = (4.0, 0.3)
    if compile_stage is not None:
        plan = make_plan(known[0][1], Settings(width=8))
        cold = cold_compile(compile_stage, sum(choice.enabled for choice in plan.effects.values()))
    target = file or user_file()
    record = {
        "format": FORMAT,
        **machine(),
        "stages": [name for name, _ in known],
        "nanoseconds": {unit: round(ns, 3) for unit, ns in sorted(found.items())},
        "cold": [round(x, 3) for x in cold],
        "indirect": round(indirect, 3),
        "spread": round(spread, 3),
        "efficiency": efficiency(),
    }
    target.parent.mkdir(parents=True, exist_ok=True)
    with whole(target) as draft:
        draft.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return target
