"""Stretched spheres and cylinders: their areas, and meshes that stand in for them."""

import numpy as np

from scratchwarp.scene import Mesh

_TURNS = 96  # segments around
_STACKS = 48  # from pole to pole


def ellipsoid_area(linear: np.ndarray) -> float:
    """Area of the unit sphere's image under a matrix [3, 3].

    The integral of |det A| |A^-T n| over the sphere: Gauss-Legendre in z, equal steps in azimuth; the error stays below
    1e-6 up to scales of 1:10.
    """
    scales = np.linalg.svd(linear, compute_uv=False)
    z, weights = np.polynomial.legendre.leggauss(64)
    turn = (np.arange(64) + 0.5) * (2 * np.pi / 64)
    ring = np.sqrt(1 - z * z)
    n = np.stack(np.broadcast_arrays(ring[:, None] * np.cos(turn), ring[:, None] * np.sin(turn), z[:, None]))
    cofactor = np.array([scales[1] * scales[2], scales[0] * scales[2], scales[0] * scales[1]])
    stretch = np.sqrt(((cofactor[:, None, None] * n) ** 2).sum(0))
    return float((weights[:, None] * stretch).sum() * 2 * np.pi / 64)


def cylinder_area(along: np.ndarray, y: np.ndarray, z: np.ndarray) -> float:
    """Area of the side of a tube with half-length vector ``along`` and half-axes ``y``, ``z``, each [3]."""
    turn = np.arange(256) * (2 * np.pi / 256)
    tangent = -np.sin(turn)[:, None] * y + np.cos(turn)[:, None] * z
    return float(np.linalg.norm(np.cross(2 * along, tangent), axis=1).mean() * 2 * np.pi)


def sphere_mesh(path: str, radius: float) -> Mesh:
    """A sphere of triangles about the origin with the area of the true one."""
    polar = np.arange(_STACKS + 1) * (np.pi / _STACKS)
    turn = np.arange(_TURNS) * (2 * np.pi / _TURNS)
    points = np.stack(
        np.broadcast_arrays(
            np.sin(polar)[:, None] * np.cos(turn), np.sin(polar)[:, None] * np.sin(turn), np.cos(polar)[:, None]
        ),
        axis=-1,
    ).reshape(-1, 3)
    triangles = _grid(_STACKS, _TURNS)
    p = points[triangles]
    areas = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2
    keep = areas > 1e-9
    size = radius * np.sqrt(4 * np.pi / areas.sum())
    return Mesh(path=path, points=points * size, triangles=triangles[keep])


def cylinder_mesh(path: str, length: float, radius: float) -> Mesh:
    """The side of a cylinder about the X axis, of triangles, with the area of the true one."""
    turn = np.arange(_TURNS) * (2 * np.pi / _TURNS)
    size = radius * (np.pi / _TURNS) / np.sin(np.pi / _TURNS)
    ring = np.stack([np.zeros(_TURNS), np.cos(turn) * size, np.sin(turn) * size], axis=1)
    half = np.array([length / 2, 0.0, 0.0])
    return Mesh(path=path, points=np.concatenate([ring + half, ring - half]), triangles=_grid(1, _TURNS))


def _grid(rows: int, columns: int) -> np.ndarray:
    """Triangles of a grid of (rows + 1) rings of ``columns`` points, wound outwards for rings that turn and descend."""
    row, column = np.divmod(np.arange(rows * columns), columns)
    a, b = row * columns + column, row * columns + (column + 1) % columns
    c, d = a + columns, b + columns
    return np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
