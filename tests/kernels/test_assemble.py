"""What a plan's kernel is specialised by, and the arrays it is given."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.kernels import KernelKey, assemble, kernel_key
from scratchwarp.scene import DistantLight, Material, MeshLight, RenderOptions, SphereLight

from ..render import scenes as S

WHITE = np.ones(3)


def sun(**fields):
    return DistantLight(path="/sun", radiance=WHITE, direction=np.array([0.0, 0.0, -1.0]), **fields)


def lamp(**fields):
    return SphereLight(path="/lamp", radiance=WHITE, center=np.array([0.0, 3.0, 0.0]), radius=0.1, **fields)


def world(lights, cam=None, **fields):
    instances = [S.place(0, at=(0, 0, -6)), S.place(1, at=(0, -1, -6))]
    return S.scene([S.sphere(8, 16), S.plane()], [Material("/mat")], lights, instances, cam, **fields)


def assembled(scene, **settings):
    return assemble(scene, sw.make_plan(scene, sw.Settings(**settings)), [])


def test_a_plain_scene_has_the_plainest_key():
    scene = S.scene([S.sphere(8, 16)], [Material("/mat")], [S.dome()])
    key = kernel_key(scene, sw.make_plan(scene))
    assert key == KernelKey(lights=("dome",), filter="blackmanHarris", preview=True)
    assert not key.scratches


@pytest.mark.parametrize(
    ("field", "effects"),
    [
        ("shadows", {"shadows": True}),
        ("lens", {"lens": True}),
        ("path", {"indirect": True}),
        ("light_links", {"lights.links": True}),
        ("directed", {"base.direction": True}),
    ],
)
def test_an_effect_changes_its_own_field_alone(field, effects):
    scene = S.scene([S.sphere(8, 16)], [Material("/mat")], [S.dome()])
    before, after = (kernel_key(scene, sw.make_plan(scene, sw.Settings(effects=e))) for e in ({}, effects))
    changed = {name for name in vars(before) if getattr(before, name) != getattr(after, name)}
    assert changed == {field}


def test_scratches_off_leaves_no_scratch_code():
    scene = S.scene([S.sphere(8, 16)], [S.scratched()], [S.dome()])
    assert kernel_key(scene, sw.make_plan(scene)).distributions == ("worley",)
    off = sw.make_plan(scene, sw.Settings(effects={"scratches": False}))
    assert kernel_key(scene, off).distributions == ()


def test_lights_stand_sorted_by_kind():
    built = assembled(world([lamp(), sun(), S.dome(), lamp()]))
    assert built.key.lights == ("distant", "sphere", "dome")
    *_, lights = built.inputs
    assert lights.starts.numpy().tolist() == [0, 1, 3, 4]
    # each knows its place in the scene: the sun was second, the lamps first and last
    assert lights.lights.numpy()["index"].tolist() == [1, 0, 3, 2]


def test_a_kind_that_is_off_has_no_rows():
    built = assembled(world([lamp(), sun()]), effects={"lights.sphere": False})
    *_, lights = built.inputs
    assert built.key.lights == ("distant",) and lights.starts.numpy().tolist() == [0, 1]
    assert lights.lights.numpy()["index"].tolist() == [1]


def test_links_say_which_instance_a_light_lights():
    built = assembled(world([sun(linked=frozenset({1})), lamp()]))
    *_, lights = built.inputs
    assert built.key.light_links
    assert lights.links.numpy().tolist() == [[0, 1], [1, 1]]
    rows = lights.lights.numpy()
    assert rows["link"].tolist() == [0, -1], "the row of links of the one, none of the other"


def test_triangles_of_a_mesh_light_know_its_row():
    built = assembled(world([MeshLight(path="/glow", radiance=WHITE, instance=1), sun()]))
    _, geometry, _, _, lights = built.inputs
    row = lights.starts.numpy()[list(built.key.lights).index("mesh")]
    light, instance = geometry.light.numpy(), geometry.instance.numpy()
    assert set(light[instance == 1]) == {row} and set(light[instance == 0]) == {-1}


def test_no_lights_and_no_geometry():
    empty = S.scene([], [Material("/mat")], [])
    *_, lights = assembled(empty).inputs
    assert lights.starts.numpy().tolist() == [0]


def test_the_camera_counts_pixels_of_the_whole_image():
    """Aperture 20 at focal length 50 is 0.4 wide at distance 1; 200 pixels of it, 100 high."""
    scene = world([sun()], options=RenderOptions(resolution=(200, 100), conform="cropAperture"))
    c = assembled(scene, spp=16, crop=(0.5, 1.0, 0.5, 1.0)).inputs[0]
    assert (c.left, c.top) == pytest.approx((-0.2, 0.1))
    assert (c.pixel_x, c.pixel_y) == pytest.approx((0.002, 0.002))
    assert c.footprint == pytest.approx(0.25), "16 samples share a pixel"
    assert tuple(c.back) == pytest.approx((0, 0, 1)) and c.lens_radius == 0.0


def test_the_lens_opens_only_when_the_plan_says_so():
    scene = world([sun()], S.camera(lens_radius=0.01, focus_distance=6.0))
    assert assembled(scene).inputs[0].lens_radius == pytest.approx(0.01)
    assert assembled(scene, effects={"lens": False}).inputs[0].lens_radius == 0.0
