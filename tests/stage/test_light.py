"""Lights against the sentences of the UsdLux schema."""

import numpy as np
import pytest
from pxr import UsdLux
from scipy.special import ellipe

from scratchwarp import scene as records
from scratchwarp import stage
from scratchwarp.scene import StageError
from scratchwarp.stage.light import temperature_rgb
from scratchwarp.stage.light_far import distant_size_factor
from scratchwarp.stage.light_shape import cylinder_area, ellipsoid_area

SCALED = """
    double3 xformOp:scale = {0}
    uniform token[] xformOpOrder = ["xformOp:scale"]
"""
QUAD = """
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    uniform token subdivisionScheme = "none"
"""


def light(read, kind, body="", metres=1, **options):
    scene = read(f'def {kind} "l"\n{{\n{body}\n}}\ndef Camera "c" {{}}\n', metres=metres, **options)
    assert len(scene.lights) == 1
    return scene.lights[0]


def test_intensity_exposure_and_colour_multiply(read):
    got = light(
        read,
        "RectLight",
        "float inputs:intensity = 3\nfloat inputs:exposure = 2\ncolor3f inputs:color = (1, 0.5, 0.25)",
    )
    np.testing.assert_allclose(got.radiance, [12, 6, 3])


def test_radiances_beyond_what_images_hold_are_held(write, said):
    """Their squares, for the variance, would overflow."""
    body = "color3f inputs:color = (1, 0.5, 0)\nfloat inputs:exposure = 90"
    scene = stage.read(write(f'def DomeLight "d" {{\n{body}\n}}'))
    np.testing.assert_allclose(scene.lights[0].radiance, (1e16, 5e15, 0), rtol=1e-6)
    said(scene, "/d", "radiance is 1.24e+27", "1e+16")


def test_colour_temperature_is_white_at_6500_and_otherwise_the_blackbody(read):
    """The schema asks for white at 6500 K exactly; elsewhere it is UsdLux's blackbody seen from there."""
    np.testing.assert_array_equal(temperature_rgb(6500), 1)
    expected = np.array(UsdLux.BlackbodyTemperatureAsRgb(3000)) / np.array(UsdLux.BlackbodyTemperatureAsRgb(6500))
    body = "color3f inputs:color = (0.5, 0.5, 0.5)\nfloat inputs:colorTemperature = 3000\n"
    np.testing.assert_allclose(light(read, "DiskLight", body).radiance, 0.5)
    got = light(read, "DiskLight", body + "bool inputs:enableColorTemperature = true")
    np.testing.assert_allclose(got.radiance, 0.5 * expected, rtol=1e-6)
    warm, cold = temperature_rgb(2000), temperature_rgb(9000)
    assert warm[0] > 1 > warm[2] and cold[0] < 1 < cold[2]


AREAS = {
    "SphereLight": ("float inputs:radius = 0.25", "(3, 3, 3)", 4 * np.pi * 0.75**2),
    "RectLight": ("float inputs:width = 2\nfloat inputs:height = 0.5", "(2, 3, 7)", 2 * 0.5 * 2 * 3),
    "DiskLight": ("float inputs:radius = 0.25", "(2, 3, 7)", np.pi * 0.25**2 * 6),
    "CylinderLight": ("float inputs:radius = 0.25\nfloat inputs:length = 2", "(3, 2, 2)", 2 * np.pi * 0.5 * 6),
}


@pytest.mark.parametrize("metres", [1, 0.01])
@pytest.mark.parametrize("kind", AREAS)
def test_normalize_divides_by_the_area_in_the_world(read, kind, metres):
    """In scene units, so that metersPerUnit alone changes no light; scale counts."""
    size, scale, area = AREAS[kind]
    body = size + "\nbool inputs:normalize = true" + SCALED.format(scale)
    np.testing.assert_allclose(light(read, kind, body, metres).radiance, 1 / area, rtol=1e-6)
    np.testing.assert_allclose(light(read, kind, size + SCALED.format(scale), metres).radiance, 1)


@pytest.mark.parametrize(
    ("degrees", "factor"),
    [(0, 1), (60, np.pi / 4), (180, np.pi), (240, np.pi * (2 - 0.75)), (360, 2 * np.pi), (500, 2 * np.pi)],
)
def test_distant_size_factor(degrees, factor):
    """sin^2 pi up to a hemisphere, (2 - sin^2) pi beyond; 1 without an angle."""
    assert distant_size_factor(np.radians(degrees)) == pytest.approx(factor)


