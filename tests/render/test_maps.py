"""Masks and orientations from textures and primvars, near and far.

Mirror V grooves seen from straight above throw the light to both sides by 2 a, a = atan(2 depth / width). Under a sky
of cos^2 of the longitude, z^2 / (x^2 + z^2), grooves at an angle t from +x then show c^2 / (c^2 + (s sin t)^2) with
c = cos 2 a, s = sin 2 a: from 1 along x to c^2 along y.
"""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.scene import PreviewSurface, Texture, TextureInput

from . import scenes
from .test_variation import sky

BLACK = PreviewSurface(diffuse_color=(0.0, 0.0, 0.0), ior=1.0)
RATIO = 0.25


def shown(angle):
    """What grooves at ``angle`` [rad] from +x show of the sky."""
    c, s = np.cos(2 * np.arctan(2 * RATIO)), np.sin(2 * np.arctan(2 * RATIO))
    return c**2 / (c**2 + (s * np.sin(angle)) ** 2)


def image(values):
    """A map of one channel, or two, per texel."""
    values = np.asarray(values, np.float32)
    values = values[..., None] if values.ndim == 2 else values
    pixels = np.zeros((*values.shape[:2], 4), np.float32)
    pixels[..., : values.shape[-1]] = values
    return Texture("/map", pixels)


def shoot(mesh=None, map_=None, focal=260.0, light=None, linear=None, **fields):
    """A plane of 2 m whose middle 46 cm (focal 260) or 12 cm (1000) fill the image."""
    sun, textures = sky()
    fields = {"width": 40.0, "length": 4000.0, "coverage": 0.5, **fields}
    fields = {"depth": RATIO * fields["width"], "pitch": 2 * fields["width"], **fields}
    material = scenes.scratched(BLACK, **fields)
    placed = [scenes.place(at=(0, 0, -6), linear=linear)]
    textures = (*textures, map_) if map_ is not None else textures
    camera = scenes.camera(focal=focal)
    world = scenes.scene([mesh or scenes.plane()], [material], [light or sun], placed, camera, textures=textures)
    return scenes.shoot(world)


def ratio(**fields):
    """Light over covered share; 4 cm of the plane unless said otherwise, all views within 0.2 degrees."""
    fields = {"focal": 3000.0, **fields}
    return shoot(**fields)["color"].mean(dtype=float) / shoot(light=scenes.dome(), **fields)["color"].mean(dtype=float)


def with_primvar(values, interpolation="vertex"):
    """The plane with a primvar "along" at its corners: given for 4 vertices, 2 faces, or 6 corners."""
    mesh, values = scenes.plane(), np.asarray(values, float)
    values = values.reshape(len(values), -1)
    corners = {
        "vertex": lambda: values[mesh.triangles],
        "uniform": lambda: np.repeat(values[:, None], 3, axis=1),
        "faceVarying": lambda: values.reshape(2, 3, -1),
    }
    return replace(mesh, primvars={"along": corners[interpolation]()})


def test_masks_multiply_coverage():
    """Coverage 0.5 of unresolved scratches to 1.5e-3, the mask in 8 x 8 texels of 25 cm or one in 200 of 1 cm."""
    dome = scenes.dome()
    for size in (8, 200):
        board = image(np.indices((size, size)).sum(0) % 2)
        film = shoot(map_=board, light=dome, mask_texture=1)
        assert film["color"].mean() == pytest.approx(0.25, abs=0.02)
        if size == 8:
            # texels are some 17 pixels wide: in the middle of them the mask is what it is
            assert film["color"].min() < 0.06 and film["color"].max() > 0.44
    for mesh in (
        with_primvar([[0.2], [0.2], [0.6], [0.6]]),
        with_primvar([[0.4], [0.4]], "uniform"),
        with_primvar([[0.2], [0.2], [0.6], [0.2], [0.6], [0.6]], "faceVarying"),
    ):
        film = shoot(mesh=mesh, light=dome, mask_primvar="along")
        assert film["color"].mean() == pytest.approx(0.2, abs=3e-3)
    # a ramp runs up the image
    film = shoot(mesh=with_primvar([[0.0], [0.0], [1.0], [1.0]]), light=dome, mask_primvar="along")
    rows = film["color"][..., 0].mean(1)
    assert np.corrcoef(rows, np.arange(32))[0, 1] < -0.99


