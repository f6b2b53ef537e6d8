"""Nothing gains light at any hard place of a scene: under a sky of 1 no surface is brighter than 1, nor negative.

Convex bodies that reflect all or part of what comes, with one kernel, that of everything (``render.scenes``), and what
diffracts with that of ``render.test_diffraction``. Noise: each pixel's variance, of a mean 5 sigma.
"""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.scene import Material, Mesh, Wave

from ..render import scenes
from ..render import test_diffraction as diffracting
from ..render.test_hard_cases import LAYERS, UVS
from . import stages
from .test_scenes import LINEAR, SIZES, finite, needles

BALL = scenes.sphere(8, 16, smooth=False)
MATERIALS = {
    "metal": scenes.scratched(scenes.white_metal(0.2), **SIZES),
    "paper": scenes.scratched(scenes.lambert(), material="diffuse", diffuse_color=(1.0, 1.0, 1.0), **SIZES),
}
AHEAD = (0.0, 0.0, -6.0)


def bounded(film):
    """No pixel is brighter than the sky but for its noise, and their mean is not."""
    noise = np.sqrt(film["variance"])
    assert film["color"].mean(dtype=float) <= 1.0 + 1e-3 + 5.0 * float(np.sqrt((noise**2).sum()) / noise.size)
    assert (film["color"].max(-1) <= 1.02 + 10.0 * noise).all()
    return film


def under_a_sky(meshes, material, placed, seen=True, **fields):
    world = scenes.scene(meshes, [material], [scenes.dome()], placed, **fields)
    film = bounded(finite(scenes.shoot(world, width=12, height=12, spp=16)))
    assert not seen or (film["primId"] >= 0).any()


def moved(at):
    """A camera at a place, and its ball ahead."""
    turn = np.eye(4)
    turn[:3, 3] = at
    return {"cam": replace(scenes.camera(), transform=turn)}, [scenes.place(at=np.add(at, AHEAD))]


def sized(size):
    return [scenes.sphere(8, 16, radius=size, smooth=False)], [scenes.place(at=np.multiply(size, AHEAD))]


def squashed(*scale):
    return [BALL], [scenes.place(at=AHEAD, linear=np.diag(np.array(scale, float)))]


def broken():
    """With triangles of no area and of one point, whose normals are none."""
    thin = np.array([[0, 0, 0], [5, 5, 5], [7, 8, 8], [9, 10, 9]])
    st = np.concatenate([BALL.uvs["st"], np.zeros((4, 3, 2))])
    normals = np.concatenate([scenes.sphere(8, 16).normals, np.zeros((4, 3, 3))])
    return Mesh("/ball", BALL.points, np.concatenate([BALL.triangles, thin]), normals, {"st": st})


HERE = [scenes.place(at=AHEAD)]
# name -> (meshes, instances)
BODIES = {
    **{f"needles of {share:g}": ([needles(BALL, share)], HERE) for share in (1e-3, 1e-6)},
    "no area": ([broken()], HERE),
    "three in one place": ([BALL], [scenes.place(at=AHEAD, path=path) for path in ("/a", "/b", "/c")]),
    "one in one": ([BALL, scenes.sphere(8, 16, radius=1.0 + 1e-7)], None),
    **{f"size {size:g}": sized(size) for size in (1e-6, 1e-3, 1e3, 1e6)},
    **{name: ([BALL], [scenes.place(at=AHEAD, linear=m)]) for name, m in LINEAR.items()},
    **{f"scaled by {scale}": squashed(*scale) for scale in ((1, 1, 0), (0, 0, 1), (0, 0, 0), (1e-12,) * 3, (1e7,) * 3)},
    "around the camera": ([scenes.sphere(8, 16, radius=2.0)], [scenes.place()]),
    "touching the camera": ([BALL], [scenes.place(at=(0, 0, -1))]),
    **{
        f"level, {height:g} below": ([scenes.plane(100.0, axis="y")], [scenes.place(at=(0, -height, 0))])
        for height in (1e-1, 1e-4, 1e-6, 0.0)
    },
    **{f"uv: {name}": ([replace(BALL, uvs={"st": change(BALL.uvs["st"])})], HERE) for name, change in UVS.items()},
    "no uv": ([replace(BALL, uvs={})], HERE),
}
UNSEEN = ("scaled by", "level", "flattened")


