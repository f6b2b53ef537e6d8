"""How the demo stages are written: meshes, materials, scratch layers, lights, camera and render settings through USD.

The layout is that of a small asset: /World (component) with the Scopes geo, mtl, lights and scratches, the camera
/World/camera, and /Render/settings.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from pxr import Gf, Kind, Sdf, Usd, UsdGeom, UsdLux, UsdRender, UsdShade, Vt

from scratchwarp import usd_schemas
from scratchwarp.stage.overlay import save_layer

from .demo_shapes import Shape

Vector = Sequence[float]


def new_stage(meters_per_unit: float = 0.01, up: str = "Y") -> Usd.Stage:
    """An empty stage in memory with the layout above; the schemas are registered first."""
    usd_schemas.register()
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(stage, meters_per_unit)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y if up == "Y" else UsdGeom.Tokens.z)
    world = UsdGeom.Xform.Define(stage, "/World")
    Usd.ModelAPI(world.GetPrim()).SetKind(Kind.Tokens.component)
    stage.SetDefaultPrim(world.GetPrim())
    for name in ("geo", "mtl", "lights"):
        UsdGeom.Scope.Define(stage, f"/World/{name}")
    return stage


def save(stage: Usd.Stage, path: Path | str, comment: str) -> Path:
    """Write the stage to ``path``, whole or not at all; a copy of the file that is open in this process follows."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    stage.GetRootLayer().comment = f"{comment} Written by scratchwarp.pipelines.author_demo."
    save_layer(stage.GetRootLayer(), path)
    return path


def mesh(
    stage: Usd.Stage, name: str, shape: Shape, material: UsdShade.Material, move: Vector | None = None
) -> UsdGeom.Mesh:
    """/World/geo/<name>, bound to ``material``; ``move``: a translation, 16 numbers of a matrix (row vectors), None."""
    prim = UsdGeom.Mesh.Define(stage, f"/World/geo/{name}")
    points = np.round(shape.points, 6).astype(np.float32)
    prim.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
    prim.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(shape.counts.astype(np.int32)))
    prim.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(shape.indices.astype(np.int32)))
    prim.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(np.round(shape.normals, 5).astype(np.float32)))
    prim.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
    prim.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    prim.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(np.stack([points.min(0), points.max(0)])))
    st = UsdGeom.PrimvarsAPI(prim).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex)
    st.Set(Vt.Vec2fArray.FromNumpy(np.round(shape.uv, 6).astype(np.float32)))
    bind(prim.GetPrim(), material)
    if move is not None:
        place(prim, move)
    return prim


def bind(prim: Usd.Prim, material: UsdShade.Material) -> None:
    """Bind ``material`` for all purposes."""
    UsdShade.MaterialBindingAPI.Apply(prim).Bind(material)


def place(prim: UsdGeom.Xformable, move: Vector) -> None:
    """Give the prim a translation (3 numbers) or a matrix (16 numbers, row vectors as USD has it)."""
    if len(move) == 3:
        prim.AddTranslateOp().Set(Gf.Vec3d(*map(float, move)))
    else:
        prim.AddTransformOp().Set(Gf.Matrix4d(*map(float, move)))


def looking(eye: Vector, target: Vector, up: Vector = (0.0, 1.0, 0.0)) -> list[float]:
    """The 16 numbers that put a camera or a light at ``eye`` with its -Z towards ``target``."""
    back = np.subtract(eye, target).astype(float)
    back /= np.linalg.norm(back)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    rows = np.zeros((4, 4))
    rows[0, :3], rows[1, :3], rows[2, :3], rows[3, :3], rows[3, 3] = right, np.cross(back, right), back, eye, 1
    return [float(f"{x:.7g}") for x in rows.ravel()]


def material(stage: Usd.Stage, name: str, surface: dict[str, Any] | None = None, **inputs: Any) -> UsdShade.Material:
    """/World/mtl/<name> with a UsdPreviewSurface of the given inputs, as every other program shows it.

    ``surface``: inputs of a ScratchSurface for this renderer (``{"metal": "copper", "roughness": 0.05}``); None: the
    UsdPreviewSurface serves here, too.
    """
    prim = UsdShade.Material.Define(stage, f"/World/mtl/{name}")
    preview = UsdShade.Shader.Define(stage, f"/World/mtl/{name}/preview")
    preview.CreateIdAttr("UsdPreviewSurface")
    kinds = {"diffuseColor": Sdf.ValueTypeNames.Color3f, "specularColor": Sdf.ValueTypeNames.Color3f}
    for key, value in inputs.items():
        preview.CreateInput(key, kinds.get(key, Sdf.ValueTypeNames.Float)).Set(_value(value))
    prim.CreateSurfaceOutput().ConnectToSource(preview.CreateOutput("surface", Sdf.ValueTypeNames.Token))
    if surface is not None:
        node = UsdShade.Shader.Define(stage, f"/World/mtl/{name}/measured")
        node.CreateIdAttr("ScratchSurface")
        for key, value in surface.items():
            kind = Sdf.ValueTypeNames.Token if isinstance(value, str) else Sdf.ValueTypeNames.Float
            node.CreateInput(key, Sdf.ValueTypeNames.Color3f if isinstance(value, tuple) else kind).Set(_value(value))
        prim.CreateSurfaceOutput("scratchwarp").ConnectToSource(node.CreateOutput("surface", Sdf.ValueTypeNames.Token))
    return prim


