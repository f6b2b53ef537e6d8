"""Where what is seen may change along a line: the edges of grooves, projected.

A line in the plane z = 0, base + b step, and a direction d with d_z > 0, given by its slope (d_x, d_y) / d_z, span a
plane that cuts the grooves. Seen along d, what lies at b can change only where an edge of the surface projects to b:
a vertex of a profile, an end plane, or where facets of two pieces cross. Those b are gathered in rising order.
"""

import warp as wp

from .solid_device import GrooveSet, Piece, piece_at
from .taper_device import edge_seen

wp.set_module_options({"enable_backward": False})

EVENTS = wp.constant(48)  # gathered at once; the caller asks again from the last one on


@wp.struct
class Line:
    """base + b step in the plane z = 0, looked at along a direction of that slope."""

    base: wp.vec2d
    step: wp.vec2d
    slope: wp.vec2d


@wp.struct
class Height:
    """A plane seen along a line: at b it shows z = at + b rise, where b lies in [low, high] (none: low > high)."""

    at: wp.float64
    rise: wp.float64
    low: wp.float64
    high: wp.float64


@wp.func
def insert(events: wp.array(dtype=wp.float64), found: int, b: wp.float64) -> int:
    """Put ``b`` in its place among the ``found`` sorted events; of too many the largest is dropped."""
    n = int(found)
    j = int(n)
    if n == EVENTS:
        j = n - 1
        if events[j] <= b:
            j = -1
    else:
        n = n + 1
    if j >= 0:
        while j > 0 and events[wp.max(j - 1, 0)] > b:
            events[j] = events[j - 1]
            j = j - 1
        events[j] = b
    return n


@wp.func
def facet_height(grooves: GrooveSet, piece: Piece, j: int, line: Line) -> Height:
    """Facet from vertex ``j`` to ``j + 1`` of a piece."""
    zero = wp.float64(0.0)
    result = Height()
    result.low = wp.float64(1.0)
    v = grooves.vertices[j]
    w = grooves.vertices[j + 1]
    e = w - v
    s = wp.dot(line.slope, piece.across)
    x = wp.dot(line.base - piece.origin, piece.across)
    dx = wp.dot(line.step, piece.across)
    edge = e[0] - e[1] * s
    if piece.taper >= 0:
        # nearly flat: the plane through where its two edges are seen
        one = edge_seen(grooves, piece, v, line.base, line.step, line.slope)
        two = edge_seen(grooves, piece, w, line.base, line.step, line.slope)
        if one[2] > zero and two[2] > zero and one[0] != two[0]:
            result.rise = (two[1] - one[1]) / (two[0] - one[0])
            result.at = one[1] - one[0] * result.rise
            result.low = wp.min(one[0], two[0])
            result.high = wp.max(one[0], two[0])
    elif edge != zero and dx != zero:
        result.at = (e[0] * v[1] - e[1] * (v[0] - x)) / edge
        result.rise = e[1] * dx / edge
        b0 = (v[0] - v[1] * s - x) / dx
        b1 = (w[0] - w[1] * s - x) / dx
        result.low = wp.min(b0, b1)
        result.high = wp.max(b0, b1)
    return result


@wp.func
def wall_height(m: wp.vec2d, reach: wp.float64, line: Line, bottom: wp.float64, top: wp.float64) -> Height:
    """The vertical plane dot(m, x) = reach between two heights."""
    zero = wp.float64(0.0)
    result = Height()
    result.low = wp.float64(1.0)
    s = wp.dot(m, line.slope)
    dm = wp.dot(m, line.step)
    if s != zero and dm != zero:
        result.at = (reach - wp.dot(m, line.base)) / s
        result.rise = -dm / s
        b0 = (bottom - result.at) / result.rise
        b1 = (top - result.at) / result.rise
        result.low = wp.min(b0, b1)
        result.high = wp.max(b0, b1)
    return result


@wp.func
def meet(p: Height, q: Height, start: wp.float64, stop: wp.float64) -> wp.float64:
    """The b in (start, stop) at which two planes show the same height within both; ``stop`` when there is none."""
    result = stop
    low = wp.max(wp.max(p.low, q.low), start)
    high = wp.min(wp.min(p.high, q.high), stop)
    turn = q.rise - p.rise
    if low < high and turn != wp.float64(0.0):
        b = (p.at - q.at) / turn
        if b > low and b < high:
            result = b
    return result


@wp.func
def strip_of(piece: Piece, line: Line) -> wp.vec2d:
    """Between which b a piece shows, endless along itself (low > high: at no b, or at all of them)."""
    zero = wp.float64(0.0)
    s = wp.dot(line.slope, piece.across)
    x = wp.dot(line.base - piece.origin, piece.across)
    dx = wp.dot(line.step, piece.across)
    low = piece.low[0] - x - wp.max(piece.low[1] * s, piece.high[1] * s)
    high = piece.high[0] - x - wp.min(piece.low[1] * s, piece.high[1] * s)
    result = wp.vec2d(wp.float64(1.0), zero)
    if dx > zero:
        result = wp.vec2d(low / dx, high / dx)
    elif dx < zero:
        result = wp.vec2d(high / dx, low / dx)
    return result


