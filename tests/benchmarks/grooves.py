"""What grooves laid out one by one cost. Run it by hand on an idle machine, with the extra ``benchmark``:

    python tests/benchmarks/grooves.py [--part parallel crossing pixel cells] [--pixels 128] [--repeats 5]

parallel, crossing   a sheet of rough iron under a sun, one or two grooves a pixel, seen and lit aslant: our time and
                     error, and the time in which Mitsuba 3 (llvm where there is one, else scalar; all cores; the true
                     geometry) reaches the same error. Bars: 20 times faster; memory, Mitsuba's mesh and its tree, 40
                     times less (parallel) and 1,000 times less (crossing; 160 scratches of unlike widths either way,
                     562,000 triangles).
pixel                a grooved pixel against one of the same surface without grooves.
cells                the crossing sheet with cells by the paper's rule and by ours.

Ours: one sample a pixel, its footprint an ellipse as large as the pixel, with as many lines as asked for; its error is
the RMS, relative to the mean, against 1,536 lines. Mitsuba: box-filtered pixels; its error is measured against 9,216
samples a pixel at 4, 16, 64, ..., and between those read off a line through logarithms. Errors below a thousandth count
as one. Both without inter-reflection. Mitsuba's memory: what its process grows by when the mesh is loaded and its tree
is built, measured in a process of its own.
"""

import argparse
import importlib
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import mitsuba as mi
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
sw = importlib.import_module("scratchwarp")
sheets = importlib.import_module("tests.benchmarks.grooves_scenes")

LINES = (6, 12, 24, 48)
SAMPLES = (16, 64, 256, 1024)
TRUE = 9216
WANTED = (0.001, 0.005)

LOADED = """
import gc, sys
import mitsuba as mi
mi.set_variant(sys.argv[1])
def held():
    gc.collect()
    return int(open("/proc/self/statm").read().split()[1]) * 4096
mi.load_dict({"type": "scene", "one": {"type": "rectangle"}})
before = held()
world = mi.load_dict({"type": "scene", "one": {"type": "ply", "filename": sys.argv[2], "face_normals": True}})
print(held() - before)
"""


def variant():
    """Mitsuba's, set: llvm where it works (an LLVM that is too old ends the process; DRJIT_LIBLLVM_PATH names
    another)."""
    tried = (
        "import mitsuba as mi; mi.set_variant('llvm_ad_rgb'); mi.render(mi.load_dict(mi.cornell_box()), spp=1).numpy()"
    )
    works = subprocess.run([sys.executable, "-c", tried], capture_output=True).returncode == 0
    mi.set_variant("llvm_ad_rgb" if works else "scalar_rgb")
    return mi.variant()


def true_mesh(sheet, file):
    """Write the sheet's triangles; how many there are."""
    points, faces = sheets.triangles(sheet)
    mesh = mi.Mesh("grooves", len(points), len(faces))
    params = mi.traverse(mesh)
    params["vertex_positions"] = points.astype(np.float32).ravel()
    params["faces"] = faces.astype(np.uint32).ravel()
    params.update()
    mesh.write_ply(file)
    return len(faces)


def true_scene(sheet, file, pixels):
    """Mitsuba's scene."""
    half = 0.5 * sheet.seen
    turn = np.diag([-1.0, 1.0, -1.0, 1.0])  # its cameras look along +z with +x to the left
    place = mi.ScalarTransform4f(sheets.looking(sheets.VIEW, 2.0 * sheet.side) @ turn)
    film = {"type": "hdrfilm", "width": pixels, "height": pixels, "rfilter": {"type": "box"}}
    metal = {"type": "roughconductor", "distribution": "ggx", "alpha": sheets.ROUGHNESS}
    metal |= {"eta": {"type": "rgb", "value": [sheets.ETA] * 3}, "k": {"type": "rgb", "value": [sheets.K] * 3}}
    sun = {"type": "directional", "direction": (-sheets.TO_LIGHT).tolist()}
    return mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 2, "hide_emitters": True},
            "sensor": {
                "type": "orthographic",
                "to_world": place @ mi.ScalarTransform4f().scale([half, half, 1.0]),
                "near_clip": 1.0,
                "far_clip": 10.0 * sheet.side,
                "film": {**film, "component_format": "float32"},
                "sampler": {"type": "multijitter", "sample_count": 4},
            },
            "grooves": {"type": "ply", "filename": file, "face_normals": True, "bsdf": metal},
            "sun": {**sun, "irradiance": {"type": "rgb", "value": [1.0] * 3}},
        }
    )


def theirs(world, spp, seed=1):
    """(luminance of the picture, seconds)."""
    start = time.perf_counter()
    picture = np.array(mi.render(world, spp=spp, seed=seed), float)[..., 0]
    return picture, time.perf_counter() - start


def relative(picture, true):
    """Root of the mean square of the difference, in means."""
    return float(np.sqrt(((picture - true) ** 2).mean()) / true.mean())


