"""What wave optics costs and how exact it is. Run it by hand on an idle machine, with the extra ``benchmark``:

    python tests/benchmarks/diffraction.py [--part closed slices spoon growth build table2] [--repeats 5]

closed   a scratch under area lights, averaged over a footprint: the time in which samples of both reach the error that
         the closed form has. Bar: 1,000 times.
slices   at most four slices against the printed Eq. 27 with Eq. 29 in numba (``diffraction_paper``), one thread each,
         and the error of both. Bar: twice the time.
spoon    the spoon at 1280 x 720, one sphere light, the footprint antialiases, after warm-up. Bar: 1.5 s on 2 cores.
growth   1e3 to 1e6 scratches at equal coverage, the same of them in view. Bar: 1.5 times.
build    reading and cutting scratches. Bars: the spoon's 10,000 in 2 s and 64 bytes a piece, a million two-point curves
         in 30 s, 200,000 scratches in 24 GB.
table2   the table of the paper: three zooms, with BVH and lists of triangles, with and without antialiasing, for
         intersections alone, a sphere, a triangle.
"""

import argparse
import math
import sys
import tempfile
import time
from dataclasses import replace

import numpy as np

import scratchwarp as sw
from scratchwarp import diffraction
from scratchwarp.pipelines.author_demo import author
from scratchwarp.pipelines.demo_spoon import star
from scratchwarp.scene import (
    Camera,
    Curves,
    Instance,
    Layer,
    Material,
    Mesh,
    MeshLight,
    Profile,
    Scene,
    ScratchSurface,
    SphereLight,
    Wave,
)

PARTS = ("closed", "slices", "spoon", "growth", "build", "table2")


def fastest(call, repeats):
    """Seconds of the fastest of some calls after one that warms up."""
    call()
    taken = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        taken.append(time.perf_counter() - start)
    return min(taken)


def cases(count, size, seed=0):
    """Random scratches, views that look at a light of angular radius ``size``, and its direction."""
    rng = np.random.default_rng(seed)
    s = diffraction.Scratch(rng.uniform(0.8, 6, count), rng.uniform(0.8, 6, count), rng.uniform(-3, 3, count))
    light = rng.normal(size=(count, 3))
    light[:, 2] = np.abs(light[:, 2]) + 0.3
    light /= np.linalg.norm(light, axis=1, keepdims=True)
    c, d = np.cos(s.azimuth), np.sin(s.azimuth)
    u = size * rng.uniform(-0.5, 0.5, count) - (light[:, 0] * c + light[:, 1] * d)
    u = np.clip(u, -0.95, 0.95)
    v = rng.uniform(-0.6, 0.6, count) * np.sqrt(1 - u * u)
    wo = np.stack([u * c - v * d, u * d + v * c, np.sqrt(np.maximum(1 - u * u - v * v, 1e-4))], axis=-1)
    wo /= np.linalg.norm(wo, axis=1, keepdims=True)
    return s, wo, light, rng.uniform(400, 750, count)


def timed_kernel(call):
    """Seconds inside the kernels that a call launches, its arrays not counted."""
    from scratchwarp.reflectance.diffraction import arrays

    spent = []
    launch = arrays.wp.launch

    def timed(*values, **named):
        start = time.perf_counter()
        launch(*values, **named)
        spent.append(time.perf_counter() - start)

    arrays.wp.launch = timed
    try:
        call()
    finally:
        arrays.wp.launch = launch
    return sum(spent)


def part_closed(repeats):
    """Error against time of the closed form and of samples."""
    import diffraction_paper as paper

    n, a1, a2 = 400, 150.0, 60.0
    lights = {"sphere of 5 mm at 1 m": 0.005, "sphere of 5 cm at 1 m": 0.05, "sphere of 20 cm at 1 m": 0.2}
    for name, size in lights.items():
        s, wo, center, wave = cases(n, size)
        rng = np.random.default_rng(1)
        angle, offset = rng.uniform(0, np.pi, n), rng.uniform(-100, 100, n)
        ball = diffraction.SphereLight(center, size)

        def closed(ball=ball, wo=wo, s=s, wave=wave, angle=angle, offset=offset):
            per = diffraction.footprint(a1, a2, angle, offset, method="exact") / (2 * np.pi * 3600.0)
            return diffraction.radiance(ball, wo, s, wave, slices=4) * per

        exact = diffraction.radiance(ball, wo, s, wave, slices=64) * (
            diffraction.footprint(a1, a2, angle, offset, method="exact") / (2 * np.pi * 3600.0)
        )
        bright = exact > 0.01 * exact.max()
        error = np.sqrt(np.mean((closed()[bright] / exact[bright] - 1) ** 2))
        kernel = min(timed_kernel(closed) for _ in range(repeats))
        samples = 20000
        rows = (center, np.full(n, size), wo, s.azimuth, s.width, s.depth, 60.0, angle, offset, a1, a2, wave * 1e-3)
        taken = fastest(lambda rows=rows, samples=samples: paper.sampled(*rows, samples, 1), repeats)
        noise = np.sqrt(np.mean((paper.sampled(*rows, samples, 2)[bright] / exact[bright] - 1) ** 2))
        needed = taken * (noise / error) ** 2
        print(f"{name}: closed form {1e9 * kernel / n:8.0f} ns, relative error {error:.1e}; {samples} samples")
        print(f"    {1e9 * taken / n:10.0f} ns, {noise:.1e}; equal error after {needed / kernel:,.0f} times the time")


