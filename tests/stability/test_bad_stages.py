"""Stages with a number that is none, and transforms that become singular over time: read to finite records, or refused
by one message that names the file and the prim."""

import re

import numpy as np
import pytest
from pxr import Gf, Sdf

import scratchwarp as sw
from scratchwarp.scene import StageError

from ..render import scenes
from . import stages
from .test_scenes import finite

PARTS = [*stages.GEOMETRY.values(), *stages.LIGHTS.values(), stages.CURVES, stages.CAMERA.replace("STOP", "2")]
BASE = stages.HEADER + "".join(PARTS).replace('Light "sky"', 'Light "sky1"', 1)
BASE += """
def Material "mat" (prepend apiSchemas = ["ScratchLayerAPI:fine", "ScratchWaveAPI"])
{
    token outputs:surface.connect = </mat/node.outputs:surface>
    float scratch:wave:coherenceRadius = 60
    float2 scratch:wave:wavelengthRange = (380, 780)
    float[] scratch:wave:ior:wavelengths = [400, 700]
    float[] scratch:wave:ior:eta = [1.1, 1.2]
    float[] scratch:wave:ior:k = [3, 4]
    uniform token scratch:layer:fine:distribution = "curves"
    rel scratch:layer:fine:profile = </mat/cut>
    rel scratch:layer:fine:curves = </lines>
    float scratch:layer:fine:width = 400
    float scratch:layer:fine:depth = 100
    float scratch:layer:fine:length = 9000
    float scratch:layer:fine:coverage = 0.1
    float scratch:layer:fine:density = 1
    float scratch:layer:fine:pitch = 900
    float scratch:layer:fine:angle = 3
    float scratch:layer:fine:curvature = 3
    float2 scratch:layer:fine:center = (0.5, 0.5)
    color3f scratch:layer:fine:eta = (1, 1, 1)
    color3f scratch:layer:fine:diffuseColor = (0.1, 0.1, 0.1)
    float scratch:layer:fine:ior = 1.5
    def ScratchProfile "cut"
    {
        uniform token scratch:shape = "points"
        float2[] scratch:points = [(0, 0), (0.5, -1), (1, 0)]
        float scratch:rim = 0.1
        float scratch:rimWidth = 0.2
    }
    def Shader "node"
    {
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor = (0.5, 0.5, 0.5)
        color3f inputs:emissiveColor = (0, 0, 0)
        float inputs:roughness = 0.3
        float inputs:metallic = 0.3
        float inputs:ior = 1.4
        float inputs:opacity = 1
        float inputs:opacityThreshold = 0
        token outputs:surface
    }
}
def Material "other"
{
    token outputs:scratchwarp:surface.connect = </other/node.outputs:surface>
    def Shader "node"
    {
        uniform token info:id = "ScratchSurface"
        color3f inputs:eta = (1, 1, 1)
        float inputs:roughness = 0.3
        float inputs:anisotropy = 0.3
        token outputs:surface
    }
}
"""


def numbers(layer):
    """Paths of the attributes of numbers."""
    found = []
    layer.Traverse("/", lambda path: found.append(path) if path.IsPropertyPath() else None)
    made = [layer.GetAttributeAtPath(p) for p in found if layer.GetAttributeAtPath(p)]
    kinds = ("float", "double", "half", "point", "normal", "vector", "color", "texCoord", "matrix")
    return [a for a in made if str(a.typeName).startswith(kinds) and a.default is not None]


def spoilt(value, bad):
    if isinstance(value, float):
        return bad
    if isinstance(value, Gf.Matrix4d):
        return Gf.Matrix4d(*[bad] * 16)
    kind, items = type(value), list(value)
    last = items[-1]
    items[-1] = bad if isinstance(last, float) else type(last)(*[bad] * len(last))
    return kind(items) if kind.__module__ == "pxr.Vt" else kind(*items)


@pytest.mark.parametrize("bad", [np.nan, -np.inf])
def test_any_number_may_be_none(tmp_path, bad):
    """One at a time: each attribute of a stage with one of nearly everything."""
    layer = Sdf.Layer.CreateAnonymous(".usda")
    assert layer.ImportFromString(BASE)
    refused = []
    for number, attribute in enumerate(numbers(layer)):
        good = attribute.default
        attribute.default = spoilt(good, float(bad))
        path = tmp_path / f"stage{number}.usda"
        layer.Export(str(path))
        attribute.default = good
        try:
            scene = sw.read(path)
        except StageError as error:
            refused.append(str(attribute.path))
            assert str(path) in str(error) or re.search(r"/\w+", str(error)), error
            assert str(attribute.path.GetPrimPath()).split("/")[1] in str(error), (attribute.path, str(error))
            continue
        for mesh in scene.meshes:
            assert np.isfinite(mesh.points).all() and all(np.isfinite(v).all() for v in mesh.uvs.values())
        assert all(np.isfinite(light.radiance).all() for light in scene.lights)
        assert np.isfinite(scene.camera.transform).all()
    assert len(refused) > 5


def test_transforms_over_time(tmp_path):
    """A cube that is squashed flat, mirrored and sheared, and gone, at the samples and between them."""
    path = tmp_path / "stage.usda"
    lights = stages.LIGHTS["sun"] + stages.LIGHTS["even sky"]
    path.write_text(stages.HEADER + stages.MOVING + lights + stages.CAMERA.replace("STOP", "0"))
    settings = sw.Settings(width=16, height=16, spp=4, filter="box", effects=scenes.EVERYTHING)
    seen = {}
    for frame in (1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 9.0):
        scene = sw.read(path, frame=frame)
        film = finite(sw.render(scene, sw.make_plan(scene, settings)))
        seen[frame] = int((film["primId"] >= 0).sum())
    assert seen[1.0] > 20 and seen[3.0] > 20 and seen[4.0] == seen[9.0] == 0
