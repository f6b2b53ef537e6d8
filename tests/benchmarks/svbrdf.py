"""What scratched materials cost (Raymond 2016 section 6). Run it by hand on an idle machine:

    python tests/benchmarks/svbrdf.py [--repeats 5] [--part ggx|layers|cycles|resolved ...] [--blender PYTHON]

Every figure is a ratio of two renders of one run, taken in turn so that the machine's drift hits both alike. The bars:

- ggx: a layer that covers everything costs at most 1.15 times our own anisotropic GGX at equal samples.
- layers: 32 scattered layers cost at most 2 times one; the sweep over 1, 6, 16, 32 layers is that of Table 2.
- cycles: samples a second on one covering layer are at least those of Cycles' anisotropic GGX on the same mesh. Needs
  ``bpy``: in this Python, or in the one that --blender names.
- resolved: a relative RMSE of 1e-2 takes at least 30 times less time than by supersampling the same scratches as
  geometry, in our own renderer and in Mitsuba 3, or as a normal map in our own renderer.
"""

import argparse
import importlib.util
import json
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from svbrdf_resolved import resolved, verdict

import scratchwarp as sw
from scratchwarp.scene import (
    Camera,
    DomeLight,
    Instance,
    Layer,
    Material,
    Mesh,
    Profile,
    RectLight,
    Scene,
    ScratchSurface,
)

GGX_BAR, LAYERS_BAR = 1.15, 2.0
SIDE = 480  # pixels of the ball's image


def ball(rings: int = 48) -> Mesh:
    """Unit sphere with u around y, v from pole to pole."""
    v, u = np.meshgrid(np.linspace(0, 1, rings + 1), np.linspace(0, 1, 2 * rings + 1), indexing="ij")
    turn = 2 * np.pi * u
    points = np.stack([np.sin(np.pi * v) * np.sin(turn), -np.cos(np.pi * v), np.sin(np.pi * v) * np.cos(turn)], -1)
    points, st = points.reshape(-1, 3), np.stack([u, v], -1).reshape(-1, 2)
    a = (np.arange(rings)[:, None] * (2 * rings + 1) + np.arange(2 * rings)).ravel()
    row = 2 * rings + 1
    faces = np.concatenate([np.stack([a, a + 1, a + row + 1], 1), np.stack([a, a + row + 1, a + row], 1)])
    edges = points[faces]
    area = np.linalg.norm(np.cross(edges[:, 1] - edges[:, 0], edges[:, 2] - edges[:, 0]), axis=1)
    faces = faces[area > 1e-12]
    return Mesh(path="/ball", points=points, triangles=faces, normals=points[faces], uvs={"st": st[faces]})


def placed(mesh: Mesh, distance: float = 4.0) -> Instance:
    """In front of a camera at the origin that looks down -z."""
    m = np.eye(4)
    m[2, 3] = -distance
    return Instance(path="/placed", mesh=0, transform=m, materials=(0,))


def studio() -> tuple:
    """A panel and a dim dome."""
    normal = np.array([1.5, -2.0, -3.5]) / np.linalg.norm([1.5, -2.0, -3.5])
    ex = np.cross(normal, (0.0, 1.0, 0.0))
    ex *= 0.75 / np.linalg.norm(ex)
    key = RectLight(
        path="/key",
        radiance=np.full(3, 6.0),
        center=np.array([-1.5, 2.0, -0.5]),
        ex=ex,
        ey=np.cross(normal, ex),
        normal=normal,
    )
    return key, DomeLight(path="/dome", radiance=np.full(3, 0.4))


def world(material: Material) -> Scene:
    """The ball in the studio; it fills the image, so that every sample meets the material."""
    camera = Camera(
        path="/cam", transform=np.eye(4), horizontal_aperture=10.0, vertical_aperture=10.0, focal_length=50.0
    )
    mesh = ball()
    return Scene(
        path="benchmark",
        meshes=(mesh,),
        instances=(placed(mesh),),
        materials=(material,),
        lights=studio(),
        camera=camera,
    )


def metal(**fields) -> ScratchSurface:
    return ScratchSurface(base="conductor", metal="iron", **fields)


