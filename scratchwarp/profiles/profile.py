"""A cross-section: points (x, z), optionally joined by parabolic arcs, alone in flat ground or repeated for ever."""

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

# Facets shorter than this share of the period have no direction worth trusting and are dropped.
_SHORTEST = 1e-9
_LARGEST_CROSSING_TEST = 2048


@dataclass(frozen=True, eq=False)
class Profile:
    """Cross-section of a scratch, seen along it: x runs across (along +v), z along the normal.

    ``points``: float64 ``[n, 2]``, any one unit of length; the first is the leftmost and the last the rightmost,
    overhangs between them are allowed. The facets between them are flat unless ``controls`` ``[n - 1, 2]`` gives the
    middle point of a quadratic Bezier arc for each (the way ``shape`` makes smooth profiles; no overhangs then).
    ``isolated``: alone in flat ground at z = 0, else repeated with period ``points[-1, 0] - points[0, 0]`` and the
    highest point as the base line (Raymond 2016, section 5.3). A profile that is dug in and ends at z = 0 on both
    sides reflects the same either way.

    Raises ValueError, naming ``points`` or ``controls``, on fewer than two points, NaN, zero width, a first (last)
    point that is not the leftmost (rightmost), or an outline that crosses itself.
    """

    points: np.ndarray
    isolated: bool = False
    controls: np.ndarray | None = None

    def __post_init__(self) -> None:
        points = _checked("points", self.points)
        if len(points) < 2:
            raise ValueError(f"points must hold at least two (x, z), got {len(points)}")
        period = points[-1, 0] - points[0, 0]
        if not period > 0.0 or not np.isfinite(period):
            raise ValueError(
                f"points must run from left to right over a width above 0, got x from {points[0, 0]} to {points[-1, 0]}"
            )
        outside = (points[:, 0] < points[0, 0]) | (points[:, 0] > points[-1, 0])
        if np.any(outside):
            bad = int(np.argmax(outside))
            raise ValueError(
                f"points[0] must be leftmost and points[-1] rightmost, got points[{bad}] = {points[bad].tolist()}"
            )
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "isolated", bool(self.isolated))
        if self.controls is not None:
            controls = _checked("controls", self.controls)
            if len(controls) != len(points) - 1:
                raise ValueError(f"controls must hold one point a facet, {len(points) - 1}, got {len(controls)}")
            x, cx = points[:, 0], controls[:, 0]
            slack = 1e-9 * period
            if np.any(cx < x[:-1] - slack) or np.any(cx > x[1:] + slack):
                raise ValueError(
                    "controls must lie between the points they join (no curved overhangs: pass more points)"
                )
            controls.setflags(write=False)
            object.__setattr__(self, "controls", controls)
        elif self.overhangs and len(points) <= _LARGEST_CROSSING_TEST:
            crossing = _first_crossing(points)
            if crossing is not None:
                raise ValueError(f"points must not cross themselves, but facets {crossing[0]} and {crossing[1]} do")
        points.setflags(write=False)

    @property
    def period(self) -> float:
        """Width of the profile, in the unit of ``points``."""
        return float(self.points[-1, 0] - self.points[0, 0])

    @property
    def top(self) -> float:
        """Height of the base line that rays start from: the highest point, and the ground of an isolated profile."""
        z = self.points[:, 1] if self.controls is None else np.concatenate((self.points[:, 1], _arc_heights(self)))
        highest = float(z.max())
        return max(highest, 0.0) if self.isolated else highest

    @property
    def overhangs(self) -> bool:
        """Whether the outline turns back anywhere, so that it is no height field."""
        return bool(np.any(np.diff(self.points[:, 0]) < 0.0))

    @property
    def reciprocal(self) -> bool:
        """Whether swapping light and viewer leaves the table alone: not where light leaves sideways over flat
        ground."""
        return not self.isolated or self.top <= 0.0

    @cached_property
    def symmetric(self) -> bool:
        """Whether the profile is its own mirror image, within 1e-9 of its width."""
        middle = self.points[0, 0] + self.points[-1, 0]
        own = self.points if self.controls is None else np.concatenate((self.points, self.controls))
        flipped = (
            self.points[::-1] if self.controls is None else np.concatenate((self.points[::-1], self.controls[::-1]))
        )
        distance = np.abs(own - np.stack((middle - flipped[:, 0], flipped[:, 1]), axis=1))
        return bool(np.all(distance <= 1e-9 * self.period))

    @cached_property
    def token(self) -> str:
        """Identity as text, for cache keys: a digest of everything that the outline is made of."""
        digest = hashlib.sha256(np.ascontiguousarray(self.points).tobytes())
        digest.update(b"isolated" if self.isolated else b"periodic")
        if self.controls is not None:
            digest.update(np.ascontiguousarray(self.controls).tobytes())
        return digest.hexdigest()

    def polyline(self, arcs: int = 16) -> np.ndarray:
        """The outline as points ``[n, 2]`` float64: ``points`` themselves, or ``arcs`` chords for each arc."""
        if self.controls is None:
            return np.array(self.points)
        t = np.arange(arcs)[:, None, None] / arcs
        start, end = self.points[:-1], self.points[1:]
        along = (1 - t) ** 2 * start + 2 * t * (1 - t) * self.controls + t**2 * end
        return np.concatenate((along.transpose(1, 0, 2).reshape(-1, 2), self.points[-1:]))


