"""What is there and where: visibility, purposes, instances, point instancers, transforms."""

import numpy as np
import pytest

QUAD = """
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        uniform token subdivisionScheme = "none"
"""


def paths(scene):
    return [i.path for i in scene.instances]


def test_visibility_and_purpose_are_inherited(read):
    text = f"""
def Xform "hidden" {{
    token visibility = "invisible"
    def Mesh "m" {{
        token visibility = "inherited"
        {QUAD}
    }}
}}
def Xform "proxies" {{
    uniform token purpose = "proxy"
    def Scope "s" {{
        def Mesh "m" {{ {QUAD} }}
        def Mesh "r" {{
            uniform token purpose = "render"
            {QUAD}
        }}
    }}
}}
def Mesh "guide" {{
    uniform token purpose = "guide"
    {QUAD}
}}
def Mesh "plain" {{ {QUAD} }}
"""
    assert paths(read(text)) == ["/proxies/s/r", "/plain"]
    assert paths(read(text, purposes=("proxy",))) == ["/proxies/s/m", "/plain"]
    assert paths(read(text, purposes=("default", "guide"))) == ["/guide", "/plain"]


def test_animated_visibility_follows_the_frame(read):
    text = f"""def Mesh "m" {{
    token visibility.timeSamples = {{ 1: "inherited", 2: "invisible" }}
    {QUAD}
}}"""
    assert len(read(text, frame=1).instances) == 1
    assert len(read(text, frame=2).instances) == 0


def test_transforms_compose_in_metres_about_the_camera(read, world_points):
    """Scene units times metersPerUnit, whatever the nesting; the origin is the camera's position."""
    scene = read(
        f"""
def Xform "a" {{
    double3 xformOp:translate = (10, 0, 0)
    float xformOp:rotateZ = 90
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ"]
    def Mesh "m" {{
        double3 xformOp:scale = (2, 1, 1)
        uniform token[] xformOpOrder = ["xformOp:scale"]
        {QUAD}
    }}
}}
def Camera "c" {{
    double3 xformOp:translate = (100, 200, 300)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}}
""",
        metres=0.01,
    )
    np.testing.assert_allclose(scene.origin, [1, 2, 3])
    # (1, 1, 0) -> scaled (2, 1, 0) -> turned (-1, 2, 0) -> moved (9, 2, 0) units.
    got = world_points(scene, 0)
    assert any(np.allclose(p, [0.09, 0.02, 0.0]) for p in got.reshape(-1, 3))
    far = scene.instances[0].transform[:3, 3]
    np.testing.assert_allclose(far, np.array([0.1, 0, 0]) - [1, 2, 3])


def test_ten_kilometres_away_keeps_micrometres(read):
    """Double precision of 1e4 m leaves 2e-12 m; a float would leave 1e-3 m."""
    text = f"""
def Xform "a" {{
    double3 xformOp:translate = (AWAY, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Mesh "m" {{
        double3 xformOp:translate = (0.000001, 0, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        {QUAD}
    }}
    def Camera "c" {{}}
}}
"""
    near, far = read(text.replace("AWAY", "0")), read(text.replace("AWAY", "10000"))
    np.testing.assert_allclose(far.instances[0].transform, near.instances[0].transform, atol=1e-11)


def test_instances_share_a_mesh_and_have_their_own_places_and_materials(read):
    scene = read(f"""
class Xform "proto" {{
    def Mesh "m" {{ {QUAD} }}
}}
def Xform "one" (
    instanceable = true
    inherits = </proto>
) {{
    double3 xformOp:translate = (1, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}}
def Xform "two" (
    instanceable = true
    inherits = </proto>
    prepend apiSchemas = ["MaterialBindingAPI"]
) {{
    rel material:binding = </red>
}}
def Xform "three" (
    instanceable = true
    inherits = </proto>
) {{
    color3f[] primvars:displayColor = [(1, 0, 0)]
}}
def Material "red" {{
    token outputs:surface.connect = </red/s.outputs:surface>
    def Shader "s" {{
        uniform token info:id = "UsdPreviewSurface"
        token outputs:surface
    }}
}}
def Camera "c" {{}}
""")
    assert paths(scene) == ["/one/m", "/two/m", "/three/m"]
    one, two, three = scene.instances
    assert one.mesh == two.mesh != three.mesh
    np.testing.assert_allclose(one.transform[:3, 3] - two.transform[:3, 3], [1, 0, 0])
    assert scene.materials[two.materials[0]].path == "/red"
    np.testing.assert_array_equal(scene.meshes[three.mesh].colors[0, 0], [1, 0, 0])
    assert scene.meshes[one.mesh].colors is None


