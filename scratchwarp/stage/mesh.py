"""UsdGeomMesh to Mesh: topology, normals, uv sets, tangents, colours and material slots."""

import numpy as np
from pxr import Usd, UsdGeom, UsdShade

from scratchwarp.scene import Mesh, StageError

from .color import color
from .normals import filled, smooth
from .primvar import Corners, read_primvar, spread, uv_primvars
from .reading import Reading
from .triangulate import triangulate
from .vectors import unit

UV_SET = "st"
SUBDIVIDED = "subdivision surface; its control cage is rendered with smooth normals"


def read_mesh(reading: Reading, prim: Usd.Prim) -> Mesh | None:
    """Read a UsdGeomMesh in object space; None, with a warning, when nothing of it can be rendered.

    Slot 0 is the mesh's own material, slot i the i-th of ``material_subsets``. Raises StageError on a point that is not
    finite.
    """
    mesh = UsdGeom.Mesh(prim)
    path = str(prim.GetPath())
    points = reading.numbers(mesh.GetPointsAttr(), 3)
    counts = reading.numbers(mesh.GetFaceVertexCountsAttr(), whole=True)
    indices = reading.numbers(mesh.GetFaceVertexIndicesAttr(), whole=True)
    if not len(points) or not len(counts):
        reading.warn(path, "the mesh has no faces; it is left out")
        return None
    if counts.min() < 0 or counts.sum() != len(indices):
        reading.warn(
            path,
            f"faceVertexCounts add up to {counts.sum()}, faceVertexIndices has {len(indices)}; the mesh is left out",
        )
        return None
    if len(indices) and (indices.min() < 0 or indices.max() >= len(points)):
        reading.warn(path, f"faceVertexIndices point outside 0..{len(points) - 1}; the mesh is left out")
        return None
    _check_points(path, points)
    # points and corners with normals, tangents, uvs and colours, in float64, and their like on the way there
    said = f"a mesh of {len(points)} points and {len(indices)} corners"
    reading.budget.take(24.0 * len(points) + 400.0 * len(indices), f"{reading.path}: {path}", said)

    faces = _faces(reading, mesh, counts)
    cut = triangulate(points, counts, indices, faces)
    if len(cut.degenerate):
        reading.warn(path, "faces without area are left out")
    if not len(cut.corners):
        reading.warn(path, "no face of the mesh has an area; it is left out")
        return None
    positions = cut.corners
    if reading.value(prim, "orientation", "rightHanded") == UsdGeom.Tokens.leftHanded:
        positions = positions[:, ::-1]
    corners = Corners(positions, indices[positions], cut.faces, len(indices), len(points), len(counts))

    api = UsdGeom.PrimvarsAPI(prim)
    _complain(reading, prim, api)
    return Mesh(
        path=path,
        points=points,
        triangles=corners.points,
        normals=_normals(reading, mesh, points, corners),
        uvs=_uvs(reading, api, path, corners),
        tangents=_tangents(reading, api, corners),
        colors=_colors(reading, api, corners),
        slots=_slots(reading, prim, corners),
        faces=corners.faces,
        primvars=_layer_primvars(reading, api, corners),
        double_sided=bool(reading.value(prim, "doubleSided", False)),
    )


def material_subsets(prim: Usd.Prim) -> list[UsdGeom.Subset]:
    """The prim's face subsets that bind materials, in order."""
    if not prim.IsA(UsdGeom.Imageable):
        return []
    return [
        s
        for s in UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets()
        if s.GetElementTypeAttr().Get() == UsdGeom.Tokens.face
    ]


def _complain(reading: Reading, prim: Usd.Prim, api: UsdGeom.PrimvarsAPI) -> None:
    if "SkelBindingAPI" in prim.GetAppliedSchemas():
        reading.warn(prim.GetPath(), "skinning and blend shapes are not honoured; its rest shape is rendered")
    opacity = api.FindPrimvarWithInheritance("displayOpacity")
    got = opacity.Get(reading.time) if opacity and opacity.HasValue() else None
    if got is not None and len(got) and min(got) < 1:
        reading.warn(prim.GetPath(), "displayOpacity is not honoured; it is rendered opaque")


