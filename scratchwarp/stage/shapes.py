"""UsdGeom's intrinsic shapes (sphere, cube, plane, cylinder, cone, capsule) as meshes."""

from collections.abc import Callable

import numpy as np
from pxr import Usd, UsdGeom

from scratchwarp.scene import Mesh

from .color import color
from .reading import Reading
from .vectors import cross, lengths, unit

TURNS = 128  # segments around an axis
ARC = 64  # segments of a half circle

Profile = list[tuple[np.ndarray, np.ndarray]]
"""Pieces of an outline to turn about Z, from the top down: points (r, z) [n, 2] and their normals [n, 2]."""


def read_shape(reading: Reading, prim: Usd.Prim) -> Mesh | None:
    """Read an intrinsic shape in object space; None, with a warning, when its size is not positive."""
    sizes = {name: reading.number(prim, name, 1.0) for name in _SIZES if prim.GetAttribute(name)}
    points, triangles, normals = BUILDERS[str(prim.GetTypeName())](sizes)
    may_vanish = ("radiusTop", "radiusBottom")
    if not len(triangles) or any(size < 0 or (size == 0 and name not in may_vanish) for name, size in sizes.items()):
        given = ", ".join(f"{name} {size:g}" for name, size in sizes.items())
        reading.warn(prim.GetPath(), f"its size is not positive ({given}); it is left out")
        return None
    turn = _TURNED.get(str(reading.value(prim, "axis", "Z")), np.eye(3))
    points = points @ turn.T
    normals = None if normals is None else normals @ turn.T
    if reading.value(prim, "orientation", "rightHanded") == UsdGeom.Tokens.leftHanded:
        triangles = triangles[:, ::-1]
        normals = None if normals is None else normals[:, ::-1]
    return Mesh(
        path=str(prim.GetPath()),
        points=points,
        triangles=triangles,
        normals=normals,
        colors=_colors(reading, prim, len(triangles)),
        double_sided=bool(reading.value(prim, "doubleSided", False)),
    )


Built = tuple[np.ndarray, np.ndarray, np.ndarray | None]
# Rotations of Z to the prim's axis; a plane's width then lies along Z and X, its length along Y and Z.
_TURNED = {
    "X": np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]),
    "Y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
}
_SIZES = ("radius", "height", "size", "width", "length", "radiusTop", "radiusBottom")


def sphere(sizes: dict[str, float]) -> Built:
    """A sphere of ``radius``."""
    return _revolve([_arc(sizes["radius"], 0.0, 0.0, np.pi)])


def cube(sizes: dict[str, float]) -> Built:
    """A cube of edge ``size``."""
    points = (np.stack(np.meshgrid(*[[-0.5, 0.5]] * 3, indexing="ij"), axis=-1)).reshape(-1, 3) * sizes["size"]
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    return points, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]), None


def plane(sizes: dict[str, float]) -> Built:
    """A rectangle across Z, ``width`` along X and ``length`` along Y."""
    x, y = sizes["width"] / 2, sizes["length"] / 2
    return np.array([[-x, -y, 0], [x, -y, 0], [x, y, 0], [-x, y, 0]]), np.array([[0, 1, 2], [0, 2, 3]]), None


def cylinder(sizes: dict[str, float]) -> Built:
    """A cylinder with caps, or a frustum where ``radiusTop`` and ``radiusBottom`` are given."""
    top = sizes.get("radiusTop", sizes.get("radius", 1.0))
    bottom = sizes.get("radiusBottom", sizes.get("radius", 1.0))
    half = sizes["height"] / 2
    return _revolve(
        [_line((0, half), (top, half)), _line((top, half), (bottom, -half)), _line((bottom, -half), (0, -half))]
    )


def cone(sizes: dict[str, float]) -> Built:
    """A cone with its base, the tip at the top."""
    radius, half = sizes["radius"], sizes["height"] / 2
    return _revolve([_line((0, half), (radius, -half)), _line((radius, -half), (0, -half))])


