"""Whole images at the hard places of a scene: the same image by another road, or a furnace in which nothing is seen.

All with one kernel, that of everything (``render.scenes``). A scene scaled by a power of two has the same digits
everywhere, so that its image is the same to a few roundings; only lengths compared with constants would show.
"""

from dataclasses import replace

import numpy as np
import pytest

from scratchwarp.scene import DistantLight, Material, Mesh, PreviewSurface, Profile, RectLight, SphereLight

from ..render import scenes

ROUGH = PreviewSurface(diffuse_color=(0.6, 0.4, 0.3), roughness=0.3, clearcoat=1.0)
SIZES = {"width": 3e4, "depth": 1e4, "length": 3e5, "pitch": 1.1e5}
SMALL = {"width": 24, "height": 24, "spp": 8}


def lamp(size=1.0, **fields):
    made = {"center": (2, 2, -3), "ex": (0.5, 0, -0.5), "ey": (0, 0.7, 0), "normal": (-0.8, 0, -0.6), **fields}
    scaled = {name: np.array(v) * (size if name != "normal" else 1.0) for name, v in made.items()}
    return RectLight(path="/lamp", radiance=(9, 7, 5), **scaled)


def finite(film):
    """No value is lost, negative or not a number."""
    assert film.stats["invalid_samples"] == 0
    for name in film:
        values = film[name]
        bad = ~np.isfinite(values)
        assert not (bad & ~(np.isposinf(values) & (film["primId"] == -1))).any() if name == "depth" else not bad.any()
    assert film["color"].min() >= 0.0 and film["base"].min() >= 0.0 and film["scratches"].min() >= 0.0
    return film


def look(mesh, material=None, lights=None, placed=None, **settings):
    material = material or scenes.scratched(ROUGH, **SIZES)
    lights = [lamp(), scenes.dome(0.2)] if lights is None else lights
    placed = placed or [scenes.place(at=(0, 0, -6))]
    return finite(scenes.shoot(scenes.scene([mesh], [material], lights, placed), **{**SMALL, **settings}))


def same(film, other, rtol=1e-4, share=1.0):
    near = np.isclose(film["color"], other["color"], rtol=rtol, atol=1e-6).all(-1)
    assert near.mean() >= share, (near.mean(), np.abs(film["color"] - other["color"]).max())
    assert film["color"].std() > 0.01


@pytest.mark.parametrize("power", [-20, -10, 10, 20])
@pytest.mark.parametrize("distribution", ["worley", "crosshatch"])
def test_scaled_scenes_look_the_same(power, distribution):
    """From micrometres to thousands of kilometres, scratches with them."""

    def at(size):
        fields = {name: value * size for name, value in SIZES.items()}
        material = scenes.scratched(ROUGH, distribution=distribution, **fields)
        lights = [lamp(size), scenes.dome(0.2)]
        return look(scenes.sphere(radius=size), material, lights, [scenes.place(at=(0, 0, -6 * size))])

    # one sample of a thousand may fall on the other side of an edge of a scratch
    same(at(2.0**power), at(1.0), share=0.99)


def needles(mesh, share):
    """Each triangle cut into three by a point ``share`` of the way from its first edge to the third corner."""
    corners = mesh.points[mesh.triangles]
    weights = np.array([0.5 * (1 - share), 0.5 * (1 - share), share])
    inner = (corners * weights[:, None]).sum(1)
    number = len(mesh.points) + np.arange(len(inner))
    a, b, c = mesh.triangles.T
    triangles = np.concatenate([np.stack(t, 1) for t in ((a, b, number), (b, c, number), (c, a, number))])
    uv = mesh.uvs["st"]
    u, v, w = np.moveaxis(uv, 1, 0)
    inner_uv = (uv * weights[:, None]).sum(1)
    st = np.concatenate([np.stack(t, 1) for t in ((u, v, inner_uv), (v, w, inner_uv), (w, u, inner_uv))])
    return Mesh(mesh.path, np.concatenate([mesh.points, inner]), triangles, None, {"st": st})


