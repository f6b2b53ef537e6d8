"""What it takes to read scratches and to cut them to triangles: part ``build`` of ``diffraction.py``."""

import resource
import tempfile
import time
from pathlib import Path

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux, UsdShade, Vt

import scratchwarp as sw
from scratchwarp.kernels import assemble, kernel_key
from scratchwarp.kernels.parts import Parts
from scratchwarp.pipelines.author_demo import author


def peak():
    """Greatest memory that this process has taken so far [GB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9


def many_curves(path, count, length=0.002, sides=64):
    """A stage of ``count`` two-point scratches at random in uv on a square, all on one BasisCurves prim."""
    rng = np.random.default_rng(3)
    side = 0.02 * np.sqrt(count / 1000.0)
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.Xform.Define(stage, "/World")
    t = np.linspace(-0.5, 0.5, sides + 1)
    x, y = np.meshgrid(t, t)
    a = (np.arange(sides)[:, None] * (sides + 1) + np.arange(sides)).ravel()
    quads = np.stack([a, a + 1, a + sides + 2, a + sides + 1], 1)
    mesh = UsdGeom.Mesh.Define(stage, "/World/plane")
    points = np.stack([x, y, 0.0 * x], axis=-1).reshape(-1, 3) * side
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
    mesh.CreateFaceVertexCountsAttr(np.full(len(quads), 4).tolist())
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(quads.ravel().astype(np.int32)))
    mesh.CreateSubdivisionSchemeAttr("none")
    st = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, "vertex")
    st.Set(Vt.Vec2fArray.FromNumpy((np.stack([x, y], -1).reshape(-1, 2) + 0.5).astype(np.float32)))
    turn = rng.uniform(0, np.pi, count)
    half = 0.5 * length * np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    middle = np.concatenate([rng.uniform(-0.5, 0.5, (count, 2)) * side, np.zeros((count, 1))], axis=1)
    ends = np.stack([middle - half, middle + half], axis=1).reshape(-1, 3)
    curves = UsdGeom.BasisCurves.Define(stage, "/World/wear")
    curves.GetPrim().ApplyAPI("ScratchCurvesAPI")
    curves.CreateTypeAttr("linear")
    curves.CreateCurveVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(count, 2, np.int32)))
    curves.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(ends.astype(np.float32)))
    for name in ("width", "depth"):
        own = UsdGeom.PrimvarsAPI(curves).CreatePrimvar(f"scratch:{name}", Sdf.ValueTypeNames.FloatArray, "uniform")
        own.Set(Vt.FloatArray.FromNumpy(rng.uniform(0.8, 6.0, count).astype(np.float32)))
    material = UsdShade.Material.Define(stage, "/World/steel")
    prim = material.GetPrim()
    prim.ApplyAPI("ScratchWaveAPI")
    prim.ApplyAPI("ScratchLayerAPI", "wear")
    prim.CreateAttribute("scratch:layer:wear:distribution", Sdf.ValueTypeNames.Token).Set("curves")
    prim.CreateRelationship("scratch:layer:wear:curves").SetTargets(["/World/wear"])
    box = stage.DefinePrim("/World/steel/box", "ScratchProfile")
    box.CreateAttribute("scratch:shape", Sdf.ValueTypeNames.Token).Set("rectangle")
    prim.CreateRelationship("scratch:layer:wear:profile").SetTargets([box.GetPath()])
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
    light = UsdLux.SphereLight.Define(stage, "/World/bulb")
    light.CreateRadiusAttr(0.005)
    UsdGeom.XformCommonAPI(light).SetTranslate(Gf.Vec3d(0.1, 0.05, 1.0))
    camera = UsdGeom.Camera.Define(stage, "/World/camera")
    UsdGeom.XformCommonAPI(camera).SetTranslate(Gf.Vec3d(0, 0, 1.0))
    stage.Save()
    return path


def built(scene):
    """(pieces, bytes of one, seconds of cutting, all seconds of building) of what diffracts."""
    plan = sw.make_plan(scene, sw.Settings(width=16, height=16, spp=1))
    parts = Parts()
    assemble(scene, plan, (), parts=parts)  # compiles what cuts
    parts = Parts()
    start = time.perf_counter()
    made = assemble(scene, plan, (), parts=parts)
    seconds = time.perf_counter() - start
    arrays = made.inputs[3].glints
    assert kernel_key(scene, plan).glint_segments
    return arrays.segments.shape[0], arrays.segments.strides[0], parts.seconds["glints"], seconds


def part_build(repeats):
    """Reading and cutting."""
    with tempfile.TemporaryDirectory() as folder:
        spoon = sw.read(author(folder, names=["spoon"])[0])
        pieces, size, cut, whole = built(spoon)
        print(f"spoon: {pieces} pieces of {size} bytes, cut in {cut:.2f} s, all built in {whole:.2f} s")
        path = many_curves(Path(folder) / "curves.usdc", 1_000_000)
        start = time.perf_counter()
        scene = sw.read(path)
        read = time.perf_counter() - start
        pieces, size, cut, whole = built(scene)
        print(
            f"1,000,000 two-point curves: read in {read:.1f} s, {pieces} pieces cut in {cut:.1f} s, all built in "
            f"{whole:.1f} s; at most {peak():.1f} GB"
        )
        del scene
        # as many pieces a scratch as the spoon has
        path = many_curves(Path(folder) / "long.usdc", 200_000, 0.02, 256)
        scene = sw.read(path)
        pieces, size, cut, whole = built(scene)
        print(f"200,000 scratches: {pieces} pieces, cut in {cut:.1f} s, all built in {whole:.1f} s; {peak():.1f} GB")
