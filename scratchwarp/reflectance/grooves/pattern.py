"""Patterns of grooves: paths and cross-sections, cut into straight pieces for the device."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ...scratches.grid import StripGrid, build, strip_table
from ..vectors import numbers
from .section import closed_section, height_at, section_points
from .solid_device import GrooveSet, Piece

ENDS = ("cap", "mitre")

_SKIN = 1e-9  # of the largest length of a profile: how far off a surface its two sides are looked at
_STRAIGHT = 1e-12  # sine of the largest turn at a vertex that is none


@dataclass(frozen=True)
class Groove:
    """One path without doubled or straight vertices.

    ``points`` [k, 2]; ``section``: its closed section [n, 2]; ``loop``: whether the last point is the first;
    ``number``: its place among the paths that were given.
    """

    points: np.ndarray
    section: np.ndarray
    loop: bool
    number: int


def _turn(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def _is_straight(a: np.ndarray, b: np.ndarray) -> bool:
    return abs(_turn(a, b)) <= _STRAIGHT and float(a @ b) > 0.0


def _tangents(points: np.ndarray) -> np.ndarray:
    step = np.diff(points, axis=0)
    return step / np.linalg.norm(step, axis=1, keepdims=True)


def _simplified(path: np.ndarray) -> np.ndarray:
    """Without zero-length segments, then without vertices in which the path goes straight on."""
    points = path[np.concatenate([[True], np.any(np.diff(path, axis=0) != 0.0, axis=1)])]
    if len(points) < 3:
        return points
    t = _tangents(points)
    keep = [True, *(not _is_straight(a, b) for a, b in zip(t[:-1], t[1:], strict=True)), True]
    return points[keep]


def _joined(paths: list[tuple[np.ndarray, np.ndarray, int]]) -> list[tuple[np.ndarray, np.ndarray, int]]:
    """Paths that go straight on where another one of the same section ends, made one."""
    done: list[tuple[np.ndarray, np.ndarray, int] | None] = list(paths)
    starting: dict[bytes, list[int]] = {}
    for k, (points, _, _) in enumerate(paths):
        starting.setdefault((points[0] + 0.0).tobytes(), []).append(k)
    for k in range(len(done)):
        own = done[k]
        while own is not None:
            points, section, number = own
            for j in starting.get((points[-1] + 0.0).tobytes(), ()):
                other = done[j]
                if j == k or other is None or not (section is other[1] or np.array_equal(section, other[1])):
                    continue
                if _is_straight(_tangents(points[-2:])[0], _tangents(other[0][:2])[0]):
                    own = done[k] = (_simplified(np.concatenate([points, other[0][1:]])), section, number)
                    done[j] = None
                    break
            else:
                own = None
    return [row for row in done if row is not None]


class Pattern:
    """Grooves along paths in the plane z = 0.

    Args:
        paths: polylines [k, 2], any one unit of length. A path whose last point repeats its first is a loop.
        profiles: a section [n, 2] for each path, or one for all: (x, z), the same unit. x runs along v = n x u, u the
            path's direction, from the path as the points say (x may be negative); z = 0 is the plane, below it the
            groove digs, above it stands out. From left to right; overhangs are allowed.
        ends: "cap", a vertical wall at the end point; "mitre", beyond it as far as the profile reaches in x, with
            height max(f(x), f(y)), y the distance beyond (min where the profile only stands out).

    Corners are mitred. Where grooves cross, the lower height counts where both dig in, the higher where both stand out,
    and what one digs cuts what another piles up. Paths that go straight on from another's end, with the same section,
    are one path. Raises ValueError naming the argument.

    Attributes:
        count: how many paths were given. grooves: what the device takes (``solid_device.GrooveSet``); table: its pieces
            as a NumPy table; memory: bytes of pieces and profiles. grid: where the pieces lie
            (``scratches.grid.StripGrid``, with bytes of its own).
    """

    def __init__(self, paths: Sequence[ArrayLike], profiles: Any, ends: str = "cap") -> None:
        if ends not in ENDS:
            raise ValueError(f"ends must be one of {', '.join(ENDS)}, got {ends!r}")
        given = [numbers(f"paths[{i}]", p) for i, p in enumerate(paths)]
        for i, p in enumerate(given):
            if p.ndim != 2 or p.shape[1] != 2 or len(p) < 1:
                raise ValueError(f"paths[{i}] must have shape [k, 2], got {list(p.shape)}")
        sections = self._sections(profiles, len(given))
        rows = [(_simplified(p), s, i) for i, (p, s) in enumerate(zip(given, sections, strict=True))]
        rows = _joined([row for row in rows if len(row[0]) > 1])
        self.count = len(given)
        self.ends = ends
        self.paths = tuple(self._groove(*row) for row in rows)
        self.grooves = self._pack()

    @staticmethod
    def _sections(profiles: Any, count: int) -> list[np.ndarray]:
        try:
            single = np.asarray(profiles, np.float64).ndim == 2
        except (TypeError, ValueError):
            single = False
        several = [profiles] * count if single else list(profiles)
        if len(several) != count:
            raise ValueError(f"profiles must be one for each of the {count} paths, got {len(several)}")
        made: dict[int, np.ndarray] = {}  # the same object is the same section
        for i, p in enumerate(several):
            if id(p) not in made:
                made[id(p)] = closed_section(section_points(f"profiles[{i}]", p))
        return [made[id(p)] for p in several]

    @staticmethod
    def _groove(points: np.ndarray, section: np.ndarray, number: int) -> Groove:
        loop = len(points) > 3 and bool(np.array_equal(points[0], points[-1]))
        if loop:
            t = _tangents(points)
            if _is_straight(t[-1], t[0]):  # starts amid a straight stretch: start at a corner
                points = np.concatenate([points[1:-1], points[1:2]])
        return Groove(points, section, loop, number)

    def _pack(self) -> GrooveSet:
        pieces: list[dict[str, Any]] = []
        vertices: list[np.ndarray] = []
        known: dict[bytes, int] = {}
        total = 0
        for groove in self.paths:
            key = groove.section.tobytes()
            if key not in known:
                known[key] = total
                vertices.append(groove.section)
                total += len(groove.section)
            for piece in self._pieces(groove, len(pieces)):
                low, high = groove.section.min(0), groove.section.max(0)
                pieces.append(
                    {**piece, "first": known[key], "count": len(groove.section), "low": low, "high": high}
                    | {"path": groove.number}
                )
        z = np.concatenate([v[:, 1] for v in vertices]) if vertices else np.zeros(1)
        x = np.concatenate([v[:, 0] for v in vertices]) if vertices else np.ones(1)
        record: Any = Piece
        table = np.zeros(len(pieces), dtype=record.numpy_dtype())
        for k, piece in enumerate(pieces):
            for name, value in piece.items():
                table[name][k] = value
        made = GrooveSet()
        made.pieces = wp.array(table, dtype=Piece, device="cpu")
        corners = np.concatenate(vertices) if vertices else np.zeros((0, 2))
        made.vertices = wp.array(corners, dtype=wp.vec2d, device="cpu")
        made.bottom, made.top = wp.float64(min(z.min(), 0.0)), wp.float64(max(z.max(), 0.0))
        made.skin = wp.float64(_SKIN * max(np.abs(z).max(), np.abs(x).max()))
        made.mixed = int(z.min() < 0.0 < z.max())
        self.table = table
        self.memory = table.nbytes + corners.nbytes
        return made

    def _pieces(self, groove: Groove, first: int) -> list[dict[str, Any]]:
        p, section = groove.points, groove.section
        t = _tangents(p)
        pieces = []
        last = len(t) - 1
        for k, along in enumerate(t):
            here = [(p[k], t[k - 1] if k > 0 or groove.loop else None, -1.0)]
            here.append((p[k + 1], t[(k + 1) % len(t)] if k < last or groove.loop else None, 1.0))
            piece: dict[str, Any] = {
                "origin": p[k], "along": along, "across": (-along[1], along[0]), "partner": -1,
            }  # fmt: skip
            for end, (point, neighbour, sign) in enumerate(here):
                normal, cap = sign * along, 1
                if neighbour is not None and np.linalg.norm(along + neighbour) > 1e-6:
                    normal, cap = sign * (along + neighbour) / np.linalg.norm(along + neighbour), 0
                elif neighbour is None and self.ends == "mitre":
                    cap = int(not self._goes_on(section))
                piece |= {f"end{end}": normal, f"reach{end}": float((point - p[k]) @ normal), f"cap{end}": cap}
            pieces.append(piece)
        if self.ends == "mitre" and not groove.loop and section[:, 0].max() > 0.0:
            for point, along, out in ((p[0], t[0], -t[0]), (p[-1], t[-1], t[-1])):
                across = np.array([-along[1], along[0]])
                number = first + len(pieces)
                low, high = section[:, 0].min(), section[:, 0].max()
                rim = int(section[:, 1].min() < 0.0 < section[:, 1].max())  # goes round, and drops at its outer edges
                ends = {"end0": -out, "reach0": 0.0, "cap0": 0, "end1": out, "reach1": high, "cap1": rim}
                pieces.append({"origin": point, "along": out, "across": across, "partner": number + 1, **ends})
                ends = {"end0": -across, "reach0": -low, "cap0": rim, "end1": across, "reach1": high, "cap1": rim}
                pieces.append({"origin": point, "along": -across, "across": out, "partner": number, **ends})
        return pieces

    def strips(self) -> np.ndarray:
        """Oriented boxes about the pieces, in their order, for ``scratches.grid.build``."""
        t = self.table
        along, across = t["along"], t["across"]
        u = np.empty((len(t), 2, 2))  # piece, end, side: where the end plane cuts the profile's edges
        for end in range(2):
            m = t[f"end{end}"]
            for side, v in enumerate((t["low"][:, 0], t["high"][:, 0])):
                u[:, end, side] = (t[f"reach{end}"] - np.sum(m * across, 1) * v) / np.sum(m * along, 1)
        low, high = u[:, 0].min(1), np.maximum(u[:, 1].max(1), u[:, 0].min(1))
        v0, v1 = t["low"][:, 0], t["high"][:, 0]
        center = t["origin"] + along * (0.5 * (low + high))[:, None] + across * (0.5 * (v0 + v1))[:, None]
        return strip_table(center, along, 0.5 * np.stack([high - low, v1 - v0], 1))

    @cached_property
    def grid(self) -> StripGrid:
        """The uniform grid in which the pieces near a footprint are looked up."""
        return build(self.strips())

    @staticmethod
    def _goes_on(section: np.ndarray) -> bool:
        """Whether a mitred end starts with the whole section, for its middle is the deepest (or the highest) part."""
        middle = height_at(section, 0.0)
        extreme = section[:, 1].min() if section[:, 1].min() < 0.0 else section[:, 1].max()
        return abs(middle - extreme) <= 1e-12 * abs(extreme)