@pytest.mark.parametrize("share", [0.3, 1e-3, 1e-6])
def test_needles_look_like_the_triangles_they_cut(share):
    ball = scenes.sphere(8, 16, smooth=False)
    for distribution in ("linear", "concentric"):
        material = scenes.scratched(ROUGH, distribution=distribution, **SIZES)
        cut, whole = look(needles(ball, share), material), look(ball, material)
        # a sample at the edge of a scratch may change sides: an eighth of its pixel
        same(cut, whole, rtol=2e-2, share=0.99)
        assert cut["color"].mean() == pytest.approx(whole["color"].mean(), rel=0.01)


def test_coincident_surfaces_look_like_one():
    """Neither casts a shadow on the other, whatever order they are met in."""
    floor = scenes.plane(3.0)
    tilt = np.array([[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]])
    turned = [scenes.place(at=(0, 0, -6), linear=tilt, path=path) for path in ("/a", "/b")]
    one = look(floor, placed=turned[:1])
    two = look(floor, placed=turned)
    same(two, one, share=0.99)
    # a twin that faces the other way is its back
    back = replace(floor, triangles=floor.triangles[:, ::-1], uvs={"st": floor.uvs["st"][:, ::-1]})
    world = scenes.scene([floor, back], [scenes.scratched(ROUGH, **SIZES)], [lamp(), scenes.dome(0.2)], [
        turned[0], replace(turned[1], mesh=1)])  # fmt: skip
    both = finite(scenes.shoot(world, **SMALL))
    assert both["color"].mean() == pytest.approx(one["color"].mean(), rel=0.05)


LINEAR = {
    "mirrored": np.diag([-1.0, 1, 1]),
    "turned inside out": -np.eye(3),
    "sheared": np.array([[1, 0.7, 0], [0, 1, 0.3], [0, 0, 1.0]]),
    "mirrored and sheared": np.array([[1, 0.7, 0], [0, -1, 0.3], [0.2, 0, 1.0]]),
    "flattened": np.diag([1.0, 1e-6, 1]),
    "stretched": np.diag([1e3, 1.0, 1]),
}


@pytest.mark.parametrize("name", LINEAR)
def test_placed_is_as_if_modelled_so(name):
    """The transform of an instance, or the same done to its points: outside stays outside."""
    m = LINEAR[name]
    ball = scenes.sphere(12, 24, smooth=False)
    flip = np.linalg.det(m) < 0.0
    triangles, st = (x[:, ::-1] if flip else x for x in (ball.triangles, ball.uvs["st"]))
    modelled = Mesh("/ball", ball.points @ m.T, triangles, None, {"st": st})
    material = scenes.scratched(ROUGH, distribution="worley", space="uv", width=0.02, depth=0.01, length=0.2)
    placed = look(ball, material, placed=[scenes.place(at=(0, 0, -6), linear=m)])
    baked = look(modelled, material)
    # an image within noise: mirrored triangles begin at another corner, so that other samples are drawn
    share = 0.97 if not flip else 0.0
    near = np.isclose(placed["color"], baked["color"], rtol=1e-2, atol=1e-4).all(-1)
    assert near.mean() >= share
    assert placed["color"].mean() == pytest.approx(baked["color"].mean(), rel=0.03)
    np.testing.assert_array_equal(placed["alpha"] > 0, baked["alpha"] > 0)


TURNS = {
    "pole ahead": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "other pole ahead": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
    "seam ahead": np.eye(3),
}


