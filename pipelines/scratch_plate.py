"""The stage of ``scratch_map``: a metal plate with a normal map, for any renderer that knows UsdPreviewSurface; in
scratchwarp the facets follow the map (a layer of model normalMap)."""

import os
from pathlib import Path

from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, Vt

from scratchwarp import usd_schemas
from scratchwarp.whole import whole


def plate(path: Path, texture: Path, repeat: float = 1.0) -> Path:
    """Write a stage: a square metre of metal whose UsdPreviewSurface reads the normal map ``texture``, ``repeat`` times
    each way. OSError where it cannot be written."""
    usd_schemas.register()
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    root = UsdGeom.Xform.Define(stage, "/Scratched")
    stage.SetDefaultPrim(root.GetPrim())
    material = UsdShade.Material.Define(stage, "/Scratched/metal")
    surface = _shader(stage, "/Scratched/metal/surface", "UsdPreviewSurface")
    for key, value in (("metallic", 1.0), ("roughness", 0.2)):
        surface.CreateInput(key, Sdf.ValueTypeNames.Float).Set(value)
    surface.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(0.9, 0.9, 0.9))
    uv = _shader(stage, "/Scratched/metal/uv", "UsdPrimvarReader_float2")
    uv.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
    map_node = _shader(stage, "/Scratched/metal/scratches", "UsdUVTexture")
    relative = os.path.relpath(texture.resolve(), path.parent.resolve()).replace(os.sep, "/")
    file = relative if relative.startswith("../") else f"./{relative}"
    map_node.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(Sdf.AssetPath(file))
    map_node.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("raw")
    map_node.CreateInput("scale", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(2, 2, 2, 1))
    map_node.CreateInput("bias", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(-1, -1, -1, 0))
    for key in ("wrapS", "wrapT"):
        map_node.CreateInput(key, Sdf.ValueTypeNames.Token).Set("repeat")
    map_node.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(
        uv.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    )
    surface.CreateInput("normal", Sdf.ValueTypeNames.Normal3f).ConnectToSource(
        map_node.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)
    )
    material.CreateSurfaceOutput().ConnectToSource(surface.CreateOutput("surface", Sdf.ValueTypeNames.Token))

    material.GetPrim().ApplyAPI("ScratchLayerAPI", "map")
    material.GetPrim().GetAttribute("scratch:layer:map:model").Set("normalMap")
    material.GetPrim().GetAttribute("scratch:layer:map:normalTexture").Set(Sdf.AssetPath(file))

    mesh = UsdGeom.Mesh.Define(stage, "/Scratched/plate")
    corners = [(-0.5, -0.5, 0.0), (0.5, -0.5, 0.0), (0.5, 0.5, 0.0), (-0.5, 0.5, 0.0)]
    mesh.CreatePointsAttr(Vt.Vec3fArray([Gf.Vec3f(*corner) for corner in corners]))
    mesh.CreateFaceVertexCountsAttr([4])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2, 3])
    mesh.CreateNormalsAttr(Vt.Vec3fArray([Gf.Vec3f(0, 0, 1)] * 4))
    mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    mesh.CreateExtentAttr(Vt.Vec3fArray([Gf.Vec3f(*corners[0]), Gf.Vec3f(*corners[2])]))
    st = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex)
    st.Set(Vt.Vec2fArray([Gf.Vec2f(repeat * (x + 0.5), repeat * (y + 0.5)) for x, y, _ in corners]))
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
    stage.GetRootLayer().comment = "A scratched plate. Written by scratchwarp.pipelines.scratch_map."
    with whole(path) as draft:
        if not stage.GetRootLayer().Export(str(draft)):
            raise OSError(f"{path}: cannot be written")
    opened = Sdf.Layer.Find(str(path))
    if opened is not None:
        opened.Reload(force=True)
    return path


def _shader(stage: Usd.Stage, path: str, kind: str) -> UsdShade.Shader:
    shader = UsdShade.Shader.Define(stage, path)
    shader.CreateIdAttr(kind)
    return shader
