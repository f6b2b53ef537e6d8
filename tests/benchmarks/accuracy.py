"""Error targets, predictions and prices on stages that nothing was calibrated with.

    python tests/benchmarks/accuracy.py [FOLDER] [--width 96] [--stages kettle wood painted vinyl] [--quick]
    python tests/benchmarks/accuracy.py FOLDER --predicted     # predicted seconds alone, over processor seconds
    python tests/benchmarks/accuracy.py --plots docs --stages gold disc column --width 48 --budget 60

For each stage and each error from 0.1 to 0.003: the error reached against a reference of 4096 samples and the knobs'
reference values, over what was asked for; what the chosen settings cost over the cheapest settings of a grid that meet
it; predicted seconds over those taken. Seconds are of simulating tables and tracing on one thread: let the machine be
idle. Predictions go by the prices of costs.json, or by the user's own after study --calibrate. Prints a table and what
share of the cases keeps each bound; FOLDER gets accuracy.json.
"""

import argparse
import json
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import scratchwarp as sw
from scratchwarp.pipelines.author_demo import author
from scratchwarp.plan.cost import forecast
from scratchwarp.plan.knobs import KNOBS, acting
from scratchwarp.study.calibration import measured
from scratchwarp.study.chart import chart
from scratchwarp.study.measures import rel_mse

STAGES = ("kettle", "wood", "painted", "vinyl", "column")
ERRORS = (0.1, 0.03, 0.01, 0.003)
GRID_SPP = (2, 4, 8, 16, 32, 64, 128, 256, 512)
GRID_TABLES = ((16, 16), (32, 32), (64, 32), (64, 128), (128, 128), (256, 128))
SEEDS = (1, 2)
HELD = ("column", "grooved_sphere", "spoon_star", "vinyl", "zoom", "wood", "painted", "kettle")
SIZES = ((64, 16), (128, 4), (64, 64))
REFERENCE_SEED = 2_000_000_000


def shot(scene: Any, **settings: Any) -> tuple[Any, Any, float]:
    """(film, plan, seconds of simulating tables and tracing on one thread)."""
    plan = sw.make_plan(scene, sw.Settings(threads=1, **settings))
    film = sw.render(scene, plan)
    return film, plan, max(float(film.stats["simulate"] + film.stats["trace"]), 1e-3)


def measure(name: str, scene: Any, width: int, quick: bool) -> list[dict[str, Any]]:
    """Rows of one stage."""
    known = acting(sw.make_plan(scene, sw.Settings(width=width)))
    best = {n: KNOBS[n].reference for n in known if n.startswith("tables.") and n != "tables.theta"}
    best["spp"] = 512 if quick else 4096
    reference, _, _ = shot(scene, width=width, seed=REFERENCE_SEED, knobs=best)
    shot(scene, width=width, spp=1)  # compiled, and every first launch done
    grid = []
    for bins, rays in GRID_TABLES if "tables.resolution" in known else ((0, 0),):
        for spp in GRID_SPP[: 6 if quick else None]:
            knobs = {"tables.resolution": bins, "tables.rays": rays} if bins else {}
            film, _, taken = shot(scene, width=width, spp=spp, seed=SEEDS[0], knobs=knobs)
            grid.append((taken, rel_mse(film["color"], reference["color"])))
            if grid[-1][1] < 0.5 * ERRORS[-1]:
                break
    rows = []
    for error in ERRORS[: 2 if quick else None]:
        for seed in SEEDS[: 1 if quick else None]:
            film, plan, taken = shot(scene, width=width, max_error=error, seed=seed)
            there = replace(plan, settings=replace(plan.settings, spp=int(film.metadata["scratchwarp:spp"])))
            guess = forecast(scene, there)
            cheapest = min((t for t, e in grid if e <= error), default=float("nan"))
            rows.append({
                "stage": name, "error": error, "seed": seed, "samples": film.metadata["scratchwarp:spp"],
                "reached": rel_mse(film["color"], reference["color"]) / error,
                "estimated": film.stats["error"] / error, "missed": bool(film.stats["error"] > error),
                "price": taken / cheapest, "seconds": taken,
                "predicted": (guess.part("simulate") + guess.part("trace")) / taken,
                "knobs": dict(plan.aim.knobs),
            })  # fmt: skip
            row = rows[-1]
            print(f"{name:10s} {error:6g} seed {seed}: {row['samples']:5d} samples, reached {row['reached']:5.2f} e, "
                  f"estimated {row['estimated']:5.2f} e, price {row['price']:5.2f}, predicted {row['predicted']:5.2f} "
                  "of the time", flush=True)  # fmt: skip
    return rows


