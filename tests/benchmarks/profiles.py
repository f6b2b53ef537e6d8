"""Error against time of profile tables: our samplers, and a C tracer compiled in the same run.

    python tests/benchmarks/profiles.py [--docs docs] [--shape quartic] [--depth 0.5] [--repeats 7]

Error is the row-L1 of probabilities, sum_j |p_ji - q_ji|, averaged over the phi_i bins by their cosine weight,
against a table of ours with 2^15 rays on each of 16 directions a bin; the C tracer at its largest count must agree
with it. Times are medians of repeats, whole calls from Python (profiles.simulate with sampling data, no cache)
against the C function alone.
"""

import argparse
import ctypes
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from scratchwarp import profiles
from scratchwarp.optics import Conductor, Dielectric
from scratchwarp.profiles.launch import default_threads
from scratchwarp.profiles.profile import normalised

BINS = 256
COMMAND = ["gcc", "-O3", "-march=native", "-ffast-math", "-fopenmp", "-shared", "-fPIC"]


def compiled(folder):
    """The C tracer."""
    library = Path(folder) / "reference.so"
    source = Path(__file__).with_name("profiles_reference.c")
    subprocess.run([*COMMAND, str(source), "-o", str(library), "-lm"], check=True)
    function = ctypes.CDLL(str(library)).count_rays
    floats = np.ctypeslib.ndpointer(np.float32, flags="C")
    function.argtypes = [floats, floats, *[ctypes.c_int] * 5, ctypes.c_uint64, floats]
    function.restype = None
    return function


def c_shares(function, profile, rays, linear=False, stratified=False, seed=1):
    """Probabilities [phi_o, phi_i] by the C tracer."""
    vertices, controls = (np.ascontiguousarray(a, np.float32) for a in normalised(profile))
    table = np.zeros((BINS, BINS), np.float32)
    function(vertices, controls, len(controls), BINS, rays, int(linear), int(stratified), seed, table)
    return table.T / rays


def shares(table):
    """Probabilities of one of our tables."""
    return table.mirror * table.weights[:, None]


def timed(call, repeats):
    """(median wall seconds, median processor seconds of all threads, last result) after one call to warm up."""
    result = call()
    wall, processor = [], []
    for _ in range(repeats):
        start, start_cpu = time.perf_counter(), time.process_time()
        result = call()
        wall.append(time.perf_counter() - start)
        processor.append(time.process_time() - start_cpu)
    return float(np.median(wall)), float(np.median(processor)), result