def needed(errors, wanted):
    """Samples that Mitsuba takes to an error, by a line through the logarithms of those measured around it."""
    n, e = np.log(np.array(list(errors))), np.log(np.array(list(errors.values())))
    k = int(np.clip(np.searchsorted(-e, -np.log(wanted)), 1, len(n) - 1))
    return float(np.exp(n[k - 1] + (np.log(wanted) - e[k - 1]) * (n[k] - n[k - 1]) / (e[k] - e[k - 1])))


def against_mitsuba(sheet, pixels, repeats):
    """Our times and errors, and what Mitsuba needs for them."""
    scene = sheets.ours(sheet)

    def shown(lines, times=1):
        plan = sw.make_plan(scene, sheets.settings(pixels, knobs={"grooves.lines": lines}))
        films = [sw.render(scene, plan) for _ in range(times)]
        return films[-1], min(f.stats["trace"] for f in films)

    true = shown(1536)[0]["color"][..., 0].astype(float)
    rows = []
    for lines in LINES if len(sheet.x) else LINES[:1]:
        film, seconds = shown(lines, repeats + 1)
        rows.append((lines, seconds, relative(film["color"][..., 0].astype(float), true)))
    stats = film.stats
    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder) / "grooves.ply")
        name = variant()
        count = true_mesh(sheet, file)
        held = int(subprocess.run(
            [sys.executable, "-c", LOADED, name, file], check=True, capture_output=True, text=True
        ).stdout)  # fmt: skip
        world = true_scene(sheet, file, pixels)
        theirs(world, 4)
        reference = np.mean([theirs(world, TRUE // 16, seed=100 + k)[0] for k in range(16)], axis=0)
        errors, each = {}, 0.0
        for spp in SAMPLES:
            theirs(world, spp, seed=5)
            runs = [theirs(world, spp, seed=k) for k in range(7, 10)]
            errors[spp] = float(np.sqrt(np.mean([relative(p, reference) ** 2 for p, _ in runs])))
            each = min(s for _, s in runs) / spp
            print(f"Mitsuba ({name}) {spp} samples: {1e3 * each * spp:.1f} ms, error {100 * errors[spp]:.3f} %")
    for lines, seconds, error in rows:
        for least in (0.0, *WANTED):
            wanted = max(error, least, WANTED[0])
            if least == 0.0 or wanted == least:
                n = needed(errors, wanted)
                print(
                    f"ours, {lines} lines: {1e3 * seconds:.1f} ms, error {100 * error:.4f} %; Mitsuba for "
                    f"{100 * wanted:.2f} %: {n:.0f} samples, {1e3 * n * each:.0f} ms: {n * each / seconds:.0f} times"
                )
    parts = ", ".join(f"{name} {stats[f'groove_{name}_bytes'] / 1024:.1f}" for name in ("path", "section", "grid"))
    print(
        f"memory {stats['groove_bytes'] / 1024:.1f} kB ({parts}; {stats['groove_pieces']} pieces, "
        f"{stats['groove_cells']} cells) against {held / 1024:.0f} kB of {count} triangles and their tree: "
        f"{held / stats['groove_bytes']:.0f} times"
    )
    print(f"means {true.mean():.5f}, Mitsuba {reference.mean():.5f}")


def pixel(pixels, repeats):
    """What a grooved sample takes, against a plain one, at 16 samples a pixel."""
    for name, sheet in SHEETS.items():
        scene, seconds = sheets.ours(sheet), []
        for effects in (sheets.EFFECTS, {"grooves": False, "scratches": False}):
            plan = sw.make_plan(scene, replace(sheets.settings(pixels, 16, effects=effects), filter_width=1.0))
            runs = [sw.render(scene, plan).stats["trace"] for _ in range(repeats + 1)]
            seconds.append(1e6 * min(runs) / (pixels * pixels * 16))
        print(f"{name}: {seconds[0]:.2f} us a sample, plain {seconds[1]:.3f} us: {seconds[0] / seconds[1]:.0f} times")


def cells(pixels, repeats):
    """The crossing sheet by the paper's rule for cells and by ours."""
    scene = sheets.ours(SHEETS["crossing"])
    for rule in ("width", "balanced"):
        plan = sw.make_plan(scene, sheets.settings(pixels, knobs={"grooves.cells": rule, "grooves.lines": 12}))
        films = [sw.render(scene, plan) for _ in range(repeats + 1)]
        taken = films[0].stats
        print(
            f"{rule}: {1e3 * min(f.stats['trace'] for f in films):.1f} ms, {taken['groove_cells']} cells, "
            f"{taken['groove_grid_bytes'] / 1024:.1f} kB of {taken['groove_bytes'] / 1024:.1f}"
        )


SHEETS = {"parallel": sheets.parallel(260), "crossing": sheets.crossing(160)}


def main():
    """Run the parts asked for."""
    parts = (*SHEETS, "pixel", "cells")
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--part", nargs="+", choices=parts, default=parts)
    parser.add_argument("--pixels", type=int, default=128)
    parser.add_argument("--repeats", type=int, default=5)
    args = parser.parse_args()
    for part in args.part:
        print(f"--- {part}")
        if part in SHEETS:
            against_mitsuba(SHEETS[part], args.pixels, args.repeats)
        else:
            (pixel if part == "pixel" else cells)(args.pixels, args.repeats)


if __name__ == "__main__":
    main()
