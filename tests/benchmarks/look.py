"""Milliseconds from an edit to the picture that shows it. Run it by hand on an idle machine:

    python tests/benchmarks/look.py STAGE [--width 480] [--edits 20]

Drags a layer's depth, a layer's coverage, a light and the camera, one edit after the other, each from the call to the
first picture made after it (an image a quarter as wide) and to the first sample of the whole image. The depth must show
within half a second in the median. What each edit redid is printed with it, and what a fresh render would take.
"""

import argparse
import os
import sys
import time
from collections.abc import Callable

import numpy as np
import warp as wp

import scratchwarp as sw
from scratchwarp.image import read_texture
from scratchwarp.stage import LiveStage
from scratchwarp.viewers.looking import Looking
from scratchwarp.viewers.turning import Move

BAR = 0.5


def timed(looking: Looking, edit: Callable[[], None]) -> tuple[float, float]:
    """Seconds to the first picture after an edit, and to the first sample of the whole image."""
    start, before = time.perf_counter(), looking.shown
    edit()
    shown = before
    while shown.edits == before.edits or shown.picture == before.picture:
        shown = looking.wait(shown.version)
    first = time.perf_counter() - start
    while not shown.samples:
        shown = looking.wait(shown.version)
    return first, time.perf_counter() - start


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stage")
    parser.add_argument("--width", type=int, default=480)
    parser.add_argument("--edits", type=int, default=20)
    args = parser.parse_args()
    wp.config.log_level = wp.LOG_ERROR
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, {args.stage} at {args.width} pixels")
    live = LiveStage(args.stage, load_texture=read_texture)
    settings = sw.Settings(width=args.width, spp=16)
    with Looking(live, settings) as looking:
        shown = looking.wait(0)
        while not shown.samples:
            shown = looking.wait(shown.version)
        known = {c.id: c for c in shown.controls}
        depth = next(c for c in known.values() if c.section == "layer" and c.id.endswith(":depth"))
        coverage = known[depth.id.replace(":depth", ":coverage")]
        light = next(c.owner for c in known.values() if c.section == "light")
        ways: dict[str, Callable[[int], None]] = {
            "depth": lambda i: looking.edit({depth.id: depth.value * (1.1 + 0.05 * i)}),
            "coverage": lambda i: looking.edit({coverage.id: 0.1 + 0.8 * i / args.edits}),
            "light": lambda i: looking.move(light, Move(right=0.02)),
            "camera": lambda i: looking.move("", Move(right=0.01)),
        }
        good = True
        for name, turn in ways.items():
            spent = np.array([timed(looking, lambda i=i, turn=turn: turn(i)) for i in range(args.edits)])
            first, whole = np.median(spent, axis=0)
            most = spent[:, 0].max()
            print(f"{name:9} picture {1e3 * first:6.0f} ms (most {1e3 * most:6.0f}), whole {1e3 * whole:6.0f} ms")
            print(f"          redone: {looking.shown.redone}")
            good = good and (name != "depth" or first <= BAR)
        scene = looking.do(lambda live, session: session.scene)
    start = time.perf_counter()
    film = sw.render(scene, sw.make_plan(scene, sw.Settings(width=args.width, spp=1)))
    spent_afresh = time.perf_counter() - start
    print(f"fresh, 1 spp      {1e3 * spent_afresh:6.0f} ms, of it tracing {1e3 * film.stats['trace']:.0f} ms")
    print("ok" if good else f"BELOW the bar: depth after more than {BAR:g} s")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
