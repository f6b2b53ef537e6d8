"""Scratches of one layer as polylines in the plane of the surface, each with its width and depth."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..scene import Curves, Layer
from .generate import random_scratches
from .perturb import along_path, profile_runs

# A circle is drawn by chords that leave it by at most this part of a groove's width.
CHORD = 0.02
FEWEST = 8  # chords of a ring; other numbers are this one doubled
# Neighbours that begin at the same angle, so that their chords run in parallel; how many chords further the next begin.
RINGS_ALIKE, PHASES = 8, 0.6180339887498949
# More grooves, or corners of rings and spirals, than anything could draw.
MOST_LINES, MOST_CORNERS = 400_000, 20_000_000
PARTS = 8  # steps of the way from a profile to the other one

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Path:
    """A polyline [k, 2] in micrometres over the surface, the width and the depth of its groove [um]; ``scales`` [k, 2]:
    of width and depth at each point, None: 1; ``part``: of the way to the layer's other profile."""

    points: Array
    width: float
    depth: float
    scales: Array | None = None
    part: float = 0.0


def repeated(
    layer: Layer, low: Array, high: Array, scale: Array, handed: float = 1.0
) -> list[tuple[Path, Array, int]] | None:
    """Regular lines and rings as ``lay_out`` has them: the first of each set, how far [um] the next one is ([2], of
    rings [1]), how many there are. A set of rings is (their centre, a point of the smallest one).

    None for other layers, where lines differ, and where circles are stretched.
    """
    alike = layer.width_variation == layer.depth_variation == layer.variation_length == layer.profile_variation == 0.0
    known = layer.distribution in ("linear", "crosshatch", "concentric")
    if not known or not alike or layer.width <= 0.0 or layer.pitch <= 0.0:
        return None
    size = np.asarray(scale, float) * (1.0, handed)
    plane = size if layer.space == "surface" else np.array([1.0, handed])
    corners = np.array([[u, v] for u in (low[0], high[0]) for v in (low[1], high[1])]) * plane
    back, made = np.abs(size / plane), []
    if layer.distribution == "concentric":
        if abs(back[0] - back[1]) > 1e-9 * back[0]:
            return None
        center, shift = np.array(layer.center) * plane, layer.offset[1] * layer.pitch
        radii = _ring_radii(layer, corners, center, shift)
        if not len(radii):
            return []
        points = np.array([center, center + (radii[0], 0.0)])
        path = Path(points * back, layer.width * back[0], layer.depth * back[0])
        return [(path, layer.pitch * back[:1], len(radii))]
    for number, angle in enumerate(_angles(layer)):
        first, last, at = _range(layer, corners, angle, layer.offset[1 - number % 2] * layer.pitch)
        across = np.array([-math.sin(angle), math.cos(angle)])
        path = _stretched(at(first), back, layer.width, layer.depth)
        made.append((path, layer.pitch * across * back, last - first + 1))
    return made


def lay_out(
    layer: Layer,
    low: Array,
    high: Array,
    scale: Array,
    handed: float = 1.0,
    curves: Sequence[Curves] = (),
    most: int = MOST_LINES,
) -> list[Path]:
    """The scratches of ``layer`` over uv from ``low`` to ``high``, on a surface of ``scale`` micrometres a unit of u
    and of v. ``handed`` -1: of a mirrored mapping, angles turn the other way in uv and v counts backwards; the result
    does as well. ``curves``: of distribution curves, in uv.

    Regular patterns reach a little beyond the rectangle; those with a variation have widths and depths of their own.
    Raises ValueError where that would be more than ``MOST_LINES`` lines or ``MOST_CORNERS`` corners of rings, or more
    than ``most`` scratches laid at random.
    """
    size = np.asarray(scale, float) * (1.0, handed)  # micrometres a unit of u and of mirrored v
    if layer.distribution == "curves" or layer.distribution in ("worley", "random"):
        own = list(curves)
        if layer.distribution != "curves":
            unit = np.asarray(scale, float) if layer.space == "surface" else np.ones(2)
            own = [random_scratches(layer, tuple(low.tolist()), tuple(high.tolist()), tuple(unit.tolist()))]
            _bounded(layer, len(own[0].counts), most, "grooves", "coverage less")
        return _perturbed(layer, [path for set in own for path in _polylines(set, size)], size)
    plane = size if layer.space == "surface" else np.array([1.0, handed])  # from uv to the layer's own plane
    corners = np.array([[u, v] for u in (low[0], high[0]) for v in (low[1], high[1])]) * plane
    angles = _angles(layer)
    made: list[Array] = []
    if layer.width <= 0.0 or layer.pitch <= 0.0:
        return []
    for number, angle in enumerate(angles):
        shift = layer.offset[1 - number % 2] * layer.pitch
        if layer.distribution in ("linear", "crosshatch"):
            made += _lines(layer, corners, angle, shift)
        elif layer.distribution == "concentric":
            made += _circles(layer, corners, np.array(layer.center) * plane, shift)
        else:
            made += _spiral(layer, corners, np.array(layer.center) * plane, shift)
    if layer.variation_length > 0.0:
        back = np.abs(size / plane)
        return _perturbed(layer, [_stretched(points, back, layer.width, layer.depth) for points in made], size)
    rng = np.random.default_rng([layer.seed & 0xFFFFFFFF, *layer.name.encode()])
    wide = 1.0 + layer.width_variation * (2.0 * rng.random(len(made)) - 1.0)
    deep = 1.0 + layer.depth_variation * (2.0 * rng.random(len(made)) - 1.0)
    back = np.abs(size / plane)
    laid = [
        _stretched(points, back, layer.width * w, layer.depth * d)
        for points, w, d in zip(made, wide, deep, strict=True)
    ]
    return _perturbed(layer, laid, size)