def profile(owner: UsdShade.Material, name: str, **values: Any) -> Sdf.Path:
    """A ScratchProfile inside the material; ``shape``, ``points``, ``rim``, ... as in the schema."""
    prim = owner.GetPrim().GetStage().DefinePrim(owner.GetPath().AppendChild(name), "ScratchProfile")
    for key, value in values.items():
        _set(prim, f"scratch:{key}", value)
    return prim.GetPath()


def round_in_facets(owner: UsdShade.Material, name: str, facets: int = 8) -> Sdf.Path:
    """A round ScratchProfile of so many flat facets: each is looked at on its own where grooves cross."""
    turn = np.linspace(0.0, np.pi, facets + 1)
    points = [(float(0.5 - 0.5 * np.cos(t)), -float(np.sin(t))) for t in turn[1:-1]]
    return profile(owner, name, shape="points", points=[(0.0, 0.0), *points, (1.0, 0.0)])


def layer(
    owner: UsdShade.Material, name: str, profile: Sdf.Path | None = None, curves: Sdf.Path | None = None, **values: Any
) -> None:
    """Apply ScratchLayerAPI:<name> and set its attributes (micrometres and degrees, as the schema has them)."""
    prim = owner.GetPrim()
    prim.ApplyAPI("ScratchLayerAPI", name)
    for key, value in values.items():
        _set(prim, f"scratch:layer:{name}:{key}", value)
    for key, target in (("profile", profile), ("curves", curves)):
        if target is not None:
            prim.GetRelationship(f"scratch:layer:{name}:{key}").SetTargets([target])


def wave(owner: UsdShade.Material, **values: Any) -> None:
    """Apply ScratchWaveAPI: the material's scratches diffract; attributes under scratch:wave:."""
    owner.GetPrim().ApplyAPI("ScratchWaveAPI")
    for key, value in values.items():
        _set(owner.GetPrim(), f"scratch:wave:{key}", value)


def curves(
    stage: Usd.Stage,
    name: str,
    lines: Sequence[np.ndarray],
    width: float | np.ndarray,
    depth: float | np.ndarray,
    space: str,
    move: Vector | None = None,
) -> Sdf.Path:
    """Explicit scratches: polylines [n, 3] on one BasisCurves prim; ``width``, ``depth`` in micrometres, one for all or
    one for each line.

    ``space`` object: points lie on the surface, in the stage's units; uv: points are (u, v, 0).
    """
    UsdGeom.Scope.Define(stage, "/World/scratches")
    prim = UsdGeom.BasisCurves.Define(stage, f"/World/scratches/{name}")
    points = np.round(np.concatenate(lines), 6).astype(np.float32)
    prim.CreateTypeAttr(UsdGeom.Tokens.linear)
    prim.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
    prim.CreateCurveVertexCountsAttr(Vt.IntArray([len(line) for line in lines]))
    units = np.atleast_1d(width) * 1e-6 / UsdGeom.GetStageMetersPerUnit(stage)
    prim.CreateWidthsAttr(Vt.FloatArray.FromNumpy(units.astype(np.float32)))
    prim.SetWidthsInterpolation(UsdGeom.Tokens.constant if len(units) == 1 else UsdGeom.Tokens.uniform)
    low, high = points.min(0) - units.max() / 2, points.max(0) + units.max() / 2
    prim.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(np.stack([low, high]).astype(np.float32)))
    prim.GetPrim().ApplyAPI("ScratchCurvesAPI")
    _set(prim.GetPrim(), "scratch:curves:space", space)
    primvars = UsdGeom.PrimvarsAPI(prim)
    for key, values in (("width", np.atleast_1d(width)), ("depth", np.atleast_1d(depth))):
        varies = UsdGeom.Tokens.constant if len(values) == 1 else UsdGeom.Tokens.uniform
        primvar = primvars.CreatePrimvar(f"scratch:{key}", Sdf.ValueTypeNames.FloatArray, varies)
        primvar.Set(Vt.FloatArray.FromNumpy(np.asarray(values, np.float32)))
    if move is not None:
        place(prim, move)
    if space == "uv":
        prim.CreatePurposeAttr(UsdGeom.Tokens.guide)  # not where the scratches are: nobody else should draw them
    return prim.GetPath()


def camera(stage: Usd.Stage, eye: Vector, target: Vector, up: Vector = (0.0, 1.0, 0.0), lens: float = 50.0) -> None:
    """/World/camera: a 24 x 18 mm gate with a lens of ``lens`` millimetres, whatever the stage's unit."""
    prim = UsdGeom.Camera.Define(stage, "/World/camera")
    place(prim, looking(eye, target, up))
    tenth = 0.01 / UsdGeom.GetStageMetersPerUnit(stage)  # millimetres to tenths of a unit
    prim.CreateFocalLengthAttr(lens * tenth)
    prim.CreateHorizontalApertureAttr(24.0 * tenth)
    prim.CreateVerticalApertureAttr(18.0 * tenth)
    distance = float(np.linalg.norm(np.subtract(eye, target)))
    prim.CreateFocusDistanceAttr(distance)
    prim.CreateClippingRangeAttr(Gf.Vec2f(distance / 100, distance * 100))


