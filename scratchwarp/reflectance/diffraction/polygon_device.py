"""A polygonal light cut by a slice, any simple polygon, concave too.

Each edge spans a plane through the origin with unit normal m. On its great circle the coordinate u grows to rho =
hypot(m_2, m_3) and falls again, and passes a slice at (-m_1 u (m_2, m_3) +- sqrt(rho^2 - u^2) (-m_3, m_2)) / rho^2,
growing with the upper sign: one crossing where the ends of the edge lie on two sides of the slice, two or none where
they lie on one side and the edge turns between them. The sides of a vertex are judged once for both of its edges, so
that every outline closes. The part below the horizon is cut away edge by edge; the gaps, on the horizon, are closed
through the first point that the outline has there.
"""

import warp as wp

from .few_device import Marks, add_mark
from .quadrature_device import Rules
from .real_device import ONE, TWO, ZERO, real, vec3
from .scratch_device import WaveScratch, to_scratch
from .slice_device import Breaks, Lobe, LobeTables, SliceSum, add_crossing

_BEYOND = wp.constant(real(4.0))
_APART = wp.constant(real(0.0025))  # of the range in which corners are kept
_PARALLEL = wp.constant(real(1.0e-12))


@wp.struct
class PolygonView:
    """Rows ``first`` to ``first + count`` of ``vertices`` (shading frame) are the outline in order."""

    vertices: wp.array(dtype=vec3)
    first: int
    count: int
    flat: int  # its plane holds the origin, so that it covers nothing


@wp.func
def view_polygon(vertices: wp.array(dtype=vec3), first: int, count: int) -> PolygonView:
    """Look at a polygon given in the shading frame."""
    r = PolygonView()
    r.vertices = vertices
    r.first = first
    r.count = count
    origin = vertices[first]
    area = vec3(ZERO, ZERO, ZERO)
    size = ZERO
    for i in range(1, count):
        a = vertices[first + i] - origin
        size = wp.max(size, wp.length(a))
        if i + 1 < count:
            area += wp.cross(a, vertices[first + i + 1] - origin)
    # relative to the size, a height or an area below 1e-14 is rounding
    length = wp.length(area)
    height = wp.abs(wp.dot(area, origin))
    far = wp.max(size, wp.length(origin))
    r.flat = wp.where(height <= real(1.0e-14) * length * far or length <= real(1.0e-14) * size * size, 1, 0)
    return r


@wp.struct
class ClippedEdge:
    """The part of an edge above the horizon; ``enters`` at a, ``leaves`` at b: that end lies on the horizon."""

    a: vec3
    b: vec3
    inside: int
    enters: int
    leaves: int


@wp.func
def clipped_edge(light: PolygonView, s: WaveScratch, i: int) -> ClippedEdge:
    """Edge i in the frame of the scratch."""
    r = ClippedEdge()
    j = wp.where(i + 1 < light.count, i + 1, 0)
    r.a = to_scratch(s, light.vertices[light.first + i])
    r.b = to_scratch(s, light.vertices[light.first + j])
    above_a = r.a[2] > ZERO
    above_b = r.b[2] > ZERO
    if above_a or above_b:
        r.inside = 1
        if not (above_a and above_b):
            at = r.a + (r.a[2] / (r.a[2] - r.b[2])) * (r.b - r.a)
            at[2] = ZERO
            if above_a:
                r.b = at
                r.leaves = 1
            else:
                r.a = at
                r.enters = 1
    return r


@wp.func
def _spread(breaks: Breaks, a: vec3, b: vec3, after: real) -> Breaks:
    """Take in the ends and the turning point of an edge."""
    r = breaks
    ua = a[0] / wp.max(wp.length(a), real(1.0e-300))
    ub = b[0] / wp.max(wp.length(b), real(1.0e-300))
    turn = ua
    m = wp.cross(a, b - a)
    length = wp.length(m)
    if length > ZERO:
        m = m / length
        grows = m[1] * a[2] - m[2] * a[1]
        if (grows > ZERO) != (m[1] * b[2] - m[2] * b[1] > ZERO):
            turn = wp.sign(grows) * wp.sqrt(m[1] * m[1] + m[2] * m[2])
    r.low = wp.min(r.low, wp.min(ua, wp.min(ub, turn)))
    r.high = wp.max(r.high, wp.max(ua, wp.max(ub, turn)))
    if ua > after:
        r.following = wp.min(r.following, ua)
    if ub > after:
        r.following = wp.min(r.following, ub)
    if turn > after:
        r.following = wp.min(r.following, turn)
    return r


@wp.func
def polygon_breaks(light: PolygonView, s: WaveScratch, after: real) -> Breaks:
    """The extent of the part above the horizon, and the next u beyond ``after`` where its outline has a corner or
    turns."""
    r = Breaks()
    r.low = TWO
    r.high = -TWO
    r.round_low = 1
    r.round_high = 1
    r.following = _BEYOND
    known = int(0)
    start = vec3(ZERO, ZERO, ZERO)
    if light.flat == 0:
        for i in range(light.count):
            e = clipped_edge(light, s, i)
            if e.inside != 0:
                r = _spread(r, e.a, e.b, after)
                at = wp.where(e.enters != 0, e.a, e.b)
                if e.enters != 0 or e.leaves != 0:
                    if known == 0:
                        start = at
                        known = 1
                    r = _spread(r, start, at, after)
    return r


