"""Tiles to be traced, and the threads of this process that trace them."""

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import warp as wp

from ..kernels import Assembled
from ..plan import EffectPlan
from .interrupt import Control
from .shoot import Sums, shooter
from .tiles import Tile, run


@dataclass(frozen=True, eq=False)
class Job:
    """Samples ``first`` to ``first + count - 1`` of a tile, to be added to the sums ``earlier`` (None: the first)."""

    tile: Tile
    first: int
    count: int
    earlier: Sums | None = None


Done = Callable[[Job, Mapping[str, np.ndarray]], None]


class Tracer(Protocol):
    """Traces jobs wherever it does: ``done`` gets the sums of each, one call at a time, in any order.

    Attributes: warnings, numbers: of the device data; launches: of the kernel so far; cpu: seconds of other processes.
    """

    warnings: tuple[str, ...]
    numbers: Mapping[str, Any]
    launches: int
    cpu: float

    def __call__(self, jobs: Sequence[Job], done: Done) -> None:
        """Trace ``jobs``."""

    def close(self) -> None:
        """Let go of what the image needed."""


class Threads:
    """Tracer of the threads of this process."""

    def __init__(self, kernel: Any, built: Assembled, plan: EffectPlan, device: str, control: Control) -> None:
        self.warnings, self.numbers, self.launches, self.cpu = built.warnings, built.numbers, 0, 0.0
        self._kernel, self._built, self._plan, self._device = kernel, built, plan, device
        self._control = control

    def __call__(self, jobs: Sequence[Job], done: Done) -> None:
        """Trace ``jobs``; raises Stopped where the control says so."""
        asked = {job.tile: job for job in jobs}
        made: dict[Tile, Sums] = {}
        failed = threading.Event()

        def stopped() -> bool:
            return failed.is_set() or self._control.stop.is_set()

        def worker() -> tuple[Callable[[Tile], None], list[int]]:
            launches = [0]

            def launched() -> None:
                launches[0] += 1

            shoot = shooter(self._kernel, self._built, self._plan, self._device, stopped, launched)

            def work(tile: Tile) -> None:
                job = asked[tile]
                made[tile] = shoot(tile, job.first, job.count, job.earlier)

            return work, launches

        def ended(tile: Tile) -> None:
            done(asked[tile], made.pop(tile))

        threads = self._plan.settings.threads or 1 if wp.get_device(self._device).is_cpu else 1
        workers = [worker() for _ in range(max(1, min(threads, len(jobs))))]
        try:
            run([job.tile for job in jobs], [work for work, _ in workers], ended, failed)
        finally:
            self.launches += sum(launches[0] for _, launches in workers)

    def close(self) -> None:
        """Nothing is held."""
