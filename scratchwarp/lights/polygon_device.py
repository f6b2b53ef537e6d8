"""Flat convex outlines on the device: where a scratch cone crosses them.

The outline has ``sides`` vertices center + a ex + b ey with (a, b) on the regular polygon around the unit circle: 4
sides give the corners +-ex +-ey, 8 sides a polygon that contains the ellipse with half-axes ex, ey.
"""

import warp as wp

from scratchwarp.lights.cap_device import HALF_PI
from scratchwarp.lights.light_device import Span

_PI = wp.constant(3.141592653589793)
_SLACK = wp.constant(4.0e-7)  # error of a plane's height over a direction, both unit, in float32


@wp.func
def outline_vertex(center: wp.vec3, ex: wp.vec3, ey: wp.vec3, k: int, sides: int) -> wp.vec3:
    """Vertex k of the regular outline around the unit circle of (ex, ey)."""
    angle = _PI * float(2 * k + 1) / float(sides)
    scale = 1.0 / wp.cos(_PI / float(sides))
    return center + (scale * wp.cos(angle)) * ex + (scale * wp.sin(angle)) * ey


@wp.struct
class Crossings:
    """What the edges of a convex outline have cut out of the cone so far: least and greatest phi, and whether the
    horizon at -pi/2 (left) and pi/2 (right) lies inside of all planes."""

    lo: float
    hi: float
    left: int
    right: int


@wp.func
def no_crossings() -> Crossings:
    """Before the first edge."""
    c = Crossings()
    c.lo = 4.0
    c.hi = -4.0
    c.left = 1
    c.right = 1
    return c


@wp.func
def cross_edge(
    c: Crossings, a: wp.vec3, b: wp.vec3, turn: float, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float
) -> Crossings:
    """Add the edge from ``a`` to ``b`` (from the origin); turn 1: the inside lies towards a x b, -1: the other side.

    The edge spans a plane through the origin with inward normal m, and the cone {w: w.u = sin_theta} crosses it at
    psi_m +- acos(-sin_theta m.u / (cos_theta rho_m)), psi_m = atan2(m.v, m.n), rho_m = hypot(m.v, m.n).
    """
    r = c
    m = wp.cross(a, b - a)
    length = wp.length(m)
    if length > 0.0:
        m = (turn / length) * m
        m1 = wp.dot(m, u)
        m2 = wp.dot(m, v)
        m3 = wp.dot(m, n)
        s = wp.sqrt(wp.max((1.0 - sin_theta) * (1.0 + sin_theta), 0.0))
        if sin_theta * m1 - s * m2 < -_SLACK:
            r.left = 0
        if sin_theta * m1 + s * m2 < -_SLACK:
            r.right = 0
        rho = s * wp.sqrt(m2 * m2 + m3 * m3)
        level = -sin_theta * m1 - _SLACK
        if wp.abs(level) < rho:
            middle = wp.atan2(m2, m3)
            d = wp.atan2(wp.sqrt((rho - level) * (rho + level)), level)
            from_a = wp.cross(m, a) * (turn / wp.length(a))
            to_b = wp.cross(b, m) * (turn / wp.length(b))
            for side in range(2):
                psi = middle + float(2 * side - 1) * d
                psi = wp.where(psi > _PI, psi - 2.0 * _PI, psi)
                psi = wp.where(psi < -_PI, psi + 2.0 * _PI, psi)
                w = sin_theta * u + s * (wp.sin(psi) * v + wp.cos(psi) * n)
                if wp.min(wp.dot(w, from_a), wp.dot(w, to_b)) > -4.0 * _SLACK and wp.abs(psi) <= HALF_PI:
                    r.lo = wp.min(r.lo, psi)
                    r.hi = wp.max(r.hi, psi)
    return r


@wp.func
def close_span(c: Crossings) -> Span:
    """The interval that holds every crossing and every end that is inside."""
    r = Span()
    lo = wp.where(c.left != 0, -HALF_PI, c.lo)
    hi = wp.where(c.right != 0, HALF_PI, c.hi)
    lo = wp.where(c.right != 0, wp.min(lo, HALF_PI), lo)
    hi = wp.where(c.left != 0, wp.max(hi, -HALF_PI), hi)
    if lo <= hi:
        r.lo = wp.max(lo - _SLACK, -HALF_PI)
        r.hi = wp.min(hi + _SLACK, HALF_PI)
        r.ok = 1
    return r


@wp.func
def span_outline(
    center: wp.vec3, ex: wp.vec3, ey: wp.vec3, sides: int, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float
) -> Span:
    """Interval of phi in which the scratch cone may meet the outline seen from the origin; tight but for rounding.

    The origin must not lie in the outline's plane.
    """
    c = no_crossings()
    turn = wp.where(wp.dot(wp.cross(ex, ey), center) > 0.0, 1.0, -1.0)
    a = outline_vertex(center, ex, ey, sides - 1, sides)
    for k in range(sides):
        b = outline_vertex(center, ex, ey, k, sides)
        c = cross_edge(c, a, b, turn, u, v, n, sin_theta)
        a = b
    return close_span(c)


@wp.func
def span_triangle(a: wp.vec3, b: wp.vec3, c: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float) -> Span:
    """``span_outline`` for a triangle, seen from either side."""
    turn = wp.where(wp.dot(wp.cross(b - a, c - a), a) > 0.0, 1.0, -1.0)
    s = cross_edge(no_crossings(), a, b, turn, u, v, n, sin_theta)
    s = cross_edge(s, b, c, turn, u, v, n, sin_theta)
    s = cross_edge(s, c, a, turn, u, v, n, sin_theta)
    return close_span(s)


@wp.func
def join_spans(a: Span, b: Span) -> Span:
    """The smallest interval that holds both."""
    r = a
    if a.ok == 0:
        r = b
    elif b.ok != 0:
        r.lo = wp.min(a.lo, b.lo)
        r.hi = wp.max(a.hi, b.hi)
    return r
