"""Meshes and where they stand."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from .checks import freeze, put


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles in object space, wound counter-clockwise seen from outside.

    Attributes:
        path: prim path, for messages.
        points: object-space positions, shape [n, 3], in units that ``Instance.transform`` turns into metres.
        triangles: point indices, shape [m, 3], int32.
        normals: shading normals of each triangle corner, object space, shape [m, 3, 3]; None: the facet's own.
        uvs: name of a uv set -> coordinates of each triangle corner, shape [m, 3, 2], v up.
        tangents: ``primvars:tangents`` of each triangle corner, object space, shape [m, 3, 3]; None: from the uv set.
        colors: display colour of each triangle corner, linear Rec.709, shape [m, 3, 3]; None: not authored.
        slots: index into ``Instance.materials`` of each triangle, shape [m], int32.
        faces: source face of each triangle, shape [m], int32.
        double_sided: the prim's doubleSided attribute.
        primvars: name of a primvar that scratch layers read -> its values at each triangle corner, shape [m, 3, 1 to
            3].
    """

    path: str
    points: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray | None = None
    uvs: Mapping[str, np.ndarray] = field(default_factory=dict)
    tangents: np.ndarray | None = None
    colors: np.ndarray | None = None
    slots: np.ndarray | None = None
    faces: np.ndarray | None = None
    double_sided: bool = False
    primvars: Mapping[str, np.ndarray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        points = freeze(self.path, "points", self.points, (None, 3))
        triangles = freeze(self.path, "triangles", self.triangles, (None, 3), np.int32)
        m = len(triangles)
        if m and (triangles.min() < 0 or triangles.max() >= len(points)):
            raise ValueError(f"{self.path}: triangles index points outside 0..{len(points) - 1}")
        slots = np.zeros(m, np.int32) if self.slots is None else self.slots
        faces = np.arange(m, dtype=np.int32) if self.faces is None else self.faces
        put(
            self,
            points=points,
            triangles=triangles,
            slots=freeze(self.path, "slots", slots, (m,), np.int32),
            faces=freeze(self.path, "faces", faces, (m,), np.int32),
            primvars=MappingProxyType(
                {k: freeze(self.path, f"primvars[{k}]", v, (m, 3, None)) for k, v in self.primvars.items()}
            ),
            uvs=MappingProxyType({k: freeze(self.path, f"uvs[{k}]", v, (m, 3, 2)) for k, v in self.uvs.items()}),
        )
        for name in ("normals", "tangents", "colors"):
            value = getattr(self, name)
            if value is not None:
                put(self, **{name: freeze(self.path, name, value, (m, 3, 3), np.float32)})


@dataclass(frozen=True, eq=False)
class Instance:
    """A mesh placed in the world.

    Attributes:
        path: prim path of this placement (an instance proxy's path for instanced prims).
        mesh: index into ``Scene.meshes``.
        transform: object to world metres relative to ``Scene.origin``, shape [4, 4], column vectors: p' = M p.
        materials: for each slot of the mesh, an index into ``Scene.materials``.
        light: index into ``Scene.lights`` of the MeshLight that this geometry emits as; -1: none.
    """

    path: str
    mesh: int
    transform: np.ndarray
    materials: tuple[int, ...]
    light: int = -1

    def __post_init__(self) -> None:
        put(self, transform=freeze(self.path, "transform", self.transform, (4, 4)), materials=tuple(self.materials))
        if not self.materials:
            raise ValueError(f"{self.path}: materials is empty; give one material index for each slot")
