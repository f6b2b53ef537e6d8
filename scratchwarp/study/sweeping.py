"""sweep: render a scene at many settings, in turns, and compare with a reference.

Each round renders settings once with the round's own seed, beginning with the defaults: a slow moment of the
machine then meets all of them alike, and ratios of seconds within a round tell cost from it. The reference has all
knobs that are swept at their reference values, several times the samples of the dearest setting and other seeds;
lights along cones are sampled there, not integrated. It is rendered in two halves, whose difference is its noise. What
a knob that is no noise does is found without noise, too: by the same samples at the knob's reference value.

A budget is kept by predicting each render before it begins (``Guess``). The image may have fewer pixels and the
reference may be made cheaper for it (``reference.shrunk``), which the report says.
"""

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np

from ..render.interrupt import Control, Stopped
from ..render.progress import Progress, silent
from ..scene import Scene, Settings
from ..scene.knob import Value
from . import order
from . import reference as references
from .guess import Guess
from .report import Report
from .study import Study

ROUNDS = 0.6
"""Share of a budget after which no later round of settings begins: several knobs are turned then."""
DEAR = 0.12
"""Share of a budget that a setting may take, with compiling, before every cheaper one of the first values is there."""
LATE = 0.08
"""Share of a budget by which the reference may be late, without which there is no report at all. A setting is given up
at half of that."""
REPORT = (1.5, 0.03)
"""Seconds, and a share of the budget, that are kept for starting the program and writing the report."""


def sweep(
    scene: Scene,
    knobs: Iterable[str] | Mapping[str, Iterable[Value]] | None = None,
    reference: Mapping[str, Value] | None = None,
    repeats: int = 3,
    settings: Settings | None = None,
    budget: float | None = None,
    folder: str | Path | None = None,
    progress: Progress | None = None,
    widths: Sequence[int] = (),
    clock: Callable[[], float] = time.perf_counter,
    begun: float | None = None,
) -> Report:
    """Error against time of every knob, one at a time, then of several at once while the budget lasts.

    Args:
        knobs: names, or name -> values; None: all that act on the scene, at all of their values.
        reference: name -> value of the reference; what is left out has the knob's own reference value.
        repeats: rounds. settings: of all renderings; its seed is that of the first round.
        budget: seconds, those of reading the scene and compiling among them. What is predicted not to fit is left to
            the next call that is alike. None: every setting in every round, and no joint search.
        folder: measurements and images are kept there as they come, and found again by the next call that is alike.
        widths: in pixels, from the widest, that the image may have instead where the budget asks for it.
        clock: seconds. begun: when the budget began by it; unless given, when reading the scene did.

    Raises ValueError on unknown knobs or values, where the scene cannot be planned, and on a budget that is too short
    for the defaults and the least reference; it says how long they take.
    """
    if repeats < 1:
        raise ValueError(f"repeats must be 1 or more, got {repeats}")
    progress, now = progress or silent, clock()
    study = Study(scene, settings or Settings(width=160), knobs, reference, Path(folder) if folder else None)
    if budget is None:
        study.open({})
        study.known_reference(lambda done, total, what: progress(done, total, f"reference, {what}"))
        todo = [(own, number) for number in range(repeats) for own in study.settings if not study.book.has(own, number)]
        for number, job in enumerate(todo):
            progress(number, len(todo), "settings")
            study.measure(*job)
        progress(len(todo), len(todo), "settings")
        return study.report(clock() - now)
    began = now - scene.seconds if begun is None else begun
    return _Budgeted(study, budget, clock, began, progress, widths).run(repeats)


