"""Pieces made from what is stored of a pattern: a record a path and a point a corner, or two points for many rings.

A point takes 16 bytes and a path 32, a piece as it is used ten times that; so pieces are made where they are needed, a
footprint's at once. Two stretches that meet make the same end plane of the same numbers.
"""

import warp as wp

from ...scratches.paths import CHORD, FEWEST, PHASES, RINGS_ALIKE
from .solid_device import GroovePath, GrooveSet, Piece

wp.set_module_options({"enable_backward": False})

LOOP = wp.constant(1)  # kinds of paths: the last point is the first
CAPPED = wp.constant(2)  # walls stand at its ends
STARTS = wp.constant(4)  # two more pieces, a mitred end, where it starts
STOPS = wp.constant(8)  # and where it stops
RINGS = wp.constant(16)  # rings: about the first point, through the second, the third's x between them
DIGS_AND_PILES = wp.constant(32)

TURN = wp.constant(wp.float64(2.0 * 3.14159265358979323846))
_CHORD = wp.constant(wp.float64(CHORD))
_FEWEST = wp.constant(int(FEWEST))
_ALIKE = wp.constant(int(RINGS_ALIKE))
_PHASES = wp.constant(wp.float64(PHASES))
_STRAIGHT = wp.constant(wp.float64(1e-12))


@wp.func
def chords_of(radius: wp.float64, width: wp.float64) -> int:
    """How many chords a ring is drawn by: ``scratches.paths.chords``."""
    n = int(_FEWEST)
    part = wp.min(_CHORD * width / radius, wp.float64(0.25))
    least = wp.float64(0.5) * TURN / wp.sqrt(wp.float64(2.0) * part)
    while wp.float64(n) < least:
        n = 2 * n
    return n


@wp.func
def phase_of(ring: int) -> wp.float64:
    """Where a ring begins, in chords: a few neighbours begin alike, so that their chords run in parallel."""
    turned = wp.float64(ring / _ALIKE) * _PHASES
    return turned - wp.floor(turned)


@wp.func
def step_of(grooves: GrooveSet, first: int, j: int) -> wp.vec2d:
    """Unit vector along stretch ``j`` of the points from ``first`` on."""
    step = grooves.points[first + j + 1] - grooves.points[first + j]
    return step / wp.length(step)


@wp.func
def with_section(grooves: GrooveSet, path: GroovePath) -> Piece:
    """A piece that lies nowhere yet."""
    piece = Piece()
    piece.first = path.section
    piece.count = path.corners
    piece.partner = -1
    piece.taper = -1
    piece.path = path.number
    low = grooves.vertices[path.section]
    high = low
    for j in range(path.section + 1, path.section + path.corners):
        v = grooves.vertices[j]
        low = wp.min(low, v)
        high = wp.max(high, v)
    piece.low = low
    piece.high = high
    return piece


@wp.func
def end_between(path: GroovePath, along: wp.vec2d, neighbour: wp.vec2d, joined: bool, end: int) -> wp.vec3d:
    """The end plane of a stretch: outward normal and what ``Piece.caps`` has for it."""
    sign = wp.float64(2 * end - 1)
    normal = sign * along
    cap = float(1.0)
    if joined:
        bisector = along + neighbour
        length = wp.length(bisector)
        if length > wp.float64(1e-6):
            normal = sign * (bisector / length)
            cap = 0.0
        if path.taper >= 0:
            # facets turn there, and beyond a corner the two profiles do not quite agree
            turn = wp.abs(along[0] * neighbour[1] - along[1] * neighbour[0])
            cap = wp.where(turn <= _STRAIGHT and wp.dot(along, neighbour) > wp.float64(0.0), 4.0, 1.0)
    elif path.kind & CAPPED == 0:
        cap = 0.0
    return wp.vec3d(normal[0], normal[1], wp.float64(cap))


