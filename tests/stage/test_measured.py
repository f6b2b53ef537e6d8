"""ScratchMeasuredAPI and scratch normal maps, from a stage to records."""

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdGeom, UsdShade

import scratchwarp as sw
from scratchwarp import image, measured, usd_schemas
from scratchwarp.scene import StageError
from scratchwarp.stage.validation import validate


@pytest.fixture
def material(tmp_path):
    usd_schemas.register()
    stage = Usd.Stage.CreateNew(str(tmp_path / "a.usda"))
    mesh = UsdGeom.Mesh.Define(stage, "/Mesh")
    mesh.CreatePointsAttr([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    mesh.CreateFaceVertexCountsAttr([3])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2])
    prim = UsdShade.Material.Define(stage, "/Mat").GetPrim()
    shader = UsdShade.Shader.Define(stage, "/Mat/s")
    shader.CreateIdAttr("UsdPreviewSurface")
    UsdShade.Material(prim).CreateSurfaceOutput().ConnectToSource(
        shader.CreateOutput("surface", Sdf.ValueTypeNames.Token)
    )
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(UsdShade.Material(prim))
    UsdGeom.Camera.Define(stage, "/Cam")
    yield prim
    del stage


def read(prim):
    prim.GetStage().Save()
    return sw.read(prim.GetStage().GetRootLayer().realPath)


def modes(prim, **values):
    prim.ApplyAPI("ScratchMeasuredAPI")
    base = {"azimuth": [30.0], "width": [0.4], "a": [0.9], "b": [0.02], "kd": [0.05], "ks": [0.4], "alpha": [9.0]}
    for name, value in {**base, "color": [(1, 0.5, 0.2)], **values}.items():
        prim.GetAttribute(f"scratch:measured:modes:{name}").Set(value)
    prim.GetAttribute("scratch:measured:background").Set((0.2, 0.2, 0.2))


def test_stencils_become_the_base(material):
    modes(material)
    scene = read(material)
    record = scene.materials[0].measured
    assert record.azimuth == pytest.approx([np.pi / 6]) and record.background == pytest.approx(0.2)
    np.testing.assert_allclose(record.color, [(1, 0.5, 0.2)], rtol=1e-6)
    plan = sw.make_plan(scene)
    assert plan.on("base.stencils") and plan.effects["base.stencils"].prims == ("/Mat",) and plan.bases == (0,)
    assert not plan.on("base.preview") and plan.on("base.direction")
    off = sw.make_plan(scene, sw.Settings(effects={"base.stencils": False}))
    assert off.bases == (-1,) and off.on("base.preview") and off.responses == ()
    assert not any("ScratchMeasured" in w for w in scene.warnings)


def test_what_is_wrong_is_said(material):
    modes(material, b=[0.1, 0.2])
    with pytest.raises(StageError, match=r"/Mat.*modes:b"):
        read(material)
    modes(material, azimuth=[], b=[])
    scene = read(material)
    assert scene.materials[0].measured is None and any("/Mat" in w and "modes" in w for w in scene.warnings)
    modes(material, width=[2.0])
    with pytest.raises(ValueError, match=r"/Mat.*width"):
        sw.make_plan(read(material))


def test_normal_maps(material, tmp_path):
    n = np.zeros((4, 4, 3), np.float32)
    n[..., 2] = 1.0
    image.write_layers({"color": 0.5 * n + 0.5}, tmp_path / "n.exr", {})
    material.ApplyAPI("ScratchLayerAPI", "fine")
    for name, value in {"model": "normalMap", "normalRepeats": (3, 2), "normalDeformation": "none"}.items():
        material.GetAttribute(f"scratch:layer:fine:{name}").Set(value)
    material.GetAttribute("scratch:layer:fine:normalTexture").Set(Sdf.AssetPath("n.exr"))
    scene = read(material)
    record = scene.materials[0].layers[0].normal_map
    assert record.repeats == (3.0, 2.0) and record.deformation == "none" and record.facets == "ashikhminShirley"
    np.testing.assert_allclose(scene.textures[record.texture].pixels[..., 2], 1.0)
    plan = sw.make_plan(scene)
    assert plan.on("scratches.normalMap") and plan.on("scratches.full") and plan.tables == () and not plan.warnings
    material.GetAttribute("scratch:layer:fine:model").Set("table")
    unread = read(material)
    assert unread.textures == () and any("normalTexture" in w and "fine" in w for w in unread.warnings)
    material.GetAttribute("scratch:layer:fine:model").Set("normalMap")
    material.GetAttribute("scratch:layer:fine:normalTexture").Clear()
    bare = sw.make_plan(read(material))
    assert not bare.on("scratches.normalMap") and len(bare.tables) == 1
    assert any("normalTexture" in w for w in bare.warnings)
    found = [f for f in validate(material.GetStage().GetRootLayer().realPath) if "normalTexture" in f.message]
    assert [(f.severity, f.rule) for f in found] == [("error", "scratchwarp:ScratchSizes")]


def test_files_become_the_base(material, tmp_path):
    directions = np.linspace(0.0, 1.0, 288)
    measured.save_utia(tmp_path / "m.bin", 0.1 + 0.1 * np.repeat((directions[:, None] * directions)[..., None], 3, -1))
    material.ApplyAPI("ScratchMeasuredAPI")
    material.GetAttribute("scratch:measured:source").Set("file")
    material.GetAttribute("scratch:measured:file").Set(Sdf.AssetPath("m.bin"))
    plan = sw.make_plan(read(material))
    assert plan.on("base.utia") and not plan.on("base.stencils") and plan.responses[0].users == ("/Mat",)
    assert all(0.2 < c < 0.8 for c in plan.responses[0].albedo)
    material.GetAttribute("scratch:measured:format").Set("merl")
    with pytest.raises(ValueError, match=r"/Mat: .*m\.bin"):
        sw.make_plan(read(material))
    material.GetAttribute("scratch:measured:file").Set(Sdf.AssetPath("none.bin"))
    scene = read(material)
    assert scene.materials[0].measured is None and any("none.bin" in w for w in scene.warnings)
