"""A worker of a farm: gets each image's scene once, makes its device data once, and traces the tiles it is sent."""

import threading
import time
from collections import OrderedDict
from collections.abc import Sequence
from typing import Any

import warp as wp

from .. import __version__
from ..kernels import assemble
from ..kernels.parts import Parts
from ..kernels.stamp import stamp
from ..scene.digest import digest
from .described import described
from .farm_data import unpacked
from .launch import loaded
from .shoot import Shoot, Sums, shooter
from .trace import Job

HELD = 2
"""Images that a worker keeps ready: while the last tiles of a frame are at work those of the next one begin."""
_lock = threading.Lock()
_ready: OrderedDict[str, "_Ready"] = OrderedDict()
_records: dict[str, Any] = {}
_parts = Parts()


class _Ready:
    """What a worker has made of an image that it was sent; what the image before it had, too, is taken over."""

    def __init__(self, name: str, head: bytes, parts: dict[str, bytes]) -> None:
        image = unpacked(head, parts, _records)
        wp.config.log_level = max(wp.config.log_level, wp.LOG_ERROR)
        wp.init()
        found = digest(described(image.scene, image.plan, image.key))
        if found != name:
            raise ValueError(f"a worker reads another image than it was sent ({found}, not {name})")
        if stamp(image.key) != image.number:
            raise ValueError("a worker has other kernels of scratchwarp than this machine; install the same version")
        built = assemble(image.scene, image.plan, image.tables, image.device, _parts)
        kernel, _ = loaded(built.key, image.device)
        self.launches = 0
        self.shoot: Shoot = shooter(kernel, built, image.plan, image.device, launched=self._launched)
        self.warnings, self.numbers = built.warnings, dict(built.numbers)
        self._built = built  # its arrays are the kernel's

    def _launched(self) -> None:
        self.launches += 1


def work(
    name: str, head: bytes, names: Sequence[str], parts: Sequence[bytes], version: str, jobs: Sequence[Job]
) -> dict[str, Any]:
    """The sums of each job of the image ``name``, launches, seconds of computing, and what the device data says.

    ``head`` and ``parts`` (of the hashes ``names``): the image as ``packed`` left it, which Dask brings to each worker
    once.
    """
    if version != __version__:
        raise ValueError(f"a worker has scratchwarp {__version__}, this machine {version}; install the same")
    cpu = time.thread_time()
    with _lock:  # a worker has one thread; where somebody gives it more they take turns
        if name not in _ready:
            while len(_ready) >= HELD:  # memory is bounded
                _ready.popitem(last=False)
            _ready[name] = _Ready(name, head, dict(zip(names, parts, strict=True)))
        _ready.move_to_end(name)
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
