"""Shading normals: the authored ones, or smooth ones of a control cage."""

import numpy as np

from .primvar import Corners


def normalized(vectors: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """Unit vectors [..., 3], float32; those of no length become ``otherwise``."""
    lengths = np.sqrt(np.einsum("...i,...i->...", vectors, vectors))[..., None]
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = vectors / lengths
    return np.where(lengths > 1e-20, unit, otherwise).astype(np.float32)


def facets(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Unit normals of triangles, shape [m, 3]; (0, 0, 1) where there is no area."""
    p = points[triangles]
    a, b = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    cross = np.stack(
        [
            a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1],
            a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2],
            a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0],
        ],
        axis=1,
    )
    return normalized(cross, np.array([0.0, 0.0, 1.0]))


def smooth(points: np.ndarray, corners: Corners) -> np.ndarray:
    """Vertex normals at the corners of each triangle, shape [m, 3, 3], float32.

    Facet normals weighted by the angle at the vertex, so that how a face is cut into triangles does not matter
    (Thuermer and Wuethrich 1998, "Computing vertex normals from polygonal facets").
    """
    triangles = corners.points
    facet = facets(points, triangles)
    p = points[triangles]
    total = np.zeros((len(points), 3))
    for i in range(3):
        a, b = p[:, (i + 1) % 3] - p[:, i], p[:, (i + 2) % 3] - p[:, i]
        length = np.sqrt(np.einsum("ij,ij->i", a, a) * np.einsum("ij,ij->i", b, b))
        cosine = np.einsum("ij,ij->i", a, b) / np.maximum(length, 1e-300)
        angle = np.arccos(np.clip(cosine, -1.0, 1.0))
        for k in range(3):
            total[:, k] += np.bincount(triangles[:, i], angle * facet[:, k], minlength=len(points))
    at_corners = total[triangles]
    return normalized(at_corners, np.broadcast_to(facet[:, None, :], at_corners.shape))