def brushed(layers: int) -> Material:
    """Layers around one direction that together cover everything (Table 2, brushed)."""
    cut = Profile(path="/mat/cut", shape="quartic")
    own = tuple(
        Layer(
            name=f"l{i:02d}",
            prim="/mat",
            profile=cut,
            width=200.0,
            depth=40.0,
            length=100000.0,
            seed=i,
            coverage=1.0 if layers == 1 else 0.16,
            angle=np.radians(5.0) * (i / max(layers - 1, 1) - 0.5),
        )
        for i in range(layers)
    )
    return Material(path="/mat", surface=metal(roughness=0.02), layers=own)


def scattered(layers: int) -> Material:
    """Sparse layers in all directions (Table 2, scratched)."""
    cut = Profile(path="/mat/cut", shape="quartic")
    own = tuple(
        Layer(
            name=f"l{i:02d}",
            prim="/mat",
            profile=cut,
            width=300.0,
            depth=60.0,
            length=30000.0,
            seed=i,
            coverage=0.05,
            angle=2 * np.pi * i / layers,
        )
        for i in range(layers)
    )
    return Material(path="/mat", surface=metal(roughness=0.02), layers=own)


def seconds(scene: Scene, settings: sw.Settings) -> float:
    film = sw.render(scene, sw.make_plan(scene, settings))
    assert film.stats["invalid_samples"] == 0
    return film.stats["trace"]


def paired(runs: list[Callable[[], float]], repeats: int) -> tuple[list[float], list[float]]:
    """(median seconds of each, median ratio of each to the first), runs taken in turn."""
    for run in runs:
        run()
    rounds = [[run() for run in runs] for _ in range(repeats)]
    middle = [statistics.median(r[i] for r in rounds) for i in range(len(runs))]
    return middle, [statistics.median(r[i] / r[0] for r in rounds) for i in range(len(runs))]


def ggx(repeats: int) -> int:
    """One covering layer against anisotropic GGX."""
    plain = Material(path="/mat", surface=metal(roughness=0.15, anisotropy=0.8))
    failures = 0
    for integrator in ("direct", "path"):
        settings = sw.Settings(width=SIDE, spp=16, integrator=integrator)
        scenes = [world(plain), world(brushed(1))]
        (a, b), (_, ratio) = paired([partial(seconds, s, settings) for s in scenes], repeats)
        good = ratio <= GGX_BAR
        failures += not good
        print(
            f"ggx, {integrator}: GGX {a:.3f} s, one covering layer {b:.3f} s, {ratio:.2f} times", verdict(good, "1.15")
        )
    return failures


def layers(repeats: int) -> int:
    """The sweep of Table 2."""
    settings = sw.Settings(width=SIDE, spp=16)
    failures = 0
    for name, make in (("brushed", brushed), ("scattered", scattered)):
        counts = (1, 6, 16, 32)
        times, ratios = paired([partial(seconds, world(make(n)), settings) for n in counts], repeats)
        shown = ", ".join(f"{n}: {t:.3f} s ({r:.2f})" for n, t, r in zip(counts, times, ratios, strict=True))
        good = name == "brushed" or ratios[-1] <= LAYERS_BAR
        failures += not good
        print(f"layers, {name}: {shown}", verdict(good, "2") if name == "scattered" else "(no bar)")
    return failures


