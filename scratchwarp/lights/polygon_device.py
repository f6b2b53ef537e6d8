"""Flat convex outlines on the device: solid angle of a parallelogram, scratch-cone interval of a regular outline.

The outline has ``sides`` vertices center + a ex + b ey with (a, b) on the regular polygon around the unit circle: 4
sides give the corners +-ex +-ey, 8 sides a polygon that contains the ellipse with half-axes ex, ey.
"""

import warp as wp

from scratchwarp.lights.cap_device import HALF_PI
from scratchwarp.lights.light_device import Span

_PI = wp.constant(3.141592653589793)
_SLACK = wp.constant(4.0e-7)  # error of a plane's height over a direction, both unit, in float32


@wp.func
def triangle_solid_angle(a: wp.vec3, b: wp.vec3, c: wp.vec3, volume: float) -> float:
    """Solid angle of a triangle seen from the origin (van Oosterom and Strackee 1983).

    ``volume``: |a . (b x c)|, given, because the caller has it as plane distance times twice the area, without
    cancellation.
    """
    la = wp.length(a)
    lb = wp.length(b)
    lc = wp.length(c)
    below = 1.0 + wp.dot(a / la, b / lb) + wp.dot(a / la, c / lc) + wp.dot(b / lb, c / lc)
    above = volume / la / lb / lc
    return wp.where(above > 0.0, 2.0 * wp.atan2(above, below), 0.0)


@wp.func
def parallelogram_solid_angle(center: wp.vec3, ex: wp.vec3, ey: wp.vec3, height: float, area: float) -> float:
    """Solid angle of center +- ex +- ey seen from the origin at ``height`` > 0 over its plane; relative error some
    1e-6 however small it is."""
    a = center - ex - ey
    b = center + ex - ey
    c = center + ex + ey
    d = center - ex + ey
    return triangle_solid_angle(a, b, c, height * area) + triangle_solid_angle(a, c, d, height * area)


@wp.func
def outline_vertex(center: wp.vec3, ex: wp.vec3, ey: wp.vec3, k: int, sides: int) -> wp.vec3:
    """Vertex k of the regular outline around the unit circle of (ex, ey)."""
    angle = _PI * float(2 * k + 1) / float(sides)
    scale = 1.0 / wp.cos(_PI / float(sides))
    return center + (scale * wp.cos(angle)) * ex + (scale * wp.sin(angle)) * ey


@wp.func
def span_outline(
    center: wp.vec3,
    ex: wp.vec3,
    ey: wp.vec3,
    sides: int,
    height: float,
    u: wp.vec3,
    v: wp.vec3,
    n: wp.vec3,
    sin_theta: float,
) -> Span:
    """Interval of phi in which the scratch cone may meet the outline, seen from the origin at signed ``height`` over
    its plane (on the lit side where positive); tight but for rounding.

    Each edge spans a plane through the origin with normal m, and the cone crosses it at psi_m +- acos(-sin_theta m.u /
    (cos_theta rho_m)). The ends of the interval are crossings that lie on their edge, or the horizon where it lies
    inside of all planes.
    """
    r = Span()
    r.lo = float(4.0)
    r.hi = float(-4.0)
    reach = wp.length(ex) + wp.length(ey)
    if height > 0.0 and reach > 0.0:
        s = wp.sqrt(wp.max((1.0 - sin_theta) * (1.0 + sin_theta), 0.0))
        inside_left = int(1)
        inside_right = int(1)
        # orientation in which all planes look inwards, for a height on the lit side or either winding of ex, ey
        turn = wp.where(wp.dot(wp.cross(ex, ey), center) > 0.0, 1.0, -1.0)
        a = outline_vertex(center, ex, ey, sides - 1, sides)
        for k in range(sides):
            b = outline_vertex(center, ex, ey, k, sides)
            m = wp.cross(a, b - a)
            length = wp.length(m)
            if length > 0.0:
                m = (turn / length) * m
                m1 = wp.dot(m, u)
                m2 = wp.dot(m, v)
                m3 = wp.dot(m, n)
                if sin_theta * m1 - s * m2 < -_SLACK:
                    inside_left = 0
                if sin_theta * m1 + s * m2 < -_SLACK:
                    inside_right = 0
                rho = s * wp.sqrt(m2 * m2 + m3 * m3)
                level = -sin_theta * m1 - _SLACK
                if wp.abs(level) < rho:
                    middle = wp.atan2(m2, m3)
                    d = wp.atan2(wp.sqrt((rho - level) * (rho + level)), level)
                    from_a = turn * wp.cross(m, a) / wp.length(a)
                    to_b = turn * wp.cross(b, m) / wp.length(b)
                    for side in range(2):
                        psi = middle + float(2 * side - 1) * d
                        psi = wp.where(psi > _PI, psi - 2.0 * _PI, psi)
                        psi = wp.where(psi < -_PI, psi + 2.0 * _PI, psi)
                        w = sin_theta * u + s * (wp.sin(psi) * v + wp.cos(psi) * n)
                        beyond = wp.min(wp.dot(w, from_a), wp.dot(w, to_b))
                        if beyond > -4.0 * _SLACK and wp.abs(psi) <= HALF_PI:
                            r.lo = wp.min(r.lo, psi)
                            r.hi = wp.max(r.hi, psi)
            a = b
        if inside_left != 0:
            r.lo = -HALF_PI
            r.hi = wp.max(r.hi, -HALF_PI)
        if inside_right != 0:
            r.lo = wp.min(r.lo, HALF_PI)
            r.hi = HALF_PI
        if r.lo <= r.hi:
            r.lo = wp.max(r.lo - _SLACK, -HALF_PI)
            r.hi = wp.min(r.hi + _SLACK, HALF_PI)
            r.ok = 1
    return r
