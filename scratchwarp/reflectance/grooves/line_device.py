"""Mean radiance along a line through a footprint: spans on each of which one plane is seen, lit or dark.

One ray tells what a span shows. Over an edge that is hidden behind it, and where the next facet of the same profile
follows, what is seen and whether it is lit goes on without another ray.
"""

from typing import Any

import warp as wp

from .cast_device import cast, path_of
from .edges_device import EVENTS, gather_edges
from .planes_device import TIE, Height, Line, facet_height
from .solid_device import GrooveSet, piece_at

wp.set_module_options({"enable_backward": False})

PI = wp.constant(wp.float64(3.14159265358979323846))
UNIFORM = wp.constant(0)  # weight along a line: even, or by the area of the ellipse over it
CHORD = wp.constant(1)


@wp.struct
class FootprintMean:
    """Mean radiance, and the share of the footprint in which a surface was found (1 but for rounding)."""

    radiance: wp.vec3d
    found: wp.float64


@wp.struct
class Seen:
    """What is seen on a part of a line: z = at + b rise of unit normal ``n``, a piece's facet as ``Crossing`` has it;
    ``bent``: it may be twisted; ``lit``: whether light comes there."""

    found: bool
    bent: bool
    lit: bool
    piece: int
    facet: int
    n: wp.vec3d
    at: wp.float64
    rise: wp.float64


@wp.func
def slope_of(d: wp.vec3d) -> wp.vec2d:
    """(d_x, d_y) / d_z."""
    return wp.vec2d(d[0] / d[2], d[1] / d[2])


@wp.func
def weight_below(b: wp.float64, weighting: int) -> wp.float64:
    """Share of a line's weight below b in [-1, 1]."""
    one = wp.float64(1.0)
    result = wp.float64(0.5) * (b + one)
    if weighting == CHORD:
        q = wp.clamp(b, -one, one)
        result = wp.float64(0.5) + (wp.asin(q) + q * wp.sqrt((one - q) * (one + q))) / PI
    return result


@wp.func
def facet_seen(grooves: GrooveSet, k: int, facet: int, line: Line) -> Seen:
    """A facet of piece ``k`` from in front; not found where it has none, turns away, is bent or lies on the plane."""
    zero = wp.float64(0.0)
    result = Seen()
    piece = piece_at(grooves, k)
    if facet >= piece.first and facet < piece.first + piece.count - 1 and piece.taper < 0:
        v = grooves.vertices[facet]
        w = grooves.vertices[facet + 1]
        e = wp.normalize(w - v)
        height = facet_height(grooves, piece, facet, line)
        front = e[0] - e[1] * wp.dot(line.slope, piece.across)
        if height.low < height.high and front > wp.float64(1e-9) and (v[1] != zero or w[1] != zero):
            result.found = True
            result.piece = k
            result.facet = facet
            result.n = wp.vec3d(-e[1] * piece.across[0], -e[1] * piece.across[1], e[0])
            result.at = height.at
            result.rise = height.rise
    return result


