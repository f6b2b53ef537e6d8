"""Shading normals of a control cage, and directions for normals that have none."""

import numpy as np

from .primvar import Corners
from .vectors import cross, lengths, unit


def facets(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Unit normals of triangles that have an area, shape [m, 3]."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return unit(cross(b - a, c - a))[0]


def smooth(points: np.ndarray, corners: Corners) -> np.ndarray:
    """Vertex normals at the corners of each triangle, shape [m, 3, 3], float32.

    Facet normals weighted by the angle at the vertex, so that how a face is cut into triangles does not matter
    (Thuermer and Wuethrich 1998, "Computing vertex normals from polygonal facets").
    """
    triangles = corners.points
    facet = facets(points, triangles)
    p = [points[triangles[:, i]] for i in range(3)]
    edges = [p[(i + 1) % 3] - p[i] for i in range(3)]
    sizes = [lengths(e) for e in edges]
    total = np.zeros((len(points), 3))
    for i in range(3):
        before, after = edges[i - 1], edges[i]
        cosine = -np.einsum("ij,ij->i", before, after) / (sizes[i - 1] * sizes[i])
        angle = np.arccos(np.clip(cosine, -1.0, 1.0))
        for k in range(3):
            total[:, k] += np.bincount(triangles[:, i], angle * facet[:, k], minlength=len(points))
    return filled(unit(total)[0].astype(np.float32)[triangles], points, triangles)


def filled(normals: np.ndarray, points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Unit normals [m, 3, 3], those without a direction replaced by their facet's own."""
    good = np.einsum("mci,mci->mc", normals, normals) > 0.5
    if good.all():
        return normals
    return np.where(good[..., None], normals, facets(points, triangles)[:, None, :]).astype(np.float32)
