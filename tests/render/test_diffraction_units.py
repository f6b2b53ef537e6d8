"""The same scratches described in other units and far from the origin make the same picture."""

import numpy as np
import pytest
from pxr import Usd, UsdGeom

import scratchwarp as sw
from scratchwarp.pipelines.author_demo import author

from .test_diffraction import COMPILED

STAGE = """#usda 1.0
(
    metersPerUnit = {unit}
    upAxis = "Y"
)
def Xform "World"
{{
    double3 xformOp:translate = ({far}, {far}, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]

    def Camera "camera"
    {{
        uniform token projection = "orthographic"
        float horizontalAperture = {aperture}
        float verticalAperture = {aperture}
        float2 clippingRange = ({near}, {limit})
        double3 xformOp:translate = (0, 0, {one})
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }}
    def Mesh "plane" (
        prepend apiSchemas = ["MaterialBindingAPI"]
    )
    {{
        uniform token subdivisionScheme = "none"
        point3f[] points = [(-{edge}, -{edge}, 0), ({edge}, -{edge}, 0), ({edge}, {edge}, 0), (-{edge}, {edge}, 0)]
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (
            interpolation = "vertex"
        )
        rel material:binding = </World/steel>
    }}
    def SphereLight "bulb"
    {{
        float inputs:radius = {bulb}
        float inputs:intensity = 40
        double3 xformOp:translate = ({across}, 0, {one})
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }}
    def BasisCurves "wear" (
        prepend apiSchemas = ["ScratchCurvesAPI"]
    )
    {{
        uniform token type = "linear"
        int[] curveVertexCounts = [2, 2]
        point3f[] points = [({wear}, -{edge}, 0), ({wear}, {edge}, 0), (0, -{wear}, 0), (0, {edge}, 0)]
        float[] primvars:scratch:width = [3] (
            interpolation = "constant"
        )
        float[] primvars:scratch:depth = [1.2] (
            interpolation = "constant"
        )
    }}
    def Material "steel" (
        prepend apiSchemas = ["ScratchWaveAPI", "ScratchLayerAPI:fine"]
    )
    {{
        token outputs:surface.connect = </World/steel/shader.outputs:surface>
        token scratch:layer:fine:distribution = "curves"
        rel scratch:layer:fine:curves = </World/wear>
        rel scratch:layer:fine:profile = </World/steel/box>
        float scratch:layer:fine:width = 3
        float scratch:layer:fine:depth = 1.2

        def ScratchProfile "box"
        {{
            uniform token scratch:shape = "rectangle"
        }}
        def Shader "shader"
        {{
            uniform token info:id = "UsdPreviewSurface"
            float inputs:metallic = 1
            float inputs:roughness = 0.4
            color3f inputs:diffuseColor = (0.9, 0.9, 0.9)
            token outputs:surface
        }}
    }}
}}
"""


def picture(folder, unit, far=0.0):
    """The film of the stage in units of ``unit`` metres, ``far`` metres from the origin."""
    lengths = {"far": far, "near": 0.1, "limit": 10.0, "one": 1.0, "edge": 0.01, "bulb": 0.02, "across": 0.4}
    lengths |= {"wear": 0.002}
    # an orthographic camera's aperture is in tenths of a unit
    text = STAGE.format(unit=unit, aperture=0.02 / unit * 10.0, **{k: v / unit for k, v in lengths.items()})
    path = folder / "stage.usda"
    path.write_text(text)
    scene = sw.read(path)
    asked = sw.Settings(width=24, height=24, spp=4, filter="box", effects=COMPILED)
    return sw.render(scene, sw.make_plan(scene, asked))


@pytest.mark.parametrize("unit, far", [(0.001, 0.0), (0.01, 0.0), (1.0, 10_000.0)])
def test_units_and_places(tmp_path, unit, far):
    """Stages hold points as float32, so that scratches of 1 cm move by 1e-9 m, and lights 1 m away by 1e-7 m: 1e-4 of
    the spread of the Gaussian."""
    there, here = picture(tmp_path, unit, far), picture(tmp_path, 1.0)
    assert here["scratches"].max() > 0.02 * here["base"].max()
    np.testing.assert_allclose(there["color"], here["color"], rtol=1e-3, atol=1e-4 * here["color"].max())


WRAPPER = """#usda 1.0
(
    metersPerUnit = {unit}
    upAxis = "{up}"
)
def Xform "Base"
{{
    double3 xformOp:translate = ({far}, {far}, 0)
    double3 xformOp:scale = ({scale}, {scale}, {scale})
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]

    def "World" (
        references = @{asset}@</World>
    )
    {{
        over "camera"
        {{
            float2 clippingRange = ({near}, {limit})
        }}
    }}
}}
"""


def test_spoon_in_any_unit_and_far_away(tmp_path):
    """The demo's spoon on stages in millimetres, centimetres and metres, the latter 10 km from the origin. Single
    samples at its outline may see past it: 99 % of the pixels the same within 1 %."""
    spoon = author(tmp_path, 0.05, ["spoon"])[0]
    stage = Usd.Stage.Open(str(spoon))
    own, up = UsdGeom.GetStageMetersPerUnit(stage), UsdGeom.GetStageUpAxis(stage)
    films = []
    for unit, far in ((1.0, 0.0), (0.001, 0.0), (0.01, 0.0), (1.0, 10_000.0)):
        place = {"far": far / unit, "near": 1e-3 / unit, "limit": 1e3 / unit, "scale": own / unit}
        path = tmp_path / "wrapped.usda"
        path.write_text(WRAPPER.format(unit=unit, up=up, asset=spoon.name, **place))
        scene = sw.read(path)
        films.append(sw.render(scene, sw.make_plan(scene, sw.Settings(width=40, height=24, spp=2, filter="box"))))
    here = films[0]
    assert (here["scratches"].sum(-1) > 0.0).mean() > 0.1
    for there in films[1:]:
        apart = np.abs(there["color"] - here["color"]).max(-1)
        assert (apart <= 1e-2 * here["color"].max(-1) + 1e-4 * here["color"].max()).mean() >= 0.99