INSTANCER = f"""
def Xform "w" {{
    double3 xformOp:translate = (0, 0, 5)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def PointInstancer "pi" {{
        rel prototypes = [</w/pi/a>, </elsewhere/b>]
        int[] protoIndices = [0, 1, 0, 7]
        point3f[] positions = [(0, 0, 0), (10, 0, 0), (20, 0, 0), (30, 0, 0)]
        float3[] scales = [(1, 1, 1), (2, 2, 2), (1, 1, 1), (1, 1, 1)]
        int64[] invisibleIds = [2]
        def Mesh "a" {{ {QUAD} }}
    }}
}}
def Scope "elsewhere" {{
    def Xform "b" {{
        double3 xformOp:translate = (0, 1, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        def Mesh "m" {{ {QUAD} }}
    }}
}}
def Camera "c" {{}}
"""


def test_point_instancers_place_prototypes_and_hide_them_where_they_lie(read, said, world_points):
    scene = read(INSTANCER)
    assert paths(scene) == ["/w/pi[0]", "/w/pi[1]/m"]
    said(scene, "/w/pi:", "protoIndices")
    # Instance 1: the prototype's own translation is scaled with it: (10, 0, 5) + 2 (0, 1, 0).
    np.testing.assert_allclose(scene.instances[1].transform[:3, 3] + scene.origin, [10, 2, 5])
    assert world_points(scene, 1).max(axis=(0, 1)).tolist() == [12, 4, 5]


def test_nested_instancers_and_ones_within_themselves(read, said):
    scene = read(f"""
def PointInstancer "outer" {{
    rel prototypes = [</outer/inner>, </outer>]
    int[] protoIndices = [0, 0, 1]
    point3f[] positions = [(0, 0, 0), (10, 0, 0), (0, 0, 0)]
    def PointInstancer "inner" {{
        rel prototypes = [</outer/inner/m>]
        int[] protoIndices = [0, 0]
        point3f[] positions = [(0, 1, 0), (0, 2, 0)]
        def Mesh "m" {{ {QUAD} }}
    }}
}}
def Camera "c" {{}}
""")
    got = sorted(tuple(i.transform[:2, 3].round(9).tolist()) for i in scene.instances)
    assert got == [(0, 1), (0, 2), (10, 1), (10, 2)]
    assert len({i.mesh for i in scene.instances}) == 1
    said(scene, "/outer:", "prototype of itself")


def test_instancer_arrays_that_do_not_fit_are_left_out_quietly(read, said, capfd):
    scene = read(INSTANCER.replace("(20, 0, 0), (30, 0, 0)]", "]"))
    assert not scene.instances
    said(scene, "/w/pi:", "differ in length")
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(("scale", "count"), [("(1, 1, 0)", 1), ("(0, 0, 0)", 0), ("(1, 0, 0)", 0)])
def test_transforms_without_inverse(read, world_points, scale, count):
    """Flattened geometry is baked into its points, so that every matrix handed on has an inverse."""
    scene = read(f"""def Mesh "m" {{
    double3 xformOp:scale = {scale}
    uniform token[] xformOpOrder = ["xformOp:scale"]
    {QUAD}
}}""")
    assert len(scene.instances) == count
    if count:
        assert np.linalg.det(scene.instances[0].transform) != 0
        np.testing.assert_allclose(world_points(scene, 0).max(axis=(0, 1)), [1, 1, 0], atol=1e-12)


def test_what_cannot_be_rendered_says_so(read, said):
    scene = read('def BasisCurves "hair" {}\ndef Points "dust" {}\n')
    said(scene, "/hair", "BasisCurves")
    said(scene, "/dust", "Points")


def test_inactive_and_undefined_prims_are_not_there(read):
    scene = read(
        f'def Mesh "off" (active = false) {{ {QUAD} }}\nover Mesh "over" {{ {QUAD} }}\nclass Mesh "c" {{ {QUAD} }}'
    )
    assert not scene.instances
