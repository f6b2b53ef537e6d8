"""Look development: a scene that is changed while its image refines, doing again only what a change touched."""

import time
from collections import OrderedDict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import warp as wp

from ..kernels import Assembled, Parts, assemble, camera_data
from ..plan import EffectPlan, TablePlan, make_plan
from ..profiles import Table
from ..scene import Scene, Settings
from ..scene.digest import digest
from . import develop
from .described import render_digest
from .film import Film
from .inspect import PixelReport, inspect
from .launch import SAMPLES_A_LAUNCH, SUMS, film_arrays, launcher, loaded
from .steps import Step, steps
from .tables import identity, simulate_table
from .target import noted, remaining
from .tiles import Tile, run

# Tables kept besides those in use: a slider that comes back to where it was finds them.
SPARE_TABLES = 64


class _Interrupted(Exception):
    """Stops the tiles of a step."""


@dataclass(frozen=True)
class Redone:
    """What a change did again.

    Attributes:
        seconds: part -> seconds, in the order done. Parts: read, plan, simulate (tables), lights, geometry, curves,
            textures, layers (materials with their layers), tables (to the device), compile, film.
        simulated: the users of each table that was simulated. kept: how many tables were there already.
    """

    seconds: dict[str, float] = field(default_factory=dict)
    simulated: tuple[tuple[str, ...], ...] = ()
    kept: int = 0

    def __contains__(self, part: str) -> bool:
        return part in self.seconds

    def __str__(self) -> str:
        def says(part: str) -> str:
            count = f" {len(self.simulated)} of {len(self.simulated) + self.kept} tables" if part == "simulate" else ""
            return f"{part}{count} {1e3 * self.seconds[part]:.1f} ms"

        return ", ".join(says(part) for part in self.seconds) or "nothing"