@wp.func
def stretch(grooves: GrooveSet, path: GroovePath, j: int) -> Piece:
    """Stretch number ``j`` of a path."""
    piece = with_section(grooves, path)
    along = step_of(grooves, path.point, j)
    before = along
    after = along
    joined0 = bool(j > 0 or path.kind & LOOP != 0)
    joined1 = bool(j < path.count - 1 or path.kind & LOOP != 0)
    if joined0:
        before = step_of(grooves, path.point, wp.where(j > 0, j - 1, path.count - 1))
    if joined1:
        after = step_of(grooves, path.point, wp.where(j < path.count - 1, j + 1, 0))
    piece.origin = grooves.points[path.point + j]
    piece.along = along
    piece.across = wp.vec2d(-along[1], along[0])
    e0 = end_between(path, along, before, joined0, 0)
    e1 = end_between(path, along, after, joined1, 1)
    piece.end0 = wp.vec2d(e0[0], e0[1])
    piece.end1 = wp.vec2d(e1[0], e1[1])
    piece.reach1 = wp.dot(grooves.points[path.point + j + 1] - piece.origin, piece.end1)
    piece.caps = int(e0[2]) + 2 * int(e1[2])
    if path.taper >= 0:
        piece.taper = path.taper + j
        piece.low = grooves.tapers[piece.taper].low
        piece.high = grooves.tapers[piece.taper].high
    return piece


@wp.func
def mitred(grooves: GrooveSet, path: GroovePath, extra: int, half: int) -> Piece:
    """One of the two pieces of a mitred end, the path's first or second such end; each is the other's partner."""
    piece = with_section(grooves, path)
    stops = bool(extra == 1 or path.kind & STARTS == 0)
    at = wp.where(stops, path.count, 0)
    t = step_of(grooves, path.point, wp.where(stops, path.count - 1, 0))
    out = wp.where(stops, t, -t)
    across = wp.vec2d(-t[1], t[0])
    piece.origin = grooves.points[path.point + at]
    if path.taper >= 0:
        piece.taper = path.taper + path.count + extra
        piece.low = grooves.tapers[piece.taper].low
        piece.high = grooves.tapers[piece.taper].high
    rim = wp.where(path.kind & DIGS_AND_PILES != 0, 1, 0)  # goes round, and drops at its outer edges
    if half == 0:
        piece.along = out
        piece.across = across
        piece.end0 = -out
        piece.caps = 2 * rim
    else:
        piece.along = -across
        piece.across = out
        piece.end0 = -across
        piece.reach0 = -piece.low[0]
        piece.caps = 3 * rim
    piece.end1 = -piece.end0
    piece.reach1 = piece.high[0]
    return piece


@wp.func
def ring_piece(grooves: GrooveSet, path: GroovePath, ring: int, j: int) -> Piece:
    """Chord ``j`` of a ring, counted from 0 to ``chords_of`` its radius, or from further round."""
    piece = with_section(grooves, path)
    center = grooves.points[path.point]
    radius = grooves.points[path.point + 1][0] + wp.float64(ring) * grooves.points[path.point + 1][1]
    n = chords_of(radius, piece.high[0] - piece.low[0])
    k = (j % n + n) % n
    part = TURN / wp.float64(n)
    shift = phase_of(ring)
    a = part * (wp.float64(k) + shift)
    b = part * (wp.float64((k + 1) % n) + shift)
    middle = part * (wp.float64(k) + shift + wp.float64(0.5))
    c0 = wp.cos(a)
    s0 = wp.sin(a)
    c1 = wp.cos(b)
    s1 = wp.sin(b)
    piece.along = wp.vec2d(-wp.sin(middle), wp.cos(middle))
    piece.across = wp.vec2d(-piece.along[1], piece.along[0])
    piece.origin = center + radius * wp.vec2d(c0, s0)
    piece.end0 = wp.vec2d(s0, -c0)
    piece.end1 = wp.vec2d(-s1, c1)
    piece.reach1 = radius * wp.dot(wp.vec2d(c1 - c0, s1 - s0), piece.end1)
    return piece


@wp.func
def path_with(grooves: GrooveSet, k: int) -> int:
    """Place in ``paths`` of the path that piece ``k`` of the grid belongs to."""
    low = grooves.first_path
    high = grooves.first_path + grooves.path_count - 1
    while low < high:
        middle = (low + high + 1) / 2
        if grooves.paths[middle].first <= k:
            low = middle
        else:
            high = middle - 1
    return low


@wp.func
def piece_made(grooves: GrooveSet, path: GroovePath, j: int) -> Piece:
    """Piece ``j`` of a path of the grid: a stretch, or part of a mitred end."""
    if j < path.count:
        return stretch(grooves, path, j)
    return mitred(grooves, path, (j - path.count) / 2, (j - path.count) % 2)
