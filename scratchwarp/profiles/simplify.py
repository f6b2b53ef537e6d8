"""Cross-sections of fewer facets, each as long as it may be to leave the given ones by no more than is allowed."""

import numpy as np


def simplified(points: np.ndarray, slack: float) -> np.ndarray:
    """Some of ``points`` [n, 2], from the first to the last: no other one is farther than ``slack`` from the chord in
    its place. Points on the plane z = 0 stay, so that no opening changes its width."""
    array = np.asarray(points, float)
    if slack <= 0.0 or len(array) < 3:
        return array
    kept = [0]
    while kept[-1] < len(array) - 1:
        first = kept[-1]
        last = first + 1
        while last < len(array) - 1 and array[last, 1] != 0.0:
            further = last + 1
            if _distances(array[first + 1 : further], array[first], array[further]).max() > slack:
                break
            last = further
        kept.append(last)
    return array[kept]


def _distances(points: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """From points [n, 2] to the chord from ``a`` to ``b``."""
    way = b - a
    length = float(way @ way)
    at = np.clip((points - a) @ way / length, 0.0, 1.0) if length > 0.0 else np.zeros(len(points))
    return np.linalg.norm(points - a - at[:, None] * way, axis=1)