def make_line_mean(Material: Any, radiance: Any, tapers: bool) -> Any:
    """The device function ``line_mean``: the mean along base + b step, ``start`` < b < ``stop``, by weight."""

    @wp.func
    def line_mean(
        grooves: GrooveSet, ids: wp.array(dtype=int), count: int, base: wp.vec2d, step: wp.vec2d, weighting: int,
        start: wp.float64, stop: wp.float64, o: wp.vec3d, i: wp.vec3d, material: Material,
    ) -> FootprintMean:  # fmt: skip
        zero = wp.float64(0.0)
        one = wp.float64(1.0)
        half = wp.float64(0.5)
        result = FootprintMean()
        slope_o = slope_of(o)
        slope_i = slope_of(i)
        seen_edges = wp.zeros(shape=EVENTS, dtype=wp.vec4d)
        light_edges = wp.zeros(shape=EVENTS, dtype=wp.vec4d)
        above = grooves.top + wp.float64(1.0e6) * grooves.skin
        down = wp.vec3d(-slope_o[0], -slope_o[1], -one)
        up = wp.vec3d(slope_i[0], slope_i[1], one)
        view = Line()
        view.base = base
        view.step = step
        view.slope = slope_o
        nothing = Height()
        nothing.at = wp.float64(-wp.inf)
        # what is seen, and whether it is lit, goes on over an edge that is hidden or where the next facet follows
        known = bool(False)
        told = bool(False)
        seen = Seen()
        b = start
        while b < stop:
            seen_count = gather_edges(grooves, ids, count, view, nothing, -1, -1, b, stop, seen_edges)
            for j in range(seen_count + 1):
                b1 = stop
                if j < seen_count:
                    b1 = seen_edges[j][0]
                weight = weight_below(b1, weighting) - weight_below(b, weighting)
                # of too many edges the last is where the next ones are asked for
                if (j < EVENTS) and weight > wp.float64(1e-14):
                    middle = half * (b + b1)
                    if not known:
                        x = base + middle * step
                        top = wp.vec3d(x[0] + above * slope_o[0], x[1] + above * slope_o[1], above)
                        hit = cast(grooves, ids, count, top, down, wp.float64(wp.inf), 0, 0)
                        seen.found = hit.distance < wp.float64(wp.inf)
                        seen.n = hit.normal
                        seen.piece = hit.piece
                        seen.facet = hit.facet
                        seen.bent = bool(False)  # a facet that may be twisted: looked at anew in every part
                        if wp.static(tapers):
                            if hit.piece >= 0:
                                seen.bent = piece_at(grooves, hit.piece).taper >= 0
                        if seen.found:
                            # z = at + b' rise on the plane
                            seen.rise = (seen.n[0] * step[0] + seen.n[1] * step[1]) / wp.dot(seen.n, down)
                            seen.at = top[2] - hit.distance - middle * seen.rise
                        told = bool(False)
                    known = seen.found and not seen.bent
                    if seen.found:
                        result.found += weight
                        n = seen.n
                        if not (wp.dot(n, i) > zero or seen.bent) or i[2] <= wp.float64(1e-9):
                            told = bool(False)
                        else:
                            # the line as the light sees it
                            light = Line()
                            light.base = base + seen.at * (slope_o - slope_i)
                            light.step = step + seen.rise * (slope_o - slope_i)
                            light.slope = slope_i
                            floor = Height()
                            floor.at = seen.at - wp.float64(16.0) * grooves.skin
                            floor.rise = seen.rise
                            if seen.bent:
                                floor = nothing
                            lit = zero
                            c = b
                            after = b - TIE
                            while c < b1:
                                light_count = gather_edges(
                                    grooves, ids, count, light, floor, seen.piece, seen.facet, after, b1 + TIE,
                                    light_edges,
                                )  # fmt: skip
                                for k in range(light_count + 1):
                                    c1 = b1
                                    if k < light_count:
                                        c1 = wp.clamp(light_edges[k][0], c, b1)
                                    part = weight_below(c1, weighting) - weight_below(c, weighting)
                                    if k < EVENTS:
                                        if part > wp.float64(1e-14):
                                            m = half * (c + c1)
                                            here = n
                                            if seen.bent or not told:
                                                z = seen.at + m * seen.rise
                                                y = base + m * step + z * slope_o
                                                p = wp.vec3d(y[0], y[1], z)
                                                if wp.static(tapers):
                                                    if seen.bent:
                                                        v = base + m * step
                                                        rise_o = above * slope_o
                                                        eye = wp.vec3d(v[0] + rise_o[0], v[1] + rise_o[1], above)
                                                        far = wp.float64(wp.inf)
                                                        again = cast(grooves, ids, count, eye, down, far, 0, 0)
                                                        if again.distance < far:
                                                            here = again.normal
                                                            p = eye + again.distance * down
                                                            z = p[2]
                                                p += wp.float64(2.0) * grooves.skin * here
                                                limit = grooves.top - z + grooves.skin
                                                seen.lit = bool(wp.dot(here, i) > zero)
                                                if seen.lit:
                                                    dark = cast(grooves, ids, count, p, up, limit, 1, 0)
                                                    seen.lit = dark.distance == wp.float64(wp.inf)
                                                told = not seen.bent
                                            if seen.lit:
                                                if wp.static(tapers):
                                                    if seen.bent:
                                                        result.radiance += part * radiance(
                                                            material, path_of(grooves, seen.piece), here, o, i
                                                        )
                                                if not seen.bent:
                                                    lit += part
                                        if k < light_count:
                                            told = bool(False)
                                        c = c1
                                after = c
                            if lit > zero:
                                result.radiance += lit * radiance(material, path_of(grooves, seen.piece), n, o, i)
                elif j < EVENTS:
                    known = bool(False)
                if j == EVENTS - 1 or b1 - b < TIE:
                    known = bool(False)
                elif j + 1 < seen_count:
                    if seen_edges[j + 1][0] - b1 < TIE:
                        known = bool(False)
                if j < EVENTS:
                    b = b1
                if known and j < seen_count:
                    event = seen_edges[j]
                    if event[1] >= seen.at + b1 * seen.rise - wp.float64(16.0) * grooves.skin:
                        known = bool(False)
                        # where an opening begins, others' piles may end
                        alone = grooves.mixed == 0 or event[1] != zero
                        if alone and int(event[2]) == seen.piece and seen.facet >= 0:
                            following = 2 * int(event[3]) - 1 - seen.facet
                            if following == seen.facet - 1 or following == seen.facet + 1:
                                next = facet_seen(grooves, seen.piece, following, view)
                                if next.found:
                                    known = bool(True)
                                    seen.facet = following
                                    seen.n = next.n
                                    seen.at = next.at
                                    seen.rise = next.rise
        return result

    return line_mean