def measure(options, function):
    """Rows (name, rays, milliseconds, error, processor milliseconds)."""
    weights = profiles.table.bin_weights(BINS)

    def new_profile():
        return profiles.shape(options.shape, depth=options.depth)

    truth = shares(profiles.trace_paths(new_profile(), resolution=BINS, rays=options.truth).table())

    def error(found):
        return float((np.abs(found - truth).sum(axis=0) * weights).sum() / weights.sum())

    rows = []
    for name, counts, linear, stratified in (
        ("C random", (1000, 10000), False, False),
        ("C random, linear search", (1000,), True, False),
        ("C stratified", (1000, 10000, 100000), False, True),
    ):
        for rays in counts:
            repeats = max(1, options.repeats * 1000 // rays)
            seconds, cpu, found = timed(
                lambda r=rays, a=linear, b=stratified: c_shares(function, new_profile(), r, a, b), repeats
            )
            rows.append((name, rays, 1e3 * seconds, error(found), 1e3 * cpu))
    for sampler, counts in (
        ("beam", (64, 96, 128, 192, 256, 384, 512, 1024, 2048, 4096, 8192)),
        ("stratified", (128, 512, 2048, 8192)),
        ("random", (128, 512, 2048, 8192)),
    ):
        for rays in counts:
            repeats = options.repeats if rays <= 1024 else 3
            seconds, cpu, table = timed(
                lambda s=sampler, r=rays: profiles.simulate(new_profile(), resolution=BINS, rays=r, sampler=s), repeats
            )
            rows.append((sampler, rays, 1e3 * seconds, error(shares(table)), 1e3 * cpu))
    iron = Conductor(2.91, 3.09)
    for rays in (96, 192, 256, 512):
        seconds, cpu, table = timed(
            lambda r=rays: profiles.simulate(new_profile(), resolution=BINS, rays=r, fresnel=iron), options.repeats
        )
        rows.append(("beam, iron: three slices", rays, 1e3 * seconds, error(shares(table)), 1e3 * cpu))
    return rows


def at_error(rows, name, wanted):
    """Milliseconds that a sampler needs for an error: between its two nearest rows in log-log, or beyond its last by
    its slope of 1/2."""
    points = sorted((r[3], r[2]) for r in rows if r[0] == name)
    errors, times = np.log([p[0] for p in points]), np.log([p[1] for p in points])
    if np.log(wanted) < errors[0]:
        return float(np.exp(times[0] + 2.0 * (errors[0] - np.log(wanted))))
    return float(np.exp(np.interp(np.log(wanted), errors, times)))


def report(options, rows):
    """The table and the ratios, as text."""
    lines = [
        f"{options.shape}, depth {options.depth}, 64 arcs, {BINS} x {BINS}, {default_threads()} threads, medians",
        "",
        "| sampler | rays a bin | ms | row-L1 | CPU ms |",
        "|---|---:|---:|---:|---:|",
        *(f"| {name} | {rays} | {ms:.1f} | {error:.4f} | {cpu:.1f} |" for name, rays, ms, error, cpu in rows),
        "",
    ]
    for wanted in (0.09, 0.016):
        ours = at_error(rows, "beam", wanted)
        march = at_error(rows, "C random", wanted)
        linear = at_error(rows, "C random, linear search", wanted)
        lines.append(
            f"row-L1 {wanted}: beams {ours:.1f} ms; C random {march:.0f} ms ({march / ours:.0f} x); "
            f"C linear search {linear:.0f} ms ({linear / ours:.0f} x)"
        )
    return "\n".join(lines)


def plot(rows, path):
    """Error against time, log-log."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    matplotlib.rcParams["svg.hashsalt"] = "profiles"
    figure, axes = plt.subplots(figsize=(6.4, 4.4))
    for name in dict.fromkeys(row[0] for row in rows):
        points = sorted((row[2], row[3]) for row in rows if row[0] == name)
        axes.loglog(*zip(*points, strict=True), marker="o", ms=4, label=name, ls="--" if name.startswith("C ") else "-")
    axes.set_xlabel("ms a table (256 x 256)")
    axes.set_ylabel("row-L1 of probabilities")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def draw_shapes(path):
    """Every named shape at depth 0.5, with its table by number of bounces, as one PNG."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    size, columns = 256, 4
    pictures = []
    for name in profiles.shape_names():
        profile = profiles.shape(name, depth=0.5)
        pictures.append(profiles.picture(profiles.simulate(profile), profile, size))
    height = max(picture.shape[0] for picture in pictures)
    padded = [np.pad(p, ((height - len(p), 0), (0, 0), (0, 0)), constant_values=0.18) for p in pictures]
    rows = [np.concatenate(padded[k : k + columns], axis=1) for k in range(0, len(padded), columns)]
    plt.imsave(path, np.clip(np.concatenate(rows), 0.0, 1.0) ** (1.0 / 2.2))


def theta_report():
    """Largest albedo error of each theta model, as Markdown."""
    iron, glass = Conductor(2.91, 3.09), Dielectric(1.5)
    reflectors = (("iron, exact", iron), ("iron, Lazanyi", Conductor(2.91, 3.09, "lazanyi")), ("glass, exact", glass))
    shapes = (
        ("quartic", 0.3),
        ("quartic", 0.6),
        ("vGroove", 0.5),
        ("vGroove", 1.07),
        ("round", 0.5),
        ("rectangle", 1.0),
    )
    lines = ["| profile | reflector | " + " | ".join(profiles.THETA_MODELS) + " |"]
    lines.append("|---|---|" + "---:|" * len(profiles.THETA_MODELS))
    for name, depth in shapes:
        for title, fresnel in reflectors:
            errors = profiles.theta_model_errors(profiles.shape(name, depth=depth), fresnel)
            cells = " | ".join(f"{errors[m]:.4f}" for m in profiles.THETA_MODELS)
            lines.append(f"| {name} {depth} | {title} | {cells} |")
    return "\n".join(lines)


def main(argv=None):
    """Measure and print; with --docs, write profiles_error.svg, profiles_error.md and profiles_shapes.png there."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--docs", type=Path)
    parser.add_argument("--shape", default="quartic", choices=profiles.shape_names())
    parser.add_argument("--depth", type=float, default=0.5)
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--truth", type=int, default=1 << 15)
    options = parser.parse_args(argv)
    with tempfile.TemporaryDirectory() as folder:
        rows = measure(options, compiled(folder))
    text = report(options, rows)
    print(text)
    if options.docs:
        plot(rows, options.docs / "profiles_error.svg")
        draw_shapes(options.docs / "profiles_shapes.png")
        theta = "## Largest error of a directional albedo by theta model\n\n" + theta_report()
        page = f"# Measured: profile tables\n\n## Error against time\n\n{text}\n\n{theta}\n"
        (options.docs / "profiles_error.md").write_text(page)
    return 0


if __name__ == "__main__":
    sys.exit(main())