def part_slices(repeats):
    """Slices against the printed form."""
    import diffraction_paper as paper

    n = 100000
    print("light                     printed       slices    ratio   error: printed   slices (median, 95 %)")
    for name, size in (("1 mm sphere at 1 m", 0.001), ("5 mm sphere", 0.005), ("5 cm sphere", 0.05), ("60 cm", 0.6)):
        s, wo, center, wave = cases(n, size)
        ball = diffraction.SphereLight(center, size)
        rows = (center, np.full(n, size), wo, s.azimuth, s.width, s.depth, 60.0, np.zeros(n), wave * 1e-3)
        printed = fastest(lambda rows=rows: paper.spheres(*rows), repeats)

        def call(ball=ball, s=s, wo=wo, wave=wave):
            return diffraction.radiance(ball, wo, s, wave)

        _line(name, n, printed, call, paper.spheres(*rows), (ball, wo, s, wave), repeats)
    for name, size in (("triangle of 2 cm", 0.02), ("triangle of 30 cm", 0.3)):
        s, wo, center, wave = cases(n, size)
        side = np.cross(center, [0.3, 0.5, 0.8])
        side /= np.linalg.norm(side, axis=1, keepdims=True)
        other = np.cross(center, side)
        turn = 2 * np.pi * np.arange(3) / 3
        ring = np.cos(turn)[:, None] * side[:, None] + np.sin(turn)[:, None] * other[:, None]
        vertices = center[:, None] + size * ring
        light = diffraction.PolygonLight(vertices)
        rows = (vertices, wo, s.azimuth, s.width, s.depth, 60.0, np.zeros(n), wave * 1e-3)
        printed = fastest(lambda rows=rows: paper.polygons(*rows), repeats)

        def call(light=light, s=s, wo=wo, wave=wave):
            return diffraction.radiance(light, wo, s, wave)

        _line(name, n, printed, call, paper.polygons(*rows), (light, wo, s, wave), repeats)


def _line(name, n, printed, call, by_paper, case, repeats):
    """One row: times of the two and their errors on the first thousand."""
    call()
    kernel = min(timed_kernel(call) for _ in range(repeats))
    exact = diffraction.radiance(*case, slices=48)
    seen = exact > 1e-3 * exact.max()
    errors = [np.quantile(np.abs(v[seen] / exact[seen] - 1), [0.5, 0.95]) for v in (by_paper, call())]
    shown = "   ".join(f"{e[0]:.1e} {e[1]:.1e}" for e in errors)
    print(f"{name:20s} {1e9 * printed / n:9.0f} ns {1e9 * kernel / n:9.0f} ns   {kernel / printed:5.2f}   {shown}")


def spoon_scene(folder, name="spoon"):
    """The demo stage, read."""
    return sw.read(author(folder, names=[name])[0])


def traced(scene, repeats, effects=None, **settings):
    """(seconds of tracing, film) of the fastest render after one that warms up."""
    asked = sw.Settings(**{"width": 1280, "height": 720, "spp": 1, "effects": effects or {}, **settings})
    plan = sw.make_plan(scene, asked)
    sw.render(scene, plan)
    films = [sw.render(scene, plan) for _ in range(repeats)]
    best = min(films, key=lambda film: film.stats["trace"])
    return best.stats["trace"], best


