"""How long a frame takes on a farm of any size: scheduling, transfer, stragglers and losses, simulated task by task.

In the farm of ``scratchwarp render --scheduler`` the scene goes from worker to worker: those that have it double from
step to step. One scheduler hands out tasks one after another, two to a worker at a time; a worker without a task takes
one that waits at another; results go to one client. What each of these takes is a parameter; ``docs/farm.md`` has the
measured ones. Groups of tiles are those of the renderer.
"""

import argparse
import heapq
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from .command import Command, Report, WrongUsage

WORKERS = (1, 2, 4, 16, 64, 250, 500, 1000)
QUEUED = 2  # tasks that Dask gives a worker of one thread at a time


@dataclass(frozen=True, kw_only=True)
class Costs:
    """What a frame and a farm take.

    Attributes:
        width, height, tile: pixels; spp: samples of each.
        sample: seconds of a worker for one sample; spread: standard deviation of the logarithm of a tile's cost.
        scene: bytes that each worker is sent; ready: seconds until a worker that has them can trace.
        task: seconds of the scheduler for each task; pixel: bytes of a result for each pixel.
        link: bytes a second that leave the scheduler, and that reach the client.
        slow: share of the workers that are ``slower`` times as slow; dies: losses of a worker an hour.
    """

    width: int = 1920
    height: int = 1080
    tile: int = 32
    spp: int = 256
    sample: float = 10e-6
    spread: float = 0.7
    scene: float = 150e6
    ready: float = 3.0
    task: float = 0.004
    pixel: float = 112.0
    link: float = 1.0e9
    slow: float = 0.02
    slower: float = 3.0
    dies: float = 0.01


@dataclass(frozen=True)
class Simulated:
    """One farm: ``seconds`` of the frame, the ``ideal`` ones (work over workers), tasks, and seconds until workers
    could begin, that the scheduler was busy, and at the end with less than half of the workers at work."""

    workers: int
    seconds: float
    ideal: float
    tasks: int
    sending: float
    scheduling: float
    tail: float

    @property
    def efficiency(self) -> float:
        """Share of the workers' time that was of use."""
        return self.ideal / self.seconds


def simulated(costs: Costs, workers: int, seed: int = 0) -> Simulated:
    """A frame on ``workers`` workers of one thread, event by event."""
    import numpy as np

    from scratchwarp.render.farm import grouped
    from scratchwarp.render.tiles import tiles
    from scratchwarp.render.trace import Job

    rng = np.random.default_rng(seed)
    jobs = [Job(tile, 0, costs.spp) for tile in tiles(costs.width, costs.height, costs.tile)]
    dear = np.exp(rng.normal(-0.5 * costs.spread**2, costs.spread, len(jobs)))  # of mean 1
    cost = {
        job.tile: d * job.tile.width * job.tile.height * costs.spp * costs.sample
        for job, d in zip(jobs, dear, strict=True)
    }
    groups = grouped(jobs, workers)
    work = [sum(cost[job.tile] for job in group) for group in groups]
    size = [costs.pixel * sum(job.tile.width * job.tile.height for job in group) for group in groups]
    speed = np.where(rng.random(workers) < costs.slow, costs.slower, 1.0)

    sent = (1 + int(np.ceil(np.log2(workers)))) * costs.scene / costs.link
    begun = [sent + costs.ready] * workers
    waiting = list(range(len(groups)))[::-1]
    queued: list[list[tuple[int, float]]] = [[] for _ in range(workers)]  # (task, when it arrived)
    scheduler = client = 0.0
    busy = costs.task * len(groups)
    free = list(begun)
    events: list[tuple[float, int, int, bool]] = []  # (time, worker, task, whether it is lost)
    running = [False] * workers
    ends: list[float] = []

    def send(now: float, worker: int) -> None:
        nonlocal scheduler
        if waiting:
            scheduler = max(scheduler, now) + costs.task
            queued[worker].append((waiting.pop(), scheduler))

    def begin(worker: int, now: float = 0.0) -> None:
        if running[worker]:
            return
        if not queued[worker]:
            longest = max(range(workers), key=lambda k: len(queued[k])) if not waiting else worker
            if not queued[longest]:
                return
            queued[worker].append((queued[longest].pop()[0], now + costs.task))
        task, arrived = queued[worker].pop(0)
        running[worker] = True
        start = max(free[worker], arrived)
        takes = work[task] * speed[worker]
        lost = rng.random() < 1.0 - np.exp(-costs.dies * takes / 3600.0)
        heapq.heappush(events, (start + takes * (rng.random() if lost else 1.0), worker, task, lost))

    for _ in range(QUEUED):
        for worker in range(workers):
            send(0.0, worker)
    for worker in range(workers):
        begin(worker)
    while events:
        now, worker, task, lost = heapq.heappop(events)
        running[worker] = False
        free[worker] = now
        if lost:  # another process takes its place, and is sent the scene again
            waiting.append(task)
            free[worker] = now + costs.scene / costs.link + costs.ready
        else:
            client = max(client, now) + size[task] / costs.link
            ends.append(now)
        send(now, worker)
        begin(worker, free[worker])
    half = ends[-1 - min(len(ends) - 1, workers // 2)]
    ideal = sum(work) / workers
    return Simulated(workers, max(client, scheduler), ideal, len(groups), max(begun), busy, max(client - half, 0.0))


def table(rows: Sequence[Simulated]) -> list[str]:
    """The rows as a Markdown table."""
    head = "| workers | tasks | seconds | of use | scene sent after | scheduler busy | tail |"
    lines = [head, "| --- " * 7 + "|"]
    for r in rows:
        lines.append(
            f"| {r.workers} | {r.tasks} | {r.seconds:.1f} | {100.0 * r.efficiency:.0f} % | {r.sending:.1f} s | "
            f"{r.scheduling:.1f} s | {r.tail:.1f} s |"
        )
    return lines


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``farm-model`` understands."""
    parser.add_argument("--workers", type=int, nargs="+", default=list(WORKERS), metavar="N", help=f"[{WORKERS}]")
    parser.add_argument("--seed", type=int, default=0, help="[0]")
    for name, value in Costs().__dict__.items():
        parser.add_argument(f"--{name}", type=type(value), default=value, help=f"[{value:g}]")


def run(options: argparse.Namespace) -> Report:
    """Simulate each number of workers."""
    costs = replace(Costs(), **{name: getattr(options, name) for name in Costs().__dict__})
    if min(options.workers) < 1 or max(options.workers) > 100_000:
        raise WrongUsage("--workers must be 1 to 100000")
    if min(costs.width, costs.height, costs.tile, costs.spp) < 1 or costs.link <= 0.0 or costs.sample <= 0.0:
        raise WrongUsage("sizes, samples, link and sample must be above 0")
    rows = [simulated(costs, count, options.seed) for count in options.workers]
    record: dict[str, Any] = {"costs": costs.__dict__, "farms": [{**r.__dict__, "of use": r.efficiency} for r in rows]}
    return Report(record, tuple(table(rows)))


COMMAND = Command(
    name="farm-model",
    says="simulate how a frame scales over the workers of a farm",
    examples=("scratchwarp farm-model --workers 1 10 100 1000 --spp 1024 --link 1.25e8",),
    add_arguments=add_arguments,
    run=run,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