class _Budgeted:
    """A study that ends in time."""

    def __init__(
        self,
        study: Study,
        budget: float,
        clock: Callable[[], float],
        begun: float,
        progress: Progress,
        widths: Sequence[int],
    ) -> None:
        self.study, self.budget, self.clock, self.widths = study, budget, clock, widths
        self.start = begun
        self.guess = Guess(study.shots)
        self.told, self.control, self.late = progress, Control(), False

    @property
    def left(self) -> float:
        """Seconds that renders may still take."""
        return self.budget * (1.0 - REPORT[1]) - REPORT[0] - (self.clock() - self.start)

    def tick(self, done: int = 0, total: int = 0, what: str = "") -> None:
        """Show how much of the budget is spent."""
        spent = min(self.clock() - self.start, self.budget)
        self.told(round(10 * spent), round(10 * self.budget), f"of {self.budget:.0f} s")

    def watch(self, done: int, total: int, what: str) -> None:
        """``tick``, and give up a setting that is late by half of ``LATE``."""
        self.tick()
        if self.clock() - self.start > (1.0 + 0.5 * LATE) * self.budget and self.study.book.rows:
            self.late = True
            self.control.stop.set()

    def run(self, repeats: int) -> Report:
        """Choose the size and the reference, render what fits."""
        study = self.study
        self.tick()
        chosen = study.earlier(self.budget)
        if chosen is None:
            self._enough({})
            chosen = self._chosen()
        study.choose(chosen)
        study.open({**chosen, "budget": self.budget})
        if not study.has_reference():
            self._enough(study.half(study.best), times=2)
        study.known_reference(self.tick)
        self._measure({}, 0, float("inf"))
        first, second, third = order.levels(study.ladders, study.defaults, study.best)
        for most, level in ((DEAR, first), (DEAR, second), (1.0, first), (1.0, second + third)):
            for knobs in (knobs for unit in level for knobs in unit):
                self._measure(knobs, 0, most * self.budget)
        for repeat in range(1, repeats):
            for knobs in [dict(row.knobs) for row in study.book.rows if row.repeat == 0 and len(row.knobs) < 2]:
                if self.clock() - self.start < ROUNDS * self.budget:
                    self._measure(knobs, repeat)
        while self.left > 0.0 and (candidate := study.neighbour()) is not None:
            if not self._measure(candidate, 0):
                study.refused.append(candidate)
        self.told(1, 1, f"of {self.budget:.0f} s")
        return study.report(self.clock() - self.start)

    def _seconds(self, knobs: Mapping[str, Value], times: int = 1) -> float:
        found = self.guess.of(knobs, times)
        return float("inf") if found is None else found

    def _enough(self, knobs: Mapping[str, Value], times: int = 1) -> None:
        """ValueError where not even a render fits that there must be, and the defaults after it."""
        needed = self._seconds(knobs, times)
        if needed > self.left + LATE * self.budget:
            spent = self.clock() - self.start
            size = "x".join(map(str, self.study.shots.plan.size))
            raise ValueError(
                f"a budget of {self.budget:.0f} s is too short: the defaults and the cheapest reference take about "
                f"{1.2 * (spent + needed) + REPORT[0]:.0f} s at {size} pixels, a study of every knob about three times "
                "as long; give --budget more, or fewer pixels (-w)"
            )

    def _chosen(self) -> dict[str, object]:
        """Render the defaults, learn from it, and choose width and reference."""
        study, widest = self.study, self.study.shots.base.width
        if self.widths:
            study.resize(min(self.widths))
        self._probe()
        share = references.SHARE * self.budget
        width = study.shots.base.width
        for wider in sorted({*self.widths, widest or 0} if self.widths else (), reverse=True):
            study.resize(wider)
            first = order.levels(study.ladders, study.defaults, study.best)[0]
            once = self._seconds({}) * (1.0 + len(first))
            most = self._seconds(study.half({**study.best, "spp": study.least_samples}), 2)
            width = wider
            if once < 0.5 * self.budget and (most < share or wider == min(self.widths)):
                break
        alone = references.affordable(study.best, study.lowest, self._seconds, references.ALONE * self.budget)
        samples = (study.least_samples, study.fewest_samples)
        limit = min(share, self.left)
        made = references.shrunk(alone, study.lowest, lambda own: self._seconds(study.half(own), 2), limit, *samples)
        return {"reference": made, "width": width if self.widths else None}

    def _probe(self) -> None:
        self.study.shots.warm()
        predicted = self.guess.before({})
        self.study.first = self.study.shots.take({}, self.study.seed(0), self.tick)
        self.guess.learn(predicted, self.study.first)
        self.tick()

    def _measure(self, knobs: Mapping[str, Value], repeat: int, most: float | None = None) -> bool:
        """Measure a setting unless it is predicted to take longer than ``most`` or what is left (infinite: measure it
        in any case); whether it is measured."""
        study = self.study
        if study.book.has(knobs, repeat):
            return True
        limit = self.left if most is None else min(most, self.left) if np.isfinite(most) else most
        if limit <= 0.0 or self.guess.planning(knobs) > limit:
            return False
        needed = 0.0 if not knobs and repeat == 0 and study.first is not None else self._seconds(knobs)
        if needed > limit:
            return False
        predicted = self.guess.before(knobs)
        self.control = Control()
        try:
            shot = study.measure(knobs, repeat, self.left - needed, self._seconds, self.watch, self.control)
        except Stopped:
            if not self.late:
                raise
            return False
        self.guess.learn(predicted, shot)
        self.tick()
        return True