def _checked(name: str, value: Any) -> np.ndarray:
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be numbers of shape [n, 2], got {value!r}") from None
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name} must have shape [n, 2], got {array.shape}")
    if not np.all(np.isfinite(array)):
        row = int(np.argmax(~np.isfinite(array).all(axis=1)))
        raise ValueError(f"{name} must be finite, got {name}[{row}] = {array[row].tolist()}")
    return array


def _arc_heights(profile: Profile) -> np.ndarray:
    """Highest z on each arc."""
    assert profile.controls is not None
    a, c, b = profile.points[:-1, 1], profile.controls[:, 1], profile.points[1:, 1]
    bend = a - 2 * c + b
    t = np.divide(a - c, bend, out=np.zeros_like(a), where=np.abs(bend) > 0.0)
    t = np.clip(t, 0.0, 1.0)
    return (1 - t) ** 2 * a + 2 * t * (1 - t) * c + t**2 * b


def _first_crossing(points: np.ndarray) -> tuple[int, int] | None:
    """The first pair of facets that properly cross each other."""
    start, edge = points[:-1], np.diff(points, axis=0)

    def side(origin: np.ndarray, direction: np.ndarray, of: np.ndarray) -> np.ndarray:
        delta = of[None] - origin[:, None]
        return direction[:, None, 0] * delta[..., 1] - direction[:, None, 1] * delta[..., 0]

    first, second = side(start, edge, start), side(start, edge, points[1:])
    apart = first * second < 0.0
    crossing = np.argwhere(apart & apart.T)
    return (int(crossing[0][0]), int(crossing[0][1])) if len(crossing) else None


def normalised(profile: Profile) -> tuple[np.ndarray, np.ndarray]:
    """``(vertices [n + 1, 2], controls [n, 2])`` float64 with x from 0 to 1, the base line at z = 0, walls added up
    to an isolated profile's ground, and facets too short to have a direction dropped."""
    scale, left, top = profile.period, profile.points[0, 0], profile.top
    offset = np.array((left, top))
    vertices = (profile.points - offset) / scale
    middles = 0.5 * (vertices[:-1] + vertices[1:]) if profile.controls is None else (profile.controls - offset) / scale
    if profile.isolated:
        ground = -top / scale
        for end in (0, -1):
            if vertices[end, 1] < ground:
                rim = np.array([[vertices[end, 0], ground]])
                wall = 0.5 * (rim + vertices[end])
                vertices = np.concatenate((rim, vertices) if end == 0 else (vertices, rim))
                middles = np.concatenate((wall, middles) if end == 0 else (middles, wall))
    elif vertices[0, 1] != vertices[-1, 1]:
        # repeated, the ends meet in a wall
        step = np.array([[1.0, vertices[0, 1]]])
        middles = np.concatenate((middles, 0.5 * (vertices[-1:] + step)))
        vertices = np.concatenate((vertices, step))
    vertices[0, 0], vertices[-1, 0] = 0.0, 1.0
    short = np.abs(np.diff(vertices, axis=0)).max(axis=1) < _SHORTEST
    if np.any(short):
        keep = np.concatenate(([True], ~short))
        vertices, middles = vertices[keep], middles[~short]
    return vertices, middles
