"""Patterns of grooves: paths and cross-sections, cut into straight pieces for the device."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ...scratches.grid import StripGrid, box, build, strip_table
from ...scratches.paths import chords
from ..vectors import numbers
from .section import closed_section, height_at, run_boxes, section_points
from .solid_device import GroovePath, GrooveSet, Piece, Taper
from .stored import make_pieces
from .stored_device import CAPPED, DIGS_AND_PILES, LOOP, RINGS, STARTS, STOPS
from .tapers import Row, joined, simplified, tangents, taper_of, turn_is_straight

ENDS = ("cap", "mitre")

_FIELDS = (
    "paths", "points", "vertices", "bottom", "top", "skin", "mixed", "wide", "first_path", "path_count", "sets",
    "first_step", "steps", "tapers",
)  # fmt: skip
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
            looked for: they should reach beyond all footprints. n of 1: an ordinary path.
        rings: for each path None or (distance, n): it is n rings that far from one another, about its first point, the
            smallest through its second; they too take no memory and need no grid. Chords of ``scratches.paths.chords``.

    Corners are mitred. Where grooves cross, the lower height counts where both dig in, the higher where both stand out,
    and what one digs cuts what another piles up. Paths that go straight on from another's end, with the same section,
    are one path. Raises ValueError naming the argument.

    Attributes:
        count: how many paths were given. grooves: what the device takes (``solid_device.GrooveSet``); stored: its paths
            as a NumPy table; table: pieces that do not repeat, as another; size: how many pieces there are, repeats
            counted; memory: bytes of paths, points and profiles.
        grid: where the pieces lie (``scratches.grid.StripGrid``, with bytes of its own).
    """

    def __init__(
        self,
        paths: Sequence[ArrayLike],
        profiles: Any,
        ends: str = "cap",
        scales: Sequence[ArrayLike | None] | None = None,
        repeats: ArrayLike | None = None,
        rings: Sequence[tuple[float, int] | None] | None = None,
    ) -> None:
        if ends not in ENDS:
            raise ValueError(f"ends must be one of {', '.join(ENDS)}, got {ends!r}")
        given = [numbers(f"paths[{i}]", p) for i, p in enumerate(paths)]
        for i, p in enumerate(given):
            if p.ndim != 2 or p.shape[1] != 2 or len(p) < 1:
                raise ValueError(f"paths[{i}] must have shape [k, 2], got {list(p.shape)}")
        sections = self._sections(profiles, len(given))
        sizes = self._scales(scales, given)
        steps = np.tile((0.0, 0.0, 1.0), (len(given), 1))
        if repeats is not None and given:
            steps = numbers("repeats", repeats)
        around = list(rings) if rings is not None else [None] * len(given)
        if steps.shape != (len(given), 3) or len(around) != len(given):
            raise ValueError(f"repeats must have shape [{len(given)}, 3], rings one entry for each path")
        several = [step[2] > 1.0 or ring is not None for step, ring in zip(steps, around, strict=True)]
        if any(many and (len(p) != 2 or np.array_equal(*p)) for many, p in zip(several, given, strict=True)):
            raise ValueError("repeats must have shape [k, 3], with paths of two points that differ where n is above 1")
        rows = [simplified(Row(p, s, i, t)) for i, (p, s, t) in enumerate(zip(given, sections, sizes, strict=True))]
        single = joined([row for row in rows if len(row.points) > 1 and not several[row.number]])
        many = [row for row in rows if several[row.number]]
        self.repeats = steps[[row.number for row in many]] if many else np.zeros((0, 3))
        self.count = len(given)
        self.ends = ends
        self.paths = tuple(self._groove(row) for row in single)
        self.sets = tuple((self._groove(row), around[row.number]) for row in many)
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
        vertices: list[np.ndarray] = []
        points: list[np.ndarray] = []
        tapers: list[tuple[np.ndarray, ...]] = []
        known: dict[bytes, int] = {}
        shared: dict[int, tuple[int, np.ndarray, np.ndarray, int]] = {}  # what many grooves have of one section
        record: Any = GroovePath
        stored = np.zeros(len(self.paths) + len(self.sets), dtype=record.numpy_dtype())
        corners = placed = first = 0
        whole = [(groove, None) for groove in self.paths]
        for k, (groove, ring) in enumerate([*whole, *self.sets]):
            section = groove.section
            if id(section) not in shared:
                key = section.tobytes()
                if key not in known:
                    runs = run_boxes(section)
                    known[key] = corners + len(runs)
                    vertices += [runs, section]
                    corners += len(runs) + len(section)
                low, high = section.min(0), section.max(0)
                kind = DIGS_AND_PILES if low[1] < 0.0 < high[1] else 0
                kind += CAPPED if self.ends == "cap" or not self._goes_on(section) else 0
                shared[id(section)] = known[key], low, high, kind
            place, low, high, kind = shared[id(section)]
            kind += LOOP if groove.loop else 0
            own, laid = groove.points, len(groove.points) - 1
            if ring is not None:
                kind, laid = kind + RINGS, int(ring[1])
                own = np.array([own[0], (np.linalg.norm(own[1] - own[0]), ring[0])])
            elif self.ends == "mitre" and not groove.loop and high[0] > 0.0:
                sizes = groove.scales if groove.scales is not None else np.ones((2, 2))
                kind += (STARTS if sizes[0].min() > 0.0 else 0) + (STOPS if sizes[-1].min() > 0.0 else 0)
            taper = -1
            if groove.scales is not None:
                taper = len(tapers)
                tapers += self._tapers(groove, [bit for bit in (STARTS, STOPS) if kind & bit])
            stored[k] = (first, placed, laid, place, len(section), kind, taper, groove.number)
            points.append(own)
            placed += len(own)
            if k < len(self.paths):
                first += laid + 2 * bool(kind & STARTS) + 2 * bool(kind & STOPS)
        made = GrooveSet()
        made.paths = wp.array(stored, dtype=GroovePath, device="cpu")
        where = np.concatenate(points) if points else np.zeros((0, 2))
        made.points = wp.array(where, dtype=wp.vec2d, device="cpu")
        shape = np.concatenate(vertices) if vertices else np.zeros((0, 2))
        made.vertices = wp.array(shape, dtype=wp.vec2d, device="cpu")
        record = Taper
        grown = np.zeros(len(tapers), dtype=record.numpy_dtype())
        for k, values in enumerate(tapers):
            for name, value in zip(("size", "grow", "low", "high"), values, strict=True):
                grown[name][k] = value
        made.tapers = wp.array(grown, dtype=Taper, device="cpu")
        made.first_path, made.path_count, made.sets, made.first_step = 0, len(self.paths), len(self.sets), 0
        made.steps = wp.array(self.repeats, dtype=wp.vec3d, device="cpu")
        self.stored = stored
        self.table = make_pieces(made, first)
        boxes = [shape, grown["low"], grown["high"], self.table["low"], self.table["high"]]
        z = np.concatenate([[0.0], *(box[:, 1] for box in boxes)])
        made.bottom, made.top = wp.float64(z.min()), wp.float64(z.max())
        x = np.concatenate([box[:, 0] for box in boxes]) if len(shape) else np.ones(1)
        made.skin = wp.float64(_SKIN * max(np.abs(z).max(), np.abs(x).max()))
        made.wide = wp.float64((1.0 + 1e-9) * np.abs(x).max())
        made.mixed = int(z.min() < 0.0 < z.max())
        self.size = first + self._repeated()
        self.memory = stored.nbytes + where.nbytes + shape.nbytes + grown.nbytes + self.repeats.nbytes
        return made

    def room(self, count: int) -> Any:
        """What the device takes, with room for ``count`` pieces near a footprint."""
        made, own = GrooveSet(), self.grooves
        for name in _FIELDS:
            setattr(made, name, getattr(own, name))
        made.pieces = wp.zeros(count, dtype=Piece, device="cpu")
        return made

    def _repeated(self) -> int:
        """How many pieces lines and rings that repeat would be."""
        total = 0
        for (groove, ring), step in zip(self.sets, self.repeats, strict=True):
            total += int(step[2])
            if ring is not None:
                radii = np.linalg.norm(groove.points[1] - groove.points[0]) + ring[0] * np.arange(ring[1])
                total += int(chords(radii, float(np.ptp(groove.section[:, 0]))).sum()) - int(step[2])
        return total

    def _tapers(self, groove: Groove, ends: list[int]) -> list[tuple[np.ndarray, ...]]:
        """(size, grow, low, high) of each stretch of a path and of its mitred ``ends``."""
        p, section, scales = groove.points, groove.section, groove.scales
        assert scales is not None
        t = tangents(p)
        made: list[tuple[np.ndarray, ...]] = []
        last = len(t) - 1
        for k, along in enumerate(t):
            piece: dict[str, Any] = {"along": along, "across": (-along[1], along[0])}
            before = t[k - 1] if k > 0 or groove.loop else None
            after = t[(k + 1) % len(t)] if k < last or groove.loop else None
            for end, (neighbour, sign) in enumerate(((before, -1.0), (after, 1.0))):
                normal = sign * along
                if neighbour is not None and np.linalg.norm(along + neighbour) > 1e-6:
                    normal = sign * (along + neighbour) / np.linalg.norm(along + neighbour)
                piece[f"end{end}"] = normal
            made.append(taper_of(section, p[k], p[k + 1], scales[k], scales[k + 1], piece))
        for bit in ends:
            size = scales[0 if bit == STARTS else -1]
            made.append((size, np.zeros(2), section.min(0) * size, section.max(0) * size))
        return made

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
        """The uniform grid in which the pieces near a footprint are looked up, by the measured rule."""
        return self.grid_by()

    def grid_by(self, rule: str = "balanced") -> StripGrid:
        """The grid with cells by one of ``scratches.grid.RULES``; for grooves that all repeat an empty one."""
        if not len(self.table):
            return build(self.strips(), cell=self.widest(6.0))
        return build(self.strips(), rule)

    def widest(self, held: float) -> float:
        """Diameter of a footprint that touches ``held`` pieces on average, were they spread evenly."""
        sections = [g.section for g in self.paths] + [g.section for g, _ in self.sets]
        wide = float(np.mean([np.ptp(s[:, 0]) for s in sections])) if sections else 1.0
        lines = 0.0  # a length
        for (groove, ring), step in zip(self.sets, self.repeats, strict=True):
            along = tangents(groove.points)[0]
            lines += 1.0 / (ring[0] if ring is not None else abs(float(along[0] * step[1] - along[1] * step[0])))
        a = b = c = 0.0
        if len(self.table):
            strips = self.strips()
            low, high = box(strips)
            length, width = 2.0 * strips["half"].T
            # sum of (l + d) (w + d) = held area, with lines / d more of them
            area = max(float(np.prod(high - low)), 1e-300)
            a, b, c = len(strips) / area, float(np.sum(length + width)) / area, float(np.sum(length * width)) / area
        b, c = b + lines, c - held
        root = float(np.sqrt(max(b * b - 4.0 * a * c, 0.0)))
        found = -2.0 * c / (b + root) if b + root > 0.0 else 0.0
        return max(found, 2.0 * wide)

    @staticmethod
    def _goes_on(section: np.ndarray) -> bool:
        """Whether a mitred end starts with the whole section, for its middle is the deepest (or the highest) part."""
        middle = height_at(section, 0.0)
        extreme = section[:, 1].min() if section[:, 1].min() < 0.0 else section[:, 1].max()
        return abs(middle - extreme) <= 1e-12 * abs(extreme)
