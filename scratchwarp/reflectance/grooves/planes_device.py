"""Planes of grooves seen along a line: facets of profiles, end walls, and where two of them show the same height."""

import warp as wp

from .solid_device import GrooveSet, Piece
from .taper_device import edge_seen

wp.set_module_options({"enable_backward": False})

TIE = wp.constant(wp.float64(1e-9))  # edges nearer to one another than this, in half lines, are not told apart


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
    """The vertical plane dot(m, x) = reach between two heights, and a little beyond them."""
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
def opening_wall(grooves: GrooveSet, piece: Piece, j: int, line: Line) -> Height:
    """The wall over vertex ``j`` on the plane, where what piles up there is cut off."""
    zero = wp.float64(0.0)
    v = grooves.vertices[j]
    m = piece.across
    reach = v[0] + wp.dot(piece.across, piece.origin)
    if piece.taper >= 0:
        taper = grooves.tapers[piece.taper]
        m = wp.normalize(piece.across - v[0] * taper.grow[0] * piece.along)
        reach = wp.dot(m, piece.origin + v[0] * taper.size[0] * piece.across)
    return wall_height(m, reach, line, zero, grooves.top)


@wp.func
def meet(p: Height, q: Height, start: wp.float64, stop: wp.float64) -> wp.float64:
    """The b in (start, stop) at which two planes show the same height within both, or at their edges; ``stop`` when
    there is none."""
    result = stop
    low = wp.max(wp.max(p.low, q.low), start)
    high = wp.min(wp.min(p.high, q.high), stop)
    turn = q.rise - p.rise
    if low < high + TIE and turn != wp.float64(0.0):
        b = (p.at - q.at) / turn
        if b > low - TIE and b < high + TIE and b > start and b < stop:
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