@pytest.mark.parametrize("angle", [0.0, 0.6, np.pi / 2, 2.5])
def test_one_direction_by_every_map(angle):
    """5e-3: bins of 0.7 degrees and noise. The angle of the layer adds to the map's."""
    vector = np.array([np.cos(angle), np.sin(angle)])
    expected = shown(angle)
    assert ratio(angle=angle) == pytest.approx(expected, abs=5e-3)
    found = [
        ratio(map_=image(np.full((4, 4), angle / np.pi)), orientation_texture=1, orientation_encoding="angle"),
        ratio(map_=image(np.broadcast_to(0.5 + 0.5 * vector, (4, 4, 2))), orientation_texture=1, distribution="linear"),
        ratio(map_=image(np.full((4, 4), 0.25)), orientation_texture=1, orientation_encoding="angle",
              angle=angle - np.pi / 4, coverage=1.0),
        ratio(mesh=with_primvar(np.tile([*vector, 0.3], (4, 1))), orientation_primvar="along"),
        ratio(mesh=with_primvar(np.tile(-vector, (2, 1)), "uniform"), orientation_primvar="along"),
        ratio(mesh=with_primvar(np.full((6, 1), np.degrees(angle)), "faceVarying"), orientation_primvar="along"),
    ]  # fmt: skip
    assert found == pytest.approx([expected] * 6, abs=5e-3)


def test_directions_turn_with_their_instance():
    """A vector along x on a plane that is turned by 90 degrees about z, and on one that is mirrored at x = y."""
    mesh = with_primvar(np.tile([1.0, 0.0, 0.0], (4, 1)))
    for linear in ([[0, -1, 0], [1, 0, 0], [0, 0, 1]], [[0, 1, 0], [1, 0, 0], [0, 0, -1]]):
        found = ratio(mesh=mesh, orientation_primvar="along", linear=np.array(linear, float))
        assert found == pytest.approx(shown(np.pi / 2), abs=5e-3)


def test_far_directions_spread_as_near_ones_do():
    """Texels of 1 mm under pixels of 14 mm: 178 and 2 degrees average to 0; a normal spread of 20 degrees keeps the
    mean of what its directions show, which a single mean direction does not."""
    rng = np.random.default_rng(3)
    board = np.where(np.indices((256, 256)).sum(0) % 2 == 0, 178.0, 2.0) / 180
    assert ratio(map_=image(board), orientation_texture=1, orientation_encoding="angle", focal=260.0) == pytest.approx(
        shown(np.radians(2)), abs=6e-3
    )
    angles = rng.normal(0.0, np.radians(20), (1024, 1024))
    found = ratio(map_=image(angles / np.pi % 1.0), orientation_texture=1, orientation_encoding="angle", focal=260.0)
    assert found == pytest.approx(shown(angles).mean(), abs=8e-3)
    assert abs(shown(angles).mean() - shown(0.0)) > 0.03


def test_mapped_scratches_cover_what_others_do():
    """Scratches of 1 cm on pixels of 2 mm, turning by 180 degrees over the plane: bins shade into one another."""
    u = (np.arange(64) + 0.5) / 64
    turning = image(np.broadcast_to(u, (64, 64)))
    fields = {"width": 4000.0, "length": 40000.0, "light": scenes.dome(), "focal": 600.0}
    found = [
        shoot(map_=turning, orientation_texture=1, orientation_encoding="angle", seed=seed, **fields)["color"].mean()
        for seed in range(4)
    ]
    assert np.mean(found) == pytest.approx(0.5, abs=0.04)


