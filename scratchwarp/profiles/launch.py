"""Kernels on several CPU threads: recorded launches cut into tiles, pulled by one worker fewer than threads and by
the caller.

A Warp launch on the CPU runs in the calling thread and releases the interpreter lock. Every tile writes places of its
own, so the result has the same bits whatever the number of threads.
"""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from itertools import count
from typing import Any

import numpy as np
import warp as wp

_TILES = 8


def default_threads() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


def threads_of(threads: int | None) -> int:
    """The number asked for, or ``default_threads()`` where that is None; ValueError unless it is at least 1."""
    if threads is None:
        return default_threads()
    if isinstance(threads, bool) or not isinstance(threads, int | np.integer) or threads < 1:
        raise ValueError(f"threads must be a whole number of at least 1, got {threads!r}")
    return int(threads)


@lru_cache(maxsize=4)
def _workers(threads: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(threads, thread_name_prefix="profiles")


def run_tiles(tiles: Sequence[Callable[[], Any]], threads: int) -> None:
    """Call every tile once, on ``threads`` threads."""
    if threads <= 1 or len(tiles) <= 1:
        for tile in tiles:
            tile()
        return
    ticket = count()

    def pull() -> None:
        while (k := next(ticket)) < len(tiles):
            tiles[k]()

    helpers = [_workers(threads - 1).submit(pull) for _ in range(min(threads, len(tiles)) - 1)]
    pull()
    for helper in helpers:
        helper.result()


def ranges(total: int, pieces: int = _TILES) -> list[tuple[int, int]]:
    """``(start, length)`` of at most ``pieces`` nearly equal parts of ``range(total)``."""
    pieces = max(1, min(pieces, total))
    edges = [total * k // pieces for k in range(pieces + 1)]
    return [(a, b - a) for a, b in zip(edges[:-1], edges[1:], strict=True) if b > a]


def launch_tiles(kernel: Any, total: int, inputs: list[Any], threads: int) -> None:
    """Launch ``kernel(start, *inputs)`` over ``range(total)`` in tiles on ``threads`` threads."""
    tiles = [record(kernel, length, [start, *inputs]).launch for start, length in ranges(total, _TILES)]
    run_tiles(tiles, threads)


def record(kernel: Any, dim: int, inputs: list[Any]) -> Any:
    """A launch on the CPU made ready, to be started from any thread by its ``launch()``."""
    return wp.launch(kernel, dim=dim, inputs=inputs, device="cpu", record_cmd=True)