def test_distant_light(read):
    got = light(read, "DistantLight", 'float xformOp:rotateX = 90\nuniform token[] xformOpOrder = ["xformOp:rotateX"]')
    assert isinstance(got, records.DistantLight)
    # -Z turned by 90 degrees about X points along +Y; the fallback intensity is that of a sun of 0.53 degrees.
    np.testing.assert_allclose(got.direction, [0, 1, 0], atol=1e-12)
    np.testing.assert_allclose(got.radiance, 50000)
    assert got.angle == pytest.approx(np.radians(0.53))


@pytest.mark.parametrize("body", ["float inputs:radius = 0.5\nbool treatAsPoint = true", "float inputs:radius = 0"])
def test_points_have_the_intensity_of_the_sphere_they_stand_for(read, body):
    """I = L pi r^2 with L = 1 / (4 pi r^2) is 1/4 in scene units, 1e-4 / 4 in metres where those are centimetres."""
    got = light(read, "SphereLight", body + "\nbool inputs:normalize = true", metres=0.01)
    assert got.point and got.radius == 0
    np.testing.assert_allclose(got.radiance, 0.25e-4)


def test_point_without_normalize(read):
    got = light(read, "SphereLight", "float inputs:radius = 2\nbool treatAsPoint = true")
    np.testing.assert_allclose(got.radiance, np.pi * 4)


def test_shapes_are_placed_in_metres(read):
    place = """
    double3 xformOp:translate = (100, 200, 300)
    float xformOp:rotateZ = 90
    double3 xformOp:scale = (2, 2, 2)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ", "xformOp:scale"]
"""
    rect = light(read, "RectLight", "float inputs:width = 3\nfloat inputs:height = 1" + place, metres=0.01)
    np.testing.assert_allclose(rect.center, [1, 2, 3])
    np.testing.assert_allclose(rect.ex, [0, 0.03, 0], atol=1e-12)
    np.testing.assert_allclose(rect.ey, [-0.01, 0, 0], atol=1e-12)
    np.testing.assert_allclose(rect.normal, [0, 0, -1], atol=1e-12)
    sphere = light(read, "SphereLight", "float inputs:radius = 3" + place, metres=0.01)
    assert sphere.radius == pytest.approx(0.06)
    tube = light(read, "CylinderLight", "float inputs:length = 4\nfloat inputs:radius = 1" + place, metres=0.01)
    np.testing.assert_allclose(tube.axis, [0, 0.04, 0], atol=1e-12)
    assert tube.radius == pytest.approx(0.02)


def test_a_mirrored_rect_still_shines_along_its_minus_z(read):
    got = light(read, "RectLight", SCALED.format("(-1, 1, 1)"))
    np.testing.assert_allclose(got.normal, [0, 0, -1])
    turned = light(read, "RectLight", SCALED.format("(1, 1, -1)"))
    np.testing.assert_allclose(turned.normal, [0, 0, 1])


def test_sheared_disk_has_principal_axes_of_the_same_ellipse(read):
    body = """
    matrix4d xformOp:transform = ((1, 0, 0, 0), (1, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))
    uniform token[] xformOpOrder = ["xformOp:transform"]
    float inputs:radius = 2
"""
    got = light(read, "DiskLight", body)
    assert got.ex @ got.ey == pytest.approx(0, abs=1e-12)
    turn = np.linspace(0, 2 * np.pi, 7)
    ring = 2 * np.stack([np.cos(turn) + np.sin(turn), np.sin(turn), 0 * turn], axis=1)
    inside = (ring @ got.ex / (got.ex @ got.ex)) ** 2 + (ring @ got.ey / (got.ey @ got.ey)) ** 2
    np.testing.assert_allclose(inside, 1)


def test_areas_of_stretched_shapes_have_closed_forms():
    """Prolate spheroid with axes 1, 1, c: 2 pi (1 + c asin(e) / e), e^2 = 1 - 1 / c^2; circular cylinder 2 pi r l."""
    c = 3.0
    e = np.sqrt(1 - 1 / c**2)
    assert ellipsoid_area(np.diag([1, c, 1])) == pytest.approx(2 * np.pi * (1 + c * np.arcsin(e) / e), rel=1e-6)
    assert ellipsoid_area(2 * np.eye(3)) == pytest.approx(16 * np.pi, rel=1e-12)
    x, y, z = np.eye(3)
    assert cylinder_area(2 * x, 3 * y, 3 * z) == pytest.approx(2 * np.pi * 3 * 4, rel=1e-12)


