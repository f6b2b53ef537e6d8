"""Updates a second while a depth slider is dragged, off-screen. Run it by hand on an idle machine:

    python tests/benchmarks/viewer.py [--updates 60] [--shape quartic] [--stage ball.usda]

One update is what a step of the slider does: a new depth, its table at 128 x 128, the outline, the window drawn to the
end. The window of one profile must reach 20 a second in the median, and so must the big one when there is a --stage.
Figures are wall time; processor time tells what other programs on the machine took away.
"""

import argparse
import os
import sys
import time
from collections.abc import Callable

import numpy as np
import warp as wp

from scratchwarp.viewers import live_profile
from scratchwarp.viewers.display import canvas

BAR = 20.0


def drag(set_depth: Callable[[float], None], depths: np.ndarray) -> tuple[np.ndarray, float]:
    """Wall seconds of each update, and processor seconds of one in the mean."""
    for depth in depths[:3]:
        set_depth(depth)
    wall, cpu = [], time.process_time()
    for depth in depths:
        start = time.perf_counter()
        set_depth(depth)
        wall.append(time.perf_counter() - start)
    return np.array(wall), (time.process_time() - cpu) / len(depths)


def line(name: str, seconds: np.ndarray) -> str:
    return f"{name:12} median {1e3 * np.median(seconds):6.1f} ms   least {1e3 * seconds.min():6.1f} ms"


def told(title: str, wall: np.ndarray, cpu: float) -> float:
    """Print the figures; updates a second in the median."""
    rate = 1.0 / float(np.median(wall))
    print(line(title, wall) + f"   processor {1e3 * cpu:.1f} ms")
    print(f"{'':12} {rate:.1f} updates a second in the median, {1.0 / wall.min():.1f} at best")
    return rate


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--updates", type=int, default=60)
    parser.add_argument("--shape", default="quartic")
    parser.add_argument("--stage")
    args = parser.parse_args()
    wp.config.log_level = wp.LOG_ERROR
    share = np.linspace(0.1, 1.1, args.updates)
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    with canvas(True, live_profile.SIZE) as plotter:
        live = live_profile.LiveProfile(plotter, *live_profile.chosen(args.shape))
        spent = []

        def step(depth: float) -> None:
            live.set_depth(depth)
            spent.append(live.spent)

        wall, cpu = drag(step, share)
        for name, column in zip(("simulation", "redraw"), np.array(spent)[3:].T, strict=True):
            print(line(name, column))
        good = told(args.shape, wall, cpu) >= BAR
    if args.stage:
        import scratchwarp as sw
        from scratchwarp.viewers.window import Window

        with canvas(True, (1600, 1000), (2, 2)) as plotter:
            window = Window(plotter, sw.read(args.stage), 320, 1, 0)
            window.start_drag()
            rate = told("big window", *drag(window.set_depth, share * window.layers[0].layer.width))
            good = good and rate >= BAR
    print("ok" if good else f"BELOW {BAR:.0f} updates a second")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
