"""What each effect costs where it is on, and that it costs nothing where it is off. Run it by hand on an idle machine:

    python -m tests.benchmarks.effects [--only NAME ...] [--width 96] [--spp 32] [--repeats 7]

For each effect the two stages of ``tests/stability/effect_cases.py``, one that calls for it and one that does not, are
rendered in turn, and so is the first with the effect forced off: seconds of the processor for all of a render (one
thread; kernels are compiled and tables kept) in units of the stage without: the median of the ratios of each round,
and half of the middle half's spread. ``on`` is the price of the effect. ``off`` is held to 1: where the kernel that is
left is that of the stage without, at most NOISE more, or what the rounds differ by among themselves; else the effect
is marked and the exit status is 1, but for stages that hold more by themselves (``UNLIKE``). Where another effect takes
its place (a table for scratches that diffract) the kernels differ and ``off`` is the price of that.

A kernel is compiled for each, so that all effects take about half an hour.
"""

import argparse
import statistics
import sys
import tempfile
import time
from pathlib import Path

import scratchwarp as sw
from scratchwarp.kernels import kernel_key

from ..stability.effect_cases import CASES

NOISE = 0.05
UNLIKE = {
    "grooves.crossings": "the stage without has half as many grooves",
    "grooves.interreflection": "the stage without has flat grooves, of a single facet",
}
"""Effects whose two stages differ in more than the effect: why the one costs more with it off."""


def plan_of(scene, args, extra):
    """As in the stability suite, but larger."""
    # these scenes are near enough for what is seen as a table to be laid out
    effects = {"grooves.handover": False, **extra.get("effects", {})}
    height = max(args.width // 2, 1)
    base = {"width": args.width, "height": height, "spp": args.spp, "filter": "box", "threads": 1}
    return sw.make_plan(scene, sw.Settings(**{**base, **extra, "effects": effects}))


def measured(name, args, folder):
    """(ratios on, ratios off or None, whether off has the kernel of the stage without)."""
    case = CASES[name]
    scenes = [s(folder) if callable(s) else s for s in (case.with_it, case.without)]
    on = {**case.settings, **case.only_with}
    stages = {"on": (scenes[0], on), "without": (scenes[1], dict(case.settings))}
    if scenes[0] is not scenes[1] and not case.only_with:
        stages["off"] = (scenes[0], {**case.settings, "effects": {name: False}})
    plans = {which: (scene, plan_of(scene, args, extra)) for which, (scene, extra) in stages.items()}
    keys = {which: kernel_key(scene, plan) for which, (scene, plan) in plans.items()}
    for scene, plan in plans.values():
        sw.render(scene, plan)  # compiled, tables kept
    seconds = {which: [] for which in plans}
    for round_ in range(args.repeats):
        for which in list(plans)[:: 1 if round_ % 2 else -1]:
            clock = time.process_time()
            sw.render(*plans[which])
            seconds[which].append(time.process_time() - clock)
    ratios = {
        which: [a / b for a, b in zip(seconds[which], seconds["without"], strict=True)] for which in ("on", "off")
        if which in seconds
    }  # fmt: skip
    same = "off" in keys and keys["off"] == keys["without"]
    return ratios["on"], ratios.get("off"), same


def spread(ratios):
    """Half of the middle half's spread."""
    low, _, high = statistics.quantiles(ratios, n=4)
    return 0.5 * (high - low)


def said(ratios):
    """Median and spread."""
    return f"{'-':>15s}" if ratios is None else f"{statistics.median(ratios):7.3f} +-{spread(ratios):6.3f}"


def main():
    """Print a row for each effect."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=list(CASES), metavar="NAME", default=list(CASES))
    parser.add_argument("--width", type=int, default=96)
    parser.add_argument("--spp", type=int, default=32)
    parser.add_argument("--repeats", type=int, default=7)
    args = parser.parse_args()
    failed = []
    print(f"{'effect':<28s} {'on / without':>15s} {'off / without':>15s}")
    with tempfile.TemporaryDirectory() as folder:
        for name in args.only:
            on, off, same = measured(name, args, Path(folder))
            bad = same and statistics.median(off) - 1.0 > max(NOISE, spread(off))
            failed += [name] if bad and name not in UNLIKE else []
            marked = UNLIKE.get(name, "COSTS TIME WHERE IT IS OFF")
            note = marked if bad else "" if same or off is None else "another in its place"
            print(f"{name:<28s} {said(on)} {said(off)}  {note}".rstrip(), flush=True)
    print(f"{len(args.only)} effects, {len(failed)} that cost time where they are off {' '.join(failed)}".rstrip())
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main())