@pytest.mark.parametrize(
    ("kind", "scale", "area"),
    [
        ("SphereLight", "(2, 2, 6)", 0.25 * 4 * 2 * np.pi * (1 + 3 * np.arcsin(np.sqrt(8 / 9)) / np.sqrt(8 / 9))),
        # Side of an elliptic tube of half-axes 0.5 and 1.5, length 1: its perimeter, 4 a E(e), a = 1.5, e^2 = 8/9.
        ("CylinderLight", "(1, 1, 3)", 4 * 1.5 * ellipe(8 / 9)),
    ],
)
def test_stretched_lights_become_meshes_of_the_same_power(read, world_points, kind, scale, area):
    scene = read(f'def {kind} "l"\n{{\nbool inputs:normalize = true{SCALED.format(scale)}\n}}\ndef Camera "c" {{}}\n')
    (found,) = scene.lights
    assert isinstance(found, records.MeshLight)
    instance = scene.instances[found.instance]
    assert scene.lights[instance.light] is found
    np.testing.assert_allclose(found.radiance, 1 / area, rtol=1e-5)
    corners = world_points(scene, found.instance)
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # Facets of 3.75 degrees: the area of a stretched shape is that of the true one to some 1e-3.
    assert np.linalg.norm(cross, axis=1).sum() / 2 == pytest.approx(area, rel=2e-3)
    outward = corners.mean(axis=1) * ([1, 1, 1] if kind == "SphereLight" else [0, 1, 1])
    assert (np.einsum("mi,mi->m", cross, outward) > 0).all()


POLES = {
    ("DomeLight", "Y", ""): ([0, 1, 0], [0, 0, 1]),
    ("DomeLight", "Z", ""): ([0, 1, 0], [0, 0, 1]),
    ("DomeLight_1", "Y", ""): ([0, 1, 0], [0, 0, 1]),
    ("DomeLight_1", "Z", ""): ([0, 0, 1], [0, -1, 0]),
    ("DomeLight_1", "Z", "Y"): ([0, 1, 0], [0, 0, 1]),
    ("DomeLight_1", "Y", "Z"): ([0, 0, 1], [0, -1, 0]),
}


@pytest.mark.parametrize("case", POLES)
def test_dome_poles(read, case):
    """Where the pole and longitude 0 point, as the schema's text has it."""
    kind, up, axis = case
    pole, center = POLES[case]
    got = light(read, kind, f'uniform token poleAxis = "{axis}"' if axis else "", up=up)
    np.testing.assert_allclose(got.rotation @ [0, 1, 0], pole, atol=1e-12)
    np.testing.assert_allclose(got.rotation @ [0, 0, 1], center, atol=1e-12)
    assert np.linalg.det(got.rotation) == pytest.approx(1)


def test_dome_ignores_normalize_and_scale(read):
    got = light(
        read, "DomeLight", "bool inputs:normalize = true\nfloat inputs:intensity = 2" + SCALED.format("(5, 5, 5)")
    )
    np.testing.assert_allclose(got.radiance, 2)
    np.testing.assert_allclose(got.rotation, np.eye(3), atol=1e-12)


def test_textures_of_rect_and_dome_are_loaded(write, tmp_path, said):
    from scratchwarp import stage

    (tmp_path / "a.hdr").write_bytes(b"x")
    asked = []

    def load(path, space):
        asked.append((path, space))
        return np.ones((2, 4, 4), np.float32)

    path = write("""
def DomeLight "d" { asset inputs:texture:file = @a.hdr@ }
def RectLight "r" {
    asset inputs:texture:file = @a.hdr@ (
        colorSpace = "lin_ap1_scene"
    )
}
def RectLight "again" { asset inputs:texture:file = @a.hdr@ }
def DomeLight "ball" {
    asset inputs:texture:file = @a.hdr@
    token inputs:texture:format = "mirroredBall"
}
def RectLight "gone" { asset inputs:texture:file = @gone.hdr@ }
""")
    scene = stage.read(path, load_texture=load)
    assert [light.texture for light in scene.lights] == [0, 1, 0, -1, -1]
    assert [space for _, space in asked] == ["auto", "lin_ap1_scene"]
    said(scene, "/ball", "mirroredBall")
    said(scene, "/gone", "gone.hdr")


