"""What one sweep knows: settings to render, measurements, images, the reference."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..kernels import kernel_key
from ..plan.knobs import KNOBS, acting, checked
from ..render.described import scene_digest
from ..render.interrupt import Control
from ..render.progress import Progress, silent
from ..scene import Scene, Settings
from ..scene.digest import digest
from ..scene.knob import Value
from ..whole import whole
from . import reference as references
from .measurement import PARTS, Measurement, Notebook, Setting, header, setting_name
from .measures import flip, rel_mse, uncertainty
from .report import Report, file_name
from .shots import Shot, Shots
from .table_error import slices_of, table_error


class Study:
    """Settings to render, one knob turned in each, and what is known of them.

    Attributes:
        ladders: knob -> values. best: knob -> value of the reference. defaults: knob -> value where nothing turns it.
        lowest: knob -> value below which that of the reference never goes. wanted, asked: best and ladders as they
            would be without a budget.
        book: what was measured. first: a render of the defaults that is not in it yet. refused: settings of several
            knobs that are not wanted.
    """

    def __init__(
        self,
        scene: Scene,
        settings: Settings,
        knobs: Iterable[str] | Mapping[str, Iterable[Value]] | None,
        reference: Mapping[str, Value] | None,
        folder: Path | None,
    ) -> None:
        self.scene, self.folder = scene, folder
        self.shots = Shots(scene, replace(settings, knobs=checked(settings.knobs)))
        known = acting(self.shots.plan)
        names = list(known) if knobs is None else list(knobs)
        given = knobs if isinstance(knobs, Mapping) else {}
        checked({name: KNOBS[name].default if name in KNOBS else 0 for name in names})
        self.ladders = {n: tuple(KNOBS[n].checked(v) for v in given.get(n, self._values(n))) for n in names}
        self.best: Setting = {n: KNOBS[n].reference for n in names if n not in ("spp", "lights.cones")}
        if self.shots.plan.on("grooves") or self.shots.plan.on("diffraction"):
            self.best.pop("scratches.model", None)  # which would take their layers, too
        if "lights.cones" in known:
            self.best["lights.cones"] = "both"
        samples = max(self.spp, *(int(value) for value in self.ladders.get("spp", (1,))))
        self.best["spp"] = max(references.FACTOR * samples, references.LEAST)
        self.best |= checked(reference or {})
        self.wanted, self.asked = dict(self.best), dict(self.ladders)
        self.defaults = {n: self.default(n) for n in {**self.ladders, **self.best}}
        fixed = reference or {}
        self.lowest = {n: self.best[n] if n in fixed else value for n, value in self.defaults.items()}
        self.fewest_samples = int(self.best["spp"]) if "spp" in fixed else 16
        self.key = digest(scene_digest(scene), self.shots.base, self.best, self.ladders)
        self.first: Shot | None = None
        self.refused: list[Setting] = []
        self.floor: float | None = None
        self._known: dict[str, np.ndarray] = {}  # images by setting and seed, for pairs
        self._images: dict[str, np.ndarray] = {}

    @property
    def spp(self) -> int:
        """Samples a pixel of the defaults."""
        return self.shots.plan.settings.spp or 1

    @property
    def least_samples(self) -> int:
        """Samples that a reference should have."""
        return min(max(64, 4 * self.spp, self.fewest_samples), int(self.wanted["spp"]))

    @staticmethod
    def half(best: Mapping[str, Value]) -> Setting:
        """What each of the two halves of a reference is rendered with."""
        return {**best, "spp": max(int(best["spp"]) // 2, 1)}

    @property
    def settings(self) -> list[Setting]:
        """The defaults, and each knob at each of its values; those that need another kernel come last."""
        plan = self.shots.planned({})
        own = kernel_key(self.scene, plan) if plan is not None else None
        alike, compiled = list[Setting]([{}]), list[Setting]()
        for name, values in self.ladders.items():
            for value in (value for value in values if value != self.defaults[name]):
                made = self.shots.planned({name: value})
                if made is not None:
                    (alike if kernel_key(self.scene, made) == own else compiled).append({name: value})
        return alike + compiled

    def default(self, name: str) -> Value:
        """What a knob is at where nothing turns it."""
        settings, (where, field) = self.shots.plan.settings, KNOBS[name].place
        chosen = settings.knobs.get(name)
        if chosen is None and where == "settings":  # as the stage or an option has it
            chosen = getattr(settings, field)
        return self.spp if name == "spp" else KNOBS[name].default if chosen is None else chosen

    def _values(self, name: str) -> tuple[Value, ...]:
        values = KNOBS[name].values
        return tuple(v for v in values if not isinstance(v, int) or v <= 4 * self.spp) if name == "spp" else values

    def resize(self, width: int) -> None:
        """Render ``width`` pixels from now on; tables in stock stay."""
        if width != self.shots.base.width:
            stock = self.shots.stock
            self.shots = Shots(self.scene, replace(self.shots.base, width=width))
            self.shots.stock, self.first = stock, None

    def earlier(self, budget: float) -> dict[str, Any] | None:
        """What was chosen for a budget by a study in the folder that this one goes on with; None without any."""
        found = header(self.folder)
        if found is None or found.get("study") != self.key or found.get("budget") != budget:
            return None
        return {"reference": dict(found["reference"]), "width": found["width"]}

    def choose(self, chosen: Mapping[str, Any]) -> None:
        """Take a size and a reference, and leave out values that it cannot judge."""
        if chosen["width"] is not None:
            self.resize(chosen["width"])
        self.best = checked(chosen["reference"])
        for name, values in self.asked.items():
            if name in self.best:
                kept = references.within(values, name, self.best[name], self.wanted[name], self.defaults[name])
                self.ladders[name] = kept

    def open(self, chosen: Mapping[str, Any]) -> None:
        """Open the notebook, for what was ``chosen``."""
        self.book = Notebook(self.folder, self.key, chosen)
        self._file_key = digest(self.key, self.best, self.shots.base.width)

    def has_reference(self) -> bool:
        """Whether the reference lies in the folder."""
        file = self._kept("")
        return file is not None and file.is_file()

    def known_reference(self, progress: Progress) -> None:
        """Render the reference, in two halves where it has several samples, or find it in the folder."""
        file = self._kept("")
        if file is not None and file.is_file():
            with np.load(file, allow_pickle=False) as found:
                self.reference = found["image"]
                self.floor = float(found["floor"]) if found["floor"] >= 0.0 else None
                self._tables = [found[f"table{n}"] for n in range(len(found.files) - 2)]
            return
        samples = int(self.best["spp"])
        half = self.half(self.best)
        one = self.shots.take(half, references.SEED, progress)
        if samples > 1:
            two = self.shots.take(half, references.SEED + 1, progress, one.stock)
            self.reference = 0.5 * (one.image + two.image)
            self.floor = rel_mse(one.image, self.reference)  # half of the squared difference: the noise of the mean
        else:
            self.reference = one.image
        self._tables = slices_of(one.tables)
        if file is not None:
            file.parent.mkdir(parents=True, exist_ok=True)
            stored: dict[str, Any] = {f"table{n}": values for n, values in enumerate(self._tables)}
            stored |= {"image": self.reference, "floor": np.array(-1.0 if self.floor is None else self.floor)}
            with whole(file) as draft, draft.open("wb") as stream:
                np.savez(stream, **stored)

    def _kept(self, name: str) -> Path | None:
        """Where an image lies between calls; "" is the reference."""
        if self.folder is None:
            return None
        kind = f"{file_name(name)}.npy" if name else "reference.npz"
        return self.folder / ".images" / f"{self._file_key}-{kind}"

    def _keep(self, name: str, image: np.ndarray) -> None:
        file = self._kept(name)
        self._images[name] = image
        if file is not None:
            file.parent.mkdir(parents=True, exist_ok=True)
            with whole(file) as draft, draft.open("wb") as stream:
                np.save(stream, image)

    def seed(self, repeat: int) -> int:
        """The seed of a round."""
        return (self.shots.base.seed or 0) + repeat

    def measure(
        self,
        knobs: Mapping[str, Value],
        repeat: int,
        left: float = float("inf"),
        cost: Callable[[Mapping[str, Value]], float] | None = None,
        progress: Progress = silent,
        control: Control | None = None,
    ) -> Shot:
        """Render a setting and keep what it took. ``left``: seconds that another render to compare it with may take, by
        ``cost``. ``Stopped`` where ``control`` ends it, with nothing kept."""
        seed = self.seed(repeat)
        if not knobs and repeat == 0 and self.first is not None:
            shot = self.first
        elif not knobs:
            self._known.clear()
            self.shots.stock = type(self.shots.stock)()
            shot = self.shots.take({}, seed, progress, None, control)
        else:
            shot = self.shots.take(knobs, seed, progress, None, control)
        self.first = None
        name, image = setting_name(knobs), shot.image
        bias = beside = None
        unsure = 0.0
        if len(knobs) < 2:
            self._known[f"{name} @{seed}"] = image
        if len(knobs) == 1:
            bias, unsure = self._bias(knobs, image, seed, left, cost)
            ((knob, value),) = knobs.items()
            base_image = self._known.get(f"{setting_name({})} @{seed}")
            if not KNOBS[knob].noise and value == self.best.get(knob) and base_image is not None:
                beside, unsure = rel_mse(base_image, image), uncertainty(base_image, image)
        total = sum(shot.seconds[part] for part in PARTS)
        base = total if not knobs else self._base(repeat) or total
        error, table = rel_mse(image, self.reference), self._table_error(knobs, shot) if repeat == 0 else None
        seen, doubt = flip(image, self.reference), uncertainty(image, self.reference)
        taken = dict(shot.seconds)
        row = Measurement(dict(knobs), repeat, taken, base, error, bias, seen, seed, table, doubt, beside, unsure)
        self.book.add(row)
        if len(knobs) < 2 and name not in self._images:
            self._keep(name, image)
        return shot

    def _bias(
        self,
        knobs: Mapping[str, Value],
        image: np.ndarray,
        seed: int,
        left: float,
        cost: Callable[[Mapping[str, Value]], float] | None,
    ) -> tuple[float | None, float]:
        """relMSE against the knob's reference value with the same samples, None where it is that, or noise; and its
        standard error."""
        ((name, value),) = knobs.items()
        best = self.best.get(name, KNOBS[name].reference)
        if KNOBS[name].noise or value == best:
            return None, 0.0
        paired = {} if best == self.defaults[name] else {name: best}
        known = f"{setting_name(paired)} @{seed}"
        if known not in self._known:
            if self.shots.planned(paired) is None or (cost is not None and cost(paired) > left):
                return None, 0.0
            self._known[known] = self.shots.take(paired, seed).image
        return rel_mse(image, self._known[known]), uncertainty(image, self._known[known])

    def _table_error(self, knobs: Mapping[str, Value], shot: Shot) -> float | None:
        """Error of the tables where only they are turned, or nothing is."""
        if not shot.tables or any(KNOBS[name].place[0] != "table" for name in knobs):
            return None
        return table_error(slices_of(shot.tables), self._tables)

    def _base(self, repeat: int) -> float | None:
        return next((row.total for row in self.book.rows if not row.knobs and row.repeat == repeat), None)

    def neighbour(self) -> Setting | None:
        """A setting that was not rendered yet: one of the front with one more knob turned, or one turned further;
        then of the others."""
        rows = Report.rows_of(self.book.rows)
        known = [*(dict(row.knobs) for row in rows), *self.refused]
        for row in sorted(rows, key=lambda row: (not row.front, row.seconds)):
            for name, values in self.ladders.items():
                at = row.knobs.get(name, self.defaults[name])
                place = values.index(at) if at in values else len(values) - 1
                for step in (-1, 1):
                    if not 0 <= place + step < len(values):
                        continue
                    wanted = {**row.knobs, name: values[place + step]}
                    wanted = {n: v for n, v in wanted.items() if v != self.defaults[n]}
                    if wanted not in known and self.shots.planned(wanted) is not None:
                        return wanted
        return None

    def report(self, seconds: float) -> Report:
        """What is known so far."""
        rows = Report.rows_of(self.book.rows)
        shown = [row.name for row in rows if len(row.knobs) < 2]
        for name in shown:
            file = self._kept(name)
            if name not in self._images and file is not None and file.is_file():  # measured before an interruption
                self._images[name] = np.load(file, allow_pickle=False)
        pictures = {name: self._images[name] for name in shown if name in self._images}
        asked = [{n: v} for n, values in self.asked.items() for v in values if v != self.defaults[n]]
        plan = self.shots.plan
        about: dict[str, Any] = {
            "stage": self.scene.path,
            "size": plan.size,
            "threads": plan.settings.threads,
            "seeds": sorted({row.seed for row in self.book.rows}),
            "reference": {**self.best, "seeds": [references.SEED, references.SEED + 1]},
            "shrunk": {n: [v, self.best[n]] for n, v in self.wanted.items() if self.best[n] != v},
            "floor": self.floor,
            "budget": self.book.chosen.get("budget"),
            "defaults": {n: self.defaults[n] for n in self.ladders},
            "seconds": seconds,
            "left": sum(not self.book.has(knobs, 0) for knobs in asked),
            "unmeasured": [n for n in self.ladders if not any(n in row.knobs for row in rows)],
            "effects": [n for n, c in plan.effects.items() if c.enabled],
        }
        return Report(rows, about, self.reference, pictures)

