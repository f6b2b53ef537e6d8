"""Degenerate scenes give finite images with no sample left out, and the right ones where that is known."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.render.develop import metadata
from scratchwarp.scene import (
    CylinderLight,
    DiskLight,
    DistantLight,
    DomeLight,
    Instance,
    Material,
    Mesh,
    MeshLight,
    PreviewSurface,
    RectLight,
    ScratchSurface,
    Shaping,
    SphereLight,
    Texture,
    TextureInput,
)

from . import scenes

LAMP = RectLight(
    path="/lamp", radiance=(9, 7, 5), center=(2, 2, -3), ex=(0.5, 0, -0.5), ey=(0, 0.7, 0), normal=(-0.8, 0, -0.6)
)
POINT = SphereLight(path="/point", radiance=(5, 5, 5), center=(1, 1, -3), radius=0.0, point=True)
SUN = DistantLight(path="/sun", radiance=(2, 2, 2), direction=(0.3, -0.6, -0.74))
LIGHTS = [LAMP, POINT, SUN, scenes.dome(0.3)]
ROUGH = PreviewSurface(diffuse_color=(0.6, 0.4, 0.3), roughness=0.3, clearcoat=1.0)
LAYERED = scenes.scratched(ROUGH, width=3e4, depth=1e4, length=3e5, fresnel="exact")


def finite(world, **settings):
    film = scenes.shoot(world, **{"width": 12, "height": 12, "spp": 8, **settings})
    assert film.stats["invalid_samples"] == 0
    for name in film:
        bad = ~np.isfinite(film[name])
        if name == "depth":
            bad &= ~(np.isposinf(film["depth"]) & (film["primId"] == -1))
        assert not bad.any(), f"{name} at {np.argwhere(bad)[:3].tolist()}"
    assert (film["color"] >= 0.0).all()
    return film


def at(mesh, where=(0, 0, -6), material=LAYERED, lights=LIGHTS, cam=None, **fields):
    return scenes.scene([mesh], [material], lights, [scenes.place(0, 0, where)], cam, **fields)


@pytest.mark.parametrize("lit", [False, True])
def test_nothing_at_all(lit):
    film = finite(scenes.scene([], [], [scenes.dome(0.3)] if lit else [], []))
    assert (film["primId"] == -1).all() and film["alpha"].max() == 0
    np.testing.assert_allclose(film["color"], 0.3 if lit else 0.0, rtol=1e-5)


def test_a_mesh_without_faces():
    empty = Mesh(path="/empty", points=np.zeros((0, 3)), triangles=np.zeros((0, 3), int))
    world = scenes.scene([empty, scenes.sphere()], [LAYERED], LIGHTS)
    film, alone = finite(world), finite(scenes.scene([scenes.sphere()], [LAYERED], LIGHTS))
    np.testing.assert_array_equal(film["color"], alone["color"])
    finite(scenes.scene([empty], [LAYERED], LIGHTS))


def test_no_light():
    film = finite(at(scenes.sphere(), lights=[]))
    assert film["color"].max() == 0.0 and (film["primId"] == 0).any()


def test_faces_without_area():
    ball = scenes.sphere()
    thin = np.array([[0, 0, 0], [5, 5, 5], [7, 8, 8], [9, 10, 9]])
    st = np.concatenate([ball.uvs["st"], np.zeros((4, 3, 2))])
    normals = np.concatenate([ball.normals, np.zeros((4, 3, 3))])
    worse = Mesh("/ball", ball.points, np.concatenate([ball.triangles, thin]), normals, {"st": st})
    film, plain = finite(at(worse)), finite(at(ball))
    np.testing.assert_allclose(film["color"], plain["color"], rtol=1e-5)
    # collinear, not just repeated, points; and nothing else
    line = Mesh("/line", [[-1, 0, 0], [0, 0, 0], [1, 0, 0]], [[0, 1, 2]])
    finite(at(line))
    finite(at(Mesh("/dot", [[0, 0, 0]] * 3, [[0, 1, 2]])))


@pytest.mark.parametrize("scale", [(0, 0, 0), (1, 1, 0), (1e-9, 1, 1), (1e-12,) * 3, (1e7,) * 3])
def test_squashed_instances(scale):
    world = at(scenes.sphere())
    m = np.diag([*map(float, scale), 1.0])
    m[2, 3] = -6.0
    finite(replace(world, instances=(Instance("/placed", 0, m, (0,)),)))


@pytest.mark.parametrize("size", [1e-6, 1e-3, 1e3, 1e6])
def test_scenes_of_any_size(size):
    """The furnace: a lossless ball of any size vanishes."""
    materials = [scenes.scratched(width=50.0 * size, depth=25.0 * size, length=5000.0 * size)]
    world = scenes.scene([scenes.sphere(radius=size)], materials, [scenes.dome()], [scenes.place(at=(0, 0, -6 * size))])
    film = finite(world)
    assert (film["primId"] == 0).sum() > 40
    np.testing.assert_allclose(film["color"], 1.0, atol=1e-3)


def test_camera_inside():
    """From inside a closed white ball no sky is seen, and a lamp inside lights it."""
    inside = at(scenes.sphere(radius=2.0), where=(0, 0, 0), lights=[scenes.dome()])
    assert finite(inside)["color"].max() < 1e-6
    bulb = SphereLight(path="/bulb", radiance=(5, 5, 5), center=(0.5, 0.5, -0.5), radius=0.2)
    assert finite(replace(inside, lights=(bulb,)))["color"].min() > 1e-3
    # the eye on the surface, and within a light
    finite(at(scenes.sphere(), where=(0, 0, -1)))
    around = SphereLight(path="/around", radiance=(5, 5, 5), center=(0, 0, 0), radius=1.0)
    finite(at(scenes.sphere(), lights=[around]))


@pytest.mark.parametrize("height", [1e-1, 1e-4, 1e-6, 0.0])
def test_grazing_views(height):
    world = at(scenes.plane(100.0, axis="y"), where=(0, -height, 0))
    film = finite(world)
    assert height == 0.0 or (film["primId"] == 0).any()
    # lit at grazing incidence, and from below
    low = DistantLight(path="/low", radiance=(2, 2, 2), direction=(1, -1e-6, 0))
    below = DistantLight(path="/below", radiance=(2, 2, 2), direction=(0.5, 0.5, 0), angle=0.1)
    finite(replace(world, lights=(low, below)))


TOUCHING = {
    "sphere on": SphereLight(path="/l", radiance=(5, 5, 5), center=(0, 0, -5.5), radius=0.5),
    "sphere through": SphereLight(path="/l", radiance=(5, 5, 5), center=(0, 0, -6), radius=0.5),
    "point on": SphereLight(path="/l", radiance=(5, 5, 5), center=(0.01, 0.02, -6), radius=0.0, point=True),
    "rect on": RectLight(
        path="/l", radiance=(5, 5, 5), center=(0, 0, -6), ex=(0.5, 0, 0), ey=(0, 0.5, 0), normal=(0, 0, -1)
    ),
    "rect standing": RectLight(
        path="/l", radiance=(5, 5, 5), center=(0, 0, -5.5), ex=(0.5, 0, 0), ey=(0, 0, 0.5), normal=(0, 1, 0)
    ),
    "disk on": DiskLight(
        path="/l", radiance=(5, 5, 5), center=(0, 0, -6), ex=(0.5, 0, 0), ey=(0, 0.5, 0), normal=(0, 0, 1)
    ),
    "cylinder on": CylinderLight(path="/l", radiance=(5, 5, 5), center=(0, 0, -5.8), axis=(0.5, 0, 0), radius=0.2),
    "cylinder through": CylinderLight(path="/l", radiance=(5, 5, 5), center=(0, 0, -6), axis=(0, 0, 1), radius=0.2),
    "no size": RectLight(
        path="/l", radiance=(5, 5, 5), center=(0, 0, -5), ex=(0, 0, 0), ey=(0, 0, 0), normal=(0, 0, -1)
    ),
    "needle": CylinderLight(path="/l", radiance=(5, 5, 5), center=(0, 0, -5), axis=(0.5, 0, 0), radius=1e-7),
    "all around": DistantLight(path="/l", radiance=(5, 5, 5), direction=(0, 0, -1), angle=2 * np.pi),
    "spot of no angle": replace(POINT, shaping=Shaping(cone_angle=0.0, cone_softness=1.0, focus=50.0)),
    "very bright": replace(LAMP, radiance=np.full(3, 1e10)),
}


@pytest.mark.parametrize("name", TOUCHING)
def test_lights_that_touch(name):
    layered = scenes.scratched(ROUGH, distribution="concentric", width=3e4, pitch=5e4, depth=1e4)
    for material in (layered, Material("/metal", ScratchSurface(roughness=0.02))):
        finite(at(scenes.plane(), material=material, lights=[TOUCHING[name]]))


def test_a_light_that_is_what_it_lights():
    world = at(scenes.sphere(), lights=[MeshLight(path="/l", radiance=(2, 2, 2), instance=0)])
    glowing = replace(world, instances=(replace(world.instances[0], light=0),))
    film = finite(glowing)
    assert film["color"].max() >= 2.0 - 1e-5
    empty = Mesh(path="/empty", points=np.zeros((0, 3)), triangles=np.zeros((0, 3), int))
    nothing = replace(glowing, meshes=(empty,))
    assert finite(nothing)["color"].max() == 0.0


UVS = {
    "one point": lambda st: st * 0 + 0.5,
    "a line": lambda st: st * (1, 0),
    "tiny": lambda st: st * 1e-12,
    "huge": lambda st: st * 1e9,
    "far away": lambda st: st + 1e7,
}


@pytest.mark.parametrize("name", UVS)
@pytest.mark.parametrize("distribution", ["worley", "spiral", "crosshatch"])
def test_degenerate_mappings(name, distribution):
    ball = scenes.sphere()
    for space in ("surface", "uv"):
        size = {"width": 300.0, "depth": 100.0, "length": 9000.0, "pitch": 900.0}
        if space == "uv":
            size = {k: v * 1e-6 for k, v in size.items()}
        material = scenes.scratched(ROUGH, distribution=distribution, space=space, **size)
        finite(at(replace(ball, uvs={"st": UVS[name](ball.uvs["st"])}), material=material))


def test_normal_maps_without_tangents():
    """Without uvs, on degenerate ones, and with texels that are no direction."""
    pixels = np.random.default_rng(1).random((8, 8, 4)).astype(np.float32)
    pixels[0, 0] = pixels[3, 5] = 0.5  # the zero vector
    read = TextureInput(texture=0, scale=(2, 2, 2, 1), bias=(-1, -1, -1, 0))
    surface = PreviewSurface(diffuse_color=(0.5, 0.5, 0.5), roughness=0.2, normal=read)
    ball = scenes.sphere()
    for uvs in ({}, {"st": ball.uvs["st"] * 0}, ball.uvs):
        mesh = replace(ball, uvs=uvs)
        for material in (Material("/bumpy", surface), scenes.scratched(surface, width=3e4, depth=1e4, length=3e5)):
            finite(at(mesh, material=material, textures=(Texture("/map", pixels),)))


LAYERS = {
    "no width": {"width": 0.0},
    "no depth": {"depth": 0.0},
    "no length": {"length": 0.0},
    "no density": {"density": 0.0, "coverage": 0.0},
    "density 1e9": {"density": 1e9},
    "density 1e-9": {"density": 1e-9},
    "deep": {"depth": 50000.0},
    "wide": {"width": 1e9, "depth": 1e8},
    "thin": {"width": 1e-6, "depth": 1e-6},
    "long": {"length": 1e12},
    "curled": {"curvature": 1e4},
    "no pitch": {"distribution": "linear", "pitch": 0.0},
    "fine pitch": {"distribution": "linear", "pitch": 1e-6, "width": 1e-7, "depth": 1e-8},
    "fine rings": {"distribution": "concentric", "pitch": 1e-6, "width": 1e-7, "depth": 1e-8},
    "wound tight": {"distribution": "spiral", "pitch": 1e-6, "width": 1e-7, "depth": 1e-8},
    "wider than pitch": {"distribution": "crosshatch", "pitch": 10.0, "width": 100.0},
    "vacuum": {"material": "dielectric", "ior": 1.0, "fresnel": "exact"},
}


@pytest.mark.parametrize("name", LAYERS)
def test_extreme_layers(name):
    material = scenes.scratched(ROUGH, **LAYERS[name])
    film = finite(at(scenes.sphere(), material=material))
    hidden = name in ("no width", "no density", "no pitch")
    assert (film["scratches"].max() == 0.0) if hidden else True
    if name == "density 1e9":
        # nothing of the base is left
        assert film["base"][film["primId"] == 0].max() < 1e-6 or film["base"].mean() < 0.01 * film["scratches"].mean()


def test_a_metal_without_index_names_its_layer():
    nothing = {"material": "conductor", "metal": "custom", "eta": (0, 0, 0), "k": (0, 0, 0), "fresnel": "exact"}
    with pytest.raises(ValueError, match=r"/mat layer 'fine': eta and k must not both be 0"):
        finite(at(scenes.sphere(), material=scenes.scratched(ROUGH, **nothing)))


SURFACES = {
    "smooth": PreviewSurface(diffuse_color=(1, 1, 1), roughness=0.0, ior=1.5),
    "ior 0": PreviewSurface(ior=0.0),
    "ior 1": PreviewSurface(ior=1.0, roughness=0.0),
    "ior 100": PreviewSurface(ior=100.0),
    "coat": PreviewSurface(clearcoat=1.0, clearcoat_roughness=0.0, roughness=0.0, metallic=1.0),
    "beyond range": PreviewSurface(diffuse_color=(-3, 7, 1), metallic=5.0, roughness=-2.0, clearcoat=9.0, opacity=4.0),
    "thinnest": ScratchSurface(roughness=1e-5),
    "one-sided": ScratchSurface(roughness=0.5, anisotropy=1.0),
    "no index": ScratchSurface(metal="custom", eta=(0, 0, 0), k=(0, 0, 0)),
    "vacuum": ScratchSurface(base="dielectric", ior=0.0),
    "glowing": PreviewSurface(emissive_color=(1e6, 0, 0)),
    "absent": PreviewSurface(opacity=0.0, opacity_mode="presence"),
    "glass": PreviewSurface(opacity=0.0, roughness=0.0),
}


@pytest.mark.parametrize("name", SURFACES)
def test_extreme_surfaces(name):
    for material in (
        Material("/mat", SURFACES[name]),
        scenes.scratched(SURFACES[name], width=3e4, depth=1e4, length=3e5),
    ):
        finite(at(scenes.sphere(), material=material))
        finite(at(scenes.sphere(), material=material), integrator="path", max_depth=5)


def test_a_black_and_a_single_texel_dome():
    for pixels in (np.zeros((4, 8, 4)), np.eye(32)[:, :, None] * [1e4, 1e4, 1e4, 1], np.ones((1, 1, 4))):
        sky = DomeLight(path="/sky", radiance=(1, 1, 1), texture=0)
        finite(at(scenes.sphere(), lights=[sky], textures=(Texture("/sky", pixels),)))


def test_lens_and_clipping():
    for fields in (
        {"lens_radius": 1.0, "focus_distance": 1e-3},
        {"lens_radius": 1e-3, "focus_distance": 1e9},
        {"near": 5.5, "far": 5.6},
        {"near": 10.0, "far": 20.0},
        {"focal": 1e-3},
        {"focal": 1e6},
        {"exposure": 0.0},
    ):
        finite(at(scenes.sphere(), cam=scenes.camera(**fields)))


def test_one_pixel():
    film = finite(at(scenes.sphere()), width=1, height=1, spp=1, filter_width=0.0)
    assert film["color"].shape == (1, 1, 3)
    assert sw.make_plan(at(scenes.sphere()), sw.Settings(width=3)).size == (3, 3)


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize(
    ("near", "far"), [(0.0, np.inf), (1e-7, 1e-3), (1.0, 1.0), (5.0, 2.0), (0.0, 0.0), (3e38, 3e38), (1e-30, 1e-20)]
)
def test_headers_of_any_clipping_distances(projection, near, far):
    """The matrix of a header exists and can be inverted; what lies at the near plane has depth -1, at the far one 1."""
    cam = replace(scenes.camera(), near=near, far=far, projection=projection)
    world = at(scenes.sphere(), cam=cam)
    matrix = np.reshape(metadata(world, sw.make_plan(world), "", 0.0, 0.0)["worldToNDC"], (4, 4))
    assert np.isfinite(matrix).all()
    if 0.0 < near < far < 1e9:
        ends = np.array([[0, 0, -near, 1], [0, 0, -far, 1]]) @ matrix
        np.testing.assert_allclose(ends[:, 2] / ends[:, 3], [-1.0, 1.0], rtol=1e-6)