def predictions(name: str, scene: Any) -> list[dict[str, Any]]:
    """Predicted seconds of simulating and tracing over the processor seconds of it, at unlike footprints."""
    rows = []
    for width, spp in SIZES:
        settings = sw.Settings(width=width, spp=spp, threads=1)
        took = measured(name, scene, settings)
        guess = forecast(scene, sw.make_plan(scene, settings))
        simulated = sum(seconds for _, seconds in took.simulate)
        row = {"stage": name, "width": width, "spp": spp, "trace": guess.part("trace") / took.trace, "took": took.trace}
        row["simulate"] = guess.part("simulate") / simulated if simulated > 0.01 else None
        row["predicted"] = (guess.part("simulate") + guess.part("trace")) / (simulated + took.trace)
        rows.append(row)
        said = "" if row["simulate"] is None else f", tables {row['simulate']:5.2f}"
        print(f"{name:15s} {width:4d} wide, {spp:3d} samples: {took.trace:7.3f} s, predicted {row['predicted']:5.2f} "
              f"of the time (tracing {row['trace']:5.2f}{said})", flush=True)  # fmt: skip
    return rows


def plots(folder: Path, stages: list[str], width: int, budget: float, knobs: list[str] | None) -> None:
    """Error against seconds of every knob of the stages, ``budget`` seconds each."""
    with tempfile.TemporaryDirectory() as made:
        for file in map(Path, author(made, names=stages)):
            scene, settings = sw.read(file), sw.Settings(width=width, spp=8)
            known = acting(sw.make_plan(scene, settings))
            names = [name for name in knobs if name in known] if knobs else None
            report = sw.study.sweep(scene, names, settings=settings, budget=budget, repeats=2)
            names = [name for name in report.about["defaults"] if len(report.knob_rows(name)) > 1]
            joint = [row for row in report.rows if len(row.knobs) > 1]
            drawn = chart({name: report.knob_rows(name) for name in names}, joint, report.pareto())
            (folder / f"accuracy_{file.stem}.svg").write_text(drawn + "\n", encoding="utf-8")
            print(folder / f"accuracy_{file.stem}.svg", flush=True)


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", default="accuracy")
    parser.add_argument("--width", type=int, default=96)
    parser.add_argument("--stages", nargs="+")
    parser.add_argument("--predicted", action="store_true", help="predicted seconds alone")
    parser.add_argument("--knobs", nargs="+", help="of --plots; all that act on a stage unless given")
    parser.add_argument("--budget", type=float, default=600.0, help="seconds a stage of --plots [600]")
    parser.add_argument("--plots", metavar="DIR", help="study the stages instead; DIR/accuracy_STAGE.svg, as in docs/")
    parser.add_argument("--quick", action="store_true", help="two errors, one seed, small grid")
    args = parser.parse_args()
    folder = Path(args.folder)
    folder.mkdir(parents=True, exist_ok=True)
    if args.plots:
        plots(Path(args.plots), args.stages or list(STAGES), args.width, args.budget, args.knobs)
        return
    rows: list[dict[str, Any]] = []
    if args.predicted:
        with tempfile.TemporaryDirectory() as stages:
            for file in map(Path, author(stages, names=args.stages or list(HELD))):
                rows += predictions(file.stem, sw.read(file))
        (folder / "predicted.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
        off = np.array([abs(np.log2(row["predicted"])) for row in rows])
        print(f"{len(rows)} cases: predicted within a factor of 2 {np.mean(off <= 1):.0%} (wanted: all; median "
              f"{2 ** np.median(off):.2f}, most {2 ** off.max():.2f})")  # fmt: skip
        return
    with tempfile.TemporaryDirectory() as stages:
        for file in map(Path, author(stages, names=args.stages or list(STAGES))):
            rows += measure(file.stem, sw.read(file), args.width, args.quick)
            (folder / "accuracy.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    reached = np.array([row["reached"] for row in rows])
    price = np.array([row["price"] for row in rows])
    predicted = np.array([row["predicted"] for row in rows])
    price = price[np.isfinite(price)]
    print(f"{len(rows)} cases: below e {np.mean(reached <= 1):.0%} (wanted 95 %), above e/5 "
          f"{np.mean(reached > 0.2):.0%} (wanted: most), price at most 1.5 {np.mean(price <= 1.5):.0%} (wanted: all; "
          f"median {np.median(price):.2f}), predicted within 2 "
          f"{np.mean(np.abs(np.log2(predicted)) <= 1):.0%}")  # fmt: skip


if __name__ == "__main__":
    main()
