"""Materials: bindings, UsdPreviewSurface networks, textures, ScratchSurface, fallbacks."""

import numpy as np
import pytest

from scratchwarp.scene import PreviewSurface, ScratchSurface, StageError

QUAD = """
    int[] faceVertexCounts = [3, 3]
    int[] faceVertexIndices = [0, 1, 2, 0, 2, 3]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    uniform token subdivisionScheme = "none"
    texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] ( interpolation = "vertex" )
"""


def bound(shader, more="", mesh=""):
    """A mesh bound to /mat, whose surface node is /mat/s."""
    return f"""
def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
    rel material:binding = </mat>
    {QUAD}{mesh}
}}
def Material "mat" {{
    token outputs:surface.connect = </mat/s.outputs:surface>
    def Shader "s" {{
        {shader}
        token outputs:surface
    }}
    {more}
}}
def Camera "c" {{}}
"""


def material(scene, path="/m", slot=0):
    (instance,) = [i for i in scene.instances if i.path == path]
    return scene.materials[instance.materials[slot]]


def simple(name, kind="UsdPreviewSurface"):
    return f"""def Material "{name}" {{
    token outputs:surface.connect = </{name}/s.outputs:surface>
    def Shader "s" {{
        uniform token info:id = "{kind}"
        token outputs:surface
    }}
}}
"""


PREVIEW = 'uniform token info:id = "UsdPreviewSurface"\n'


def test_defaults_are_those_of_the_specification(read):
    surface = material(read(bound(PREVIEW))).surface
    assert vars(surface) == vars(PreviewSurface())
    assert surface.diffuse_color == (0.18, 0.18, 0.18) and surface.roughness == 0.5 and surface.ior == 1.5


def test_every_constant_arrives(read):
    surface = material(
        read(
            bound(
                PREVIEW
                + """
        color3f inputs:diffuseColor = (0.1, 0.2, 0.3)
        color3f inputs:emissiveColor = (1, 2, 3)
        int inputs:useSpecularWorkflow = 1
        color3f inputs:specularColor = (0.4, 0.5, 0.6)
        float inputs:metallic = 0.25
        float inputs:roughness = 0.75
        float inputs:clearcoat = 0.5
        float inputs:clearcoatRoughness = 0.125
        float inputs:opacity = 0.5
        float inputs:opacityThreshold = 0.25
        token inputs:opacityMode = "presence"
        float inputs:ior = 1.25
"""
            )
        )
    ).surface
    np.testing.assert_allclose(surface.diffuse_color, [0.1, 0.2, 0.3], rtol=1e-6)
    np.testing.assert_allclose(surface.specular_color, [0.4, 0.5, 0.6], rtol=1e-6)
    assert surface.emissive_color == (1, 2, 3) and surface.use_specular_workflow
    assert (surface.metallic, surface.roughness, surface.clearcoat, surface.clearcoat_roughness) == (
        0.25,
        0.75,
        0.5,
        0.125,
    )
    assert (surface.opacity, surface.opacity_threshold, surface.opacity_mode, surface.ior) == (
        0.5,
        0.25,
        "presence",
        1.25,
    )


def test_values_travel_through_the_material_interface_and_node_graphs(read):
    scene = read(
        """
def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {
    rel material:binding = </mat>
    QUAD
}
def Material "mat" {
    color3f inputs:tint = (1, 0, 0)
    token outputs:surface.connect = </mat/g.outputs:surface>
    def NodeGraph "g" {
        color3f inputs:tint.connect = </mat.inputs:tint>
        token outputs:surface.connect = </mat/g/s.outputs:surface>
        def Shader "s" {
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </mat/g.inputs:tint>
            token outputs:surface
        }
    }
}""".replace("QUAD", QUAD)
    )
    assert material(scene).surface.diffuse_color == (1, 0, 0)


def test_binding_purposes_and_render_settings(read):
    text = f"""
def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
    rel material:binding = </all>
    rel material:binding:full = </full>
    rel material:binding:preview = </preview>
    {QUAD}
}}
{simple("all")}{simple("full")}{simple("preview")}
def RenderSettings "rs" {{
    uniform token[] materialBindingPurposes = ["preview", ""]
}}
"""
    assert material(read(text)).path == "/full"
    assert material(read(text, render_settings="/rs")).path == "/preview"
    assert material(read(text.replace("rel material:binding:full = </full>", ""))).path == "/all"


def test_a_later_purpose_goes_before_the_all_purpose_binding(read):
    text = f"""
def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
    rel material:binding = </all>
    rel material:binding:full = </full>
    {QUAD}
}}
{simple("all")}{simple("full")}
def RenderSettings "rs" {{
    uniform token[] materialBindingPurposes = ["preview", "full", ""]
}}
"""
    assert material(read(text, render_settings="/rs")).path == "/full"


