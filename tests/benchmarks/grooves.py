"""What grooves laid out one by one cost. Run it by hand on an idle machine, with the extra ``benchmark``:

    python tests/benchmarks/grooves.py [--part parallel crossing pixel] [--pixels 48] [--repeats 5]

parallel, crossing   a sheet of V grooves under a sun: our time and error, and the time in which Mitsuba 3 (scalar, all
                     cores, the true geometry) reaches the same error. Bars: 20 times faster, memory 40 times less
                     (parallel) and 1,000 times less (crossing; the paper's scratches, ours are 30 periods a side).
pixel                a grooved pixel against one of the same surface without grooves.

Ours: one sample a pixel, its footprint an ellipse as large as the pixel; its error is the RMS against the same means by
1,023 lines a footprint. Mitsuba: box-filtered pixels; its error at n samples is the root of its variance over n. For
the same error, or a thousandth where ours is smaller, and for half a per cent. Both without inter-reflection.
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
grooves = importlib.import_module("scratchwarp.reflectance.grooves")
scenes = importlib.import_module("tests.render.scenes")

EFFECTS = {"grooves.interreflection": False}


SIDE = sheets.COUNT * 200.0  # of our sheet [um]


def film(crossing, pixels):
    """Our picture under a sun, one sample in the middle of each pixel, whose footprint is as large as the pixel."""
    world = sheets.world(crossing, sheets.LAMBERT, 1.0, 0.0)
    world = replace(world, meshes=(scenes.plane(SIDE * 1e-6),))
    settings = replace(sheets.settings(pixels, 1, EFFECTS), filter_width=1e-6)
    return sw.render(world, sw.make_plan(world, settings))


def exact(picture, crossing, pixels):
    """The same means by 1,023 lines over each footprint."""
    at = 200.0 * np.arange(-2, sheets.COUNT + 2)
    far = np.array([-SIDE, 2.0 * SIDE])
    paths = [np.stack([far, np.full(2, y + 50.0)], 1) for y in at]
    paths += [np.stack([np.full(2, x + 150.0), far], 1) for x in at] if crossing else []
    pattern = grooves.Pattern(paths, [[-50.0, 0.0], [0.0, -50.0], [50.0, 0.0]])
    center = picture["P"][..., :2].astype(float) * 1e6 + 0.5 * SIDE
    half = 800.0 / pixels / np.sqrt(np.pi)
    axes = [0.0, half], [half / sheets.VIEW[2], 0.0]
    diffuse = grooves.Diffuse(float(sheets.LAMBERT.color[0]))
    return grooves.radiance(pattern, center, *axes, sheets.VIEW, sheets.TO_LIGHT, diffuse, slices=1023)


def against_mitsuba(crossing, pixels, repeats):
    """Our time and error, and what Mitsuba needs for it."""
    with tempfile.TemporaryDirectory() as folder:
        file, true_bytes = sheets.true_mesh(crossing, Path(folder))
        sheets.theirs(file, sheets.LAMBERT, 1.0, 0.0, pixels, 4, bounces=2)
        start = time.perf_counter()
        true, variance = sheets.theirs(file, sheets.LAMBERT, 1.0, 0.0, pixels, 256, bounces=2)
        each = (time.perf_counter() - start) / 256
    one = 255 * variance.mean()
    films = [film(crossing, pixels) for _ in range(repeats + 1)][1:]
    seconds = float(np.median([f.stats["trace"] for f in films]))
    picture, ours = films[0]["color"][..., 0].astype(float), films[0].stats["groove_bytes"]
    error = float(np.sqrt(((picture - exact(films[0], crossing, pixels)) ** 2).mean())) / picture.mean()
    for least in (error, 0.005):
        # float32 adds no visible error: nobody needs less than a thousandth
        wanted = max(error, least, 1e-3)
        needed = one / (wanted * picture.mean()) ** 2
        print(
            f"ours {1e3 * seconds:.1f} ms, error {100 * error:.4f} %; Mitsuba for {100 * wanted:.2f} %: "
            f"{needed:.0f} samples, {1e3 * needed * each:.0f} ms, {needed * each / seconds:.0f} times"
        )
    print(f"memory {ours / 1024:.1f} kB against {true_bytes / 1024:.1f} kB and its tree: {true_bytes / ours:.1f} times")
    print(f"means {picture.mean():.5f}, Mitsuba {true.mean():.5f}")


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
    parser.add_argument("--repeats", type=int, default=5)
    args = parser.parse_args()
    for part in args.part:
        print(f"--- {part}")
        if part == "pixel":
            pixel(args.pixels, args.repeats)
        else:
            against_mitsuba(part == "crossing", args.pixels, args.repeats)


if __name__ == "__main__":
    main()
