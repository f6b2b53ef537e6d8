"""Tiles over threads: each pixel is one thread's alone, so the image does not depend on who renders which tile."""

import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Tile:
    """Pixels of the rendered window."""

    x: int
    y: int
    width: int
    height: int


def tiles(width: int, height: int, edge: int) -> list[Tile]:
    """Square tiles of ``edge`` pixels (less at the right and lower borders), row by row."""
    return [
        Tile(x, y, min(edge, width - x), min(edge, height - y))
        for y in range(0, height, edge)
        for x in range(0, width, edge)
    ]


def run(
    jobs: Sequence[Tile],
    workers: Sequence[Callable[[Tile], None]],
    done: Callable[[Tile], None],
    stop: threading.Event | None = None,
) -> None:
    """Let every worker pull tiles until none is left; the first worker runs on the calling thread.

    ``done`` is called after each tile, one call at a time. An exception in any worker, KeyboardInterrupt included,
    stops the others after the tile they are at, or before its end where they look at ``stop``, and is raised here.
    """
    lock, stop = threading.Lock(), stop or threading.Event()
    waiting: Iterator[Tile] = iter(jobs)
    failures: list[BaseException] = []

    def pull(work: Callable[[Tile], None]) -> None:
        try:
            while not stop.is_set():
                with lock:
                    tile = next(waiting, None)
                if tile is None:
                    return
                work(tile)
                with lock:
                    done(tile)
        except BaseException as error:  # handed to the caller below
            failures.append(error)
            stop.set()

    threads = [threading.Thread(target=pull, args=(work,), daemon=True) for work in workers[1:]]
    for thread in threads:
        thread.start()
    try:
        pull(workers[0])
        for thread in threads:
            thread.join()
    except BaseException:  # raised by a signal while this thread waits: no other may still run while the process ends
        stop.set()
        for thread in threads:
            thread.join()
        raise
    if failures:
        raise failures[0]