def _stretched(points: Array, back: Array, width: float, depth: float) -> Path:
    """A path of the layer's own plane in micrometres: widths are stretched as the plane is across the path."""
    run = np.abs(points[-1] - points[0]) if len(points) == 2 else np.abs(np.diff(points, axis=0)).sum(0)
    along = run / max(float(np.linalg.norm(run)), 1e-300)
    across = float(back[0] * back[1] / max(np.linalg.norm(back * along), 1e-300))
    return Path(points * back, width * across, depth * across)


def _perturbed(layer: Layer, paths: list[Path], size: Array) -> list[Path]:
    """Paths whose widths, depths and profiles vary as the layer says: along each of them where it has a
    ``variation_length``, the profile in steps, at which one path ends and the next one begins; else from path to
    path."""
    rng = np.random.default_rng([layer.seed & 0xFFFFFFFF, 7, *layer.name.encode()])
    unit = 1.0 if layer.space == "surface" else math.sqrt(abs(size[0] * size[1]))
    amount = layer.profile_variation if layer.profile_end is not None else 0.0
    made = []
    for path in paths:
        if layer.variation_length > 0.0 and max(layer.width_variation, layer.depth_variation) > 0.0:
            points, scales = along_path(layer, path.points, layer.variation_length * unit, rng)
            if path.scales is not None:
                scales = scales * _at(path, points)
            path = replace(path, points=points, scales=scales)
        if amount > 0.0 and layer.variation_length > 0.0:
            try:
                runs = profile_runs(path.points, path.scales, layer.variation_length * unit, PARTS, rng)
            except ValueError as error:
                raise ValueError(f"{layer.label}: {error}; make variationLength longer") from None
            made += [replace(path, points=p, scales=sizes, part=amount * part) for p, sizes, part in runs]
            continue
        if amount > 0.0:  # a few steps, so that paths share their profiles
            path = replace(path, part=amount * round(rng.random() * PARTS) / PARTS)
        made.append(path)
    return made


def _at(path: Path, points: Array) -> Array:
    """Scales of a path at points further along it."""
    assert path.scales is not None
    lengths = [np.linalg.norm(np.diff(p, axis=0), axis=1) for p in (path.points, points)]
    first, last = (np.concatenate([[0.0], np.cumsum(step)]) for step in lengths)
    return np.stack([np.interp(last, first, column) for column in path.scales.T], 1)


def _polylines(curves: Curves, size: Array) -> list[Path]:
    made = []
    scale = math.sqrt(abs(size[0] * size[1]))
    first = 0
    for count in curves.counts:
        own = slice(first, first + count)
        first += count
        widths, depths = np.asarray(curves.widths[own], float), np.asarray(curves.depths[own], float)
        wide, deep = float(widths.max(initial=0.0)), float(depths.max(initial=0.0))
        if wide <= 0.0 or count < 2:
            continue
        scales = None
        if np.ptp(widths) > 1e-6 * wide or np.ptp(depths) > 1e-6 * deep:
            scales = np.stack([widths / wide, depths / deep if deep > 0.0 else np.ones(count)], 1)
        width = wide * (scale if curves.width_unit == "uv" else 1.0)
        depth = deep * (scale if curves.depth_unit == "uv" else 1.0)
        made.append(Path(curves.points[own, :2] * size, width, depth, scales))
    return made


def _bounded(layer: Layer, count: float, most: int, what: str, remedy: str = "pitch larger") -> None:
    if not count <= most:
        raise ValueError(
            f"{layer.label}: it calls for {count:.3g} {what}, more than {most}; set its model to table, or make its "
            f"{remedy}"
        )


def _angles(layer: Layer) -> list[float]:
    return [layer.angle] if layer.distribution != "crosshatch" else [layer.angle, layer.angle + layer.cross_angle]