@wp.func
def wall_meets(
    grooves: GrooveSet, ids: wp.array(dtype=int), count: int, line: Line, wall: Height, start: wp.float64,
    stop: wp.float64, events: wp.array(dtype=wp.float64), found: int,
) -> int:  # fmt: skip
    """Gather where a vertical wall meets facets or end walls of any piece."""
    n = int(found)
    if wp.max(wall.low, start) < wp.min(wall.high, stop):
        for c in range(count):
            other = piece_at(grooves, ids[c])
            for end in range(2):
                if (other.caps >> end) & 1 == 1:
                    m = wp.where(end == 0, other.end0, other.end1)
                    reach = wp.where(end == 0, other.reach0, other.reach1) + wp.dot(m, other.origin)
                    b = meet(wall, wall_height(m, reach, line, grooves.bottom, grooves.top), start, stop)
                    if b < stop:
                        n = insert(events, n, b)
            strip = strip_of(other, line)
            if wp.max(strip[0], wp.max(wall.low, start)) < wp.min(strip[1], wp.min(wall.high, stop)):
                for j in range(other.first, other.first + other.count - 1):
                    b = meet(wall, facet_height(grooves, other, j, line), start, stop)
                    if b < stop:
                        n = insert(events, n, b)
    return n


@wp.func
def turns(
    grooves: GrooveSet, piece: Piece, facet: Height, line: Line, start: wp.float64, stop: wp.float64,
    events: wp.array(dtype=wp.float64), found: int,
) -> int:  # fmt: skip
    """Gather where a facet goes over to that of the next stretch of its groove."""
    n = int(found)
    for end in range(2):
        if (piece.caps >> (2 + end)) & 1 == 1:
            m = wp.where(end == 0, piece.end0, piece.end1)
            reach = wp.where(end == 0, piece.reach0, piece.reach1) + wp.dot(m, piece.origin)
            b = meet(facet, wall_height(m, reach, line, grooves.bottom, grooves.top), start, stop)
            if b < stop:
                n = insert(events, n, b)
    return n


@wp.func
def gather_edges(
    grooves: GrooveSet, ids: wp.array(dtype=int), count: int, line: Line, start: wp.float64, stop: wp.float64,
    events: wp.array(dtype=wp.float64),
) -> int:  # fmt: skip
    """How many b in (start, stop) were written to ``events``, rising: at most ``EVENTS``, the first of them."""
    zero = wp.float64(0.0)
    n = int(0)
    for a in range(count):
        piece = piece_at(grooves, ids[a])
        strip = strip_of(piece, line)
        shown = wp.max(strip[0], start) < wp.min(strip[1], stop)
        for end in range(2):
            m = wp.where(end == 0, piece.end0, piece.end1)
            wall = (piece.caps >> end) & 1
            reach = wp.where(end == 0, piece.reach0, piece.reach1) + wp.dot(m, piece.origin)
            dm = wp.dot(m, line.step)
            if wall == 1 and dm != zero:
                b = (reach - wp.dot(m, line.base)) / dm
                if b > start and b < stop:
                    n = insert(events, n, b)
                height = wall_height(m, reach, line, grooves.bottom, grooves.top)
                n = wall_meets(grooves, ids, count, line, height, start, stop, events, n)
        if shown:
            s = wp.dot(line.slope, piece.across)
            x = wp.dot(line.base - piece.origin, piece.across)
            dx = wp.dot(line.step, piece.across)
            for j in range(piece.first, piece.first + piece.count):
                v = grooves.vertices[j]
                b = (v[0] - v[1] * s - x) / dx
                if piece.taper >= 0:
                    seen = edge_seen(grooves, piece, v, line.base, line.step, line.slope)
                    b = wp.where(seen[2] > zero, seen[0], stop)
                if b > start and b < stop:
                    n = insert(events, n, b)
                if j < piece.first + piece.count - 1:
                    own = facet_height(grooves, piece, j, line)
                    if piece.caps > 3:
                        n = turns(grooves, piece, own, line, start, stop, events, n)
                    if wp.max(own.low, start) < wp.min(own.high, stop):
                        for c in range(a + 1, count):
                            other = piece_at(grooves, ids[c])
                            strip = strip_of(other, line)
                            if wp.max(strip[0], wp.max(own.low, start)) < wp.min(strip[1], wp.min(own.high, stop)):
                                for i in range(other.first, other.first + other.count - 1):
                                    b = meet(own, facet_height(grooves, other, i, line), start, stop)
                                    if b < stop:
                                        n = insert(events, n, b)
                if grooves.mixed == 1 and v[1] == zero:
                    m = piece.across
                    reach = v[0] + wp.dot(piece.across, piece.origin)
                    if piece.taper >= 0:
                        taper = grooves.tapers[piece.taper]
                        m = wp.normalize(piece.across - v[0] * taper.grow[0] * piece.along)
                        reach = wp.dot(m, piece.origin + v[0] * taper.size[0] * piece.across)
                    height = wall_height(m, reach, line, zero, grooves.top)
                    n = wall_meets(grooves, ids, count, line, height, start, stop, events, n)
    return n
