"""Patterns of grooves: paths and cross-sections, cut into straight pieces for the device."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ...scratches.grid import StripGrid, box, build, strip_table
from ..vectors import numbers
from .section import closed_section, height_at, run_boxes, section_points
from .solid_device import GrooveSet, Piece, Taper
from .tapers import Row, joined, simplified, tangents, taper_of, turn_is_straight

ENDS = ("cap", "mitre")

_SKIN = 1e-9  # of the largest length of a profile: how far off a surface its two sides are looked at


@dataclass(frozen=True)
class Groove:
    """One path without doubled or straight vertices.

    ``points`` [k, 2]; ``section``: its closed section [n, 2]; ``loop``: whether the last point is the first;
    ``number``: its place among the paths that were given; ``scales`` [k, 2] of x and z at each point, None: 1.
    """

    points: np.ndarray
    section: np.ndarray
    loop: bool
    number: int
    scales: np.ndarray | None = None


class Pattern:
    """Grooves along paths in the plane z = 0.

    Args:
        paths: polylines [k, 2], any one unit of length. A path whose last point repeats its first is a loop.
        profiles: a section [n, 2] for each path, or one for all: (x, z), the same unit. x runs along v = n x u, u the
            path's direction, from the path as the points say (x may be negative); z = 0 is the plane, below it the
            groove digs, above it stands out. From left to right; overhangs are allowed.
        ends: "cap", a vertical wall at the end point; "mitre", beyond it as far as the profile reaches in x, with
            height max(f(x), f(y)), y the distance beyond (min where the profile only stands out).
        scales: for each path None, or factors [k, 2] >= 0 of the profile's x and z at each of its points, between which
            they change linearly.
        repeats: for each path (x, y, n): it is there n times, each moved by (x, y) from the one before. Paths are then
            straight, take no memory for their copies and need no grid, and what they do beyond their ends is not
            looked for: they should reach beyond all footprints.

    Corners are mitred. Where grooves cross, the lower height counts where both dig in, the higher where both stand out,
    and what one digs cuts what another piles up. Paths that go straight on from another's end, with the same section,
    are one path. Raises ValueError naming the argument.

    Attributes:
        count: how many paths were given. grooves: what the device takes (``solid_device.GrooveSet``); table: its pieces
            as a NumPy table; size: how many pieces there are, repeats counted; memory: bytes of pieces and profiles.
        grid: where the pieces lie (``scratches.grid.StripGrid``, with bytes of its own).
    """

    def __init__(
        self,
        paths: Sequence[ArrayLike],
        profiles: Any,
        ends: str = "cap",
        scales: Sequence[ArrayLike | None] | None = None,
        repeats: ArrayLike | None = None,
    ) -> None:
        if ends not in ENDS:
            raise ValueError(f"ends must be one of {', '.join(ENDS)}, got {ends!r}")
        given = [numbers(f"paths[{i}]", p) for i, p in enumerate(paths)]
        for i, p in enumerate(given):
            if p.ndim != 2 or p.shape[1] != 2 or len(p) < 1:
                raise ValueError(f"paths[{i}] must have shape [k, 2], got {list(p.shape)}")
        sections = self._sections(profiles, len(given))
        sizes = self._scales(scales, given)
        rows = [simplified(Row(p, s, i, t)) for i, (p, s, t) in enumerate(zip(given, sections, sizes, strict=True))]
        rows = [row for row in rows if len(row.points) > 1]
        self.repeats = np.zeros((0, 3))
        if repeats is None:
            rows = joined(rows)
        else:
            self.repeats = numbers("repeats", repeats)
            if self.repeats.shape != (len(given), 3) or len(rows) != len(given) or any(len(p) != 2 for p in given):
                raise ValueError(f"repeats must have shape [{len(given)}, 3], one row for each path of two points")
        self.count = len(given)
        self.ends = ends
        self.paths = tuple(self._groove(row) for row in rows)
        self.tapers: list[tuple[np.ndarray, np.ndarray]] = []
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
    def _scales(scales: Any, given: list[np.ndarray]) -> list[np.ndarray | None]:
        if scales is None:
            return [None] * len(given)
        if len(scales) != len(given):
            raise ValueError(f"scales must be one for each of the {len(given)} paths, got {len(scales)}")
        made: list[np.ndarray | None] = []
        for i, (own, path) in enumerate(zip(scales, given, strict=True)):
            array = None if own is None else numbers(f"scales[{i}]", own)
            if array is not None and (array.shape != (len(path), 2) or array.min() < 0.0):
                raise ValueError(f"scales[{i}] must have shape [{len(path)}, 2] and be 0 and more, got {array.shape}")
            made.append(array)
        return made

    @staticmethod
    def _groove(row: Row) -> Groove:
        points = row.points
        loop = len(points) > 3 and bool(np.array_equal(points[0], points[-1]))
        if loop and row.scales is None:
            t = tangents(points)
            if turn_is_straight(t[-1], t[0]):  # starts amid a straight stretch: start at a corner
                points = np.concatenate([points[1:-1], points[1:2]])
        return Groove(points, row.section, loop, row.number, row.scales)

    def _pack(self) -> GrooveSet:
        pieces: list[dict[str, Any]] = []
        vertices: list[np.ndarray] = []
        known: dict[bytes, int] = {}
        shared: dict[int, dict[str, Any]] = {}  # what many grooves have of one section
        total = 0
        for groove in self.paths:
            section = groove.section
            if id(section) not in shared:
                key = section.tobytes()
                if key not in known:
                    runs = run_boxes(section)
                    known[key] = total + len(runs)
                    vertices += [runs, section]
                    total += len(runs) + len(section)
                extent = {"low": section.min(0), "high": section.max(0)}
                shared[id(section)] = {"first": known[key], "count": len(section), **extent, "taper": -1}
            for piece in self._pieces(groove, len(pieces)):
                pieces.append({**shared[id(section)], **piece, "path": groove.number})
        z = np.array([p[name][1] for p in pieces for name in ("low", "high")] or [0.0])
        x = np.array([p[name][0] for p in pieces for name in ("low", "high")] or [1.0])
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
        record = Taper
        tapers = np.zeros(len(self.tapers), dtype=record.numpy_dtype())
        for k, (size, grow) in enumerate(self.tapers):
            tapers["size"][k], tapers["grow"][k] = size, grow
        made.tapers = wp.array(tapers, dtype=Taper, device="cpu")
        made.sets, made.start, made.first_step = len(self.repeats), 0, 0
        made.steps = wp.array(self.repeats, dtype=wp.vec3d, device="cpu")
        self.table = table
        self.size = len(table) if not len(self.repeats) else len(self.repeats) * int(self.repeats[:, 2].max())
        self.memory = table.nbytes + corners.nbytes + tapers.nbytes + self.repeats.nbytes
        return made

    def _pieces(self, groove: Groove, first: int) -> list[dict[str, Any]]:
        p, section = groove.points, groove.section
        t = tangents(p)
        pieces = []
        last = len(t) - 1
        for k, along in enumerate(t):
            here = [(p[k], t[k - 1] if k > 0 or groove.loop else None, -1.0)]
            here.append((p[k + 1], t[(k + 1) % len(t)] if k < last or groove.loop else None, 1.0))
            piece: dict[str, Any] = {
                "origin": p[k], "along": along, "across": (-along[1], along[0]), "partner": -1, "caps": 0,
            }  # fmt: skip
            for end, (point, neighbour, sign) in enumerate(here):
                normal, cap = sign * along, 1
                if neighbour is not None and np.linalg.norm(along + neighbour) > 1e-6:
                    normal, cap = sign * (along + neighbour) / np.linalg.norm(along + neighbour), 0
                elif neighbour is None and self.ends == "mitre":
                    cap = int(not self._goes_on(section))
                if groove.scales is not None and neighbour is not None:
                    # facets turn there, and beyond a corner the two profiles do not quite agree
                    cap = 4 if turn_is_straight(*((neighbour, along) if end == 0 else (along, neighbour))) else 1
                piece |= {f"end{end}": normal, f"reach{end}": float((point - p[k]) @ normal)}
                piece["caps"] += cap << end
            if groove.scales is not None:
                made = taper_of(section, p[k], p[k + 1], groove.scales[k], groove.scales[k + 1], piece)
                piece |= {"taper": len(self.tapers), "low": made[2], "high": made[3]}
                self.tapers.append(made[:2])
            pieces.append(piece)
        if self.ends == "mitre" and not groove.loop and section[:, 0].max() > 0.0:
            for at, along, out in ((0, t[0], -t[0]), (-1, t[-1], t[-1])):
                point, size = p[at], np.ones(2)
                if groove.scales is not None:
                    size = groove.scales[at]
                    if size.min() <= 0.0:
                        continue
                across = np.array([-along[1], along[0]])
                number = first + len(pieces)
                low, high = section[:, 0].min() * size[0], section[:, 0].max() * size[0]
                rim = int(section[:, 1].min() < 0.0 < section[:, 1].max())  # goes round, and drops at its outer edges
                ends = {"end0": -out, "reach0": 0.0, "end1": out, "reach1": high, "caps": 2 * rim}
                pieces.append({"origin": point, "along": out, "across": across, "partner": number + 1, **ends})
                ends = {"end0": -across, "reach0": -low, "end1": across, "reach1": high, "caps": 3 * rim}
                pieces.append({"origin": point, "along": -across, "across": out, "partner": number, **ends})
                if groove.scales is not None:
                    box = {"low": section.min(0) * size, "high": section.max(0) * size, "taper": len(self.tapers)}
                    self.tapers.append((size, np.zeros(2)))
                    pieces[-2] |= box
                    pieces[-1] |= box
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
        if len(self.repeats):
            return build(self.strips()[:0], cell=self.widest(6.0))
        return build(self.strips())

    def widest(self, held: float) -> float:
        """Diameter of a footprint that touches ``held`` pieces on average, were they spread evenly."""
        table, steps = self.table, self.repeats
        wide = float((table["high"] - table["low"])[:, 0].mean())
        if len(steps):
            apart = np.abs((steps[:, :2] * table["across"]).sum(1))
            return max(held / float((1.0 / apart).sum()), 2.0 * wide)
        strips = self.strips()
        low, high = box(strips)
        length, width = 2.0 * strips["half"].T
        # sum of (l + d) (w + d) = held area, solved for d
        b, c = float(np.sum(length + width)), float(np.sum(length * width)) - held * float(np.prod(high - low))
        found = (-b + float(np.sqrt(max(b * b - 4.0 * len(strips) * c, 0.0)))) / (2.0 * len(strips))
        return max(found, 2.0 * wide)

    @staticmethod
    def _goes_on(section: np.ndarray) -> bool:
        """Whether a mitred end starts with the whole section, for its middle is the deepest (or the highest) part."""
        middle = height_at(section, 0.0)
        extreme = section[:, 1].min() if section[:, 1].min() < 0.0 else section[:, 1].max()
        return abs(middle - extreme) <= 1e-12 * abs(extreme)