@pytest.mark.parametrize("turn", TURNS)
def test_poles_and_seams_of_a_mapping_neither_shine_nor_are_dark(turn):
    """Mirror scratches of every kind about a point where dP/du is 0, under a sky of 1."""
    cut = Profile(path="/mat/profile", shape="round")
    layers = [
        scenes.scratched(distribution=kind, space=space, width=0.03 * unit, depth=0.01 * unit, pitch=0.1 * unit,
                         length=0.5 * unit, profile=cut, center=(0.5, 0.0))
        for kind in ("worley", "linear", "concentric", "spiral", "crosshatch")
        for space, unit in (("uv", 1.0), ("surface", 1e6))
    ]  # fmt: skip
    ball = scenes.slotted(scenes.sphere(16, 32), len(layers))
    placed = replace(scenes.place(at=(0, 0, -3), linear=TURNS[turn]), materials=tuple(range(len(layers))))
    film = finite(scenes.shoot(scenes.scene([ball], layers, [scenes.dome()], [placed]), **SMALL))
    assert film["scratches"][film["primId"] == 0].mean() > 0.05
    assert np.abs(film["color"] - 1.0).max() < 1e-3


SHADING = {
    "away": lambda n: -n,
    "sideways": lambda n: n[..., [1, 2, 0]],
    "none": lambda n: n * 0.0,
    "tiny": lambda n: n * 1e-30,
    "huge": lambda n: n * 1e30,
}


@pytest.mark.parametrize("name", SHADING)
def test_normals_that_face_elsewhere(name):
    """Shading normals that look away from the viewer, lie in the surface, or have no length."""
    ball = scenes.sphere(12, 24)
    bent = replace(ball, normals=SHADING[name](ball.normals))
    for material in (scenes.scratched(scenes.white_metal(), **SIZES), Material("/mat", scenes.lambert())):
        film = look(bent, material, [scenes.dome()])
        noise = np.sqrt(film["variance"].sum()) / film["variance"].size
        assert film["color"].mean() <= 1.0 + 1e-3 + 5 * noise
    look(bent)


LIT = {
    "sun on the horizon": DistantLight(path="/l", radiance=(2, 2, 2), direction=(0, -1, 0), angle=0.01),
    "sun just below": DistantLight(path="/l", radiance=(2, 2, 2), direction=(0, -1, -1e-7), angle=0.0),
    "lamp around everything": SphereLight(path="/l", radiance=(1, 1, 1), center=(0, 0, -6), radius=100.0),
    "lamp inside": SphereLight(path="/l", radiance=(1, 1, 1), center=(0, 0, -6), radius=0.5),
    "lamp of 1e6": SphereLight(path="/l", radiance=(1, 1, 1), center=(0, 1e6 + 3, -6), radius=1e6),
    "lamp of 1e-12": SphereLight(path="/l", radiance=(1, 1, 1), center=(0, 2, -5), radius=1e-12),
    "panel of 1e9": lamp(center=(0, 3, 0), ex=(1e9, 0, 0), ey=(0, 0, 1e9), normal=(0, -1, 0)),
    "panel of 1e-9": lamp(ex=(1e-9, 0, 0), ey=(0, 1e-9, 0), normal=(0, 0, -1)),
    "panel through it": lamp(center=(0, 0, -6), ex=(3, 0, 0), ey=(0, 3, 0), normal=(0, 0, 1)),
}


@pytest.mark.parametrize("name", LIT)
def test_no_more_light_than_a_sky_of_it(name):
    """Under a light of radiance L that may fill all directions nothing is brighter than L; none below the horizon is
    seen."""
    light = LIT[name]
    for material in (scenes.scratched(scenes.white_metal(0.2), **SIZES), Material("/mat", scenes.lambert())):
        film = look(scenes.sphere(12, 24, smooth=False), material, [light], spp=16)
        surface = film["color"] - film["emission"]
        most = np.max(light.radiance)
        inside = film["primId"] == 0
        if not isinstance(light, DistantLight) and inside.any():
            assert surface[inside].mean() <= most * (1.0 + 0.02)
        if name in ("lamp of 1e-12", "panel of 1e-9", "lamp inside"):
            assert surface[inside].max(initial=0.0) < 1e-3