@wp.func
def _mark(marks: Marks, u: real, first: real, last: real, turn: int) -> Marks:
    r = marks
    if u < r.low:
        r.low = u
        r.turn_low = turn
    if u > r.high:
        r.high = u
        r.turn_high = turn
    if u > first and u < last:
        r = add_mark(r, u, turn, _APART * (last - first))
    return r


@wp.func
def _direction(a: vec3) -> real:
    """u of a point."""
    return a[0] / wp.max(wp.length(a), real(1.0e-300))


@wp.func
def _mark_turn(marks: Marks, a: vec3, b: vec3, first: real, last: real) -> Marks:
    """Take in the point at which an edge turns in u."""
    r = marks
    m = wp.cross(a, b - a)
    grows = m[1] * a[2] - m[2] * a[1]
    if (grows > ZERO) != (m[1] * b[2] - m[2] * b[1] > ZERO):
        length = wp.length(m)
        if length > ZERO:
            turn = wp.sign(grows) * wp.sqrt(m[1] * m[1] + m[2] * m[2]) / length
            r = _mark(r, turn, first, last, 1)
    return r


@wp.func
def polygon_marks(light: PolygonView, s: WaveScratch, first: real, last: real) -> Marks:
    """The extent of the part above the horizon, and where its outline has corners or turns between ``first`` and
    ``last``."""
    r = Marks()
    r.low = TWO
    r.high = -TWO
    known = int(0)
    start = vec3(ZERO, ZERO, ZERO)
    if light.flat == 0:
        for i in range(light.count):
            e = clipped_edge(light, s, i)
            if e.inside != 0:
                r = _mark(r, _direction(e.a), first, last, 0)
                r = _mark_turn(r, e.a, e.b, first, last)
                if e.leaves != 0:
                    r = _mark(r, _direction(e.b), first, last, 0)
                if e.enters != 0 or e.leaves != 0:
                    at = wp.where(e.enters != 0, e.a, e.b)
                    if known == 0:
                        start = at
                        known = 1
                        r.profiled = 1
                    r = _mark_turn(r, start, at, first, last)
    return r


@wp.func
def _cut_edge(acc: SliceSum, lobe: Lobe, tables: LobeTables, rules: Rules, u: real, a: vec3, b: vec3) -> SliceSum:
    r = acc
    side_a = a[0] - u * wp.length(a)
    side_b = b[0] - u * wp.length(b)
    over_a = side_a >= ZERO
    over_b = side_b >= ZERO
    m = wp.cross(a, b - a)
    length = wp.length(m)
    if length > ZERO:
        m = m / length
        rho2 = m[1] * m[1] + m[2] * m[2]
        rho = wp.sqrt(rho2)
        root = wp.sqrt(wp.max((rho - u) * (rho + u), ZERO))
        scale = ONE / wp.max(rho2, real(1.0e-300))
        foot = -m[0] * u * scale
        root = root * scale
        if over_a != over_b:
            direction = wp.where(over_b, 1, -1)
            across = foot * m[1] - real(direction) * root * m[2]
            height = foot * m[2] + real(direction) * root * m[1]
            if rho < _PARALLEL:
                # the edge lies along the slice u = 0: where it changes sides
                w = a + (side_a / (side_a - side_b)) * (b - a)
                w = w / wp.length(w)
                across = w[1]
                height = w[2]
            r = add_crossing(r, lobe, tables, rules, u, across, height, direction)
        else:
            grows_a = m[1] * a[2] - m[2] * a[1] > ZERO
            grows_b = m[1] * b[2] - m[2] * b[1] > ZERO
            over_the_top = not over_a and grows_a and not grows_b and rho > u
            under_the_bottom = over_a and not grows_a and grows_b and -rho < u
            if over_the_top or under_the_bottom:
                for k in range(2):
                    sign = 1 - 2 * k
                    step = real(sign) * root
                    r = add_crossing(
                        r, lobe, tables, rules, u, foot * m[1] - step * m[2], foot * m[2] + step * m[1], sign
                    )
    return r


@wp.func
def cut_polygon(light: PolygonView, lobe: Lobe, tables: LobeTables, rules: Rules, u: real) -> SliceSum:
    """The crossings of the slice at u with the part of the polygon above the horizon."""
    r = SliceSum()
    known = int(0)
    start = vec3(ZERO, ZERO, ZERO)
    if light.flat == 0:
        for i in range(light.count):
            e = clipped_edge(light, lobe.scratch, i)
            if e.inside != 0:
                r = _cut_edge(r, lobe, tables, rules, u, e.a, e.b)
                if e.enters != 0 or e.leaves != 0:
                    at = wp.where(e.enters != 0, e.a, e.b)
                    if known == 0:
                        start = at
                        known = 1
                    elif e.enters != 0:
                        r = _cut_edge(r, lobe, tables, rules, u, start, at)
                    else:
                        r = _cut_edge(r, lobe, tables, rules, u, at, start)
    return r


@wp.func
def short_polygon(light: PolygonView, lobe: Lobe, tables: LobeTables, rules: Rules, sharp: real, slices: int) -> real:
    """No short cut."""
    return -ONE