class Session:
    """A scene, its plan, tables, device data, kernel and film.

    ``change`` makes it another scene or other settings and says what that did again; ``refine`` adds a step to the
    image: smaller images first, then one sample a pixel, two, four and so on. The finished film has the bits of
    ``render`` for the same scene and settings, whatever was changed before and however often.

    For one thread at a time. Attributes: scene, settings: as they are looked at; plan: with a line in ``explain`` on
    what was redone; redone: what the last change did again; samples: a pixel that the whole image has.
    """

    def __init__(self, scene: Scene, settings: Settings | None = None, device: str = "cpu") -> None:
        wp.config.log_level = max(wp.config.log_level, wp.LOG_WARNING)
        wp.init()
        self.scene, self.settings, self.device = scene, settings or Settings(), device
        self.plan: EffectPlan | None = None
        self.samples = 0
        self._parts = Parts()
        self._tables: OrderedDict[tuple[Any, ...], Table] = OrderedDict()
        self._described = ""
        self._steps: list[Step] = []
        self._left: dict[Tile, None] | None = None  # tiles of the step that is under way
        self.change()

    def change(
        self, scene: Scene | None = None, settings: Settings | None = None, read: float = 0.0, **fields: Any
    ) -> Redone:
        """Look at another scene, or at this one under other settings, and begin the image again if that changes it.

        Args:
            read: seconds that reading took, for the record.
            fields: of the scene, given or as it is, that are replaced: camera, lights, materials, and so on.

        Raises ValueError as ``make_plan`` does; the session then stays as it was.
        """
        wanted = settings or self.settings
        looked_at = replace(scene or self.scene, **fields) if fields else scene or self.scene
        plan = make_plan(looked_at, wanted, self.plan)
        seconds = {"read": read, "plan": plan.seconds} if read else {"plan": plan.seconds}
        clock = time.perf_counter()
        tables, simulated = self._tables_of(plan)
        if simulated:
            seconds["simulate"] = time.perf_counter() - clock
        built = assemble(looked_at, plan, tables, self.device, self._parts)
        seconds |= self._parts.seconds
        clock = time.perf_counter()
        kernel, fresh = loaded(built.key, self.device)
        if fresh:
            seconds["compile"] = time.perf_counter() - clock
        clock = time.perf_counter()
        described = _described(looked_at, plan, built)
        if self._parts.seconds or described != self._described:
            self._begin(plan)
            seconds["film"] = time.perf_counter() - clock
        self._parts.seconds.clear()
        self._described = described
        self.scene, self.settings, self._built, self._kernel = looked_at, wanted, built, kernel
        self._used = tables
        self.redone = Redone(seconds, tuple(t.users for t in simulated), len(plan.tables) - len(simulated))
        self.plan = replace(plan, numbers={**plan.numbers, "redone": str(self.redone)})
        return self.redone

    @property
    def finished(self) -> bool:
        """Whether every sample of the image is there."""
        return not self._steps

    def refine(self, interrupted: Callable[[], bool] = lambda: False) -> Film | None:
        """Make the image a step better and return it; None where it is finished, or ``interrupted()`` says so after
        some tile. An interrupted step goes on where it was at the next call."""
        if self.finished:
            return None
        step = self._steps[0]
        if self._left is None:
            self._sums = self._whole if step.whole else film_arrays(*step.size, self.device)
            self._left = dict.fromkeys(step.tiles())
        wall, cpu = time.perf_counter(), time.process_time()
        traced = self._traced(step, self._left, interrupted)
        self._wall += time.perf_counter() - wall
        self._cpu += time.process_time() - cpu
        if not traced:
            return None
        self._left = None
        del self._steps[0]
        if step.whole:
            self.samples = step.first + step.count
        return self._developed(step)

    def inspect(self, pixel: tuple[int, int]) -> PixelReport:
        """What made a pixel (column, row) of the image; ValueError for one outside it."""
        assert self.plan is not None
        return inspect(
            self.scene, self.plan, self._built, self._kernel, self._used, self._parts, self.device, pixel
        )  # fmt: skip

    def _tables_of(self, plan: EffectPlan) -> tuple[list[Table], list[TablePlan]]:
        """(the plan's tables, those of them that had to be simulated)."""
        simulated, tables = [], []
        for t in plan.tables:
            key = identity(t)
            if key not in self._tables:
                self._tables[key] = simulate_table(t, plan.settings.threads or 1)
                simulated.append(t)
            self._tables.move_to_end(key)
            tables.append(self._tables[key])
        while len(self._tables) > len(tables) + SPARE_TABLES:
            self._tables.popitem(last=False)
        return tables, simulated

    def _begin(self, plan: EffectPlan) -> None:
        """An image without samples."""
        self._steps, self._left, self.samples = steps(plan), None, 0
        self._whole = film_arrays(*self._steps[-1].size, self.device)
        self._wall = self._cpu = 0.0
        self._launches = 0

    def _traced(self, step: Step, left: dict[Tile, None], interrupted: Callable[[], bool]) -> bool:
        """Trace the tiles that are left of a step; whether all are done."""
        on_cpu = wp.get_device(self.device).is_cpu
        built = replace(self._built, inputs=(camera_data(self.scene, step.plan), *self._built.inputs[1:]))

        def worker() -> Callable[[Tile], None]:
            launch = launcher(self._kernel, built, step.plan, self._sums, self.device)

            def work(tile: Tile) -> None:
                last = step.first + step.count
                for first in range(step.first, last, SAMPLES_A_LAUNCH):
                    launch(tile, first, min(SAMPLES_A_LAUNCH, last - first))

            return work

        def done(tile: Tile) -> None:
            del left[tile]
            self._launches += 1
            if left and interrupted():
                raise _Interrupted

        threads = (step.plan.settings.threads or 1) if on_cpu else 1
        with suppress(_Interrupted):
            run(list(left), [worker() for _ in range(min(threads, len(left)))], done)
        if not on_cpu:
            wp.synchronize_device(self.device)
        return not left

    def _developed(self, step: Step) -> Film:
        sums = {name: getattr(self._sums, name).numpy() for name in SUMS}
        samples = step.first + step.count
        images = develop.aovs(sums, self.scene, samples)
        invalid = int(sums["invalid"].sum())
        warnings = self._built.warnings + step.plan.warnings
        if invalid:
            warnings += (f"{invalid} samples were not finite and were left out",)
        assert self.plan is not None
        stats = {
            "read": self.scene.seconds,
            "plan": self.plan.seconds,
            "simulate": self.redone.seconds.get("simulate", 0.0),
            "compile": self.redone.seconds.get("compile", 0.0),
            "trace": self._wall,
            "write": 0.0,
            "rays": int(sums["rays"].sum()),
            "samples": int(np.prod(step.size)) * samples,
            "kernels_compiled": int("compile" in self.redone),
            "kernels_launched": self._launches,
            "tables_simulated": len(self.redone.simulated),
            "invalid_samples": invalid,
            **self._built.numbers,
        }
        # the hash of a large scene takes longer than a step: only the finished image carries it
        key = render_digest(self.scene, step.plan, self._built.key) if self.finished else ""
        header = develop.metadata(self.scene, step.plan, key, self._wall, self._cpu)
        header |= {"scratchwarp:spp": samples}
        if self.finished:
            header |= noted(remaining(sums, samples))
        return Film(images, stats, header, step.plan.size, step.plan.window, warnings)


def _described(scene: Scene, plan: EffectPlan, built: Assembled) -> str:
    """A hash of what the image depends on besides the parts of ``assemble``."""
    decided = replace(plan.settings, threads=None, tile=1)
    on = tuple(name for name, choice in plan.effects.items() if choice.enabled)
    return digest(built.key, scene.camera, scene.origin, scene.options, decided, plan.size, plan.window, on)
