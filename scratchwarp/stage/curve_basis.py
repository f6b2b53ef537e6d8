"""UsdGeomBasisCurves to polylines: Bezier, B-spline and Catmull-Rom segments sampled at equal steps."""

from dataclasses import dataclass

import numpy as np

STEPS = 8  # samples a cubic segment

# Rows: weights of four vertices for t^3, t^2, t, 1.
_BASES = {
    "bezier": np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 3, 0, 0], [1, 0, 0, 0]], float),
    "bspline": np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 0, 3, 0], [1, 4, 1, 0]], float) / 6,
    "catmullRom": np.array([[-1, 3, -3, 1], [2, -5, 4, -1], [-1, 0, 1, 0], [0, 2, 0, 0]], float) / 2,
}


@dataclass(frozen=True)
class CurveKind:
    """How a BasisCurves prim is to be read: type (linear, cubic), basis (bezier, bspline, catmullRom) and wrap
    (nonperiodic, periodic, pinned)."""

    type: str
    basis: str
    wrap: str

    def segments(self, counts: np.ndarray) -> np.ndarray:
        """Segments of curves with ``counts`` vertices; 0 where those are too few."""
        n = np.asarray(counts)
        if self.type == "linear":
            return np.where(n > 1, n if self.wrap == "periodic" else n - 1, 0)
        if self.basis == "bezier":
            return np.where(n >= 3, n // 3, 0) if self.wrap == "periodic" else np.where(n >= 4, (n - 1) // 3, 0)
        if self.wrap == "periodic":
            return np.where(n >= 3, n, 0)
        return np.where(n >= 2, n - 1, 0) if self.wrap == "pinned" else np.where(n >= 4, n - 3, 0)

    def varying(self, counts: np.ndarray) -> np.ndarray:
        """Values that varying data has for each curve: one at every segment's end."""
        segments = self.segments(counts)
        return np.where(segments > 0, segments + (self.wrap != "periodic"), 0)


def polylines(
    kind: CurveKind, counts: np.ndarray, vertex: np.ndarray, varying: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Sample curves.

    ``vertex`` [sum(counts), k] is combined by the basis, ``varying`` [sum(kind.varying(counts)), j] linearly. Returns
    (samples [s, k + j], samples of each curve [c], 0 where a curve has too few vertices).
    """
    segments = kind.segments(counts)
    open_linear = kind.type == "linear" and kind.wrap != "periodic"
    if open_linear and (segments > 0).all():
        return np.concatenate([vertex, varying], axis=1), counts
    steps = 1 if kind.type == "linear" else STEPS
    lengths = np.where(segments > 0, segments * steps + 1, 0)
    out = np.empty((int(lengths.sum()), vertex.shape[1] + varying.shape[1]))
    starts = [np.cumsum(c) - c for c in (counts, kind.varying(counts), lengths)]
    for n in np.unique(counts[segments > 0]):
        curves = np.flatnonzero(counts == n)
        own = vertex[starts[0][curves][:, None] + np.arange(n)]
        ends = varying[starts[1][curves][:, None] + np.arange(int(kind.varying(n)))]
        samples = np.concatenate([_combine(kind, own, steps), _blend(ends, int(kind.segments(n)), steps)], axis=2)
        out[starts[2][curves][:, None] + np.arange(samples.shape[1])] = samples
    return out, lengths


def _combine(kind: CurveKind, own: np.ndarray, steps: int) -> np.ndarray:
    """Vertices [c, n, k] to samples [c, segments * steps + 1, k]."""
    segments = int(kind.segments(own.shape[1]))
    if kind.type == "linear":
        return own[:, np.arange(segments + 1) % own.shape[1]]
    if kind.wrap == "pinned" and kind.basis != "bezier":
        own = np.concatenate([2 * own[:, :1] - own[:, 1:2], own, 2 * own[:, -1:] - own[:, -2:-1]], axis=1)
    stride = 3 if kind.basis == "bezier" else 1
    # A periodic uniform spline starts one vertex later than its first stencil, so its seam lies at vertex 0.
    first = np.arange(segments) * stride - (kind.wrap == "periodic" and stride == 1)
    stencil = (first[:, None] + np.arange(4)) % own.shape[1]
    t = np.arange(steps + 1) / steps
    weights = np.stack([t**3, t**2, t, np.ones_like(t)], axis=1) @ _BASES[kind.basis]
    samples = np.einsum("tj,csjk->cstk", weights, own[:, stencil])
    inner = samples[:, :, :-1].reshape(len(own), segments * steps, -1)
    return np.concatenate([inner, samples[:, -1, -1:]], axis=1)


def _blend(ends: np.ndarray, segments: int, steps: int) -> np.ndarray:
    """Values at segment ends [c, e, j] to samples, linearly."""
    at = np.arange(segments * steps + 1) / steps
    low = np.minimum(at.astype(int), segments - 1)
    part = (at - low)[:, None]
    count = ends.shape[1]
    return (1 - part) * ends[:, low % count] + part * ends[:, (low + 1) % count]
