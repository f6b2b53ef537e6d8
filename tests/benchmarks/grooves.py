"""What grooves laid out one by one cost. Run it by hand on an idle machine, with the extra ``benchmark``:

    python tests/benchmarks/grooves.py [--part parallel crossing pixel] [--pixels 48] [--spp 1 4 16] [--repeats 5]

parallel, crossing   a sheet of V grooves under a sun: our time and error, and the time in which Mitsuba 3 (scalar, all
                     cores, the true geometry) reaches the same error. Bars: 20 times faster, memory 40 times less
                     (parallel) and 1,000 times less (crossing; the paper's scratches, ours are 30 periods a side).
pixel                a grooved pixel against one of the same surface without grooves.

Errors are RMS over the picture against a picture of 4,096 samples of ours, which is within 0.1 % of Mitsuba's.
Mitsuba's error at n samples is the root of its variance over n, for it has no other.
"""

import argparse
import importlib
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
sw = importlib.import_module("scratchwarp")
sheets = importlib.import_module("tests.render.groove_geometry")
scenes = importlib.import_module("tests.render.scenes")

EFFECTS = {"grooves.interreflection": False}


def film(crossing, pixels, spp, **fields):
    """Our picture under a sun."""
    world = sheets.world(crossing, sheets.LAMBERT, 1.0, 0.0, **fields)
    world = replace(world, meshes=(scenes.plane(sheets.COUNT * 200e-6),))
    return sw.render(world, sw.make_plan(world, sheets.settings(pixels, spp, EFFECTS)))


def against_mitsuba(crossing, pixels, samples, repeats):
    """A line for each number of our samples."""
    with tempfile.TemporaryDirectory() as folder:
        file, true_bytes = sheets.true_mesh(crossing, Path(folder))
        reference = film(crossing, pixels, 4096)["color"].astype(float)
        sheets.theirs(file, sheets.LAMBERT, 1.0, 0.0, pixels, 4, bounces=2)
        start = time.perf_counter()
        picture, variance = sheets.theirs(file, sheets.LAMBERT, 1.0, 0.0, pixels, 256, bounces=2)
        each = (time.perf_counter() - start) / 256
    print(f"reference {reference.mean():.5f}, Mitsuba at 256 samples {picture.mean():.5f}")
    mean, one = reference.mean(), 255 * variance.mean()
    for spp in samples:
        films = [film(crossing, pixels, spp) for _ in range(repeats + 1)][1:]
        seconds = float(np.median([f.stats["trace"] for f in films]))
        error = float(np.sqrt(((films[0]["color"] - reference) ** 2).mean()))
        needed = one / error**2
        ours = films[0].stats["groove_bytes"]
        print(
            f"{spp:4d} samples: {1e3 * seconds:8.1f} ms, error {100 * error / mean:6.3f} %; Mitsuba {needed:9.0f} "
            f"samples, {1e3 * needed * each:9.1f} ms: {needed * each / seconds:7.1f} times; memory "
            f"{ours / 1024:.1f} kB against {true_bytes / 1024:.1f} kB without its tree: {true_bytes / ours:.1f} times"
        )


def pixel(pixels, repeats):
    """What a grooved pixel takes, against a plain one."""
    for crossing in (False, True):
        world = sheets.world(crossing, sheets.LAMBERT, 1.0, 0.0)
        seconds = []
        for effects in (EFFECTS, {"grooves": False, "scratches": False}):
            plan = sw.make_plan(world, sheets.settings(pixels, 16, effects))
            runs = [sw.render(world, plan).stats["trace"] for _ in range(repeats + 1)][1:]
            seconds.append(float(np.median(runs)) / (pixels * pixels * 16))
        name = "crossing" if crossing else "parallel"
        us = [1e6 * s for s in seconds]
        print(f"{name}: {us[0]:.2f} us a sample, plain {us[1]:.3f} us: {us[0] / us[1]:.0f} times")


def main():
    """Run the parts asked for."""
    parts = ("parallel", "crossing", "pixel")
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--part", nargs="+", choices=parts, default=parts)
    parser.add_argument("--pixels", type=int, default=48)
    parser.add_argument("--spp", type=int, nargs="+", default=[1, 4, 16])
    parser.add_argument("--repeats", type=int, default=5)
    args = parser.parse_args()
    for part in args.part:
        print(f"--- {part}")
        if part == "pixel":
            pixel(args.pixels, args.repeats)
        else:
            against_mitsuba(part == "crossing", args.pixels, args.spp, args.repeats)


if __name__ == "__main__":
    main()