def test_shaping_and_shadow(read):
    api = '(prepend apiSchemas = ["ShapingAPI", "ShadowAPI"])'
    scene = read(
        f"""def SphereLight "l" {api} {{
    float inputs:shaping:focus = 2
    color3f inputs:shaping:focusTint = (0.1, 0.2, 0.3)
    float inputs:shaping:cone:angle = 30
    float inputs:shaping:cone:softness = 0.5
    bool inputs:shadow:enable = false
    color3f inputs:shadow:color = (0, 0, 1)
    float inputs:shadow:distance = 50
}}
def RectLight "wide" {api} {{}}
def SphereLight "half" {api} {{}}""",
        metres=0.01,
    )
    spot, wide, half = scene.lights
    assert spot.shaping.focus == 2 and spot.shaping.cone_softness == 0.5
    assert spot.shaping.cone_angle == pytest.approx(np.pi / 6)
    np.testing.assert_allclose(spot.shaping.focus_tint, [0.1, 0.2, 0.3], rtol=1e-6)
    assert not spot.shadow and spot.shadow_color == (0, 0, 1) and spot.shadow_distance == pytest.approx(0.5)
    # The API's fallback cone of 90 degrees cuts nothing off a one-sided light, and half of a sphere.
    assert wide.shaping is None and wide.shadow and wide.shadow_distance == np.inf
    assert half.shaping.cone_angle == pytest.approx(np.pi / 2)


def test_light_linking(read):
    scene = read(f"""
def Xform "w" {{
    def Mesh "a" {{ {QUAD} }}
    def Mesh "b" {{ {QUAD} }}
}}
def SphereLight "all" {{}}
def SphereLight "not_b" {{
    rel collection:lightLink:excludes = </w/b>
}}
def SphereLight "only_b" {{
    uniform bool collection:lightLink:includeRoot = 0
    rel collection:lightLink:includes = </w/b>
    rel collection:shadowLink:excludes = </w>
}}
""")
    everything, not_b, only_b = scene.lights
    assert everything.linked is None and everything.shadow_linked is None
    assert not_b.linked == {0} and only_b.linked == {1} and only_b.shadow_linked == frozenset()


MESH_LIGHT = f"""
def Mesh "m" (prepend apiSchemas = ["MeshLightAPI", "MaterialBindingAPI"])
{{
    float inputs:intensity = 10
    rel material:binding = </glow>
    MODE
    {QUAD}{SCALED.format("(2, 3, 1)")}
}}
def Material "glow"
{{
    token outputs:surface.connect = </glow/s.outputs:surface>
    def Shader "s"
    {{
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:emissiveColor = (1, 0.5, 0)
        token outputs:surface
    }}
}}
"""
MODES = {
    "": ([10, 5, 0], (0, 0, 0)),
    'uniform token light:materialSyncMode = "independent"': ([10, 10, 10], (1, 0.5, 0)),
    "bool inputs:normalize = true": ([10 / 6, 5 / 6, 0], (0, 0, 0)),
}


@pytest.mark.parametrize("mode", MODES)
def test_mesh_lights(read, mode):
    radiance, glow = MODES[mode]
    scene = read(MESH_LIGHT.replace("MODE", mode))
    (found,) = scene.lights
    assert isinstance(found, records.MeshLight) and found.instance == 0 and scene.instances[0].light == 0
    np.testing.assert_allclose(found.radiance, radiance)
    assert scene.materials[scene.instances[0].materials[0]].surface.emissive_color == glow


def test_a_mesh_light_without_material_response_is_black(read):
    scene = read(MESH_LIGHT.replace("MODE", 'uniform token light:materialSyncMode = "noMaterialResponse"'))
    surface = scene.materials[scene.instances[0].materials[0]].surface
    assert surface.base == "diffuse" and surface.color == (0, 0, 0)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('def PortalLight "l" {}', ["PortalLight"]),
        ('def GeometryLight "l" {}', ["GeometryLight"]),
        ('def RectLight "l" { float inputs:width = 0 }', ["no area"]),
        ('def SphereLight "l" { float inputs:radius = 0 }', ["radius is 0"]),
        (f'def SphereLight "l" {{{SCALED.format("(0, 1, 1)")}}}', ["scale of 0"]),
        ('def SphereLight "l" { float inputs:intensity = -1 }', ["intensity is negative"]),
        ('def SphereLight "l" { float inputs:intensity = nan }', ["inputs:intensity is nan"]),
    ],
)
def test_lights_that_cannot_be_honoured_say_so(read, said, text, words):
    said(read(text), "/l", *words)


def test_a_light_with_nan_in_its_transform_is_refused(read):
    with pytest.raises(StageError, match="/l has a transform"):
        read("""def RectLight "l" {
    double3 xformOp:translate = (nan, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}""")


def test_lights_of_invisible_scopes_are_off_and_proxies_are_on(read, said):
    scene = read("""
def Scope "off" {
    token visibility = "invisible"
    def SphereLight "l" {}
}
def Scope "guide" {
    uniform token purpose = "guide"
    def SphereLight "l" {}
}""")
    assert [light.path for light in scene.lights] == ["/guide/l"]
