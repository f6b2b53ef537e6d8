"""Paths cleaned up before they are cut into pieces, and how the profile of a piece grows along it."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

_STRAIGHT = 1e-12  # sine of the largest turn at a vertex that is none

_TWIST = 0.15  # change of the angle of scales, arctan(z / x), along one stretch


@dataclass(frozen=True, eq=False)
class Row:
    """One path: its points [k, 2], closed section [n, 2], number among those given, scales [k, 2] or None."""

    points: np.ndarray
    section: np.ndarray
    number: int
    scales: np.ndarray | None = None


def turn_is_straight(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether a path goes straight on from unit vector ``a`` to ``b``."""
    return abs(float(a[0] * b[1] - a[1] * b[0])) <= _STRAIGHT and float(a @ b) > 0.0


def tangents(points: np.ndarray) -> np.ndarray:
    """Unit vectors along the segments of a polyline."""
    step = np.diff(points, axis=0)
    return step / np.linalg.norm(step, axis=1, keepdims=True)


def simplified(row: Row) -> Row:
    """Without zero-length segments, then without vertices in which the path goes straight on (but for those at which
    its scale may change its pace)."""
    if len(row.points) == 2 and row.scales is None and row.points[0].tolist() != row.points[1].tolist():
        return row
    keep = np.concatenate([[True], np.any(np.diff(row.points, axis=0) != 0.0, axis=1)])
    points = row.points[keep]
    if row.scales is not None:
        return _finer(replace(row, points=points, scales=row.scales[keep]))
    if len(points) > 2:
        t = tangents(points)
        points = points[[True, *(not turn_is_straight(a, b) for a, b in zip(t[:-1], t[1:], strict=True)), True]]
    return replace(row, points=points)


def _finer(row: Row) -> Row:
    """With points between those where x and z do not grow alike, for then facets are twisted."""
    assert row.scales is not None
    points, scales = [row.points[:1]], [row.scales[:1]]
    for k in range(len(row.points) - 1):
        steep = np.arctan2(row.scales[k : k + 2, 1], row.scales[k : k + 2, 0])
        n = max(int(np.ceil(abs(float(steep[1] - steep[0])) / _TWIST)), 1) if row.scales[k : k + 2].any(1).all() else 1
        at = np.arange(1, n + 1)[:, None] / n
        points.append(row.points[k] + at * (row.points[k + 1] - row.points[k]))
        scales.append(row.scales[k] + at * (row.scales[k + 1] - row.scales[k]))
    return replace(row, points=np.concatenate(points), scales=np.concatenate(scales))


def joined(rows: list[Row]) -> list[Row]:
    """Paths that go straight on where another one of the same section ends, made one."""
    done: list[Row | None] = list(rows)
    starting: dict[bytes, list[int]] = {}
    for k, row in enumerate(rows):
        starting.setdefault((row.points[0] + 0.0).tobytes(), []).append(k)
    for k in range(len(done)):
        own = done[k]
        while own is not None and own.scales is None:
            for j in starting.get((own.points[-1] + 0.0).tobytes(), ()):
                other = done[j]
                if j == k or other is None or other.scales is not None:
                    continue
                alike = own.section is other.section or np.array_equal(own.section, other.section)
                if alike and turn_is_straight(tangents(own.points[-2:])[0], tangents(other.points[:2])[0]):
                    done[k] = simplified(replace(own, points=np.concatenate([own.points, other.points[1:]])))
                    own, done[j] = done[k], None
                    break
            else:
                own = None
    return [row for row in done if row is not None]


def taper_of(
    section: np.ndarray, start: np.ndarray, stop: np.ndarray, first: np.ndarray, last: np.ndarray, piece: dict[str, Any]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(size, grow, low, high) of a piece from ``start`` to ``stop`` whose scales go from ``first`` to ``last``.

    The box from ``low`` to ``high`` holds what mitred corners reach beyond both ends.
    """
    length = float(np.linalg.norm(stop - start))
    grow = (last - first) / length
    far = float(np.abs(section[:, 0]).max() * max(first[0], last[0]))
    reach = []
    for end in range(2):
        m = np.asarray(piece[f"end{end}"])
        reach.append(far * abs(float(m @ piece["across"])) / max(abs(float(m @ piece["along"])), 1e-6))
    at = np.stack([first, last, first - reach[0] * grow, last + reach[1] * grow])
    small, large = np.maximum(at.min(0), 0.0), np.maximum(at.max(0), 0.0)
    low, high = section.min(0), section.max(0)
    return first, grow, np.minimum(low * small, low * large), np.maximum(high * small, high * large)
