"""Textures that material inputs read: wraps, transforms, colour spaces, missing files, packages."""

import zipfile

import numpy as np
from pxr import UsdUtils

from scratchwarp import stage

from .test_material import PREVIEW, bound, material

TEXTURED = (
    PREVIEW
    + """
        color3f inputs:diffuseColor.connect = </mat/t.outputs:rgb>
        float inputs:roughness.connect = </mat/t.outputs:g>
        normal3f inputs:normal.connect = </mat/n.outputs:rgb>
"""
)
NODES = """
    def Shader "t" {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @a.png@
        float2 inputs:st.connect = </mat/turn.outputs:result>
        float4 inputs:scale = (2, 3, 4, 5)
        float4 inputs:bias = (0.1, 0.2, 0.3, 0.4)
        token inputs:wrapS = "mirror"
        token inputs:wrapT = "clamp"
        token inputs:sourceColorSpace = "sRGB"
        float4 inputs:fallback = (0.25, 0.5, 0.75, 1)
        float3 outputs:rgb
        float outputs:g
    }
    def Shader "n" {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @n.png@
        token inputs:wrapS = "useMetadata"
        float3 outputs:rgb
        float2 inputs:st.connect = </mat/reader.outputs:result>
    }
    def Shader "turn" {
        uniform token info:id = "UsdTransform2d"
        float2 inputs:in.connect = </mat/again.outputs:result>
        float inputs:rotation = 90
        float2 inputs:scale = (2, 3)
        float2 inputs:translation = (0.5, 0.25)
        float2 outputs:result
    }
    def Shader "again" {
        uniform token info:id = "UsdTransform2d"
        float2 inputs:in.connect = </mat/reader.outputs:result>
        float2 inputs:translation = (1, 0)
        float2 outputs:result
    }
    def Shader "reader" {
        uniform token info:id = "UsdPrimvarReader_float2"
        string inputs:varname.connect = </mat.inputs:uvs>
        float2 outputs:result
    }
    token inputs:uvs = "st"
"""


def pixels(path, space):
    return np.full((2, 2, 4), 0.5, np.float32)


def test_texture_inputs(write, tmp_path):
    for name in ("a.png", "n.png"):
        (tmp_path / name).write_bytes(b"x")
    asked = []

    def load(path, space):
        asked.append((path.rpartition("/")[2], space))
        return pixels(path, space)

    scene = stage.read(write(bound(TEXTURED, NODES)), load_texture=load)
    surface = material(scene).surface
    color, rough, normal = surface.diffuse_color, surface.roughness, surface.normal
    assert (color.channel, rough.channel, normal.channel) == ("rgb", "g", "rgb")
    assert color.texture == rough.texture != normal.texture and len(scene.textures) == 2
    np.testing.assert_allclose(color.scale, [2, 3, 4, 5])
    np.testing.assert_allclose(color.bias, [0.1, 0.2, 0.3, 0.4], rtol=1e-6)
    assert (color.wrap_s, color.wrap_t) == ("mirror", "clamp")
    assert (normal.wrap_s, normal.wrap_t) == ("black", "repeat")
    # (u, v) = (0, 1): moved to (1, 1), scaled to (2, 3), turned by 90 degrees to (-3, 2), moved to (-2.5, 2.25).
    np.testing.assert_allclose(color.transform @ [0, 1, 1], [-2.5, 2.25], atol=1e-12)
    np.testing.assert_allclose(normal.transform, [[1, 0, 0], [0, 1, 0]])
    assert color.uv_set == "st"
    # An automatic normal map is raw, as the specification wants it.
    assert sorted(asked) == [("a.png", "sRGB"), ("n.png", "raw")]


def test_missing_textures_give_the_authored_fallback_else_the_default(write, said):
    scene = stage.read(write(bound(TEXTURED, NODES)), load_texture=pixels)
    surface = material(scene).surface
    assert surface.diffuse_color == (0.25, 0.5, 0.75) and surface.roughness == 0.5 and surface.normal is None
    said(scene, "/mat/t", "a.png")
    said(scene, "/mat/n", "n.png")


def test_textures_that_cannot_be_decoded_warn(write, tmp_path, said):
    (tmp_path / "a.png").write_bytes(b"x")

    def load(path, space):
        raise OSError(f"{path}: cannot be decoded")

    scene = stage.read(write(bound(TEXTURED, NODES)), load_texture=load)
    said(scene, "/mat/t", "a.png: cannot be decoded")
    assert material(scene).surface.diffuse_color == (0.25, 0.5, 0.75)


def test_colour_space_of_the_file_attribute_counts_when_automatic(write, tmp_path):
    (tmp_path / "a.png").write_bytes(b"x")
    asked = []

    def load(path, space):
        asked.append(space)
        return pixels(path, space)

    nodes = NODES.replace('token inputs:sourceColorSpace = "sRGB"', "").replace(
        "@a.png@", '@a.png@ ( colorSpace = "lin_ap1_scene" )'
    )
    stage.read(write(bound(TEXTURED, nodes)), load_texture=load)
    assert asked == ["lin_ap1_scene"]


def test_textures_inside_a_package(write, tmp_path):
    (tmp_path / "a.png").write_bytes(b"the pixels")
    path = write(bound(TEXTURED, NODES.replace("n.png", "a.png")))
    package = tmp_path / "all.usdz"
    assert UsdUtils.CreateNewUsdzPackage(str(path), str(package))
    assert "stage.usda" in zipfile.ZipFile(package).namelist()
    found = []

    def load(file, space):
        found.append(open(file, "rb").read())
        return pixels(file, space)

    scene = stage.read(package, load_texture=load)
    # Once as colour, once raw for the normal map.
    assert found == [b"the pixels"] * 2 and len(scene.textures) == 2


def test_a_uv_set_that_the_mesh_lacks_warns(write, tmp_path, said):
    (tmp_path / "a.png").write_bytes(b"x")
    nodes = NODES.replace('inputs:uvs = "st"', 'inputs:uvs = "map2"')
    scene = stage.read(write(bound(TEXTURED, nodes)), load_texture=pixels)
    said(scene, "/m", "primvars:map2")
    assert material(scene).surface.diffuse_color.uv_set == "map2"
