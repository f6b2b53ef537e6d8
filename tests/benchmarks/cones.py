"""Closed form along mirror cones against sampling, on a brushed ball. Run it by hand on an idle machine:

    python tests/benchmarks/cones.py [--size 96] [--repeats 3]

For each lighting: seconds and relative RMSE of one sample a pixel in closed form, and of 1 to 256 by multiple
importance sampling, all of one run and in turn; the reference has 4096 samples, drawn anew. Samples are points: no
pixel is filtered, so that only light makes noise. The last figure is how many samples by sampling have the error of one
in closed form, interpolated in log-log. The bar: at least 64 where nothing hides a light.
"""

import argparse
import statistics

import numpy as np

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
    SphereLight,
    Texture,
)

BAR = 64
COUNTS = (1, 4, 16, 64, 256)
LAMP = RectLight(
    path="/lamp",
    radiance=(4, 4, 4),
    center=(2, 2, 2),
    ex=(1, 0, -1),
    ey=(0, 1, 0),
    normal=(-(0.5**0.5), 0, -(0.5**0.5)),
)
BULB = SphereLight(path="/bulb", radiance=(9, 7, 5), center=(-1.5, 1.5, 2.5), radius=0.6)


def ball() -> Mesh:
    """Unit sphere, closed and convex, with u around the y axis."""
    v, u = np.meshgrid(np.linspace(0, 1, 65), np.linspace(0, 1, 129), indexing="ij")
    turn = 2 * np.pi * u
    points = np.stack([np.sin(np.pi * v) * np.sin(turn), -np.cos(np.pi * v), np.sin(np.pi * v) * np.cos(turn)], -1)
    a = (np.arange(64)[:, None] * 129 + np.arange(128)).ravel()
    triangles = np.concatenate([np.stack([a, a + 1, a + 130], 1), np.stack([a, a + 130, a + 129], 1)])
    points = points.reshape(-1, 3)
    # at the poles one of two has no area
    corners = points[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    triangles = triangles[area > 1e-12]
    st = np.stack([u, v], -1).reshape(-1, 2)
    return Mesh("/ball", points, triangles, normals=points[triangles], uvs={"st": st[triangles]})


def sky() -> Texture:
    """A smooth image with a bright window."""
    y, x = np.mgrid[0:128, 0:256]
    pixels = np.ones((128, 256, 4), np.float32)
    pixels[..., :3] = (0.4 + 0.3 * np.sin(x / 20.0) * np.cos(y / 15.0))[..., None] * (0.7, 0.9, 1.1)
    pixels[30:50, 100:120, :3] = 20.0
    return Texture("/sky", pixels)


def world(lights, hidden: bool) -> Scene:
    """A ball of gold, brushed all over; ``hidden``: another one beside it casts its shadow."""
    layer = Layer(
        name="brushed", prim="/mat", profile=Profile("/mat/p", shape="round"), coverage=1.0, width=20.0,
        depth=4.0, fresnel="exact",
    )  # fmt: skip
    gold = Material("/mat", ScratchSurface("conductor", metal="gold"), layers=(layer,))
    view = np.eye(4)
    view[2, 3] = 6.0
    beside = np.eye(4)
    beside[:3, 3] = (1.2, 1.2, 1.2)
    beside[:3, :3] *= 0.5
    placed = [Instance("/ball", 0, np.eye(4), (0,))] + ([Instance("/other", 0, beside, (0,))] if hidden else [])
    camera = Camera("/cam", view, horizontal_aperture=20.0, vertical_aperture=20.0, focal_length=50.0)
    return Scene(path="ball", meshes=(ball(),), instances=tuple(placed), materials=(gold,), lights=tuple(lights),
                 camera=camera, textures=(sky(),))  # fmt: skip


def film(scene: Scene, size: int, spp: int, closed: bool, seed: int = 0) -> tuple[float, np.ndarray]:
    """(seconds of tracing, image)."""
    effects = {"lights.closedForm": closed}
    settings = sw.Settings(
        width=size, height=size, spp=spp, filter="box", filter_width=1e-4, seed=seed, effects=effects,
        knobs={"tables.theta": "table"},
    )  # fmt: skip
    made = sw.render(scene, sw.make_plan(scene, settings))
    return made.stats["trace"], made["color"].astype(float)


def measure(name: str, scene: Scene, size: int, repeats: int) -> float:
    """Print a lighting's figures; how many samples one in closed form is worth."""
    reference = film(scene, size, 4096, closed=False, seed=7)[1]
    # a pixel's edge of geometry is noise that has nothing to do with light: one sample of it is drawn alike by both
    inside = np.hypot(*(np.mgrid[0:size, 0:size] - (size - 1) / 2)) < 0.36 * size

    def off(image: np.ndarray) -> float:
        return float(np.sqrt(((image - reference)[inside] ** 2).mean()) / reference[inside].mean())

    def run(spp: int, closed: bool) -> tuple[float, float]:
        made = [film(scene, size, spp, closed, seed) for seed in range(repeats)]
        return statistics.median(t for t, _ in made), statistics.median(off(image) for _, image in made)

    print(f"{name}: samples, seconds, relative RMSE")
    one = run(1, True)
    print(f"  closed form    1  {one[0]:8.4f}  {one[1]:.5f}")
    errors = []
    for count in COUNTS:
        seconds, error = run(count, False)
        errors.append(error)
        print(f"  sampling    {count:4d}  {seconds:8.4f}  {error:.5f}")
    for count in COUNTS[1:]:
        seconds, error = run(count, True)
        print(f"  closed form {count:4d}  {seconds:8.4f}  {error:.5f}")
    worth = float(np.exp(np.interp(-np.log(one[1]), -np.log(errors), np.log(COUNTS))))
    print(f"  one in closed form is worth {worth:.0f}{' or more' if worth >= COUNTS[-1] else ''}")
    return worth


def main() -> None:
    """Measure every lighting and say whether the bar holds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=96)
    parser.add_argument("--repeats", type=int, default=3)
    args = parser.parse_args()
    dome = DomeLight(path="/dome", radiance=(1, 1, 1))
    lit = {
        "rect and sphere": ([LAMP, BULB], False),
        "constant dome": ([dome], False),
        "image": ([DomeLight(path="/dome", radiance=(1, 1, 1), texture=0)], False),
        "rect and sphere, half hidden": ([LAMP, BULB], True),
    }
    worth = {
        name: measure(name, world(lights, hidden), args.size, args.repeats) for name, (lights, hidden) in lit.items()
    }
    held = all(worth[name] >= BAR for name in ("rect and sphere", "constant dome"))
    print(f"bar of {BAR} samples: {'held' if held else 'missed'}")


if __name__ == "__main__":
    main()
