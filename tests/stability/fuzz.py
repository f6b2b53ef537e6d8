"""Stages damaged at random, rendered by the command line: a finite image or one clear error, never anything else.

    python -m tests.stability.fuzz --count 2000 --seed 0

runs batches in processes of their own, so that a crash or a hang is one failure and no end; ``--inside`` runs them in
this process. A stage is its number: ``--seed N --count 1 --keep FOLDER`` repeats one and leaves its files.

To compile few kernels, harmless code that a stage does not call for is compiled too, without optimisation (a fifth of
the time), and after ``--kernels`` of them a stage that would need another is built but not traced ("built").
"""

import argparse
import contextlib
import importlib
import io
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from unittest import mock

import numpy as np
import OpenImageIO as oiio
import warp as wp

import scratchwarp as sw
from scratchwarp import cli
from scratchwarp.kernels import KernelKey
from scratchwarp.lights.registry import MODELS
from scratchwarp.reflectance.responses import RESPONSES
from scratchwarp.scene import DomeLight, PreviewSurface
from scratchwarp.scratches import KINDS

from .mutate import mutate
from .stages import stage

LIMIT = 60
"""Seconds of this process that one stage may take, compiling aside: its own, whatever else the machine does."""
COMPILING = 30
"""Seconds of a process that compiling one kernel takes at most."""
MEMORY = 12 << 30
"""Bytes of address space of a batch."""
FINE = ("image", "refused", "built")
COARSE = [f"--knob={k}" for k in ("tables.resolution=32", "tables.rays=8")]


@dataclass(frozen=True)
class Outcome:
    """What became of one stage; ``what`` is one of FINE or the name of a failure."""

    seed: int
    what: str
    said: str = ""
    seconds: float = 0.0


class Hang(BaseException):
    """A stage took more than LIMIT."""


class Unbuilt(Exception):
    """A kernel more than are wanted."""


def shared(key):
    """The key with the code of more effects than the stage calls for, so that few kernels do for all stages."""
    names = ("directed", "lens", "shadows", "opacity", "emission", "normal_maps", "display_colors", "textures")
    names += ("preview", "measured", "light_links", "light_multipliers", "mesh_lights", "path")
    more = {"lights": tuple(m.name for m in MODELS.values()), "filter": "box"}
    if key.distributions:
        more["distributions"] = tuple(KINDS)
        names += ("diffuse_scratches", "variation", "masks", "tints", "orientations")
        more["cone_taps"] = key.closed_form
    if key.responses:
        more["responses"] = tuple(n for n, r in RESPONSES.items() if key.distributions or r.base)
    if key.glints:
        names += ("glint_segments", "glint_lists", "glint_hierarchy", "glint_bands", "glint_gratings", "glint_areas")
        names += ("glint_lookup", "glint_numeric")
    if key.grooves:
        names += ("groove_crossings", "groove_bounces", "groove_glass")
    return replace(key, **more, **dict.fromkeys(names, True))


def plain(key):
    """Whether a kernel is one of those that most stages need."""
    return bool(key.distributions) and not (key.glints or key.grooves or key.responses or key.orthographic)


def every(key):
    """Any kernel."""
    return True


@dataclass
class Bench:
    """What is watched while one stage is rendered; ``wanted``: whether a kernel may be compiled."""

    kernels: int
    compiled: set
    wanted: Callable[[KernelKey], bool] = every
    scene: object = None
    film: object = None
    furnace: bool = False
    built: bool = False


def _furnace(scene):
    """The scene under an even sky alone, or None where more light or less may come."""
    surfaces = [m.surface for m in scene.materials]
    glows = [s for s in surfaces if isinstance(s, PreviewSurface) and np.any(np.asarray(s.emissive_color) != 0.0)]
    if glows or scene.camera.exposure != 1.0 or any(i.light >= 0 for i in scene.instances):
        return None
    return replace(scene, lights=(DomeLight(path="/even", radiance=(1.0, 1.0, 1.0)),))


@contextlib.contextmanager
def watched(bench):
    """The renderer with the kernels shared, the alarm off while it compiles, and what it makes noted."""
    assembling = importlib.import_module("scratchwarp.kernels.assemble")
    rendering = importlib.import_module("scratchwarp.render.renderer")
    real_key, real_loaded, real_read, real_render = assembling.kernel_key, rendering.loaded, sw.read, sw.render

    def loaded(key, *rest):
        bench.built = True
        if key not in bench.compiled and (len(bench.compiled) >= bench.kernels or not bench.wanted(key)):
            raise Unbuilt
        bench.compiled.add(key)
        left, _ = signal.setitimer(signal.ITIMER_PROF, 0.0)
        try:
            with mock.patch.object(wp.config, "optimization_level", 0):
                return real_loaded(key, *rest)
        finally:
            signal.setitimer(signal.ITIMER_PROF, left)

    def read(path, **options):
        scene = real_read(path, **options)
        under = _furnace(scene) if bench.furnace else None
        bench.furnace = under is not None
        bench.scene = under or scene
        return bench.scene

    def render(*args, **options):
        bench.film = real_render(*args, **options)
        return bench.film

    with (
        mock.patch.object(assembling, "kernel_key", lambda scene, plan: shared(real_key(scene, plan))),
        mock.patch.object(rendering, "kernel_key", lambda scene, plan: shared(real_key(scene, plan))),
        mock.patch.object(rendering, "loaded", loaded),
        mock.patch.object(sw, "read", read),
        mock.patch.object(sw, "render", render),
    ):
        yield


