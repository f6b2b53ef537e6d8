"""Primvars of a mesh, spread over the corners of its triangles."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from pxr import Sdf, Usd, UsdGeom

from .reading import Reading

Convert = Callable[[np.ndarray], np.ndarray]

UV_TYPES = (
    Sdf.ValueTypeNames.TexCoord2fArray,
    Sdf.ValueTypeNames.TexCoord2dArray,
    Sdf.ValueTypeNames.TexCoord2hArray,
    Sdf.ValueTypeNames.Float2Array,
)


@dataclass(frozen=True, eq=False)
class Corners:
    """Where the corners of a mesh's triangles lie in the mesh's arrays.

    Attributes:
        positions: in faceVertexIndices, shape [m, 3]; points: in points, shape [m, 3]; faces: source face, shape [m].
        corner_count, point_count, face_count: lengths that faceVarying, vertex and uniform values must have.
    """

    positions: np.ndarray
    points: np.ndarray
    faces: np.ndarray
    corner_count: int
    point_count: int
    face_count: int

    def lookup(self, interpolation: str) -> tuple[np.ndarray, int]:
        """(element of each corner, broadcastable to [m, 3]; how many elements there must be)."""
        if interpolation == UsdGeom.Tokens.faceVarying:
            return self.positions, self.corner_count
        if interpolation in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying):
            return self.points, self.point_count
        if interpolation == UsdGeom.Tokens.uniform:
            return self.faces[:, None], self.face_count
        return np.zeros((1, 1), np.int64), 1


def spread(
    reading: Reading,
    attribute: Usd.Attribute,
    corners: Corners,
    width: int,
    interpolation: str,
    indices: np.ndarray | None = None,
    convert: Convert | None = None,
) -> np.ndarray | None:
    """An attribute's values of ``width`` components at the corners of each triangle, shape [m, 3, width].

    ``indices``: index of each element's value; None: the values themselves. ``convert`` is applied to the values before
    they are spread. Returns None when there is no value; also, with a warning, when it has the wrong size or is not
    finite.
    """
    got = attribute.Get(reading.time)
    if got is None:
        return None
    values = np.asarray(got)
    if values.dtype.kind not in "fiu":
        reading.warn(attribute.GetPath(), "holds no numbers; it is ignored")
        return None
    if values.ndim < 2:  # one value, or an array of numbers
        alone = values.ndim == 0 or type(got).__name__.startswith("Vec")
        values = values.reshape(1, -1) if alone else values.reshape(-1, 1)
    values = values[:, :width]
    element, wanted = corners.lookup(interpolation)
    given = len(values) if indices is None else len(indices)
    fault = ""
    if not len(values) or values.shape[1] < width:
        fault = "is empty; it is ignored"
    elif not np.isfinite(values).all():
        fault = "holds values that are not finite; it is ignored"
    elif given < wanted or (given > wanted and wanted > 1):
        fault = f"has {given} values, expected {wanted} ({interpolation}); it is ignored"
    elif indices is not None and (indices.min() < 0 or indices.max() >= len(values)):
        fault = f"has indices outside 0..{len(values) - 1}; it is ignored"
    if fault:
        reading.warn(attribute.GetPath(), fault)
        return None
    if indices is not None:
        element = indices[element]
    if convert is not None:
        values = convert(values)
    return np.broadcast_to(values[element], (*corners.positions.shape, width))


def read_primvar(
    reading: Reading, primvar: UsdGeom.Primvar, corners: Corners, width: int, convert: Convert | None = None
) -> np.ndarray | None:
    """``spread`` for a primvar, indexed or not."""
    indices = np.asarray(primvar.GetIndices(reading.time), np.int64) if primvar.IsIndexed() else None
    if indices is not None and not len(indices):
        indices = None
    return spread(reading, primvar.GetAttr(), corners, width, primvar.GetInterpolation(), indices, convert)


def uv_primvars(api: UsdGeom.PrimvarsAPI) -> list[UsdGeom.Primvar]:
    """The primvars that can be uv sets, the prim's own and inherited ones."""
    return [p for p in api.FindPrimvarsWithInheritance() if p.GetTypeName() in UV_TYPES]
