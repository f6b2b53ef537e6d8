"""sweep: render a scene at many settings, in turns, and compare with a reference.

Each round renders every setting once with the round's own seed, beginning with the defaults: a slow moment of the
machine then meets all of them alike, and ratios of seconds within a round tell cost from it. The reference has all
knobs that are swept at their reference values, ``REFERENCE_FACTOR`` times the samples of the dearest setting and other
seeds; lights along cones are sampled there, not integrated. What a knob that is no noise
does is found without noise, too: by the same samples at the knob's reference value.
"""

import time
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..kernels import kernel_key
from ..plan import EffectPlan, make_plan
from ..plan.knobs import KNOBS, acting, checked
from ..profiles import Table
from ..render.described import scene_digest
from ..render.progress import Progress, silent
from ..render.renderer import render
from ..scene import Scene, Settings
from ..scene.digest import digest
from ..scene.knob import Value
from ..whole import whole
from .measurement import PARTS, Measurement, Notebook, setting_name
from .measures import flip, rel_mse
from .report import Report, file_name
from .table_error import table_error, tables_of

REFERENCE_FACTOR = 4
REFERENCE_SEED = 2_000_000_000
LEAST_REFERENCE = 256
Setting = dict[str, Value]


def sweep(
    scene: Scene,
    knobs: Iterable[str] | Mapping[str, Iterable[Value]] | None = None,
    reference: Mapping[str, Value] | None = None,
    repeats: int = 3,
    settings: Settings | None = None,
    budget: float | None = None,
    folder: str | Path | None = None,
    progress: Progress | None = None,
) -> Report:
    """Error against time of every knob, one at a time, then of several at once while the budget lasts.

    Args:
        knobs: names, or name -> values; None: all that act on the scene, at all of their values.
        reference: name -> value of the reference; what is left out has the knob's own reference value.
        repeats: rounds. settings: of all renderings; its seed is that of the first round.
        budget: seconds; the reference and the defaults are always rendered, what does not fit is left to the next call
            that is alike. None: no joint search.
        folder: measurements and images are kept there as they come, and found again by the next call that is alike.

    Raises ValueError on unknown knobs or values, and where the scene cannot be planned.
    """
    if repeats < 1:
        raise ValueError(f"repeats must be 1 or more, got {repeats}")
    start, progress = time.perf_counter(), progress or silent
    study = _Study(scene, settings or Settings(width=160), knobs, reference, Path(folder) if folder else None)
    jobs = [(knobs, number) for number in range(repeats) for knobs in study.settings]
    todo = [job for job in jobs if not study.book.has(*job)]
    study.known_reference(lambda done, total, what: progress(done, total, f"reference, {what}"))
    for number, (setting, repeat) in enumerate(todo):
        spent = time.perf_counter() - start
        if budget is not None and study.book.rows and spent > (0.6 if repeat else 0.9) * budget:
            break
        progress(number, len(todo), "settings")
        study.measure(setting, repeat)
    progress(len(todo), len(todo), "settings")
    while budget is not None and (left := budget - (time.perf_counter() - start)) > 0.0:
        progress(int(budget - left), int(budget), "joint search")
        candidate = study.neighbour()
        if candidate is None or study.measure(candidate, 0) > left:
            break
    return study.report(time.perf_counter() - start)