def capsule(sizes: dict[str, float]) -> Built:
    """A cylinder of ``height`` between two half spheres."""
    top = sizes.get("radiusTop", sizes.get("radius", 1.0))
    bottom = sizes.get("radiusBottom", sizes.get("radius", 1.0))
    half = sizes["height"] / 2
    pieces = [_arc(top, half, 0.0, np.pi / 2), _line((top, half), (bottom, -half))]
    return _revolve([*pieces, _arc(bottom, -half, np.pi / 2, np.pi)])


BUILDERS: dict[str, Callable[[dict[str, float]], Built]] = {
    "Sphere": sphere,
    "Cube": cube,
    "Plane": plane,
    "Cylinder": cylinder,
    "Cylinder_1": cylinder,
    "Cone": cone,
    "Capsule": capsule,
    "Capsule_1": capsule,
}
"""Type name of an intrinsic shape -> what makes its (points, triangles, corner normals or None for facets)."""


def _arc(radius: float, height: float, first: float, last: float) -> tuple[np.ndarray, np.ndarray]:
    steps = max(2, round(ARC * (last - first) / np.pi)) + 1
    polar = np.linspace(first, last, steps)
    normals = np.stack([np.sin(polar), np.cos(polar)], axis=1)
    normals[np.abs(normals) < 1e-15] = 0.0
    return normals * radius + (0.0, height), normals


def _line(start: tuple[float, float], end: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    points = np.array([start, end], float)
    along = points[1] - points[0]
    normal = np.array([-along[1], along[0]]) / max(float(np.hypot(*along)), 1e-300)
    return points, np.stack([normal, normal])


def _revolve(profile: Profile) -> Built:
    turn = np.arange(TURNS) * (2 * np.pi / TURNS)
    around = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    points: list[np.ndarray] = []
    triangles: list[np.ndarray] = []
    normals: list[np.ndarray] = []
    count = 0
    for outline, directions in profile:
        rings = len(outline)
        ring = np.concatenate(
            [outline[:, None, :1] * around, np.broadcast_to(outline[:, None, 1:], (rings, TURNS, 1))], axis=2
        )
        way = np.concatenate(
            [directions[:, None, :1] * around, np.broadcast_to(directions[:, None, 1:], (rings, TURNS, 1))], axis=2
        )
        row, column = np.divmod(np.arange((rings - 1) * TURNS), TURNS)
        a, b = row * TURNS + column, row * TURNS + (column + 1) % TURNS
        c, d = a + TURNS, b + TURNS
        made = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
        p = ring.reshape(-1, 3)[made]
        made = made[lengths(cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])) > 1e-14 * np.abs(outline).max() ** 2]
        points.append(ring.reshape(-1, 3))
        triangles.append(made + count)
        normals.append(way.reshape(-1, 3)[made])
        count += rings * TURNS
    return np.concatenate(points), np.concatenate(triangles), unit(np.concatenate(normals))[0]


def _colors(reading: Reading, prim: Usd.Prim, count: int) -> np.ndarray | None:
    primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayColor")
    got = primvar.Get(reading.time) if primvar and primvar.HasValue() else None
    if got is None:
        return None
    values = np.asarray(got)
    values = values[None] if type(got).__name__.startswith("Vec3") and values.shape == (3,) else values
    if not values.size:
        return None
    if values.dtype.kind not in "fiu" or values.ndim != 2 or values.shape[1] < 3 or not np.isfinite(values).all():
        reading.warn(primvar.GetAttr().GetPath(), "holds no colours; it is ignored")
        return None
    if len(values) > 1:
        reading.warn(primvar.GetAttr().GetPath(), "has more than one value; the first colours the whole shape")
    first = color(reading, primvar.GetAttr(), values[0, :3].astype(np.float64))
    return np.broadcast_to(first, (count, 3, 3))
