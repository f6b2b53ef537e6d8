"""The cross-section of a scratch as a height over the width, in facets for its Fourier transform."""

import functools

import numpy as np

from scratchwarp.profiles import Profile

_SAG = 2e-4  # greatest distance of a curved outline from its facets, in depths: 0.6 nm of 3 um
_MOST_ARCS = 64


@functools.lru_cache(maxsize=64)
def facets(profile: Profile) -> np.ndarray:
    """Rows (middle v, middle h, width, rise) ``[n, 4]``, v in widths from -1/2 to 1/2 and h in depths, 0 the surface.

    The surface is z = 0 of the profile; depths are counted to its lowest point (to the highest of one that only stands
    out). Of an overhang what is seen from above counts; walls have no width, flat ground no effect: both are left out.
    """
    points = _upper_envelope(profile.polyline(_arcs(profile)))
    x = (points[:, 0] - profile.points[0, 0]) / profile.period - 0.5
    low, high = points[:, 1].min(), points[:, 1].max()
    scale = -low if low < 0.0 else high
    z = points[:, 1] / scale if scale > 0.0 else 0.0 * points[:, 1]
    rows = np.stack((0.5 * (x[1:] + x[:-1]), 0.5 * (z[1:] + z[:-1]), np.diff(x), np.diff(z)), axis=1)
    rows = rows[(rows[:, 2] > 0.0) & ((z[1:] != 0.0) | (z[:-1] != 0.0))]
    rows.setflags(write=False)
    return rows


def proportion(profile: Profile) -> float:
    """Depth over width of the profile as it is drawn."""
    z = profile.polyline(_arcs(profile))[:, 1]
    return float(-z.min() if z.min() < 0.0 else z.max()) / profile.period


def _arcs(profile: Profile) -> int:
    if profile.controls is None:
        return 1
    bend = profile.points[:-1, 1] - 2.0 * profile.controls[:, 1] + profile.points[1:, 1]
    depth = np.ptp(profile.points[:, 1])
    # the chord of a parabola cut in n leaves |bend| / (4 n^2)
    needed = 0.5 * np.sqrt(np.abs(bend).max() / max(_SAG * depth, 1e-300))
    return int(np.clip(np.ceil(needed), 1, _MOST_ARCS))


def _upper_envelope(points: np.ndarray) -> np.ndarray:
    """The part of an outline that does not cross itself that is seen from straight above."""
    if np.all(np.diff(points[:, 0]) >= 0.0):
        return points
    at = np.unique(points[:, 0])
    a, b = points[:-1], points[1:]
    left, right = np.minimum(a[:, 0], b[:, 0]), np.maximum(a[:, 0], b[:, 0])
    pieces = []
    for x0, x1 in zip(at[:-1], at[1:], strict=True):
        over = (left <= x0) & (right >= x1) & (right > left)
        slope = (b[over, 1] - a[over, 1]) / (b[over, 0] - a[over, 0])
        z0, z1 = (a[over, 1] + slope * (x - a[over, 0]) for x in (x0, x1))
        top = int(np.argmax(z0 + z1))
        pieces.append([[x0, z0[top]], [x1, z1[top]]])
    return np.array(pieces).reshape(-1, 2)