class _Study:
    """What one sweep knows: settings to render, measurements, images."""

    def __init__(
        self,
        scene: Scene,
        settings: Settings,
        knobs: Iterable[str] | Mapping[str, Iterable[Value]] | None,
        reference: Mapping[str, Value] | None,
        folder: Path | None,
    ) -> None:
        self.scene, self.base = scene, replace(settings, knobs=checked(settings.knobs))
        plan = make_plan(scene, self.base)
        self.plan = plan
        known = acting(plan)
        names = list(known) if knobs is None else list(knobs)
        given = knobs if isinstance(knobs, Mapping) else {}
        checked({name: KNOBS[name].default if name in KNOBS else 0 for name in names})
        self.ladders = {n: tuple(KNOBS[n].checked(v) for v in given.get(n, self._values(n))) for n in names}
        self.settings: list[Setting] = [{}]
        own, compiled = kernel_key(scene, plan), list[Setting]()
        for name, values in self.ladders.items():
            for value in (value for value in values if value != self.default(name)):
                made = self._planned({name: value})
                if made is not None:
                    alike = kernel_key(scene, made) == own
                    (self.settings if alike else compiled).append({name: value})
        self.settings += compiled  # last: compiling takes from the budget
        self.best = {n: KNOBS[n].reference for n in names if n not in ("spp", "lights.cones")}
        if "lights.cones" in known:
            self.best["lights.cones"] = "both"
        samples = [self.spp, *(s["spp"] for s in self.settings if "spp" in s)]
        self.best["spp"] = max(REFERENCE_FACTOR * max(int(n) for n in samples), LEAST_REFERENCE)
        self.best |= checked(reference or {})
        self.key = digest(scene_digest(scene), self.base, self.best, self.ladders)
        self.book = Notebook(folder, self.key)
        self.folder = folder
        self.images: dict[str, np.ndarray] = {}
        self.seconds_of_defaults: dict[int, float] = {}
        self.tables: list[Table] = []  # at the reference values

    @property
    def spp(self) -> int:
        return self.plan.settings.spp or 1

    def default(self, name: str) -> Value:
        """What a knob is at where nothing turns it."""
        chosen = self.plan.settings.knobs.get(name)
        return self.spp if name == "spp" else KNOBS[name].default if chosen is None else chosen

    def _values(self, name: str) -> tuple[Value, ...]:
        values = KNOBS[name].values
        return tuple(v for v in values if not isinstance(v, int) or v <= 4 * self.spp) if name == "spp" else values

    def _fits(self, name: str, value: Value) -> bool:
        """Whether a plan can be made with it."""
        return self._planned({name: value}) is not None

    def _planned(self, knobs: Setting) -> EffectPlan | None:
        try:
            return make_plan(self.scene, self._turned(knobs, 0))
        except ValueError:
            return None

    def _turned(self, knobs: Setting, seed: int) -> Settings:
        return replace(self.base, knobs={**self.base.knobs, **knobs}, seed=seed)

    def _rendered(self, knobs: Setting, seed: int, progress: Progress = silent) -> tuple[np.ndarray, dict[str, float]]:
        plan: EffectPlan = make_plan(self.scene, self._turned(knobs, seed))
        plan = replace(plan, aim=None, settings=replace(plan.settings, max_error=None))  # samples are given
        film = render(self.scene, plan, progress=progress)
        return film["color"], {part: float(film.stats[part]) for part in (*PARTS, "compile")}

    def known_reference(self, progress: Progress) -> None:
        """Render the reference, or find it in the folder."""
        file = self._kept("")
        if file is not None and file.is_file():
            self.reference = np.load(file, allow_pickle=False)
            return
        self.reference, _ = self._rendered(self.best, REFERENCE_SEED, progress)
        self._keep("", self.reference)

    def _kept(self, name: str) -> Path | None:
        """Where an image lies between calls; "" is the reference."""
        if self.folder is None:
            return None
        return self.folder / ".images" / f"{self.key}-{file_name(name) or 'reference'}.npy"

    def _keep(self, name: str, image: np.ndarray) -> None:
        file = self._kept(name)
        if file is not None:
            file.parent.mkdir(parents=True, exist_ok=True)
            with whole(file) as draft, draft.open("wb") as stream:
                np.save(stream, image)

    def seed(self, repeat: int) -> int:
        """The seed of a round."""
        return (self.base.seed or 0) + repeat

    def measure(self, knobs: Setting, repeat: int) -> float:
        """Render a setting and keep what it took; the seconds that this took."""
        start, seed = time.perf_counter(), self.seed(repeat)
        image, seconds = self._rendered(knobs, seed)
        name, total = setting_name(knobs), sum(seconds[part] for part in PARTS)
        if not knobs:
            self.seconds_of_defaults[repeat] = total
        base = self.seconds_of_defaults.get(repeat) or self._known_base(repeat) or total
        bias = None
        if len(knobs) == 1:
            (own, value), = knobs.items()
            paired = {own: KNOBS[own].reference}
            if not KNOBS[own].noise and value != KNOBS[own].reference and self._fits(own, KNOBS[own].reference):
                bias = rel_mse(image, self._paired(paired, seed))
        error = rel_mse(image, self.reference)
        table = self._table_error(knobs) if repeat == 0 else None
        row = Measurement(dict(knobs), repeat, seconds, base, error, bias, flip(image, self.reference), seed, table)
        self.book.add(row)
        if len(knobs) < 2 and name not in self.images:
            self.images[name] = image
            self._keep(name, image)
        return time.perf_counter() - start

    def _table_error(self, knobs: Setting) -> float | None:
        """Error of the tables where only they are turned, or nothing is."""
        if not self.plan.tables or any(KNOBS[name].place[0] != "table" for name in knobs):
            return None
        if not self.tables:
            own = {n: v for n, v in self.best.items() if KNOBS[n].place[0] == "table"}
            self.tables = tables_of(make_plan(self.scene, self._turned(own, 0)))
        return table_error(tables_of(make_plan(self.scene, self._turned(knobs, 0))), self.tables)

    def _known_base(self, repeat: int) -> float | None:
        return next((row.total for row in self.book.rows if not row.knobs and row.repeat == repeat), None)

    def _paired(self, knobs: Setting, seed: int) -> np.ndarray:
        """The image at a knob's reference value with the same samples, rendered once."""
        name = f"{setting_name(knobs)} @{seed}"
        if name not in self.images:
            self.images[name] = self._rendered(knobs, seed)[0]
        return self.images[name]

    def neighbour(self) -> Setting | None:
        """A setting that was not rendered yet: one of the front with one more knob turned, or one turned further;
        then of the others."""
        rows = Report.rows_of(self.book.rows)
        known = [dict(row.knobs) for row in rows]
        for row in sorted(rows, key=lambda row: (not row.front, row.seconds)):
            for name, values in self.ladders.items():
                at = row.knobs.get(name, self.default(name))
                place = values.index(at) if at in values else len(values) - 1
                for step in (-1, 1):
                    if not 0 <= place + step < len(values):
                        continue
                    wanted = {**row.knobs, name: values[place + step]}
                    wanted = {n: v for n, v in wanted.items() if v != self.default(n)}
                    if wanted not in known and all(self._fits(n, v) for n, v in wanted.items()):
                        return wanted
        return None

    def report(self, seconds: float) -> Report:
        """What is known so far."""
        shown = [row.name for row in Report.rows_of(self.book.rows) if len(row.knobs) < 2]
        for name in shown:
            file = self._kept(name)
            if name not in self.images and file is not None and file.is_file():  # measured before an interruption
                self.images[name] = np.load(file, allow_pickle=False)
        pictures = {name: self.images[name] for name in shown if name in self.images}
        about: dict[str, Any] = {
            "stage": self.scene.path,
            "size": self.plan.size,
            "threads": self.plan.settings.threads,
            "seeds": sorted({row.seed for row in self.book.rows}),
            "reference": {**self.best, "seed": REFERENCE_SEED},
            "defaults": {n: self.default(n) for n in self.ladders},
            "seconds": seconds,
            "left": sum(not self.book.has(knobs, 0) for knobs in self.settings),
            "effects": [n for n, c in self.plan.effects.items() if c.enabled],
        }
        return Report(Report.rows_of(self.book.rows), about, self.reference, pictures)
