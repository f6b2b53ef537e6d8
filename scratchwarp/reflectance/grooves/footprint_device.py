"""Mean radiance of a footprint over grooves: exact along lines, which are added up over the footprint's width.

Along a line through the footprint everything is exact: the edges seen along the view direction part the line into
spans on each of which one plane is seen (one ray a span tells which); the edges seen from that plane along the light's
direction part the span into lit and dark ones (again one ray each). Where all grooves near a footprint run in parallel
and end outside it, one line across them is the whole answer, each span weighted by the area of the ellipse over it
(the exact form of Bosch et al. 2008, section 5). Elsewhere ``slices`` lines stand at the nodes of the Gauss-Chebyshev
rule of the second kind, in a direction that keeps off those of the grooves (section 6 by lines in place of polygons).
"""

from typing import Any

import warp as wp

from .line_device import CHORD, PI, UNIFORM, FootprintMean, make_line_mean, slope_of
from .solid_device import GrooveSet, Piece, piece_at

wp.set_module_options({"enable_backward": False})

PIECES = wp.constant(8)  # a line is cut into as many parts as there are times so many pieces
FACETS = wp.constant(96)  # and no fewer than times so many facets
MOST = wp.constant(64)  # pieces of one part; where more touch it, all of them are tried
TRIED = wp.constant(16)  # directions of lines compared


@wp.struct
class Footprint:
    """Ellipse center + disk point (a1, a2) in the plane z = 0."""

    center: wp.vec2d
    a1: wp.vec2d
    a2: wp.vec2d


@wp.func
def half_extent(f: Footprint, m: wp.vec2d) -> wp.float64:
    """How far the ellipse reaches along a unit vector ``m``."""
    x = wp.dot(f.a1, m)
    y = wp.dot(f.a2, m)
    return wp.sqrt(x * x + y * y)


@wp.func
def swept_range(grooves: GrooveSet, f: Footprint, slope_o: wp.vec2d, slope_i: wp.vec2d, m: wp.vec2d) -> wp.vec2d:
    """Range of dot(m, x) of all that the footprint sees and that can hide it or stand in its light.

    The ellipse, swept along the view from the lowest to the highest z, and up along the light by their difference.
    """
    zero = wp.float64(0.0)
    o = wp.dot(slope_o, m)
    i = wp.dot(slope_i, m) * (grooves.top - grooves.bottom)
    reach = half_extent(f, m) + wp.float64(4.0) * grooves.skin
    middle = wp.dot(f.center, m)
    low = middle - reach + wp.min(grooves.bottom * o, grooves.top * o) + wp.min(i, zero)
    high = middle + reach + wp.max(grooves.bottom * o, grooves.top * o) + wp.max(i, zero)
    return wp.vec2d(low, high)


@wp.func
def touches(grooves: GrooveSet, piece: Piece, f: Footprint, slope_o: wp.vec2d, slope_i: wp.vec2d) -> bool:
    """Whether a piece may be seen in a footprint, or hide or darken what is seen there."""
    x = swept_range(grooves, f, slope_o, slope_i, piece.across) - wp.dot(piece.origin, piece.across) * wp.vec2d(
        wp.float64(1.0), wp.float64(1.0)
    )
    result = x[0] <= piece.high[0] and x[1] >= piece.low[0]
    if result:
        e0 = swept_range(grooves, f, slope_o, slope_i, piece.end0)
        e1 = swept_range(grooves, f, slope_o, slope_i, piece.end1)
        result = (
            e0[0] - wp.dot(piece.origin, piece.end0) <= piece.reach0
            and e1[0] - wp.dot(piece.origin, piece.end1) <= piece.reach1
        )
    return result


@wp.func
def passes_through(grooves: GrooveSet, piece: Piece, f: Footprint, slope_o: wp.vec2d, slope_i: wp.vec2d) -> bool:
    """Whether a piece ends nowhere near a footprint."""
    e0 = swept_range(grooves, f, slope_o, slope_i, piece.end0)
    e1 = swept_range(grooves, f, slope_o, slope_i, piece.end1)
    return (
        e0[1] - wp.dot(piece.origin, piece.end0) < piece.reach0
        and e1[1] - wp.dot(piece.origin, piece.end1) < piece.reach1
    )


@wp.func
def direction_of_lines(
    grooves: GrooveSet, ids: wp.array(dtype=int), count: int, f: Footprint, slope_o: wp.vec2d, slope_i: wp.vec2d
) -> wp.vec2d:  # fmt: skip
    """The point of the unit disk towards which lines run: far from the grooves' and the walls' own directions."""
    best = wp.float64(-1.0)
    result = wp.vec2d(wp.float64(1.0), wp.float64(0.0))
    for tried in range(TRIED):
        angle = PI * (wp.float64(tried) + wp.float64(0.37)) / wp.float64(16.0)
        w = wp.vec2d(wp.cos(angle), wp.sin(angle))
        score = wp.float64(1.0)
        first = piece_at(grooves, ids[0]).along
        for a in range(3 * count + 2):
            m = slope_o
            if a == 3 * count + 1:
                m = slope_i
            if a < count:
                m = piece_at(grooves, ids[a]).along
            elif a < 2 * count:
                m = piece_at(grooves, ids[a - count]).end0
                m = wp.vec2d(-m[1], m[0])
            elif a < 3 * count:
                m = piece_at(grooves, ids[a - 2 * count]).end1
                m = wp.vec2d(-m[1], m[0])
            # the direction on the disk that runs along m: A^-1 m, up to its length
            t = wp.vec2d(m[0] * f.a2[1] - m[1] * f.a2[0], f.a1[0] * m[1] - f.a1[1] * m[0])
            length = wp.length(t)
            if length > wp.float64(0.0):
                score = wp.min(score, wp.abs(t[0] * w[1] - t[1] * w[0]) / length)
            # where two grooves cross, their facets meet about half way between
            if a < count and wp.abs(wp.dot(m, first)) < wp.float64(0.999):
                for sign in range(2):
                    h = first + (wp.float64(1.0) - wp.float64(2.0) * wp.float64(sign)) * m
                    t = wp.vec2d(h[0] * f.a2[1] - h[1] * f.a2[0], f.a1[0] * h[1] - f.a1[1] * h[0])
                    length = wp.length(t)
                    if length > wp.float64(0.0):
                        score = wp.min(score, wp.abs(t[0] * w[1] - t[1] * w[0]) / length)
        if score > best + wp.float64(0.01):
            best = score
            result = w
    return result


