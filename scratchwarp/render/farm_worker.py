"""A worker of a farm: gets each image's scene once, makes its device data once, and traces the tiles it is sent."""

import copyreg
import io
import pickle
import threading
import time
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import warp as wp

from .. import __version__
from ..kernels import KernelKey, assemble
from ..kernels.stamp import stamp
from ..plan import EffectPlan
from ..profiles import Table
from ..scene import Scene
from ..scene.digest import digest
from .described import described
from .launch import loaded
from .shoot import Shoot, Sums, shooter
from .trace import Job

_lock = threading.Lock()
_ready: dict[str, "_Ready"] = {}


class _Ready:
    """What a worker has made of an image that it was sent."""

    def __init__(self, name: str, data: bytes) -> None:
        scene, plan, tables, key, number, device = unpacked(data)
        wp.config.log_level = max(wp.config.log_level, wp.LOG_ERROR)
        wp.init()
        found = digest(described(scene, plan, key))
        if found != name:
            raise ValueError(f"a worker reads another image than it was sent ({found}, not {name})")
        if stamp(key) != number:
            raise ValueError("a worker has other kernels of scratchwarp than this machine; install the same version")
        built = assemble(scene, plan, tables, device)
        kernel, _ = loaded(built.key, device)
        self.launches = 0
        self.shoot: Shoot = shooter(kernel, built, plan, device, launched=self._launched)
        self.warnings, self.numbers = built.warnings, dict(built.numbers)
        self._built = built  # its arrays are the kernel's

    def _launched(self) -> None:
        self.launches += 1


def work(name: str, data: bytes, version: str, jobs: Sequence[Job]) -> dict[str, Any]:
    """The sums of each job of the image ``name``, launches, seconds of computing, and what the device data says.

    ``data``: the image as ``packed`` left it, which Dask brings to each worker once.
    """
    if version != __version__:
        raise ValueError(f"a worker has scratchwarp {__version__}, this machine {version}; install the same")
    cpu = time.thread_time()
    with _lock:  # a worker has one thread; where somebody gives it more they take turns
        if name not in _ready:
            _ready.clear()  # one image at a time: memory is bounded
            _ready[name] = _Ready(name, data)
        ready = _ready[name]
        before = ready.launches
        sums: list[Sums] = [ready.shoot(job.tile, job.first, job.count, job.earlier) for job in jobs]
        return {
            "sums": sums,
            "launches": ready.launches - before,
            "cpu": time.thread_time() - cpu,
            "warnings": ready.warnings,
            "numbers": ready.numbers,
            "machine": machine(),
        }


def machine() -> str:
    """The kind of processor that kernels are compiled for: others may round otherwise."""
    return str(wp.get_cpu_kernel_cache_key())


def packed(
    scene: Scene, plan: EffectPlan, tables: Sequence[Table], key: KernelKey, device: str
) -> bytes:  # fmt: skip
    """An image as bytes, for ``unpacked`` of the same version alone."""
    held = io.BytesIO()
    _Pickler(held, pickle.HIGHEST_PROTOCOL).dump((scene, plan, tables, key, stamp(key), device))
    return held.getvalue()


def unpacked(data: bytes) -> tuple[Scene, EffectPlan, Sequence[Table], KernelKey, int, str]:
    """What ``packed`` was given, and the number of its kernel."""
    found: tuple[Scene, EffectPlan, Sequence[Table], KernelKey, int, str] = pickle.loads(data)
    return found


def _read_only(values: Mapping[Any, Any]) -> Mapping[Any, Any]:
    return MappingProxyType(dict(values))


class _Pickler(pickle.Pickler):
    """One that knows mappings which cannot be changed."""

    dispatch_table = copyreg.dispatch_table | {MappingProxyType: lambda values: (_read_only, (dict(values),))}