def _range(layer: Layer, corners: Array, angle: float, shift: float) -> tuple[int, int, Callable[[int], Array]]:
    """Numbers of the first and the last line, and what gives the two ends of one."""
    along, across = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
    x, y = corners @ along, corners @ across + shift
    margin = 0.5 * float(x.max() - x.min()) + 10.0 * layer.pitch
    _bounded(layer, float(np.ptp(y)) / layer.pitch, MOST_LINES, "grooves")
    first = math.floor(float(y.min()) / layer.pitch) - 2
    last = math.ceil(float(y.max()) / layer.pitch) + 2
    ends = np.array([x.min() - margin, x.max() + margin])

    def line(i: int) -> Array:
        return ends[:, None] * along + (i * layer.pitch + 0.5 * layer.width - shift) * across

    return first, last, line


def _lines(layer: Layer, corners: Array, angle: float, shift: float) -> list[Array]:
    first, last, line = _range(layer, corners, angle, shift)
    return [line(i) for i in range(first, last + 1)]


def chords(radii: Array, width: float) -> Array:
    """How many chords rings of ``radii`` are drawn by whose grooves are ``width`` wide: ``FEWEST``, doubled."""
    least = math.pi / np.sqrt(2.0 * np.minimum(CHORD * width / radii, 0.25))
    n = np.full(np.shape(radii), FEWEST)
    while (n < least).any():
        n = np.where(n < least, 2 * n, n)
    return n


def _radii(corners: Array, center: Array, layer: Layer) -> tuple[float, float]:
    low, high = corners.min(0), corners.max(0)
    nearest = float(np.linalg.norm(np.maximum(np.maximum(low - center, center - high), 0.0)))
    return nearest - 2.0 * layer.pitch, float(np.linalg.norm(corners - center, axis=1).max()) + 2.0 * layer.pitch


def _ring_corners(layer: Layer, nearest: float, farthest: float) -> float:
    """About how many corners rings from one radius to another have."""
    turns = (farthest - max(nearest, 0.0)) / layer.pitch
    return turns * max(math.pi / math.sqrt(2.0 * min(CHORD * layer.width / max(farthest, 1e-300), 0.25)), 8.0)


def _runs(points: Array, corners: Array, margin: float) -> list[Array]:
    """The parts of a polyline within ``margin`` of the box about the corners."""
    low, high = corners.min(0) - margin, corners.max(0) + margin
    a, b = points[:-1], points[1:]
    near = np.all((np.minimum(a, b) <= high) & (np.maximum(a, b) >= low), axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], near, [False]]).astype(int)))
    return [points[i : j + 1] for i, j in zip(edges[::2], edges[1::2], strict=True)]


def _ring_radii(layer: Layer, corners: Array, center: Array, shift: float) -> Array:
    """Radii of the rings that a rectangle has a part in."""
    nearest, farthest = _radii(corners, center, layer)
    first = math.floor((max(nearest, 0.0) + shift) / layer.pitch)
    radii = np.arange(first, math.ceil((farthest + shift) / layer.pitch)) * layer.pitch + 0.5 * layer.width - shift
    return radii[radii > 0.5 * layer.width]


def _circles(layer: Layer, corners: Array, center: Array, shift: float) -> list[Array]:
    made: list[Array] = []
    nearest, farthest = _radii(corners, center, layer)
    _bounded(layer, _ring_corners(layer, nearest, farthest), MOST_CORNERS, "corners of rings")
    for i, r in enumerate(_ring_radii(layer, corners, center, shift).tolist()):
        n = int(chords(np.array(r), layer.width))
        turn = 2.0 * math.pi * (np.arange(n) + i // RINGS_ALIKE * PHASES % 1.0) / n
        ring = center + r * np.stack([np.cos(turn), np.sin(turn)], 1)
        made += _runs(np.concatenate([ring, ring[:1]]), corners, 2.0 * layer.pitch)
    return made


def _spiral(layer: Layer, corners: Array, center: Array, shift: float) -> list[Array]:
    nearest, farthest = _radii(corners, center, layer)
    _bounded(layer, _ring_corners(layer, nearest, farthest), MOST_CORNERS, "corners of a spiral")
    start = shift - 0.5 * layer.width  # radius = pitch turns - start
    turns = [(max(nearest, 0.5 * layer.width) + start) / layer.pitch]
    while layer.pitch * turns[-1] - start < farthest:
        r = max(layer.pitch * turns[-1] - start, 0.5 * layer.width)
        turns.append(turns[-1] + min(math.sqrt(8.0 * min(CHORD * layer.width / r, 0.25)), 0.5) / (2.0 * math.pi))
    at = np.array(turns)
    radii, angle = layer.pitch * at - start, 2.0 * math.pi * at
    points = center + radii[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
    return _runs(points, corners, 2.0 * layer.pitch)
