"""Smaller copies of a latlong image, each texel the mean radiance over the solid angle that it covers."""

from collections.abc import Callable

import numpy as np


def _overlap(count: int, measure: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Weights [n, count], rows summing to 1, of n = (count + 1) // 2 cells that share the range [0, 1] of ``count``
    cells evenly, by the ``measure`` of the range up to a place in it."""
    n = (count + 1) // 2
    old, new = measure(np.arange(count + 1) / count), measure(np.arange(n + 1) / n)
    weights = np.minimum(new[1:, None], old[None, 1:]) - np.maximum(new[:-1, None], old[None, :-1])
    weights = np.maximum(weights, 0.0)
    return weights / weights.sum(1, keepdims=True)


def halved(pixels: np.ndarray) -> np.ndarray:
    """The image [h, w, 4] at half the size, rounded up; float32."""
    rows, columns = pixels.shape[:2]
    # a solid angle's height is the difference of the cosines of its polar angles
    down = _overlap(rows, lambda t: -np.cos(np.pi * t))
    across = _overlap(columns, lambda t: t)
    smaller = np.einsum("ij,jkc->ikc", down, pixels, optimize=True)
    return np.einsum("ij,kjc->kic", across, smaller, optimize=True).astype(np.float32)


def levels(pixels: np.ndarray) -> list[np.ndarray]:
    """Copies of ever half the size, down to two rows; together at most some 2/5 of the image's texels."""
    made = []
    while pixels.shape[0] > 2:
        pixels = halved(pixels)
        made.append(pixels)
    return made