def write_stage(seed, folder):
    """Author the stage of a number in a folder, with the images that it may read."""
    rng = np.random.default_rng(seed)
    text = mutate(rng, stage(rng))
    (folder / "stage.usda").write_text(text)
    pixels = rng.random((4, 8, 3)).astype(np.float32)
    if rng.integers(4) == 0:
        pixels[rng.integers(4), rng.integers(8)] = (np.nan, np.inf, -1.0)[rng.integers(3)]
    for name, data in (("pixels.png", np.nan_to_num(pixels)), ("tiny.exr", pixels)):
        out = oiio.ImageOutput.create(str(folder / name))
        kind = "float" if name.endswith("exr") else "uint8"
        out.open(str(folder / name), oiio.ImageSpec(8, 4, 3, kind))
        out.write_image(data)
        out.close()
    (folder / "broken.png").write_bytes((folder / "pixels.png").read_bytes()[:40])
    return rng


def _image_fault(folder, bench):
    """What is wrong with an image that was written, or ''."""
    read = oiio.ImageInput.open(str(folder / "out.exr"))
    if read is None:
        return "half written: the image cannot be read"
    pixels = np.asarray(read.read_image("float"))
    color = pixels[..., :3]
    film = bench.film
    read.close()
    if not np.isfinite(color).all():
        return "not finite: colours of the image"
    if film.stats["invalid_samples"]:
        return f"not finite: {film.stats['invalid_samples']} samples"
    if color.min() < 0.0:
        return f"negative: {color.min()}"
    for name in film:
        values = film[name]
        if name != "depth" and not np.isfinite(values).all():
            return f"not finite: {name}"
    if bench.furnace:
        noise = float(np.sqrt(np.maximum(film["variance"], 0.0).sum()) / film["variance"].size)
        mean = float(film["color"].mean(dtype=float))
        if mean > 1.0 + 1e-3 + 6.0 * noise:
            return f"energy: {mean:.4f} +- {noise:.4f} under a sky of 1"
    return ""


def _as_shipped(argv):
    """(status, what was said) of the command line by itself, kernels optimised: None where it takes more than LIMIT
    and what it takes to compile."""
    seconds = LIMIT + COMPILING
    bounded = f"import resource, sys; resource.setrlimit(resource.RLIMIT_CPU, ({seconds}, {seconds})); "
    bounded += "from scratchwarp.cli import main; sys.exit(main(sys.argv[1:]))"
    done = subprocess.run([sys.executable, "-c", bounded, *argv], capture_output=True, text=True)
    return None if done.returncode in (-signal.SIGKILL, -signal.SIGXCPU) else (done.returncode, done.stderr)


def spent(number: int) -> float:
    """Seconds that a process took of a processor; nothing where the system does not say."""
    try:
        fields = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _verdict(status, said, folder, before, bench):
    after = {p.name for p in folder.iterdir()}
    lines = [line for line in said.strip().splitlines() if line]
    if status == 0:
        return ("image", "") if after == before | {"out.exr"} else ("half written", str(after - before))
    if after != before:
        return "half written", str(after - before)
    last = lines[-1] if lines else ""
    if status != 1 or not last.startswith("scratchwarp: error: "):
        return "unclear", f"status {status}: {said[-500:]}"
    if "a fault of scratchwarp" in last:
        return "traceback", last
    if not re.search(r"stage\.usda|/[A-Za-z_]\w*|\.png|\.exr", last):
        return "unclear", last
    return "refused", last


def command(rng, folder):
    """(arguments of the command line, whether under an even sky alone) for the stage of a number, once it is there."""
    furnace = bool(rng.integers(4) == 0)
    argv = ["render", str(folder / "stage.usda"), str(folder / "out.exr"), "--imageWidth", "16", "--spp", "2"]
    argv += ["--threads", "1", "--filter", "box", *COARSE]
    argv += [["--integrator", "path", "--maxDepth", "3"], [], ["--frames", "2"], ["--frames", "4"]][rng.integers(4)]
    return argv, furnace


