"""The meshes of a stage, each read once, and where they are placed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from pxr import Usd, UsdGeom

from scratchwarp.scene import Mesh

from .mesh import read_mesh
from .primvar import uv_primvars
from .reading import Reading, shared_path
from .shapes import BUILDERS, read_shape
from .traverse import Placed

READERS: dict[str, Callable[[Reading, Usd.Prim], Mesh | None]] = {
    "Mesh": read_mesh,
    **dict.fromkeys(BUILDERS, read_shape),
}
"""Type name of a geometric prim -> its reader."""

_INHERITED = ("displayColor", "tangents")


@dataclass(frozen=True, eq=False)
class Geometry:
    """Meshes in object space and their placements: (placed prim, index of its mesh)."""

    meshes: list[Mesh]
    placements: list[tuple[Placed, int]]

    def bounds(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Lower and upper corner of everything in world space [scene units]; None where there is nothing."""
        if not self.placements:
            return None
        corners = np.array(
            [np.stack(np.meshgrid(*_box(m).T, indexing="ij"), axis=-1).reshape(-1, 3) for m in self.meshes]
        )
        worlds = np.array([placed.world for placed, _ in self.placements])
        every = np.einsum("pij,pcj->pci", worlds[:, :3, :3], corners[[i for _, i in self.placements]])
        every += worlds[:, None, :3, 3]
        return every.min((0, 1)), every.max((0, 1))


def _box(mesh: Mesh) -> np.ndarray:
    """Corners [2, 3] of the box about the points that triangles use."""
    used = np.zeros(len(mesh.points), bool)
    used[mesh.triangles.ravel()] = True
    points = mesh.points[used]
    return np.array([points.min(0), points.max(0)])


def read_geometry(reading: Reading, places: Sequence[Placed]) -> Geometry:
    """Read the geometric prims among ``places``; instances of one prototype share a mesh.

    Types that cannot be rendered are left out with a warning.
    """
    found = Geometry([], [])
    known: dict[tuple[str, ...], int | None] = {}
    for placed in places:
        prim = placed.prim
        if not placed.included or not prim.IsA(UsdGeom.Gprim):
            continue
        reader = READERS.get(str(prim.GetTypeName()))
        if reader is None:
            if "ScratchCurvesAPI" not in prim.GetAppliedSchemas():
                reading.warn(prim.GetPath(), f"geometry of type {prim.GetTypeName()} is not rendered")
            continue
        key = _key(reading, prim)
        if key not in known:
            mesh = reader(reading, prim)
            known[key] = None if mesh is None else len(found.meshes)
            if mesh is not None:
                found.meshes.append(mesh)
        index = known[key]
        if index is not None:
            found.placements.append((placed, index))
    return found


def _key(reading: Reading, prim: Usd.Prim) -> tuple[str, ...]:
    """What a prim's mesh depends on: the prim (of the prototype) and inherited primvars from outside the prototype."""
    if not prim.IsInstanceProxy():
        return (str(prim.GetPath()),)
    api = UsdGeom.PrimvarsAPI(prim)
    names = (*_INHERITED, *sorted(reading.primvars))
    inherited = [api.FindPrimvarWithInheritance(name) for name in names] + uv_primvars(api)
    owners = [p.GetAttr() for p in inherited if p and p.HasValue()]
    outside = [str(a.GetPath()) for a in owners if not a.GetPrim().IsInstanceProxy()]
    return (shared_path(prim), *outside)
