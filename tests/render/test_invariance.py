"""The same stage elsewhere, in other units, or standing on another axis, renders the same image.

The reader works in float64 and hands over metres relative to the camera. Moving a stage by 10 km shifts positions by
10^4 m * 2^-53 = 1e-12 m, which changes the rounding to float32 (6e-8 of a metre) of about one coordinate in 5e4; units
change them by 1e-16, so all bits stay but in rare pixels. Points that the file itself rounds to float32 (a floor of
4 / 0.3048 feet) move by 1e-7 of themselves and light with them by as much, 1e-6 of it, but for a sample that crosses
the edge of a scratch or a shadow: 1 / 32 of a pixel. So 98 % of the pixels agree within 1e-5 and relMSE is below 1e-5
(2e-15 measured; one such sample adds 1e-3 / 2304 = 4e-7).

Turned to stand on Z, the isotropic frames of sampling fall elsewhere: other samples, hence the same image within noise.
"""

import numpy as np
import pytest

import scratchwarp as sw

from . import scenes

SIZE, SPP = 48, 32
STAGE = """#usda 1.0
(
    metersPerUnit = {metres}
    upAxis = "{up}"
)
def Xform "World"
{{
    {root}
    def Sphere "ball" (prepend apiSchemas = ["MaterialBindingAPI"])
    {{
        double radius = {one}
        double3 xformOp:translate = (0, {one}, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        rel material:binding = </World/brushed>
    }}
    def Mesh "floor" (prepend apiSchemas = ["MaterialBindingAPI"])
    {{
        uniform token subdivisionScheme = "none"
        point3f[] points = [(-{four}, 0, {four}), ({four}, 0, {four}), ({four}, 0, -{four}), (-{four}, 0, -{four})]
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "vertex")
        rel material:binding = </World/brushed>
    }}
    def Camera "camera"
    {{
        float horizontalAperture = 20
        float verticalAperture = 20
        float focalLength = 40
        float2 clippingRange = {clip}
        double3 xformOp:translate = ({one}, {four}, {eight})
        double3 xformOp:rotateXYZ = (-23, 8, 0)
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ"]
    }}
    def RectLight "key"
    {{
        float inputs:width = {two}
        float inputs:height = {one}
        float inputs:intensity = 6
        double3 xformOp:translate = (-{two}, {four}, {two})
        double3 xformOp:rotateXYZ = (-55, -40, 0)
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ"]
    }}
    def DistantLight "sun"
    {{
        float inputs:intensity = 0.7
        float inputs:angle = 0
        double3 xformOp:rotateXYZ = (-60, 50, 0)
        uniform token[] xformOpOrder = ["xformOp:rotateXYZ"]
    }}
    def DomeLight "sky"
    {{
        float inputs:intensity = 0.3
    }}
    def Material "brushed" (prepend apiSchemas = ["ScratchLayerAPI:fine", "ScratchLayerAPI:deep"])
    {{
        token outputs:surface.connect = </World/brushed/node.outputs:surface>
        uniform token scratch:layer:fine:distribution = "worley"
        float scratch:layer:fine:width = 30
        float scratch:layer:fine:depth = 8
        float scratch:layer:fine:length = 20000
        float scratch:layer:fine:coverage = 0.4
        rel scratch:layer:fine:profile = </World/brushed/vee>
        uniform token scratch:layer:deep:distribution = "linear"
        float scratch:layer:deep:width = 4000
        float scratch:layer:deep:depth = 1000
        float scratch:layer:deep:pitch = 50000
        float scratch:layer:deep:angle = 35
        rel scratch:layer:deep:profile = </World/brushed/vee>
        def Shader "node"
        {{
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor = (0.6, 0.5, 0.4)
            float inputs:metallic = 1
            float inputs:roughness = 0.6
            token outputs:surface
        }}
        def ScratchProfile "vee"
        {{
            uniform token scratch:shape = "vGroove"
        }}
    }}
}}
"""


def ops(**values):
    lines = [f"double3 xformOp:{name} = {value}" for name, value in values.items()]
    order = ", ".join(f'"xformOp:{name}"' for name in values)
    return "\n    ".join([*lines, f"uniform token[] xformOpOrder = [{order}]"])


def image(folder, unit=1.0, metres=1.0, up="Y", root="", **settings):
    sizes = {name: f"{n * unit!r}" for name, n in (("one", 1), ("two", 2), ("four", 4), ("eight", 8))}
    sizes["clip"] = (1 / metres, 1000 / metres)  # always in the stage's units
    file = folder / "stage.usda"
    file.write_text(STAGE.format(metres=metres, up=up, root=root, **sizes))
    world = sw.read(file)
    assert not [w for w in world.warnings if "st" not in w], world.warnings
    return scenes.shoot(world, width=SIZE, height=SIZE, spp=SPP, **settings)


def relative_mse(a, b):
    a, b = a["color"].astype(float), b["color"].astype(float)
    return ((a - b) ** 2).mean() / (b.mean() ** 2)


# name -> how the stage is written
ELSEWHERE = {
    "10 km away": {"root": ops(translate=(7000, 1000, -7000))},
    "centimetres": {"unit": 100.0, "metres": 0.01},
    "millimetres by a scale": {"metres": 0.001, "root": ops(scale=(1000, 1000, 1000))},
    "feet, 10 km away": {"unit": 1 / 0.3048, "metres": 0.3048, "root": ops(translate=(-20000, 5000, 25000))},
}


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return image(tmp_path_factory.mktemp("plain"))


@pytest.mark.parametrize("name", ELSEWHERE)
def test_moved_and_scaled(tmp_path, plain, name):
    moved = image(tmp_path, **ELSEWHERE[name])
    near = np.isclose(moved["color"], plain["color"], rtol=1e-5).all(-1).mean()
    assert near > 0.98
    assert relative_mse(moved, plain) < 1e-5
    assert (moved["primId"] == plain["primId"]).mean() > 0.998
    if "feet" not in name:
        assert (moved["color"] == plain["color"]).all(-1).mean() > 0.99


def test_standing_on_z(tmp_path, plain):
    turned = image(tmp_path, up="Z", root=ops(rotateXYZ=(90, 0, 0)))
    variance = turned["variance"] + plain["variance"]
    assert (np.abs(turned["color"] - plain["color"]).max(-1) < 5 * np.sqrt(variance) + 1e-5).all()
    # a tenth of that noise in practice, for both sample in strata
    assert abs(turned["color"].mean() / plain["color"].mean() - 1) < 5e-3
    assert relative_mse(turned, plain) < 1e-3


def test_the_image_shows_what_is_moved(plain):
    assert plain["scratches"].mean() > 0.1 * plain["color"].mean()
    assert set(np.unique(plain["primId"])) == {-1, 0, 1}