CYCLES = """
import bpy, json, sys, time
import numpy as np
file, side, spp = sys.argv[-3], int(sys.argv[-2]), int(sys.argv[-1])
data = np.load(file)
bpy.ops.wm.read_factory_settings(use_empty=True)
import addon_utils
addon_utils.enable("cycles")
scene = bpy.context.scene
mesh = bpy.data.meshes.new("ball")
mesh.from_pydata(data["points"].tolist(), [], data["triangles"].tolist())
uv = mesh.uv_layers.new(name="st")
uv.data.foreach_set("uv", data["st"].astype(np.float32).ravel())
mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
thing = bpy.data.objects.new("ball", mesh)
thing.location = (0, 0, -4)
scene.collection.objects.link(thing)
material = bpy.data.materials.new("metal")
material.use_nodes = True
nodes, links = material.node_tree.nodes, material.node_tree.links
nodes.clear()
glossy = nodes.new("ShaderNodeBsdfAnisotropic")
glossy.distribution = "GGX"
glossy.inputs["Color"].default_value = (0.56, 0.55, 0.53, 1)
glossy.inputs["Roughness"].default_value = 0.39
glossy.inputs["Anisotropy"].default_value = 0.8
tangent = nodes.new("ShaderNodeTangent")
tangent.direction_type, tangent.uv_map = "UV_MAP", "st"
links.new(tangent.outputs[0], glossy.inputs["Tangent"])
links.new(glossy.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
mesh.materials.append(material)
lamp = bpy.data.lights.new("key", "AREA")
lamp.size, lamp.energy = 1.5, 40.0
key = bpy.data.objects.new("key", lamp)
key.location = (-1.5, 2.0, -0.5)
import mathutils
key.rotation_mode = "QUATERNION"
key.rotation_quaternion = mathutils.Vector((1.5, -2.0, -3.5)).to_track_quat("-Z", "Y")
scene.collection.objects.link(key)
world = bpy.data.worlds.new("world")
world.use_nodes = True
world.node_tree.nodes["Background"].inputs[0].default_value = (0.4, 0.4, 0.4, 1)
scene.world = world
eye = bpy.data.cameras.new("eye")
eye.sensor_width, eye.lens = 10.0, 50.0
scene.camera = bpy.data.objects.new("eye", eye)
scene.collection.objects.link(scene.camera)
scene.render.engine = "CYCLES"
cycles = scene.cycles
cycles.device, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", False, False
cycles.max_bounces, cycles.use_auto_tile = 8, False
scene.render.threads_mode, scene.render.threads = "FIXED", 2
scene.render.use_persistent_data = False
scene.render.resolution_x = scene.render.resolution_y = side
scene.render.resolution_percentage = 100
def shoot(samples):
    scene.cycles.samples = samples
    start = time.perf_counter()
    bpy.ops.render.render()
    return time.perf_counter() - start
shoot(1)
times = []
for _ in range(3):
    few = shoot(2)
    times.append((shoot(2 + spp) - few) / spp)
print("SECONDS", json.dumps(times))
"""


def cycles(repeats: int, python: str) -> int:
    """Samples a second against Cycles, the time of the scene's set-up taken off by a difference of two renders."""
    settings = sw.Settings(width=SIDE, spp=32, integrator="path", threads=2)
    scene = world(brushed(1))
    seconds(scene, settings)
    ours = statistics.median(seconds(scene, settings) for _ in range(repeats)) / 32
    mesh = ball()
    with tempfile.TemporaryDirectory() as folder:
        np.savez(f"{folder}/ball.npz", points=mesh.points, triangles=mesh.triangles, st=mesh.uvs["st"].reshape(-1, 2))
        Path(folder, "rival.py").write_text(CYCLES)  # not cycles.py, which Blender would load as its add-on
        done = subprocess.run(
            [python, f"{folder}/rival.py", f"{folder}/ball.npz", str(SIDE), "16"], capture_output=True, text=True
        )
    said = [line for line in done.stdout.splitlines() if line.startswith("SECONDS")]
    if not said:
        print(f"cycles: could not be run by {python}: {done.stderr.strip().splitlines()[-1:]}")
        return 1
    theirs = statistics.median(json.loads(said[0].removeprefix("SECONDS ")))
    good = ours <= theirs
    rate = SIDE * SIDE / 1e6
    print(f"cycles: {rate / theirs:.2f} million samples/s, ours {rate / ours:.2f}", verdict(good, "Cycles"))
    return int(not good)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--part", nargs="+", choices=("ggx", "layers", "cycles", "resolved"))
    parser.add_argument("--blender", default=sys.executable, help="a Python that has bpy [this one]")
    args = parser.parse_args()
    parts = args.part or ["ggx", "layers", "cycles", "resolved"]
    failures = 0
    for part in parts:
        if part == "cycles":
            if args.blender == sys.executable and importlib.util.find_spec("bpy") is None:
                print("cycles: needs bpy; pip install bpy, or give --blender a Python that has it")
                failures += 1
                continue
            failures += cycles(args.repeats, args.blender)
        else:
            failures += {"ggx": ggx, "layers": layers, "resolved": resolved}[part](args.repeats)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