def _check_points(path: str, points: np.ndarray) -> None:
    finite = np.isfinite(points).all(1)
    if not finite.all():
        first = int(np.argmin(finite))
        raise StageError(f"{path}: points[{first}] is {tuple(points[first].tolist())}; every coordinate must be finite")


def _faces(reading: Reading, mesh: UsdGeom.Mesh, counts: np.ndarray) -> np.ndarray:
    """Faces to render: neither holes nor with fewer than three corners."""
    keep = counts >= 3
    path = mesh.GetPath()
    if not keep.all():
        reading.warn(path, "faces with fewer than three corners are left out")
    holes = reading.numbers(mesh.GetHoleIndicesAttr(), whole=True)
    inside = (holes >= 0) & (holes < len(counts))
    if not inside.all():
        reading.warn(path, f"holeIndices point outside 0..{len(counts) - 1}; those are ignored")
    keep[holes[inside]] = False
    return np.flatnonzero(keep)


def _normals(reading: Reading, mesh: UsdGeom.Mesh, points: np.ndarray, corners: Corners) -> np.ndarray | None:
    """Authored normals of a polygonal mesh; smooth ones of a subdivision cage; None: the facets' own."""
    if reading.value(mesh.GetPrim(), "subdivisionScheme", "catmullClark") != UsdGeom.Tokens.none:
        reading.warn(mesh.GetPath(), SUBDIVIDED)
        return smooth(points, corners)
    primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
    if primvar and primvar.HasValue():
        values = read_primvar(reading, primvar, corners, 3, _directions)
    else:
        how = mesh.GetNormalsInterpolation()
        values = spread(reading, mesh.GetNormalsAttr(), corners, 3, how, convert=_directions)
    return None if values is None else filled(values, points, corners.points)


def _directions(vectors: np.ndarray) -> np.ndarray:
    return unit(vectors)[0].astype(np.float32)


def _uvs(reading: Reading, api: UsdGeom.PrimvarsAPI, path: str, corners: Corners) -> dict[str, np.ndarray]:
    """Every uv set by name; where none is called st, the first stands in for it."""
    found = {}
    for primvar in uv_primvars(api):
        values = read_primvar(reading, primvar, corners, 2)
        if values is not None:
            found[str(primvar.GetPrimvarName())] = values
    if found and UV_SET not in found:
        first = next(iter(found))
        reading.warn(path, f"has no primvars:{UV_SET}; primvars:{first} is used in its place")
        found[UV_SET] = found[first]
    return found


def _tangents(reading: Reading, api: UsdGeom.PrimvarsAPI, corners: Corners) -> np.ndarray | None:
    primvar = api.FindPrimvarWithInheritance("tangents")
    return read_primvar(reading, primvar, corners, 3) if primvar and primvar.HasValue() else None


def _colors(reading: Reading, api: UsdGeom.PrimvarsAPI, corners: Corners) -> np.ndarray | None:
    primvar = api.FindPrimvarWithInheritance("displayColor")
    if not (primvar and primvar.HasValue()):
        return None
    return read_primvar(reading, primvar, corners, 3, lambda values: color(reading, primvar.GetAttr(), values))


def _layer_primvars(reading: Reading, api: UsdGeom.PrimvarsAPI, corners: Corners) -> dict[str, np.ndarray]:
    """The primvars that scratch layers read, with one to three components."""
    found = {}
    for name in sorted(reading.primvars):
        primvar = api.FindPrimvarWithInheritance(name)
        if primvar and primvar.HasValue():
            one = primvar.GetTypeName().scalarType.defaultValue
            values = read_primvar(reading, primvar, corners, min(len(one), 3) if hasattr(one, "__len__") else 1)
            if values is not None:
                found[name] = values
    return found


def _slots(reading: Reading, prim: Usd.Prim, corners: Corners) -> np.ndarray:
    slots = np.zeros(corners.face_count, np.int32)
    for slot, subset in enumerate(material_subsets(prim), start=1):
        faces = reading.numbers(subset.GetIndicesAttr(), whole=True)
        inside = (faces >= 0) & (faces < corners.face_count)
        if not inside.all():
            reading.warn(subset.GetPath(), f"indices point outside 0..{corners.face_count - 1}; those are ignored")
        slots[faces[inside]] = slot
    return slots[corners.faces]