def make_footprint_mean(Material: Any, radiance: Any, crossings: bool = True, tapers: bool = True) -> Any:
    """The device function ``mean(grooves, ids, count, footprint, o, i, material, slices, chord) -> FootprintMean``.

    ``radiance(material: Material, path, n, o, i) -> vec3d`` gives what a facet of normal ``n`` sends to ``o`` under
    unit perpendicular irradiance from ``i``; ``Material`` is its struct, ``path`` the groove's number (-1 the ground).
    ``ids[0 .. count - 1]``: every piece that ``touches`` says yes to. ``chord`` 1 is exact, 0 Bosch's
    larger axis. Below the horizon nothing is seen or lit. ``crossings`` False compiles one line alone, for grooves that
    all run in parallel and end nowhere near; ``tapers`` False: for grooves that do not change along themselves.
    """

    line_mean = make_line_mean(Material, radiance, tapers)

    @wp.func
    def whole_line(
        grooves: GrooveSet, ids: wp.array(dtype=int), count: int, base: wp.vec2d, step: wp.vec2d, weighting: int,
        o: wp.vec3d, i: wp.vec3d, slope_i: wp.vec2d, material: Material,
    ) -> FootprintMean:  # fmt: skip
        """``line_mean`` in parts, each with the pieces alone that touch it."""
        one = wp.float64(1.0)
        result = FootprintMean()
        mine = wp.zeros(shape=MOST, dtype=int)
        facets = int(0)
        for a in range(count):
            facets += piece_at(grooves, ids[a]).count
        parts = 1 + wp.max(count / PIECES, facets / FACETS)
        part = Footprint()
        part.a1 = step / wp.float64(parts)
        for k in range(parts):
            start = wp.float64(2 * k) / wp.float64(parts) - one
            stop = wp.float64(2 * k + 2) / wp.float64(parts) - one
            part.center = base + wp.float64(0.5) * (start + stop) * step
            n = int(0)
            for a in range(count):
                if touches(grooves, piece_at(grooves, ids[a]), part, slope_of(o), slope_i):
                    if n < MOST:
                        mine[n] = ids[a]
                    n += 1
            some = FootprintMean()
            if n <= MOST:
                some = line_mean(grooves, mine, n, base, step, weighting, start, stop, o, i, material)
            else:
                some = line_mean(grooves, ids, count, base, step, weighting, start, stop, o, i, material)
            result.radiance += some.radiance
            result.found += some.found
        return result

    @wp.func
    def mean(
        grooves: GrooveSet, ids: wp.array(dtype=int), count: int, f: Footprint, o: wp.vec3d, i: wp.vec3d,
        material: Material, slices: int, chord: int,
    ) -> FootprintMean:  # fmt: skip
        zero = wp.float64(0.0)
        one = wp.float64(1.0)
        result = FootprintMean()
        if o[2] > wp.float64(1e-9):
            if count == 0:
                result.found = one
                if i[2] > wp.float64(1e-9):
                    result.radiance = radiance(material, -1, wp.vec3d(zero, zero, one), o, i)
            else:
                slope_o = slope_of(o)
                slope_i = wp.vec2d(zero, zero)
                if i[2] > wp.float64(1e-9):
                    slope_i = slope_of(i)
                first = piece_at(grooves, ids[0])
                parallel = bool(True)
                if wp.static(crossings):
                    for a in range(count):
                        piece = piece_at(grooves, ids[a])
                        turn = piece.along[0] * first.along[1] - piece.along[1] * first.along[0]
                        if wp.abs(turn) > wp.float64(1e-12) or piece.taper >= 0:
                            parallel = False
                        if not passes_through(grooves, piece, f, slope_o, slope_i):
                            parallel = False
                if parallel:
                    m = first.across
                    reach = half_extent(f, m)
                    if chord == 1:
                        result = whole_line(grooves, ids, count, f.center, reach * m, CHORD, o, i, slope_i, material)
                    else:
                        reach = wp.max(wp.abs(wp.dot(f.a1, m)), wp.abs(wp.dot(f.a2, m)))
                        result = whole_line(grooves, ids, count, f.center, reach * m, UNIFORM, o, i, slope_i, material)
                if wp.static(crossings):
                    if not parallel:
                        w = direction_of_lines(grooves, ids, count, f, slope_o, slope_i)
                        along = w[0] * f.a1 + w[1] * f.a2
                        across = w[0] * f.a2 - w[1] * f.a1
                        for k in range(slices):
                            angle = PI * wp.float64(k + 1) / wp.float64(slices + 1)
                            share = wp.float64(2.0) * wp.sin(angle) * wp.sin(angle) / wp.float64(slices + 1)
                            base = f.center + wp.cos(angle) * across
                            step = wp.sin(angle) * along
                            part = whole_line(grooves, ids, count, base, step, UNIFORM, o, i, slope_i, material)
                            result.radiance += share * part.radiance
                            result.found += share * part.found
        return result

    return mean