def run_shipped(seed):
    """The stage of a number by the command line alone."""
    folder = Path(tempfile.mkdtemp(prefix="scratchwarp-fuzz-"))
    try:
        argv, _ = command(write_stage(seed, folder), folder)
        before = {p.name for p in folder.iterdir()}
        shipped = _as_shipped(argv)
        return Outcome(seed, *(_verdict(*shipped, folder, before, None) if shipped else ("hang", "as shipped")))
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def run_one(seed, folder, compiled=None, kernels=24, wanted=every):
    """Render the stage of a number into a folder of its own; ``compiled``: kernels there are already."""
    started = time.perf_counter()
    folder = Path(folder)
    rng = write_stage(seed, folder)
    before = {p.name for p in folder.iterdir()}
    argv, furnace = command(rng, folder)
    bench = Bench(kernels, set() if compiled is None else compiled, wanted, furnace=furnace)

    def late(*_):
        raise Hang

    said = io.StringIO()
    old = signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, LIMIT)
    try:
        with watched(bench), contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
            status = cli.main(argv)
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        if "[Unbuilt;" in said.getvalue():
            what, text = "built", ""
        else:
            what, text = _verdict(status, said.getvalue(), folder, before, bench)
            if what == "image" and (fault := _image_fault(folder, bench)):
                what, text = fault.split(":")[0], fault
    except Hang:
        what, text = "hang", "".join(traceback.format_exc())[-2000:]
        if "in launch" in text and (shipped := _as_shipped(argv)):  # tracing, by kernels without optimisation
            what, text = _verdict(*shipped, folder, before, bench)
    except BaseException:
        if isinstance(sys.exc_info()[1], KeyboardInterrupt):
            raise
        what, text = "traceback", traceback.format_exc()[-2000:]
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, old)
    return Outcome(seed, what, text, round(time.perf_counter() - started, 3))


def inside(first, count, kernels, report, keep=None):
    """Outcomes of ``count`` stages in this process."""
    compiled: set = set()
    for seed in range(first, first + count):
        folder = Path(keep or tempfile.mkdtemp(prefix="scratchwarp-fuzz-"))
        folder.mkdir(parents=True, exist_ok=True)
        try:
            report(run_one(seed, folder, compiled, kernels))
        finally:
            if not keep:
                shutil.rmtree(folder, ignore_errors=True)


def batches(first, count, kernels, report, stall=6.0 * LIMIT):
    """The same in processes of their own: one that dies costs the stage that it was at, which fails. One that takes
    more than ``stall`` seconds over a stage, in a kernel that hears no alarm, is ended, and the stage rendered by the
    command line alone."""
    done, log = 0, Path(tempfile.mkdtemp(prefix="scratchwarp-fuzz-")) / "log"
    while done < count:
        log.write_text("")
        argv = [sys.executable, "-m", "tests.stability.fuzz", "--inside", "--json", "--kernels", str(kernels)]
        argv += ["--seed", str(first + done), "--count", str(min(200, count - done))]
        with log.open("a") as out:
            child = subprocess.Popen(argv, stdout=out, stderr=subprocess.DEVNULL)
        told, heard, stalled = 0, 0.0, False
        while True:
            over = child.poll() is not None
            lines = log.read_text().splitlines()
            for line in lines[told:] if over else lines[told : max(len(lines) - 1, told)]:
                report(Outcome(**json.loads(line)))
                told, heard = told + 1, spent(child.pid)
            if over:
                break
            if spent(child.pid) - heard > stall:
                stalled = True
                child.kill()
            time.sleep(0.5)
        done += told
        if child.returncode != 0 and done < count:
            failed = Outcome(first + done, "crash", f"status {child.returncode}")
            report(run_shipped(first + done) if stalled else failed)
            done += 1


def main(argv=None):
    """Fuzz; exit status 1 where a stage failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0, help="number of the first stage")
    parser.add_argument("--kernels", type=int, default=24, help="kernels that may be compiled")
    parser.add_argument("--inside", action="store_true", help="in this process")
    parser.add_argument("--json", action="store_true", help="one line of JSON a stage")
    parser.add_argument("--keep", metavar="FOLDER", help="leave the files of the (last) stage there")
    args = parser.parse_args(argv)
    counts: Counter = Counter()
    started = time.monotonic()

    def report(outcome):
        counts[outcome.what] += 1
        if args.json:
            print(json.dumps(asdict(outcome)), flush=True)
        elif outcome.what not in FINE or args.count == 1:
            print(f"{outcome.seed}: {outcome.what}: {outcome.said} ({outcome.seconds} s)", flush=True)

    if args.inside or args.keep:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        inside(args.seed, args.count, args.kernels, report, args.keep)
    else:
        batches(args.seed, args.count, args.kernels, report)
    failed = sum(n for what, n in counts.items() if what not in FINE)
    if not args.json:
        said = ", ".join(f"{n} {what}" for what, n in counts.most_common())
        print(f"{args.count} stages in {time.monotonic() - started:.0f} s: {said}; {failed} failed", flush=True)
    return int(failed > 0 and not args.json)


if __name__ == "__main__":
    sys.exit(main())