def test_subsets_bind_their_faces(read, said):
    scene = read(f"""
def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
    rel material:binding = </a>
    {QUAD}
    def GeomSubset "part" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
        uniform token elementType = "face"
        uniform token familyName = "materialBind"
        int[] indices = [1, 7]
        rel material:binding = </b>
    }}
}}
{simple("a")}{simple("b")}""")
    assert scene.meshes[0].slots.tolist() == [0, 1]
    assert [material(scene, slot=s).path for s in (0, 1)] == ["/a", "/b"]
    said(scene, "/m/part", "outside 0..1")


def test_unbound_geometry_is_grey_in_its_display_color(read):
    scene = read(f'def Mesh "m" {{{QUAD}}}')
    assert material(scene).uses_display_color and material(scene).surface.diffuse_color == (0.18, 0.18, 0.18)


def test_a_binding_to_nothing_is_told_own_or_inherited(read, said):
    mesh = f'def Mesh "m" {{{QUAD}}}'
    inherited = (
        f'def Xform "x" (prepend apiSchemas = ["MaterialBindingAPI"]) {{ rel material:binding = </gone>\n{mesh} }}'
    )
    said(read(inherited), "/x/m", "bound to /gone, which is no Material")
    said(read(bound("").replace("</mat>", "</c>")), "/m", "bound to /c, which is no Material")
    assert not any("is no Material" in w for w in read(mesh).warnings)


def test_display_color_through_a_primvar_reader(read):
    more = """def Shader "p" {
        uniform token info:id = "UsdPrimvarReader_float3"
        string inputs:varname = "displayColor"
        vector3f outputs:result
    }"""
    scene = read(bound(PREVIEW + "color3f inputs:diffuseColor.connect = </mat/p.outputs:result>", more))
    assert material(scene).uses_display_color


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (bound('uniform token info:id = "ND_standard_surface_surfaceshader"'), ["/mat", "ND_standard_surface"]),
        (bound(PREVIEW).replace("outputs:surface.connect", "outputs:mtlx:surface.connect"), ["/mat", "mtlx"]),
        (
            bound(PREVIEW).replace("token outputs:surface.connect", "token outputs:nothing.connect"),
            ["/mat", "no surface"],
        ),
        (bound(PREVIEW + "float inputs:ior = -1"), ["/mat/s", "ior is -1"]),
        (bound(PREVIEW + "float inputs:roughness = nan"), ["/mat/s", "roughness is nan"]),
        (bound(PREVIEW + "float inputs:displacement = 1"), ["/mat/s", "displacement"]),
        (bound(PREVIEW + 'token inputs:opacityMode = "odd"'), ["/mat/s", "odd"]),
        (bound(PREVIEW + "float inputs:metallic.connect = </mat/x.outputs:y>"), ["/mat/s", "does not exist"]),
        (
            bound(PREVIEW + "float inputs:metallic.connect = </mat/x.outputs:y>", 'def Shader "x" { float outputs:y }'),
            ["/mat/s", "metallic"],
        ),
    ],
)
def test_what_cannot_be_honoured_warns_and_falls_back(read, said, text, words):
    scene = read(text)
    said(scene, *words)
    assert isinstance(material(scene).surface, PreviewSurface)


def test_constant_colours_are_converted_from_their_colour_space(read):
    """White stays white; AP1 red lies outside Rec.709."""
    space = '( colorSpace = "lin_ap1_scene" )'
    surface = material(
        read(
            bound(
                PREVIEW
                + f"color3f inputs:diffuseColor = (1, 1, 1) {space}\ncolor3f inputs:emissiveColor = (1, 0, 0) {space}"
            )
        )
    ).surface
    np.testing.assert_allclose(surface.diffuse_color, 1, atol=1e-5)
    assert surface.emissive_color[0] > 1.5 and surface.emissive_color[1] < 0


def test_scratch_surface_goes_before_the_preview(read):
    text = bound(
        PREVIEW,
        """
    token outputs:scratchwarp:surface.connect = </mat/own.outputs:surface>
    def Shader "own" {
        uniform token info:id = "ScratchSurface"
        token inputs:base = "dielectric"
        color3f inputs:color = (0.5, 0.25, 0.125)
        float inputs:roughness = 0.25
        float inputs:anisotropy = -0.5
        float inputs:anisotropyRotation = 0.25
        float inputs:ior = 1.25
        token outputs:surface
    }""",
    )
    surface = material(read(text)).surface
    assert isinstance(surface, ScratchSurface)
    assert (surface.base, surface.metal, surface.roughness, surface.anisotropy) == (
        "dielectric",
        "aluminium",
        0.25,
        -0.5,
    )
    assert surface.color == (0.5, 0.25, 0.125) and surface.ior == 1.25
    assert surface.rotation == pytest.approx(np.pi / 2)
    with pytest.raises(StageError, match=r"/mat/own.*roughness is 2"):
        read(text.replace("inputs:roughness = 0.25", "inputs:roughness = 2"))


def test_a_bound_material_is_read_once(read):
    scene = read(
        bound(PREVIEW)
        + f'def Mesh "m2" (prepend apiSchemas = ["MaterialBindingAPI"]) {{ rel material:binding = </mat>\n{QUAD}}}'
    )
    assert len(scene.materials) == 1 and len(scene.instances) == 2
