"""Statistics of grooves far below a pixel against supersampling them, for ``svbrdf.py``."""

import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from functools import partial

import numpy as np

import scratchwarp as sw
from scratchwarp.scene import (
    Camera,
    DistantLight,
    DomeLight,
    Instance,
    Layer,
    Material,
    Mesh,
    PreviewSurface,
    Profile,
    Scene,
    ScratchSurface,
    Texture,
    TextureInput,
)

RESOLVED_BAR, TARGET = 30.0, 1e-2
PERIOD = 100e-6  # metres from groove to groove
ASPECT, PIXELS, ACROSS = 0.12, 32, 60  # depth over width, side of the image, grooves a pixel


def verdict(good: bool, bar: str) -> str:
    return "ok" if good else f"MISSES {bar}"


def sheet(profile: np.ndarray | None) -> Mesh:
    """A square of the image's width about the origin in the plane z = 0: flat, or with real grooves along x."""
    size = PIXELS * ACROSS * PERIOD
    if profile is None:
        h = size
        points = np.array([[-h, -h, 0], [h, -h, 0], [h, h, 0], [-h, h, 0]])
        faces = np.array([[0, 1, 2], [0, 2, 3]])
        st = (points[:, :2] + h) / (2 * h)
        return Mesh(path="/sheet", points=points, triangles=faces, uvs={"st": st[faces]})
    count = int(1.2 * PIXELS * ACROSS)
    y = ((np.arange(count)[:, None] - count // 2) + profile[:-1, 0]).ravel() * PERIOD
    z = np.tile(profile[:-1, 1], count) * PERIOD
    points = np.concatenate([np.stack([np.full_like(y, x), y, z], 1) for x in (-size, size)])
    a = np.arange(len(y) - 1)
    b = a + len(y)
    faces = np.concatenate([np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)])
    return Mesh(path="/sheet", points=points, triangles=faces)


def groove(samples: int = 33) -> np.ndarray:
    """The quartic groove as (x, z) in periods."""
    x = np.linspace(0, 1, samples)
    return np.stack([x, -ASPECT * (1 - (2 * x - 1) ** 2) ** 2], 1)


def far(material: Material, mesh: Mesh) -> Scene:
    """The sheet from a metre's distance under a lamp of five degrees and a dome."""
    view = np.array([0.35, -0.25, 0.9])
    view /= np.linalg.norm(view)
    right = np.cross((0, 0, 1), view)
    right /= np.linalg.norm(right)
    m = np.eye(4)
    m[:3] = np.stack([right, np.cross(view, right), view, view], 1)
    size = 0.7 * PIXELS * ACROSS * PERIOD
    camera = Camera(
        path="/cam",
        transform=m,
        horizontal_aperture=size * 1000 / 20,
        vertical_aperture=size * 1000 / 20,
        focal_length=50.0,
    )
    travels = np.array([view[0], -view[1] - 0.35, -view[2]])  # grooves along x mirror it towards the camera
    travels /= np.linalg.norm(travels)
    lamp = DistantLight(path="/sun", radiance=np.full(3, 200.0), direction=travels, angle=np.radians(5.0))
    sky = DomeLight(path="/dome", radiance=np.full(3, 0.3))
    return Scene(
        path="benchmark",
        meshes=(mesh,),
        instances=(Instance(path="/sheet", mesh=0, transform=np.eye(4), materials=(0,)),),
        materials=(material,),
        lights=(lamp, sky),
        camera=camera,
    )


def to_reach(scene: Scene, settings: sw.Settings) -> tuple[float, float]:
    """(seconds to a relative RMSE of TARGET, mean radiance): noise falls with the root of time, as two renders say."""
    plans = [sw.make_plan(scene, replace(settings, seed=s)) for s in (1, 2)]
    sw.render(scene, plans[0])
    films = [sw.render(scene, plan) for plan in plans]
    a, b = (f["color"].astype(np.float64) for f in films)
    spent = statistics.mean(f.stats["trace"] for f in films)
    rmse = np.sqrt(np.mean((a - b) ** 2) / 2) / np.mean((a + b) / 2)
    return spent * (rmse / TARGET) ** 2, float((a + b).mean() / 2)


def normal_map(samples: int = 64) -> Texture:
    """One period of the groove as a tangent-space normal map, texel by texel the slope's mean."""
    x = np.linspace(0, 1, samples + 1)
    slope = np.diff(-ASPECT * (1 - (2 * x - 1) ** 2) ** 2) * samples
    n = np.stack([np.zeros(samples), -slope, np.ones(samples)], 1)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    pixels = np.ones((samples, 1, 4), np.float32)
    pixels[:, 0, :3] = (0.5 + 0.5 * n)[::-1]
    return Texture(path="groove.png", pixels=pixels)


def mitsuba(scene: Scene) -> tuple[float, float]:
    """(seconds to TARGET, mean radiance) of Mitsuba's path tracer on the grooves' geometry."""
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb" if _llvm_works() else "scalar_rgb")
    t = mi.ScalarTransform4f
    mesh = scene.meshes[0]
    shape = mi.Mesh("grooves", len(mesh.points), len(mesh.triangles))
    params = mi.traverse(shape)
    scale = 1e4  # its float32 offsets still cost some of the light between the grooves: its time counts here
    params["vertex_positions"] = (mesh.points * scale).astype(np.float32).ravel()
    params["faces"] = mesh.triangles.astype(np.uint32).ravel()
    params.update()
    half = scene.camera.horizontal_aperture / 50.0 / 2
    fov = 2 * np.degrees(np.arctan(half))
    at = scene.camera.transform.copy()
    at[:3, 3] *= scale
    towards = scene.lights[0].direction
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/grooves.ply"
        shape.write_ply(file)
        loaded = mi.load_dict(
            {
                "type": "scene",
                "integrator": {"type": "path", "max_depth": 9},
                "sensor": {
                    "type": "perspective",
                    "fov": fov,
                    "to_world": t(at @ np.diag([-1.0, 1.0, -1.0, 1.0])),
                    "film": {"type": "hdrfilm", "width": PIXELS, "height": PIXELS, "rfilter": {"type": "box"}},
                    "near_clip": 1.0,
                    "far_clip": 1e6,
                },
                "grooves": {
                    "type": "ply",
                    "filename": file,
                    "face_normals": True,
                    "bsdf": {
                        "type": "twosided",
                        "nested": {"type": "conductor", "material": "none"},
                    },
                },
                # a lamp of five degrees: a disk far away that looks at the sheet
                "sun": {
                    "type": "disk",
                    "to_world": t()
                    .look_at(origin=(-towards * 3e4).tolist(), target=[0, 0, 0], up=[0.1, 0.9, 0.3])
                    .scale(3e4 * float(np.tan(np.radians(2.5)))),
                    "emitter": {"type": "area", "radiance": {"type": "rgb", "value": [200.0] * 3}},
                },
                "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [0.3] * 3}},
            }
        )
    spp = 256
    mi.render(loaded, spp=spp, seed=9)
    images, spent = [], []
    for seed in (1, 2):
        start = time.perf_counter()
        images.append(np.array(mi.render(loaded, spp=spp, seed=seed)).astype(np.float64)[..., :3])
        spent.append(time.perf_counter() - start)
    a, b = images
    rmse = np.sqrt(np.mean((a - b) ** 2) / 2) / np.mean((a + b) / 2)
    return statistics.mean(spent) * (rmse / TARGET) ** 2, float((a + b).mean() / 2)


def _llvm_works() -> bool:
    """Whether Mitsuba renders through LLVM here; tried in another process, which one that does not suit ends."""
    tried = (
        "import mitsuba as mi, numpy; mi.set_variant('llvm_ad_rgb');"
        "numpy.array(mi.render(mi.load_dict(mi.cornell_box()), spp=1))"
    )
    return subprocess.run([sys.executable, "-c", tried], capture_output=True).returncode == 0


def resolved(repeats: int) -> int:
    """Statistics against supersampled geometry and normal maps, grooves far below a pixel."""
    mirror = ScratchSurface(base="conductor", metal="custom", eta=(0.0,) * 3, k=(1.0,) * 3, roughness=0.0)
    points = groove()
    cut = Profile(path="/mat/cut", shape="quartic", periodic=True)
    layer = Layer(
        name="cut",
        prim="/mat",
        profile=cut,
        distribution="linear",
        width=PERIOD * 1e6,
        pitch=PERIOD * 1e6,
        depth=ASPECT * PERIOD * 1e6,
        fresnel="mirror",
    )
    mapped = PreviewSurface(
        diffuse_color=(1.0,) * 3,
        metallic=1.0,
        roughness=0.0,
        normal=TextureInput(
            texture=0,
            channel="rgb",
            scale=np.array([2.0, 2.0, 2.0, 1.0]),
            bias=np.array([-1.0, -1.0, -1.0, 0.0]),
            transform=np.array([[1.0, 0.0, 0.0], [0.0, 2.0 * PIXELS * ACROSS, 0.0]]),
        ),
    )
    ours = far(Material(path="/mat", surface=mirror, layers=(layer,)), sheet(None))
    geometry = far(Material(path="/mat", surface=mirror), sheet(points))
    texture = replace(far(Material(path="/mat", surface=mapped), sheet(None)), textures=(normal_map(),))
    rivals = {
        "geometry, our path tracer": partial(to_reach, geometry, sw.Settings(width=PIXELS, spp=256, integrator="path")),
        "normal map, ours": partial(to_reach, texture, sw.Settings(width=PIXELS, spp=256)),
        "geometry, Mitsuba 3": partial(mitsuba, geometry),
    }
    failures = 0
    mine = [to_reach(ours, sw.Settings(width=PIXELS, spp=64)) for _ in range(repeats)]
    fast, mean = statistics.median(t for t, _ in mine), mine[0][1]
    print(f"resolved: our scratches reach {TARGET:g} in {fast:.4f} s, mean radiance {mean:.4f}")
    for name, run in rivals.items():
        slow, other = run()
        good = slow / fast >= RESOLVED_BAR
        failures += not good
        print(f"  {name}: {slow:.3f} s, {slow / fast:.0f} times, mean radiance {other:.4f}", verdict(good, "30"))
    return failures
