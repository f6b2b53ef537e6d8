"""Scratch layers, profiles and waves as the schema has them."""

import numpy as np
import pytest

from scratchwarp.scene import StageError

QUAD = """
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    uniform token subdivisionScheme = "none"
"""
ST = 'texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] ( interpolation = "vertex" )\n'


def scratched(body, apis=("ScratchLayerAPI:fine",), children="", mesh=ST):
    names = ", ".join(f'"{a}"' for a in ("MaterialBindingAPI", *apis))
    return f"""
def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
    rel material:binding = </mat>
    {QUAD}{mesh}
}}
def Material "mat" (prepend apiSchemas = [{names}]) {{
    token outputs:surface.connect = </mat/s.outputs:surface>
    def Shader "s" {{
        uniform token info:id = "UsdPreviewSurface"
        token outputs:surface
    }}
    {body}
    {children}
}}
"""


VEE = 'def ScratchProfile "Vee" {}\n'
PROFILE = "rel scratch:layer:fine:profile = </mat/Vee>\n"


def layer(scene, index=0):
    return scene.materials[0].layers[index]


def test_fallbacks_are_the_schemas(read):
    got = layer(read(scratched(PROFILE, children=VEE)))
    assert (got.name, got.prim, got.order, got.model, got.distribution) == ("fine", "/mat", 0, "auto", "worley")
    assert (got.width, got.depth, got.length, got.pitch, got.density) == (10, 1, 1000, 100, 0)
    assert got.coverage == pytest.approx(0.1) and got.profile.shape == "vGroove" and got.profile.path == "/mat/Vee"
    assert (got.patterns, got.cross_angle) == (1, pytest.approx(np.pi / 2))
    assert dict(got.extra) == {"ends": "cap"}


def test_authored_values_arrive_in_radians_and_micrometres(read):
    """metersPerUnit and transforms leave micrometres alone."""
    got = layer(
        read(
            scratched(
                PROFILE
                + """
    uniform token scratch:layer:fine:distribution = "linear"
    uniform token scratch:layer:fine:space = "uv"
    float scratch:layer:fine:width = 0.25
    float scratch:layer:fine:angle = 90
    float scratch:layer:fine:angleSpread = 45
    float scratch:layer:fine:curvature = -180
    float2 scratch:layer:fine:offset = (1, 2)
    float2 scratch:layer:fine:center = (0.25, 0.75)
    uniform int scratch:layer:fine:seed = 7
    uniform token scratch:layer:fine:material = "conductor"
    uniform token scratch:layer:fine:metal = "gold"
    color3f scratch:layer:fine:diffuseColor = (1, 0.5, 0.25)
    uniform token scratch:layer:fine:fresnelModel = "lazanyiError"
""",
                children=VEE,
            ),
            metres=0.001,
        )
    )
    assert (got.distribution, got.space, got.width, got.seed) == ("linear", "uv", 0.25, 7)
    assert (got.angle, got.angle_spread, got.curvature) == pytest.approx((np.pi / 2, np.pi / 4, -np.pi))
    assert got.offset == (1, 2) and got.center == (0.25, 0.75)
    assert (got.material, got.metal, got.fresnel) == ("conductor", "gold", "lazanyiError")
    assert got.diffuse_color == (1, 0.5, 0.25)


def test_blocked_attributes_have_the_fallback(read):
    got = layer(read(scratched(PROFILE + "float scratch:layer:fine:width = None", children=VEE)))
    assert got.width == 10


def test_layers_are_sorted_by_order_then_name_and_may_be_off(read):
    body = """
    uniform int scratch:layer:a:order = 2
    uniform int scratch:layer:c:order = -1
    uniform bool scratch:layer:d:enabled = 0
"""
    apis = [f"ScratchLayerAPI:{n}" for n in "dabc"]
    scene = read(scratched(body, apis))
    assert [one.name for one in scene.materials[0].layers] == ["c", "b", "a"]


def test_orphaned_attributes_are_no_layers(read):
    scene = read(scratched("float scratch:layer:gone:width = 5", apis=()))
    assert scene.materials[0].layers == ()


def test_profiles(read):
    children = """def ScratchProfile "Vee" {
        uniform token scratch:shape = "points"
        float2[] scratch:points = [(0, 0), (0.5, -1), (1, 0)]
        float scratch:rim = 0.5
        float scratch:rimWidth = 0.125
        float scratch:apex = 0.25
        uniform bool scratch:periodic = 1
    }"""
    got = layer(read(scratched(PROFILE, children=children))).profile
    assert (got.shape, got.rim, got.rim_width, got.periodic) == ("points", 0.5, 0.125, True)
    np.testing.assert_allclose(got.points, [(0, 0), (0.5, -1), (1, 0)])
    assert dict(got.parameters) == {"apex": 0.25, "floorWidth": 0.5, "sigma": pytest.approx(1 / 6)}


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("", ["/mat layer 'fine'", "no profile", "V groove"]),
        ("rel scratch:layer:fine:profile = </m>", ["/mat layer 'fine'", "/m is no ScratchProfile"]),
        ("rel scratch:layer:fine:profile = </nowhere>", ["/mat layer 'fine'", "/nowhere"]),
    ],
)
def test_a_layer_without_a_profile_is_a_v_groove(read, said, body, words):
    scene = read(scratched(body))
    assert layer(scene).profile.shape == "vGroove"
    said(scene, *words)


