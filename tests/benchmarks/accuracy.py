"""Error targets, predictions and prices on stages that nothing was calibrated with.

    python tests/benchmarks/accuracy.py [FOLDER] [--width 64] [--stages kettle wood painted vinyl] [--quick]
    python tests/benchmarks/accuracy.py FOLDER --predicted     # predicted seconds alone, over processor seconds
    python tests/benchmarks/accuracy.py --plots docs --stages gold disc column --width 48 --budget 60

For each stage and each error from 0.1 to 0.003: the error reached against a reference of 4096 samples and the knobs'
reference values, over what was asked for; what the chosen settings cost over the cheapest settings of a grid that meet
it, and where they lie above that, whether tables, samples or the price of a sample make the difference; predicted
seconds over those taken. Seconds are processor time of simulating tables and tracing on one thread. References and the
grid, of the same seed as what is compared to it, are kept in a folder of the system's temporary one (``--fresh``
measures them anew, as is due after changes of the renderer). Predictions go by the prices of costs.json, or by the
user's own after study --calibrate. Prints a table and what share of the cases keeps each bound; FOLDER gets
accuracy.json.
"""

import argparse
import hashlib
import json
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import scratchwarp as sw
from scratchwarp.pipelines.author_demo import author
from scratchwarp.plan.cost import forecast
from scratchwarp.plan.knobs import KNOBS, acting
from scratchwarp.study.calibration import measured
from scratchwarp.study.chart import chart
from scratchwarp.study.measures import rel_mse, weights

STAGES = ("kettle", "wood", "painted", "vinyl", "column")
ERRORS = (0.1, 0.03, 0.01, 0.003)
GRID_SPP = (2, 4, 8, 16, 32, 64, 128, 256, 512)
GRID_TABLES = ((16, 16), (32, 32), (64, 32), (64, 128), (128, 128), (256, 128))
SEEDS = (1, 2)
REPEATS = 2
"""Renders of a case, of which the faster counts."""
MOST_PRICE = 1.5
HELD = ("column", "grooved_sphere", "spoon_star", "vinyl", "zoom", "wood", "painted", "kettle")
SIZES = ((64, 16), (128, 4), (64, 64))
REFERENCE_SEED = 2_000_000_000


@dataclass(frozen=True)
class Taken:
    """Processor seconds of tables and of tracing, the error that was left, samples a pixel and how it was made."""

    tables: float
    trace: float
    error: float
    samples: int
    how: str
    settings: dict[str, Any]

    @property
    def seconds(self) -> float:
        """Together."""
        return max(self.tables + self.trace, 1e-4)


class _Clock:
    """A progress that notes when tables begin, when they end and when tracing begins."""

    def __init__(self) -> None:
        self.at: dict[str, list[float]] = {"simulate": [], "trace": []}

    def __call__(self, done: int, total: int, what: str) -> None:
        if what in self.at:
            self.at[what].append(time.process_time())

    def spent(self, what: str, end: float | None = None) -> float:
        marks = self.at[what]
        return (marks[-1] if end is None else end) - marks[0] if marks else 0.0


@dataclass(frozen=True)
class Reference:
    """An image of many samples and the relMSE that its own noise leaves, known from its two halves."""

    color: np.ndarray
    noise: float

    def error(self, color: np.ndarray) -> float:
        """relMSE of an image, the reference's own noise taken out."""
        return max(rel_mse(color, self.color) - self.noise, 0.0)


def shot(scene: Any, reference: Reference | None = None, **settings: Any) -> tuple[Any, Any, Taken]:
    """(film, plan, what it took on one thread)."""
    plan = sw.make_plan(scene, sw.Settings(threads=1, **settings))
    clock = _Clock()
    film = sw.render(scene, plan, progress=clock)
    end = time.process_time()
    error = float("nan") if reference is None else reference.error(film["color"])
    samples = int(film.metadata["scratchwarp:spp"])
    how = ", ".join(f"{name} {value}" for name, value in plan.settings.knobs.items() if name != "spp")
    return film, plan, Taken(clock.spent("simulate"), clock.spent("trace", end), error, samples, how, settings)


