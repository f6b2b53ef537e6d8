"""Workers of a farm on this machine: 1, 2 and 4 of them, and what a task costs beside its samples. Run it by hand on an
idle machine:

    python tests/benchmarks/farm.py [--stage STAGE] [--width 480] [--spp 64] [--workers 1 2 4]

Each farm renders the same image twice: the first render makes workers ready (imports, kernels), the second is measured,
with the sending of the scene in it. Two workers on two cores must be at least 1.7 times as fast as one. The images
must have the same bits. Costs of tasks: empty ones, each with the result of a tile of 32 x 32, and the time until
100 MB have reached each worker. With --frames N, N images of a moving camera, one after another and beside one another
on two workers.
"""

import argparse
import os
import tempfile
import time
from dataclasses import replace

import numpy as np
import warp as wp

import scratchwarp as sw
from scratchwarp.pipelines.author_demo import author
from scratchwarp.render import Control, Farm, side_by_side

BAR = 1.7
TILE = {"color": (32, 32, 3), "base": (32, 32, 3), "scratches": (32, 32, 3), "rest": (32, 32, 17)}


def empty(number: int) -> dict[str, np.ndarray]:
    return {name: np.zeros(shape, np.float32) for name, shape in TILE.items()}


def costs(farm: Farm, tasks: int = 400) -> tuple[float, float]:
    """(seconds a task, seconds until 100 MB are at every worker)."""
    from distributed import as_completed

    clock = time.perf_counter()
    asked = [farm.client.submit(empty, n, pure=False) for n in range(tasks)]
    for future in as_completed(asked, loop=farm.client.loop):
        future.result()
    each = (time.perf_counter() - clock) / tasks
    clock = time.perf_counter()
    farm.client.scatter(os.urandom(100_000_000), broadcast=True, hash=False)
    return each, time.perf_counter() - clock


def sequence(scene: sw.Scene, settings: sw.Settings, count: int) -> tuple[float, float]:
    """Seconds of ``count`` images on two workers, one after another and beside one another."""
    frames = []
    for i in range(count):
        moved = scene.camera.transform.copy()
        moved[:3, 3] *= 1.0 + 0.02 * i
        frames.append(replace(scene, camera=replace(scene.camera, transform=moved)))

    def shown(frame: sw.Scene, farm: Farm, control: Control | None = None) -> sw.Film:
        return sw.render(frame, sw.make_plan(frame, settings), farm=farm, control=control)

    with Farm("local:2") as farm:
        shown(frames[0], farm)
        clock = time.perf_counter()
        after = [shown(frame, farm) for frame in frames]
        between = time.perf_counter()
        beside = list(side_by_side(farm, [lambda c, f=f: shown(f, farm, c) for f in frames]))
        seconds = between - clock, time.perf_counter() - between
    assert all(np.array_equal(a["color"], b["color"]) for a, b in zip(after, beside, strict=True))
    return seconds


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--stage")
    parser.add_argument("--width", type=int, default=480)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--frames", type=int, default=0)
    args = parser.parse_args()
    wp.config.log_level = wp.LOG_ERROR
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as folder:
        scene = sw.read(args.stage or author(folder, names=["ball"])[0])
    if args.frames:
        after, beside = sequence(scene, sw.Settings(width=args.width, spp=args.spp, threads=1), args.frames)
        print(f"{args.frames} frames, 2 workers: {after:.2f} s one after another, {beside:.2f} s beside one another")
        return 0
    plan = sw.make_plan(scene, sw.Settings(width=args.width, spp=args.spp, threads=1))
    alone = sw.render(scene, plan)
    print(f"no farm, 1 thread   trace {alone.stats['trace']:7.2f} s")
    seconds, same = {}, True
    for count in args.workers:
        clock = time.perf_counter()
        with Farm(f"local:{count}") as farm:
            start = time.perf_counter() - clock
            sw.render(scene, plan, farm=farm)
            film = sw.render(scene, plan, farm=farm)
            seconds[count] = film.stats["compile"] + film.stats["trace"]
            same &= all(np.array_equal(film[name], alone[name]) for name in alone)
            each, sent = costs(farm)
        print(
            f"{count} workers           send and trace {seconds[count]:7.2f} s   to start {start:5.2f} s   "
            f"a task {1e3 * each:5.2f} ms   100 MB to each {sent:5.2f} s"
        )
    print(f"the same bits: {same}")
    if 1 in seconds and 2 in seconds:
        ratio = seconds[1] / seconds[2]
        print(f"two workers are {ratio:.2f} times as fast as one (at least {BAR})")
        return int(ratio < BAR or not same)
    return int(not same)


if __name__ == "__main__":
    raise SystemExit(main())
