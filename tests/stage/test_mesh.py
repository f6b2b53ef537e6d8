"""Meshes: topology, primvars, normals, colours, slots."""

import numpy as np
import pytest

from scratchwarp.scene import StageError

CUBE = """
    int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]
    int[] faceVertexIndices = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5]
    point3f[] points = [(0,0,0), (1,0,0), (0,1,0), (1,1,0), (0,0,1), (1,0,1), (0,1,1), (1,1,1)]
"""
QUAD = """
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
"""
NONE = '    uniform token subdivisionScheme = "none"\n'


def volume(corners):
    return np.einsum("mi,mi->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6


@pytest.mark.parametrize(("orientation", "sign"), [("rightHanded", 1), ("leftHanded", -1)])
def test_triangles_wind_counter_clockwise_seen_from_outside(read, orientation, sign):
    """The signed volume of a closed mesh is positive; left-handed faces are turned over, so it changes sign."""
    scene = read(f'def Mesh "m"\n{{{CUBE}{NONE}    uniform token orientation = "{orientation}"\n}}')
    mesh = scene.meshes[0]
    np.testing.assert_allclose(volume(mesh.points[mesh.triangles]), sign)
    assert mesh.faces.tolist() == np.repeat(np.arange(6), 2).tolist()


def test_negative_scale_stays_in_the_transform(read):
    scene = read(
        f'def Mesh "m"\n{{{CUBE}{NONE}    double3 xformOp:scale = (-1, 2, 1)\n'
        '    uniform token[] xformOpOrder = ["xformOp:scale"]\n}'
    )
    assert np.linalg.det(scene.instances[0].transform[:3, :3]) < 0
    np.testing.assert_allclose(volume(scene.meshes[0].points[scene.meshes[0].triangles]), 1)


def test_holes_degenerate_faces_and_slivers_are_left_out(read, said):
    scene = read(f"""def Mesh "m"
{{
    int[] faceVertexCounts = [4, 4, 3, 2, 0]
    int[] faceVertexIndices = [0, 1, 2, 3, 0, 1, 2, 3, 0, 0, 1, 0, 1]
    int[] holeIndices = [1, 99]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
{NONE}}}""")
    assert scene.meshes[0].faces.tolist() == [0, 0]
    said(scene, "/m:", "holeIndices")
    said(scene, "/m:", "without area")
    said(scene, "/m:", "fewer than three")


@pytest.mark.parametrize(
    ("body", "word"),
    [
        (
            "int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 9]\npoint3f[] points = [(0,0,0)]",
            "outside 0..0",
        ),
        ("int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1]\npoint3f[] points = [(0,0,0)]", "add up to 3"),
        ("int[] faceVertexCounts = []\npoint3f[] points = [(0,0,0)]", "no faces"),
        ("int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0,0,0]\npoint3f[] points = [(0,0,0)]", "an area"),
    ],
)
def test_meshes_that_cannot_be_rendered_are_left_out(read, said, body, word):
    scene = read(f'def Mesh "bad"\n{{\n{body}\n{NONE}}}\ndef Mesh "good"\n{{{QUAD}{NONE}}}')
    said(scene, "/bad", word)
    assert [i.path for i in scene.instances] == ["/good"]


def test_points_that_are_not_finite_name_the_file_the_prim_and_the_point(read):
    text = QUAD.replace("(1, 1, 0)", "(1, nan, 0)")
    with pytest.raises(StageError, match=r"stage.usda: /m: points\[2\]"):
        read(f'def Mesh "m"\n{{{text}{NONE}}}')


PRIMVARS = {
    "faceVarying": "[(0, 0), (1, 0), (1, 1), (0, 1)]",
    "vertex": "[(0, 0), (1, 0), (1, 1), (0, 1)]",
    "varying": "[(0, 0), (1, 0), (1, 1), (0, 1)]",
    "indexed": "[(1, 1), (0, 0), (0, 1), (1, 0)]",
}


@pytest.mark.parametrize("kind", PRIMVARS)
def test_every_interpolation_of_st_gives_each_corner_its_own_value(read, kind):
    """On this square the uv of each corner equals its position, whatever way it is authored."""
    interpolation = "faceVarying" if kind == "indexed" else kind
    more = "    int[] primvars:st:indices = [1, 3, 0, 2]\n" if kind == "indexed" else ""
    scene = read(
        f'def Mesh "m"\n{{{QUAD}{NONE}    texCoord2f[] primvars:st = {PRIMVARS[kind]} (\n'
        f'        interpolation = "{interpolation}"\n    )\n{more}}}'
    )
    mesh = scene.meshes[0]
    np.testing.assert_array_equal(mesh.uvs["st"], mesh.points[mesh.triangles][..., :2])


def test_uniform_and_constant_colours(read):
    two = """
    int[] faceVertexCounts = [3, 3]
    int[] faceVertexIndices = [0, 1, 2, 0, 2, 3]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
"""
    scene = read(f"""
def Mesh "u"
{{{two}{NONE}    color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0)] (
        interpolation = "uniform"
    )
}}
def Xform "x"
{{
    color3f[] primvars:displayColor = [(0, 0, 1)]
    def Mesh "c" {{{two}{NONE}}}
}}
def Mesh "n" {{{two}{NONE}}}
""")
    by_path = {m.path: m for m in scene.meshes}
    np.testing.assert_array_equal(by_path["/u"].colors[:, 0], [[1, 0, 0], [0, 1, 0]])
    np.testing.assert_array_equal(by_path["/x/c"].colors[:, 2], [[0, 0, 1], [0, 0, 1]])
    assert by_path["/n"].colors is None
    assert scene.materials[scene.instances[0].materials[0]].uses_display_color


def test_primvars_of_the_wrong_size_are_ignored_with_a_warning(read, said):
    scene = read(
        f'def Mesh "m"\n{{{QUAD}{NONE}    texCoord2f[] primvars:st = [(0, 0), (1, 0)] (\n'
        '        interpolation = "vertex"\n    )\n}'
    )
    assert not scene.meshes[0].uvs
    said(scene, "/m.primvars:st", "2 values", "expected 4")


def test_another_uv_set_stands_in_for_st(read, said):
    scene = read(
        f'def Mesh "m"\n{{{QUAD}{NONE}    texCoord2f[] primvars:map1 = [(0, 0), (1, 0), (1, 1), (0, 1)] (\n'
        '        interpolation = "vertex"\n    )\n}'
    )
    assert set(scene.meshes[0].uvs) == {"map1", "st"}
    said(scene, "/m", "map1")


def test_normals_primvar_wins_over_the_attribute_and_zero_ones_become_the_facets(read):
    scene = read(f"""def Mesh "m"
{{{QUAD}{NONE}
    normal3f[] normals = [(1, 0, 0), (1, 0, 0), (1, 0, 0), (1, 0, 0)]
    normal3f[] primvars:normals = [(0, 3, 4), (0, 0, 0), (0, 3, 4), (0, 3, 4)] (
        interpolation = "vertex"
    )
}}""")
    mesh = scene.meshes[0]
    expected = np.where((mesh.triangles == 1)[..., None], [0, 0, 1], [0, 0.6, 0.8])
    np.testing.assert_allclose(mesh.normals, expected, atol=1e-7)


def test_polygons_without_normals_are_flat(read):
    assert read(f'def Mesh "m"\n{{{CUBE}{NONE}}}').meshes[0].normals is None


def test_subdivision_cages_are_smooth_and_warn_once(read, said):
    """At a corner of a cube three faces meet at right angles: the normal is the diagonal, however they are cut."""
    authored = '    normal3f[] normals = [(1, 0, 0)] (\n        interpolation = "constant"\n    )\n'
    scene = read(f'def Mesh "a"\n{{{CUBE}{authored}}}\ndef Mesh "b"\n{{{CUBE}}}')
    mesh = scene.meshes[0]
    expected = (mesh.points[mesh.triangles] * 2 - 1) / np.sqrt(3)
    np.testing.assert_allclose(mesh.normals, expected, atol=1e-6)
    assert said(scene, "subdivision surface").startswith("/a, /b:")


def test_tangents_primvar(read):
    scene = read(
        f'def Mesh "m"\n{{{QUAD}{NONE}    float3[] primvars:tangents = [(0, 1, 0)] (\n'
        '        interpolation = "constant"\n    )\n}'
    )
    np.testing.assert_array_equal(scene.meshes[0].tangents, np.broadcast_to([0, 1, 0], (2, 3, 3)))


def test_time_samples_of_points_are_read_at_the_frame(read):
    text = (
        QUAD.split("point3f[]")[0]
        + """    point3f[] points.timeSamples = {
        1: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
        3: [(0, 0, 2), (1, 0, 2), (1, 1, 2), (0, 1, 2)],
    }
"""
    )
    body = f'def Mesh "m"\n{{{text}{NONE}}}'
    assert read(body, frame=2).meshes[0].points[0, 2] == 1
    assert read(body, frame=3).meshes[0].points[0, 2] == 2
    assert read(body).meshes[0].points[0, 2] == 0
    assert read(body, frame=2).time == 2 and read(body).time is None


def test_the_default_time_passes_over_samples(read):
    up = "double3 xformOp:translate"
    moved = f"    {up} = (0, 0, 7)\n    {up}.timeSamples = {{ 1: (0, 0, 4) }}\n"
    moved += '    uniform token[] xformOpOrder = ["xformOp:translate"]\n'
    body = f'def Mesh "m"\n{{{QUAD}{moved}{NONE}}}'
    earliest, default = (s.bounds()[0] + s.origin for s in (read(body), read(body, default_time=True)))
    np.testing.assert_allclose(default[2] / earliest[2], 7 / 4)
    with pytest.raises(StageError, match="give one of them"):
        read(body, frame=1, default_time=True)
