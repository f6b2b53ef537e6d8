"""A farm: tiles traced by the workers of Dask distributed, on this machine or on many."""

import itertools
import queue
import threading
import time
import weakref
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

    from .farm_data import Packed

IN_FLIGHT = 3
"""Tasks for each thread of a worker, of all images, that are sent before results are back: this bounds memory, and
hides latency."""
TASK_SAMPLES = 1 << 17
"""Samples of all pixels that make a task worth its sending; tiles are sent together up to so many."""
TASKS_A_WORKER = 12
"""At least so many tasks are made for each worker where there are tiles enough, so that all end about at once."""
RETRIES = 8
"""Workers that a tile may lose before it is taken for what kills them."""
WAIT = 60.0
"""Seconds that a farm may be without a worker."""
LOOK = 0.25
"""Seconds between looks at whether to stop."""


class Farm:
    """Workers of Dask: ``local:N`` starts N of them here, ``tcp://HOST:PORT`` and ``tls://HOST:PORT`` are those of a
    scheduler. Close it when done, or use it as a context manager.

    The image has the bits of one machine, whatever the number of workers, their order, and however many die.
    Whoever reaches a scheduler of Dask can run code on its workers: keep it in a network that you trust, or use tls.

    Args:
        memory: bytes that the workers on this machine may use together, and frames that are under way; a worker that
            takes more is started again.

    Raises ValueError on an address that is none, ImportError without the extra ``farm``, OSError when nobody answers.
    """

    def __init__(self, address: str, memory: float | None = None) -> None:
        self.local = address.startswith("local:")
        self.address = address
        number = workers_of(address)
        self.memory, self.largest, self.flying = memory, 0, 0
        self._serial, self._sending = itertools.count(), threading.Lock()
        self._sent: weakref.WeakValueDictionary[str, _Sent] = weakref.WeakValueDictionary()
        self._latest: list[_Sent] = []
        self._pickled: weakref.WeakKeyDictionary[Any, tuple[str, bytes]] = weakref.WeakKeyDictionary()
        self.tables: dict[tuple[Any, ...], Table] = {}
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
        """The tracer of one image, whose data is sent to each worker now; ``name``: the hash of all that decides it.

        Parts that the image before it has, or one under way, are not sent again. Tiles of the first image go first.
        """
        from .farm_data import packed

        image = packed(scene, plan, tables, key, device, self._pickled)
        return OnFarm(self, image, control, name, next(self._serial))

    def send(self, image: "Packed") -> tuple["_Sent", list["_Sent"]]:
        """(head, parts) of an image, each at every worker."""
        with self._sending:
            self.largest = max(self.largest, image.size)
            parts = []
            for name, data in image.parts.items():
                one = self._sent.get(name) or _Sent(self, data)
                self._sent[name] = one
                parts.append(one)
            self._latest = parts  # what it had in common with the next one stays until that is sent
        head = _Sent(self, image.head)
        for sent in (head, *parts):
            sent.future()
        return head, parts

    def fly(self, change: int) -> None:
        """Count the tasks of all images that are with the workers."""
        with self._sending:
            self.flying += change


class _Sent:
    """Bytes that are at the workers; they go again where all workers that had them died."""

    def __init__(self, farm: Farm, data: bytes) -> None:
        self._farm, self._data, self._lock, self._future = farm, data, threading.Lock(), None

    def future(self) -> Any:
        """The bytes as Dask knows them."""
        with self._lock:
            if self._future is None or self._future.status != "finished":
                self._future = self._farm.client.scatter(self._data, broadcast=True, hash=False)
            return self._future


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

    ``image`` goes from here to a few workers and from those to the others. Attribute sent: bytes of the image that no
    worker had.
    """

    def __init__(self, farm: Farm, image: "Packed", control: Control, name: str, serial: int = 0) -> None:
        from .farm_worker import machine

        self.warnings: tuple[str, ...] = ()
        self.numbers: Mapping[str, Any] = {}
        self.launches, self.cpu = 0, 0.0
        self._farm, self._control, self._name, self._image, self._serial = farm, control, name, image, serial
        self._sent: tuple[_Sent, list[_Sent]] | None = None
        self._machines = {machine()}

    def __call__(self, jobs: Sequence[Job], done: Done) -> None:
        """Trace ``jobs``; tiles of a worker that dies go to another one. Raises OSError when the farm is lost."""
        from .farm_worker import work

        farm = self._farm
        waiting = deque(grouped(jobs, farm.threads()))
        ended: queue.SimpleQueue[Any] = queue.SimpleQueue()
        flying: dict[Any, tuple[Sequence[Job], int]] = {}
        threads, looked = farm.threads(), time.monotonic()
        seen = looked
        if waiting and self._sent is None:
            self._sent = farm.send(self._image)

        def send(group: Sequence[Job], losses: int) -> None:
            assert self._sent is not None
            head, parts = self._sent
            args = (self._name, head.future(), list(self._image.parts), [part.future() for part in parts])
            rank = RETRIES * -self._serial + losses  # tiles that were lost go first, then those of earlier images
            future = farm.client.submit(work, *args, __version__, group, pure=False, priority=rank)
            flying[future] = (group, losses)
            farm.fly(1)
            future.add_done_callback(ended.put)

        try:
            while waiting or flying:
                while waiting and (not flying or farm.flying < IN_FLIGHT * max(1, threads)):
                    send(waiting.popleft(), 0)
                if not waiting:
                    self._control.handed.set()
                try:
                    future = ended.get(timeout=LOOK)
                except queue.Empty:
                    future = None
                if self._control.stop.is_set():
                    raise Stopped
                if time.monotonic() - looked > 2.0:
                    threads, looked = farm.threads(), time.monotonic()
                    seen = looked if threads else seen
                    if looked - seen > WAIT:
                        raise OSError(f"{farm.address}: no worker is left after {WAIT:g} s")
                if future is None:
                    continue
                group, losses = flying.pop(future)
                farm.fly(-1)
                ended_well = future.status == "finished"
                found = self._found(future) if ended_well else None
                if found is not None:
                    self._take(group, found, done)
                elif losses < RETRIES and (ended_well or _died(future)):
                    send(group, losses + 1)
                else:
                    raise self._failure(future)
        finally:
            farm.fly(-len(flying))
            for future in flying:
                future.cancel()
            if not self._control.stop.is_set():
                self._machines_differ()

    def close(self) -> None:
        """Let the workers forget the image."""
        self._sent = None

    def _found(self, future: Any) -> dict[str, Any] | None:
        """What a task found; None where that was lost with its worker before it was fetched."""
        from distributed import CancelledError

        try:
            found: dict[str, Any] = future.result()
        except CancelledError:
            return None
        return found

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
