"""Arrays of vectors."""

import numpy as np


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross products of the last axis; NumPy's own is several times slower."""
    out = np.empty(np.broadcast_shapes(a.shape, b.shape), np.result_type(a, b))
    out[..., 0] = a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1]
    out[..., 1] = a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
    out[..., 2] = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return out


def lengths(vectors: np.ndarray) -> np.ndarray:
    """Lengths of vectors [..., k]."""
    return np.sqrt(np.einsum("...i,...i->...", vectors, vectors))


def unit(vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(unit vectors, whether each has a direction at all); those without one stay as they are."""
    size = lengths(vectors)
    good = size > 1e-30
    return vectors / np.where(good, size, 1.0)[..., None], good