def test_the_plan_compiles_maps_where_there_are_any():
    plain = scenes.scene([scenes.plane()], [scenes.scratched(BLACK)], [scenes.dome()])
    plan = sw.make_plan(plain)
    assert not plan.on("scratches.masks") and not plan.on("scratches.orientation")
    mapped = scenes.scratched(BLACK, mask_primvar="wear", orientation_texture=0)
    plan = sw.make_plan(replace(plain, materials=(mapped,), textures=(image([[0.5]]),)))
    assert plan.on("scratches.masks") and plan.on("scratches.orientation")
    rings = scenes.scratched(BLACK, distribution="concentric", orientation_texture=0)
    assert not sw.make_plan(replace(plain, materials=(rings,), textures=(image([[0.5]]),))).on("scratches.orientation")
    with pytest.raises(ValueError, match="texture 3 is not one of 0"):
        replace(plain, materials=(scenes.scratched(BLACK, mask_texture=3),))


@pytest.mark.parametrize("depth", [0.1, 0.3])
@pytest.mark.parametrize("workflow", [False, True])
def test_scratches_of_a_textured_base_have_its_local_colour(depth, workflow):
    """Left half copper, right half grey: each half as on a base of that one colour, within 1 % where light meets the
    walls once near their normals (aspect 0.1; single reflections up to aspect 0.29), 5 % at 0.3."""
    colors = np.array([[0.95, 0.6, 0.5], [0.3, 0.35, 0.4]])
    pixels = np.ones((1, 2, 4), np.float32)
    pixels[0, :, :3] = colors

    def base(color):
        if workflow:
            return PreviewSurface(diffuse_color=(0, 0, 0), specular_color=color, use_specular_workflow=True)
        return PreviewSurface(diffuse_color=color, metallic=1.0)

    def world(color, textures=()):
        fields = {"width": 50.0, "depth": 50.0 * depth, "coverage": 1.0, "fresnel": "exact"}
        material = scenes.scratched(base(color), **fields)
        placed = [scenes.place(at=(0, 0, -6))]
        camera = scenes.camera(15.0)
        return scenes.scene([scenes.plane()], [material], [scenes.dome()], placed, camera, textures=textures)

    read = TextureInput(texture=0, wrap_s="clamp", wrap_t="clamp")
    textured = world(read, (Texture("/two", pixels),))
    plan = sw.make_plan(textured)
    assert plan.on("scratches.textured") and not any("mean of" in w for w in plan.warnings)
    film = scenes.shoot(textured)["color"]
    # texture centres are a quarter in: the outer quarters have one colour
    for half, color in ((film[:, :8], colors[0]), (film[:, -8:], colors[1])):
        alone = scenes.shoot(world(tuple(color.tolist())))["color"][:, :8]
        assert half.mean((0, 1)) == pytest.approx(alone.mean((0, 1)), rel=0.01 if depth < 0.2 else 0.05)
    assert film.max() < 1.0


def test_lacquered_wood_shows_its_grain_through_its_scratches():
    """Scratches in a clear coat over a textured diffuse base: the diffuse part is the base's own where it is, and all
    in all no more light leaves than arrives."""
    grain = np.ones((1, 2, 4), np.float32)
    grain[0, :, :3] = [[0.6, 0.3, 0.1], [0.2, 0.1, 0.05]]
    wood = PreviewSurface(diffuse_color=TextureInput(texture=0, wrap_s="clamp"), roughness=0.2)
    material = scenes.scratched(wood, coverage=1.0, fresnel="exact", depth=10.0)
    placed = [scenes.place(at=(0, 0, -6))]
    world = scenes.scene(
        [scenes.plane()], [material], [scenes.dome()], placed, scenes.camera(15.0), textures=(Texture("/w", grain),)
    )
    film = scenes.shoot(world)["color"]
    left, right = film[:, :8].mean((0, 1)), film[:, -8:].mean((0, 1))
    # what both reflect alike is the coat's; the rest is in proportion to the albedo, within its coupling to the coat
    coat = (left * grain[0, 1, :3] - right * grain[0, 0, :3]) / (grain[0, 1, :3] - grain[0, 0, :3])
    assert (coat > 0.03).all() and (coat < 0.09).all() and np.ptp(coat) < 0.02
    white = replace(wood, diffuse_color=(1.0, 1.0, 1.0))
    lossless = replace(world, materials=(replace(material, surface=white),), textures=())
    assert scenes.shoot(lossless)["color"].mean() < 1.003  # noise of 16384 samples