def kept(kind: str, file: Path, width: int, *about: Any) -> Path:
    """Where something of a stage is kept from run to run."""
    folder = Path(tempfile.gettempdir()) / "scratchwarp_accuracy"
    folder.mkdir(exist_ok=True)
    content = hashlib.sha256(file.read_bytes() + repr((width, *about)).encode()).hexdigest()[:12]
    return folder / f"{file.stem}_{kind}_{content}"


def reference_of(scene: Any, file: Path, width: int, spp: int, fresh: bool) -> Reference:
    """The image at the reference values of the tables' knobs."""
    known = acting(sw.make_plan(scene, sw.Settings(width=width)))
    best = {n: KNOBS[n].reference for n in known if n.startswith("tables.") and n != "tables.theta"}
    best["spp"] = max(spp // 2, 1)
    halves = []
    for seed in (REFERENCE_SEED, REFERENCE_SEED + 1):
        place = kept("reference", file, width, sorted(best.items()), seed).with_suffix(".npy")
        if fresh or not place.is_file():
            np.save(place, shot(scene, width=width, seed=seed, knobs=best)[0]["color"])
        halves.append(np.load(place).astype(np.float64))
    whole = 0.5 * (halves[0] + halves[1])
    apart = float((((halves[0] - halves[1]) ** 2).mean(axis=-1) * weights(whole)).mean())
    return Reference(whole, 0.25 * apart)


def grid_of(scene: Any, file: Path, width: int, reference: Reference, seed: int, fresh: bool) -> list[Taken]:
    """Settings of tables by samples, cheapest tables first; more samples than any error needs are left out."""
    place = kept("grid", file, width, GRID_SPP, GRID_TABLES, ERRORS, reference.noise, seed).with_suffix(".json")
    if place.is_file() and not fresh:
        return [Taken(**row) for row in json.loads(place.read_text(encoding="utf-8"))]
    known = acting(sw.make_plan(scene, sw.Settings(width=width)))
    grid: list[Taken] = []
    shot(scene, width=width, spp=1)  # compiled, and every first launch done
    for bins, rays in GRID_TABLES if "tables.resolution" in known else ((0, 0),):
        knobs = {"tables.resolution": bins, "tables.rays": rays} if bins else {}
        for spp in GRID_SPP:
            row = shot(scene, reference, width=width, spp=spp, seed=seed, knobs=knobs)[2]
            grid.append(row)
            if row.error < 0.5 * ERRORS[-1] or all(row.seconds > cheapest(grid, e).seconds for e in ERRORS):
                break
    place.write_text(json.dumps([asdict(row) for row in grid]), encoding="utf-8")
    return grid


def cheapest(grid: Sequence[Taken], error: float) -> Taken:
    """The cheapest that meets an error; one that takes forever where none does."""
    nothing = Taken(0.0, float("inf"), float("inf"), 0, "nothing", {})
    return min((row for row in grid if row.error <= error), key=lambda row: row.seconds, default=nothing)


def causes(own: Taken, best: Taken) -> dict[str, float]:
    """Seconds over the cheapest: of tables; of samples, at its price of one; of dearer samples (looks at the error,
    knobs of tracing)."""
    each = best.trace / max(best.samples, 1)
    more = (own.samples - best.samples) * each
    return {"tables": own.tables - best.tables, "samples": more, "each": own.trace - best.trace - more}


def measure(scene: Any, file: Path, width: int, options: Any) -> list[dict[str, Any]]:
    """Rows of one stage."""
    name, quick = file.stem, options.quick
    reference = reference_of(scene, file, width, 512 if quick else options.reference, options.fresh)
    rows = []
    for seed in SEEDS[: 1 if quick else None]:
        grid = grid_of(scene, file, width, reference, seed, options.fresh)
        for error in ERRORS[: 2 if quick else None]:
            found = cheapest(grid, error)
            runs = [shot(scene, reference, width=width, max_error=error, seed=seed) for _ in range(REPEATS)]
            film, plan, own = min(runs, key=lambda run: run[2].seconds)
            again = [shot(scene, reference, **found.settings)[2] for _ in range(REPEATS if found.settings else 0)]
            best = min(again, key=lambda row: row.seconds, default=found)  # as busy a machine
            there = replace(plan, settings=replace(plan.settings, spp=own.samples))
            guess = forecast(scene, there)
            over = causes(own, best)
            rows.append({
                "stage": name, "error": error, "seed": seed, "samples": own.samples,
                "reached": own.error / error, "bias": film.stats["bias"] / error,
                "estimated": film.stats["error"] / error, "missed": bool(film.stats["error"] > error),
                "price": own.seconds / best.seconds if np.isfinite(best.seconds) else None, "seconds": own.seconds,
                "predicted": (guess.part("simulate") + guess.part("trace")) / own.seconds,
                "knobs": dict(plan.aim.knobs), "reference": reference.noise / error,
                "own": asdict(own), "best": asdict(best), "over": over,
                "cause": max(over, key=lambda part: over[part]),
            })  # fmt: skip
            row = rows[-1]
            said = ""
            if row["price"] and row["price"] > MOST_PRICE:
                parts = ", ".join(f"{part} {1e3 * s:+.0f}" for part, s in over.items())
                said = f"; over {1e3 * best.seconds:.0f} ms of {best.samples} samples, {best.how}: {parts} ms"
            print(f"{name:10s} {error:6g} seed {seed}: {own.samples:4d} samples, {own.how}: reached "
                  f"{row['reached']:5.2f} e, estimated {row['estimated']:5.2f} e, price {row['price'] or np.nan:5.2f}, "
                  f"predicted {row['predicted']:5.2f} of the time{said}", flush=True)  # fmt: skip
    return rows


def summary(rows: Sequence[dict[str, Any]]) -> str:
    """What share of the cases keeps each bound, and why prices are over theirs."""
    reached = np.array([row["reached"] for row in rows])
    predicted = np.array([row["predicted"] for row in rows])
    priced = [row for row in rows if row["price"] is not None]
    price = np.array([row["price"] for row in priced])
    over = [row for row in priced if row["price"] > MOST_PRICE]
    names = ("tables", "samples", "each")
    why = ", ".join(f"{name} {sum(row['cause'] == name for row in over)}" for name in names)
    return (
        f"{len(rows)} cases: below e {np.mean(reached <= 1):.0%} (wanted 95 %), above e/5 "
        f"{np.mean(reached > 0.2):.0%} (wanted: most; median {np.median(reached):.2f}), price at most {MOST_PRICE:g} "
        f"{np.mean(price <= MOST_PRICE):.0%} of {len(price)} (wanted: all; median {np.median(price):.2f}), predicted "
        f"within 2 {np.mean(np.abs(np.log2(predicted)) <= 1):.0%}\nprices over {MOST_PRICE:g}, by what makes most of "
        f"the difference: {why}"
    )


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
            drawn = chart({name: report.knob_rows(name) for name in names}, joint, report.pareto(), report.floor)
            (folder / f"accuracy_{file.stem}.svg").write_text(drawn + "\n", encoding="utf-8")
            print(folder / f"accuracy_{file.stem}.svg", flush=True)


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", default="accuracy")
    parser.add_argument("--width", type=int, default=64)
    parser.add_argument("--reference", type=int, default=4096, help="samples of references [4096]")
    parser.add_argument("--fresh", action="store_true", help="render references and grids anew")
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
            rows += measure(sw.read(file), file, args.width, args)
            (folder / "accuracy.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    print(summary(rows))


if __name__ == "__main__":
    main()