@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("name", BODIES)
def test_bodies(name, material):
    under_a_sky(*BODIES[name][:1], MATERIALS[material], BODIES[name][1], seen=not name.startswith(UNSEEN))


@pytest.mark.parametrize("at", [(1e3, -1e3, 1e3), (1e6, 1e6, -1e6), (1e9, 0, 0)])
def test_far_from_the_origin(at):
    """Where float32 tells apart no more than centimetres, and nothing."""
    fields, placed = moved(at)
    under_a_sky([BALL], MATERIALS["metal"], placed, seen=False, **fields)


@pytest.mark.parametrize("distribution", ["worley", "linear"])
@pytest.mark.parametrize("name", LAYERS)
def test_layers(name, distribution):
    """Widths, depths, lengths and densities of nothing and of far too much."""
    kept = {k: v for k, v in LAYERS[name].items() if k not in ("distribution", "material", "ior")}
    asked = {"distribution": distribution, **kept, "fresnel": "mirror"}
    for surface in (scenes.white_metal(0.2), scenes.lambert()):
        under_a_sky([BALL], scenes.scratched(surface, **asked), HERE)


LAID = {"distribution": "random", "coverage": 0.3, "width": 6.0, "length": 4000.0}
WAVES = {
    "no width": {"width": 1e-9, "density": 1.0},
    "no depth": {"depth": 0.0},
    "metres deep": {"depth": 1e6},
    "an atom deep": {"depth": 1e-4},
    "a millimetre wide": {"width": 1e3},
    "a point long": {"length": 1e-3, "coverage": 1e-3},
    "everywhere": {"coverage": 1.0, "length": 9000.0},
    "hardly": {"coverage": 1e-9},
    "no coherence": {"wave": Wave(coherence_radius=1e-6)},
    "endless coherence": {"wave": Wave(coherence_radius=1e9)},
    "X-rays to heat": {"wave": Wave(wavelength_range=(100.0, 20000.0))},
    "one colour": {"wave": Wave(wavelength_range=(550.0, 550.001))},
    "rough floors": {"wave": Wave(roughness=1e12)},
    "lines without a gap": {"distribution": "linear", "pitch": 6.0},
    "lines far apart": {"distribution": "linear", "pitch": 1e9},
}


@pytest.mark.parametrize("name", WAVES)
def test_waves(name):
    """Scratches that diffract, whatever of them is too small or too large; a mirror's light is without noise."""
    material = diffracting.waves(surface=scenes.white_metal(), **{**LAID, "model": "diffraction", **WAVES[name]})
    film = finite(diffracting.render(material, scenes.dome(), (), size=4, spp=1))
    assert film["color"].max() <= 1.0 + 2e-3


def test_matrices_over_time(tmp_path):
    """A cube that is squashed flat, mirrored and sheared, and gone, at its time samples and between them."""
    path = tmp_path / "stage.usda"
    path.write_text(stages.HEADER + stages.MOVING + stages.LIGHTS["even sky"] + stages.CAMERA.replace("STOP", "0"))
    settings = sw.Settings(width=12, height=12, spp=16, filter="box", effects=scenes.EVERYTHING)
    for frame in (1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 9.0):
        world = sw.read(path, frame=frame)
        surfaces = tuple(Material(m.path, scenes.lambert()) for m in world.materials)
        world = replace(world, lights=(scenes.dome(),), materials=surfaces)
        bounded(finite(sw.render(world, sw.make_plan(world, settings))))
