"""Mean coverage of the stretched cellular noise, and the threshold that gives a coverage.

A point is covered when one of the jittered points lies within the radius of its scratch. Each cell's point is uniform
in the cell and independent of the others, so for a point x

    1 - coverage(x) = product over cells (1 - E_r area(cell inside the disk of radius r about x)),

averaged over x in one cell. The disk-in-square areas are one-dimensional integrals of a clipped chord.
"""

from functools import lru_cache

import numpy as np

MOST = 0.99999  # coverage that a threshold is looked for
MAX_RADIUS = 1.5  # beyond it every point of the plane is covered (largest distance to the nearest point is below it)


def _disk_in_cells(x: np.ndarray, y: np.ndarray, radius: float, nodes: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Area of a disk about each (x, y) in [0, 1]^2 inside the 25 cells around it, shape [25, n]."""
    areas = []
    for i in range(-2, 3):
        low = np.clip(i - x, -radius, radius)
        high = np.clip(i + 1 - x, -radius, radius)
        t = 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * nodes
        half = np.sqrt(np.maximum(radius * radius - t * t, 0.0))
        for j in range(-2, 3):
            bottom = np.clip((j - y)[:, None], -half, half)
            top = np.clip((j + 1 - y)[:, None], -half, half)
            areas.append(0.5 * (high - low) * ((top - bottom) @ weights))
    return np.array(areas)


@lru_cache(maxsize=4096)
def coverage(radius: float, variation: float = 0.0) -> float:
    """Mean covered fraction for threshold ``radius`` [cells], each scratch's own radius uniform in 1 -+ ``variation``.

    Quadrature error below 1e-4 (tests compare it with the device function over a large area).
    """
    if radius <= 0.0:
        return 0.0
    if radius * (1.0 - variation) >= MAX_RADIUS:
        return 1.0
    at, weight = np.polynomial.legendre.leggauss(8)
    x, y = (g.ravel() for g in np.meshgrid(0.25 + 0.25 * at, 0.25 + 0.25 * at))  # a quarter: the rest is symmetric
    over = np.outer(weight, weight).ravel() / 4.0
    nodes, weights = np.polynomial.legendre.leggauss(24)
    radii, shares = np.array([radius]), np.array([1.0])
    if variation > 0.0:
        g, w = np.polynomial.legendre.leggauss(5)
        radii, shares = radius * (1.0 + variation * g), w / 2.0
    mean = sum(s * _disk_in_cells(x, y, float(r), nodes, weights) for r, s in zip(radii, shares, strict=True))
    return float(over @ (1.0 - np.prod(1.0 - np.minimum(mean, 1.0), axis=0)))


@lru_cache(maxsize=4096)
def threshold(wanted: float, variation: float = 0.0) -> float:
    """Radius [cells] whose mean coverage is ``wanted``, in (0, 1)."""
    low, high = 0.0, MAX_RADIUS
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if coverage(middle, variation) < wanted else (low, middle)
    return 0.5 * (low + high)