def part_spoon(repeats):
    """The spoon in one sample a pixel, whose footprint antialiases."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("spoon", "spoon_star", "spoon_window"):
            start = time.perf_counter()
            scene = spoon_scene(folder, name)
            seconds, film = traced(scene, repeats)
            print(
                f"{name:13s} 1280 x 720: traced in {seconds:.2f} s; read {scene.seconds:.2f} s, "
                f"compiled and built {film.stats['compile']:.2f} s, all {time.perf_counter() - start:.1f} s"
            )


def field(count, per_side):
    """``count`` scratches of 2 mm over a square plane that grows with their number, in uv."""
    rng = np.random.default_rng(3)
    side = 0.02 * math.sqrt(count / 1000.0)
    n = max(2, round(per_side * side / 0.02))
    t = np.linspace(-0.5, 0.5, n + 1) * side
    x, y = np.meshgrid(t, t)
    points = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    st = np.stack([x, y], axis=-1).reshape(-1, 2) / side + 0.5
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    quads = np.stack([a, a + 1, a + n + 2, a + n + 1], 1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    mesh = Mesh(path="/plane", points=points, triangles=triangles, uvs={"st": st[triangles]})
    turn = rng.uniform(0, np.pi, count)
    half = 0.001 / side * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    middle = rng.uniform(0, 1, (count, 2))
    ends = np.stack([middle - half, middle + half], axis=1).reshape(-1, 2)
    sizes = rng.uniform(0.8, 6.0, (2, count))
    curves = Curves(
        "/wear", np.concatenate([ends, np.zeros((2 * count, 1))], axis=1), np.full(count, 2), np.repeat(sizes[0], 2),
        np.repeat(sizes[1], 2), space="uv",
    )  # fmt: skip
    layer = Layer(
        name="wear", prim="/mat", profile=Profile(path="/mat/groove", shape="rectangle"), distribution="curves",
        curves=(0,),
    )  # fmt: skip
    material = Material(path="/mat", surface=ScratchSurface(roughness=0.04), layers=(layer,), wave=Wave())
    place = np.eye(4)
    place[2, 3] = -1.0
    camera = Camera(
        path="/cam", transform=np.eye(4), horizontal_aperture=0.016, vertical_aperture=0.009, projection="orthographic"
    )
    light = SphereLight(path="/l", radiance=np.full(3, 1e4), center=np.array([0.1, 0.05, 0.0]), radius=0.005)
    return Scene(
        path="growth", meshes=(mesh,), instances=(Instance("/plane", 0, place, (0,)),), materials=(material,),
        lights=(light,), camera=camera, curves=(curves,),
    )  # fmt: skip


def part_growth(repeats):
    """More and more scratches out of view."""
    first = None
    for count in (1000, 10000, 100000, 1000000):
        start = time.perf_counter()
        scene = field(count, 20)
        made = time.perf_counter() - start
        seconds, film = traced(scene, repeats, width=320, height=180)
        first = first or seconds
        whole = time.perf_counter() - start - made
        print(
            f"{count:8d} scratches: traced in {seconds:.3f} s, {seconds / first:.2f} times the first; "
            f"{whole:.1f} s in all"
        )


def part_build(repeats):
    """Reading and cutting scratches."""
    import diffraction_build

    diffraction_build.part_build(repeats)


def zoomed(scene, factor):
    """The camera's lens longer by a factor."""
    return replace(scene, camera=replace(scene.camera, focal_length=scene.camera.focal_length * factor))


def part_table2(repeats):
    """Table 2. Without antialiasing a sample's footprint is its point."""
    by_bvh = {"diffraction.hierarchy": True, "diffraction.lists": False}
    by_list = {"diffraction.hierarchy": False, "diffraction.lists": True}
    switches = {
        "BVH": {**by_bvh, "diffraction.pointFootprint": True},
        "Per Triangle Array": {**by_list, "diffraction.pointFootprint": True},
        "AA: BVH": by_bvh,
        "AA: Per Triangle Array": by_list,
    }
    with tempfile.TemporaryDirectory() as folder:
        scene = spoon_scene(folder)
        bulb = scene.lights[0]
        shape = star(8, 2.0, 9.0)
        tip = Mesh(path="/tip", points=0.01 * shape.points[:3], triangles=np.array([[0, 1, 2]]))
        place = np.eye(4)
        place[:3, 3] = bulb.center
        back = -bulb.center / np.linalg.norm(bulb.center)
        side = np.cross([0.0, 1.0, 0.0], back)
        place[:3, :3] = np.stack([side, np.cross(back, side), back], axis=1)
        dark = Material(path="/dark", surface=ScratchSurface(base="diffuse", color=(0.0, 0.0, 0.0)))
        at = len(scene.instances)
        instances = (*scene.instances, Instance("/tip", len(scene.meshes), place, (len(scene.materials),), light=0))
        triangle = replace(
            scene, meshes=(*scene.meshes, tip), materials=(*scene.materials, dark), instances=instances,
            lights=(MeshLight(path="/tip", radiance=bulb.radiance, instance=at),),
        )  # fmt: skip
        rows = {"Intersection Only": replace(scene, lights=()), "Sphere": scene, "Triangle": triangle}
        zooms = (0.5, 1.0, 2.0)
        print("1280 x 720, one sample a pixel, 10,000 scratches; milliseconds")
        print(f"{'':20s}" + "".join(f"{name:>33s}" for name in switches))
        print(f"{'Zoom-In':20s}" + "".join(f"{z:>10.1f}x" for _ in switches for z in zooms))
        for name, world in rows.items():
            line = f"{name:20s}"
            for effects in switches.values():
                for zoom in zooms:
                    line += f"{1e3 * traced(zoomed(world, zoom), repeats, effects)[0]:>11.0f}"
            print(line, flush=True)


def main(argv=None):
    """Run the parts that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", nargs="+", choices=PARTS, default=PARTS)
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args(argv)
    for part in options.part:
        print(f"\n{part}", flush=True)
        globals()[f"part_{part}"](options.repeats)
    return 0


if __name__ == "__main__":
    sys.exit(main())