def settings(stage: Usd.Stage, width: int = 640, height: int = 480, **values: Any) -> None:
    """/Render/settings, found through the stage's metadata; ``values``: attributes under scratch:render:."""
    UsdGeom.Scope.Define(stage, "/Render")
    prim = UsdRender.Settings.Define(stage, "/Render/settings")
    prim.CreateResolutionAttr(Gf.Vec2i(width, height))
    prim.CreateCameraRel().SetTargets([Sdf.Path("/World/camera")])
    stage.SetMetadata("renderSettingsPrimPath", "/Render/settings")
    for key, value in values.items():
        _set(prim.GetPrim(), f"scratch:render:{key}", value)


def sphere_light(
    stage: Usd.Stage, name: str, at: Vector, radius: float, radiance: float, color: Vector = (1, 1, 1)
) -> None:
    """A small bright ball of light: what makes scratches glint."""
    prim = UsdLux.SphereLight.Define(stage, f"/World/lights/{name}")
    prim.CreateRadiusAttr(float(radius))
    prim.CreateExtentAttr(Vt.Vec3fArray([Gf.Vec3f(-radius), Gf.Vec3f(radius)]))
    _light(prim, radiance, color, at)


def rect_light(
    stage: Usd.Stage,
    name: str,
    at: Vector,
    target: Vector,
    size: tuple[float, float],
    radiance: float,
    color: Vector = (1, 1, 1),
    up: Vector = (0.0, 1.0, 0.0),
) -> None:
    """A soft panel that shines from ``at`` towards ``target``."""
    prim = UsdLux.RectLight.Define(stage, f"/World/lights/{name}")
    prim.CreateWidthAttr(float(size[0]))
    prim.CreateHeightAttr(float(size[1]))
    half = Gf.Vec3f(size[0] / 2, size[1] / 2, 0)
    prim.CreateExtentAttr(Vt.Vec3fArray([-half, half]))
    _light(prim, radiance, color, looking(at, target, up))


def mesh_light(
    stage: Usd.Stage, name: str, shape: Shape, move: Vector, radiance: float, color: Vector = (1, 1, 1)
) -> None:
    """A mesh that shines from its outside: /World/lights/<name>."""
    black = material(stage, name, diffuseColor=(0.0, 0.0, 0.0), roughness=1.0)
    prim = mesh(stage, name, shape, black, move)
    api = UsdLux.MeshLightAPI.Apply(prim.GetPrim())
    light = UsdLux.LightAPI(api)
    light.CreateIntensityAttr(float(radiance))
    light.CreateColorAttr(Gf.Vec3f(*map(float, color)))


def distant_light(
    stage: Usd.Stage,
    name: str,
    towards: Vector,
    angle: float,
    irradiance: float,
    color: Vector = (1, 1, 1),
    up: Vector = (0.0, 1.0, 0.0),
) -> None:
    """A sun: ``irradiance`` at normal incidence whatever its angular diameter ``angle`` (degrees)."""
    prim = UsdLux.DistantLight.Define(stage, f"/World/lights/{name}")
    prim.CreateAngleAttr(float(angle))
    prim.CreateNormalizeAttr(True)
    _light(prim, irradiance, color, looking((0, 0, 0), towards, up))


def dome_light(stage: Usd.Stage, name: str, radiance: float, color: Vector = (1, 1, 1)) -> None:
    """Even light from all around."""
    _light(UsdLux.DomeLight.Define(stage, f"/World/lights/{name}"), radiance, color, None)


def _light(prim: Any, intensity: float, color: Vector, move: Vector | None) -> None:
    prim.CreateIntensityAttr(float(intensity))
    prim.CreateColorAttr(Gf.Vec3f(*map(float, color)))
    if move is not None:
        place(prim, move)


def _set(prim: Usd.Prim, name: str, value: Any) -> None:
    """Set an attribute of the schema; ValueError when the schema has none of this name."""
    attribute = prim.GetAttribute(name)
    if not attribute.IsDefined():
        raise ValueError(f"{prim.GetPath()}: the schema has no attribute {name!r}; see usd_schemas/schema.usda")
    if not attribute.Set(_value(value)):
        raise ValueError(f"{prim.GetPath()}: {name} does not take {value!r}")


def _value(value: Any) -> Any:
    """Tuples of three as vectors, pairs and lists of pairs as float2, lists of strings as they are; all else, too."""
    if isinstance(value, tuple):
        return Gf.Vec3f(*value) if len(value) == 3 else Gf.Vec2f(*value)
    if isinstance(value, list) and all(isinstance(one, str) for one in value):
        return Vt.StringArray(value)
    if isinstance(value, list):
        return Vt.Vec2fArray([Gf.Vec2f(*map(float, pair)) for pair in value])
    return value
