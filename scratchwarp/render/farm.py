"""A farm: tiles traced by the workers of Dask distributed, on this machine or on many."""

import queue
import time
from collections import deque
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from .. import __version__
from ..kernels import KernelKey
from ..plan import EffectPlan
from ..profiles import Table
from ..scene import Scene
from .interrupt import Control, Stopped
from .trace import Done, Job

if TYPE_CHECKING:
    from distributed import Client

IN_FLIGHT = 3
"""Tasks for each thread of a worker that are sent before results are back: this bounds memory, and hides latency."""
TASK_SAMPLES = 1 << 17
"""Samples of all pixels that make a task worth its sending; tiles are sent together up to so many."""
TASKS_A_WORKER = 12
"""At least so many tasks are made for each worker where there are tiles enough, so that all end about at once."""
RETRIES = 8
"""Workers that a tile may lose before it is taken for what kills them."""
WAIT = 60.0
"""Seconds that a farm may be without a worker."""


class Farm:
    """Workers of Dask: ``local:N`` starts N of them here, ``tcp://HOST:PORT`` and ``tls://HOST:PORT`` are those of a
    scheduler. Close it when done, or use it as a context manager.

    The image has the bits of one machine, whatever the number of workers, their order, and however many die.
    Whoever reaches a scheduler of Dask can run code on its workers: keep it in a network that you trust, or use tls.

    Args:
        memory: bytes that the workers on this machine may use together; one that takes more is started again.

    Raises ValueError on an address that is none, ImportError without the extra ``farm``, OSError when nobody answers.
    """

    def __init__(self, address: str, memory: float | None = None) -> None:
        self.local = address.startswith("local:")
        self.address = address
        number = workers_of(address)
        try:
            import dask
            import distributed
            import distributed.system
        except ImportError as error:
            raise ImportError(f'{address}: needs Dask; python -m pip install "scratchwarp[farm]"') from error
        dask.config.set(
            {
                "distributed.scheduler.allowed-failures": RETRIES,
                # statistics that nobody looks at, on cores that render
                "distributed.worker.profile.enabled": False,
                "distributed.admin.system-monitor.interval": "2s",
                "distributed.admin.system-monitor.gil.enabled": False,
            }
        )
        self._cluster: Any = None
        try:
            if number:
                total = memory or distributed.system.MEMORY_LIMIT
                self._cluster = distributed.LocalCluster(
                    n_workers=number,
                    threads_per_worker=1,
                    host="127.0.0.1",
                    protocol="tcp",
                    dashboard_address=None,
                    memory_limit=int(total / number),
                    silence_logs=50,
                )
            self.client: Client = distributed.Client(self._cluster or address, timeout=WAIT, set_as_default=False)
            self.client.wait_for_workers(number or 1, timeout=WAIT)
        except (OSError, TimeoutError) as error:
            self.close()
            what = "has no worker" if hasattr(self, "client") else "does not answer"
            raise OSError(f"{address}: {what} ({error or 'timed out'}); start dask scheduler and dask worker") from None

    def __enter__(self) -> "Farm":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the workers that were started here."""
        if hasattr(self, "client"):
            self.client.close(timeout=1.0)
        if self._cluster is not None:
            with suppress(TimeoutError):  # what does not end by itself ends with this process
                self._cluster.close(timeout=10.0)

    def threads(self) -> int:
        """Threads of all workers at this time."""
        return sum(self.client.nthreads().values())

    def tracer(
        self,
        scene: Scene,
        plan: EffectPlan,
        tables: Sequence[Table],
        key: KernelKey,
        device: str,
        control: Control,
        name: str,
    ) -> "OnFarm":
        """The tracer of one image, whose data is sent to each worker now; ``name``: the hash of all that decides it."""
        from .farm_worker import packed

        return OnFarm(self, packed(scene, plan, tables, key, device), control, name)


def workers_of(address: str) -> int:
    """Workers to start here, 0 for a scheduler elsewhere; ValueError on what is neither."""
    kind, _, rest = address.partition(":")
    if kind == "local" and rest.isdecimal() and 0 < int(rest) <= 1024:
        return int(rest)
    if kind in ("tcp", "tls") and rest.startswith("//") and rest.rpartition(":")[2].isdecimal():
        return 0
    raise ValueError(f"{address!r} is not local:N (1 to 1024 workers here), tcp://HOST:PORT or tls://HOST:PORT")


class OnFarm:
    """Tracer that sends jobs to a farm, a few more at a time than it has threads.

    ``data`` goes from here to a few workers and from those to the others; where all that have it die, it goes again.
    """

    def __init__(self, farm: Farm, data: bytes, control: Control, name: str) -> None:
        from .farm_worker import machine

        self.warnings: tuple[str, ...] = ()
        self.numbers: Mapping[str, Any] = {}
        self.launches, self.cpu = 0, 0.0
        self._farm, self._control, self._name, self._data = farm, control, name, data
        self._scene: Any = None
        self._machines = {machine()}

    def __call__(self, jobs: Sequence[Job], done: Done) -> None:
        """Trace ``jobs``; tiles of a worker that dies go to another one. Raises OSError when the farm is lost."""
        from .farm_worker import work

        waiting = deque(grouped(jobs, self._farm.threads()))
        ended: queue.SimpleQueue[Any] = queue.SimpleQueue()
        flying: dict[Any, tuple[Sequence[Job], int]] = {}
        threads, looked = self._farm.threads(), time.monotonic()
        seen = looked

        def send(group: Sequence[Job], losses: int) -> None:
            if self._scene is None or self._scene.status != "finished":
                self._scene = self._farm.client.scatter(self._data, broadcast=True, hash=False)
            future = self._farm.client.submit(
                work, self._name, self._scene, __version__, group, pure=False, priority=losses
            )
            flying[future] = (group, losses)
            future.add_done_callback(ended.put)

        try:
            while waiting or flying:
                while waiting and len(flying) < IN_FLIGHT * max(1, threads):
                    send(waiting.popleft(), 0)
                try:
                    future = ended.get(timeout=1.0)
                except queue.Empty:
                    future = None
                if self._control.stop.is_set():
                    raise Stopped
                if time.monotonic() - looked > 2.0:
                    threads, looked = self._farm.threads(), time.monotonic()
                    seen = looked if threads else seen
                    if looked - seen > WAIT:
                        raise OSError(f"{self._farm.address}: no worker is left after {WAIT:g} s")
                if future is None:
                    continue
                group, losses = flying.pop(future)
                if future.status == "finished":
                    self._take(group, future.result(), done)
                elif losses < RETRIES and _died(future):
                    send(group, losses + 1)
                else:
                    raise self._failure(future)
        finally:
            for future in flying:
                future.cancel()
            if not self._control.stop.is_set():
                self._machines_differ()

    def close(self) -> None:
        """Let the workers forget the image."""
        self._scene = None

    def _take(self, group: Sequence[Job], found: dict[str, Any], done: Done) -> None:
        self.launches += found["launches"]
        self.cpu += found["cpu"]
        self.numbers = found["numbers"]
        self.warnings += tuple(w for w in found["warnings"] if w not in self.warnings)
        self._machines.add(found["machine"])
        for job, sums in zip(group, found["sums"], strict=True):
            done(job, sums)

    def _machines_differ(self) -> None:
        said = "workers have different processors, for which kernels are compiled differently: last bits may differ"
        if len(self._machines) > 1 and said not in self.warnings:
            self.warnings += (said,)

    def _failure(self, future: Any) -> Exception:
        if future.status == "error":
            error = future.exception()
            if isinstance(error, ValueError | MemoryError):
                return type(error)(f"{self._farm.address}: {error}")
            if _died(future):
                return OSError(
                    f"{self._farm.address}: {RETRIES} workers died of the same tiles; do they have memory enough?"
                )
            return error if isinstance(error, Exception) else RuntimeError(str(error))
        return OSError(f"{self._farm.address}: the scheduler was lost; what is finished is in the checkpoint")


def _died(future: Any) -> bool:
    """Whether a task was lost with its workers."""
    from distributed.scheduler import KilledWorker

    return future.status in ("lost", "cancelled") or isinstance(future.exception(), KilledWorker)


def grouped(jobs: Sequence[Job], threads: int) -> list[tuple[Job, ...]]:
    """Jobs in the order given, put together until a task has samples enough, but not fewer tasks than every thread
    needs several of."""
    most = max(1, len(jobs) // (TASKS_A_WORKER * max(1, threads)))
    groups: list[tuple[Job, ...]] = []
    group: list[Job] = []
    samples = 0
    for job in jobs:
        group.append(job)
        samples += job.tile.width * job.tile.height * job.count
        if samples >= TASK_SAMPLES or len(group) >= most:
            groups.append(tuple(group))
            group, samples = [], 0
    return groups + ([tuple(group)] if group else [])