@pytest.mark.parametrize(
    ("body", "children", "words"),
    [
        ("float scratch:layer:fine:width = -1", VEE, "/mat layer 'fine': width is -1"),
        ("float scratch:layer:fine:depth = nan", VEE, "/mat layer 'fine': depth is nan"),
        ("float scratch:layer:fine:coverage = 2", VEE, "/mat layer 'fine': coverage is 2"),
        ("float2 scratch:layer:fine:offset = (nan, 0)", VEE, "/mat layer 'fine': offset is nan"),
        ("float2 scratch:layer:fine:center = (0, inf)", VEE, "/mat layer 'fine': center is inf"),
        ("float scratch:layer:fine:crossAngle = nan", VEE, "/mat layer 'fine': crossAngle in radians is nan"),
        ("float scratch:layer:fine:angleSpread = inf", VEE, "/mat layer 'fine': angleSpread in radians is inf"),
        ("uniform int scratch:layer:fine:patterns = 0", VEE, "/mat layer 'fine': patterns is 0"),
        ("uniform int scratch:layer:fine:seed = -1", VEE, "/mat layer 'fine': seed is -1"),
        ("color3f scratch:layer:fine:diffuseColor = (nan, 0, 0)", VEE, "/mat layer 'fine': diffuseColor is nan"),
        ('uniform token scratch:layer:fine:distribution = "spots"', VEE, "/mat layer 'fine': distribution is 'spots'"),
        ("", 'def ScratchProfile "Vee" { uniform token scratch:shape = "W" }', "/mat/Vee: scratch:shape is 'W'"),
        (
            "",
            'def ScratchProfile "Vee" {\nuniform token scratch:shape = "points"\n'
            "float2[] scratch:points = [(0, 0), (nan, 0)] }",
            r"/mat/Vee: scratch:points\[1, 0\] is nan",
        ),
    ],
)
def test_impossible_values_name_the_prim_and_the_value(read, body, children, words):
    with pytest.raises(StageError, match=words):
        read(scratched(PROFILE + body, children=children))


def test_scratches_never_reflect_more_than_all(read, said):
    scene = read(scratched(PROFILE + "color3f scratch:layer:fine:diffuseColor = (2, 0.5, -1)\n", children=VEE))
    assert layer(scene).diffuse_color == (1.0, 0.5, 0.0)
    said(scene, "/mat layer 'fine'", "diffuseColor is (2.0, 0.5, -1.0)", "[0, 1]")


@pytest.mark.parametrize("body", ["float scratch:layer:fine:width = 0", "float scratch:layer:fine:density = 1e9"])
def test_extreme_values_are_read(read, body):
    assert layer(read(scratched(PROFILE + body, children=VEE)))


def test_missing_st_and_unit_warn_where_scratches_depend_on_them(write, said):
    from scratchwarp import stage

    path = write(scratched(PROFILE, children=VEE, mesh=""))
    scene = stage.read(path)
    said(scene, "/m", "no primvars:st", "fallback tangent")
    path.write_text(path.read_text().replace("metersPerUnit = 1", ""))
    said(stage.read(path.rename(path.with_name("other.usda"))), "metersPerUnit is not authored")
    tangents = 'float3[] primvars:tangents = [(1, 0, 0)] ( interpolation = "constant" )\n'
    assert not any(
        "tangent" in w
        for w in stage.read(write(scratched(PROFILE, children=VEE, mesh=tangents), name="t.usda")).warnings
    )
    in_uv = scratched(PROFILE + 'uniform token scratch:layer:fine:space = "uv"', children=VEE, mesh="")
    said(stage.read(write(in_uv, name="uv.usda")), "/m", "uv space")


def test_layers_come_through_references_and_variants(read, write):
    write(scratched(PROFILE, children=VEE), name="asset.usda")
    scene = read(
        """
def "there" (
    prepend references = @asset.usda@</mat>
    variants = { string look = "deep" }
    prepend variantSets = "look"
) {
    variantSet "look" = {
        "deep" { float scratch:layer:fine:depth = 4 }
    }
}
def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {
    rel material:binding = </there>
    QUAD
}""".replace("QUAD", QUAD + ST)
    )
    assert layer(scene).depth == 4 and layer(scene).profile.path == "/there/Vee"


def test_what_has_no_room_yet_warns(read, said):
    scene = read(scratched(PROFILE, ("ScratchLayerAPI:fine", "ScratchMeasuredAPI"), VEE))
    said(scene, "/mat:", "ScratchMeasuredAPI")


def test_waves(read, said):
    body = """
    float scratch:wave:coherenceRadius = 30
    uniform int scratch:wave:samples = 8
    uniform float2 scratch:wave:wavelengthRange = (400, 700)
    uniform float[] scratch:wave:ior:wavelengths = [400, 700]
    uniform float[] scratch:wave:ior:eta = [1, 2]
    uniform float[] scratch:wave:ior:k = [3, 4]
"""
    wave = read(scratched(body, ("ScratchWaveAPI",))).materials[0].wave
    assert (wave.coherence_radius, wave.samples, wave.wavelength_range) == (30, 8, (400, 700))
    assert (wave.phase, wave.summation, wave.sampling, wave.roughness) == ("smallAngle", "incoherent", "auto", 0)
    np.testing.assert_allclose(wave.ior, [[400, 1, 3], [700, 2, 4]])
    uneven = read(scratched(body.replace("[3, 4]", "[3]"), ("ScratchWaveAPI",)))
    assert uneven.materials[0].wave.ior is None
    said(uneven, "/mat", "differ in length")
    assert read(scratched("")).materials[0].wave is None
