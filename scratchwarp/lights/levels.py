"""Smaller copies of a latlong image, each texel the mean radiance over the solid angle that it covers."""

import numpy as np


def _overlap(count: int, edges: np.ndarray) -> np.ndarray:
    """Weights [n, count], rows summing to 1, of n cells that share the range of ``count`` cells evenly; ``edges``
    [count + 1]: measure of the range up to each of their bounds."""
    n = (count + 1) // 2
    at = np.interp(np.linspace(0.0, count, n + 1), np.arange(count + 1), edges)
    low = np.maximum(at[:-1, None], edges[None, :-1])
    high = np.minimum(at[1:, None], edges[None, 1:])
    weights = np.maximum(high - low, 0.0)
    return weights / weights.sum(1, keepdims=True)


def halved(pixels: np.ndarray) -> np.ndarray:
    """The image [h, w, 4] at half the size, rounded up; float32."""
    rows, columns = pixels.shape[:2]
    # a solid angle's height is the difference of the cosines of its polar angles
    heights = -np.cos(np.pi * np.arange(rows + 1) / rows)
    smaller = np.einsum("ij,jkc->ikc", _overlap(rows, heights), pixels, optimize=True)
    return np.einsum("ij,kjc->kic", _overlap(columns, np.arange(columns + 1.0)), smaller, optimize=True).astype(
        np.float32
    )


def levels(pixels: np.ndarray) -> list[np.ndarray]:
    """Copies of ever half the size, down to two rows; together at most some 2/5 of the image's texels."""
    made = []
    while pixels.shape[0] > 2:
        pixels = halved(pixels)
        made.append(pixels)
    return made
