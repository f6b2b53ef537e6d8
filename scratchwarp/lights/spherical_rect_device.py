"""Rectangles seen from a point: their solid angle, and uniform sampling of it.

The rectangle is p +- ex +- ey with ex, ey orthogonal; the point is the origin, ``height`` > 0 over its plane.

Source: Urena, Fajardo and King 2013, "An area-preserving parametrization for spherical rectangles"; the angles between
its side planes come from the heights of their normals by atan2, which holds next to 0 and pi where acos loses half the
digits.
"""

import warp as wp

_TWO_PI = wp.constant(6.283185307179586)
_SMALL = wp.constant(0.05)  # [sr] below which the sum of angles, of error 5e-7, is not accurate enough


@wp.struct
class RectView:
    """Extents x0..x1, y0..y1 along the unit axes ax, ay from the foot of the origin; angles g0..g3 between the side
    planes y0 | x1 | y1 | x0 | y0; heights n0, n2 of the normals of the planes y0, y1."""

    ax: wp.vec3
    ay: wp.vec3
    x0: float
    x1: float
    y0: float
    y1: float
    g01: float
    g2: float
    g3: float
    n0: float
    n2: float


@wp.func
def edge_angle(m0: float, z0: float, m1: float, z1: float) -> float:
    """acos(-z0 z1) of two unit normals' heights, with m = 1 - z^2 given so that it holds next to 0 and pi."""
    return wp.atan2(wp.sqrt(wp.max(m0 + m1 - m0 * m1, 0.0)), -z0 * z1)


@wp.func
def rect_view(p: wp.vec3, ex: wp.vec3, ey: wp.vec3, height: float) -> RectView:
    """How the origin sees the rectangle."""
    r = RectView()
    half_x = wp.length(ex)
    half_y = wp.length(ey)
    r.ax = ex / half_x
    r.ay = ey / half_y
    cx = wp.dot(p, r.ax)
    cy = wp.dot(p, r.ay)
    r.x0 = cx - half_x
    r.x1 = cx + half_x
    r.y0 = cy - half_y
    r.y1 = cy + half_y
    zz = height * height
    n1 = r.x1 / wp.sqrt(r.x1 * r.x1 + zz)
    n3 = -r.x0 / wp.sqrt(r.x0 * r.x0 + zz)
    r.n0 = -r.y0 / wp.sqrt(r.y0 * r.y0 + zz)
    r.n2 = r.y1 / wp.sqrt(r.y1 * r.y1 + zz)
    m0 = zz / (r.y0 * r.y0 + zz)
    m1 = zz / (r.x1 * r.x1 + zz)
    m2 = zz / (r.y1 * r.y1 + zz)
    m3 = zz / (r.x0 * r.x0 + zz)
    r.g01 = edge_angle(m0, r.n0, m1, n1) + edge_angle(m1, n1, m2, r.n2)
    r.g2 = edge_angle(m2, r.n2, m3, n3)
    r.g3 = edge_angle(m3, n3, m0, r.n0)
    return r


@wp.func
def triangle_solid_angle(a: wp.vec3, b: wp.vec3, c: wp.vec3, volume: float) -> float:
    """Solid angle of a triangle seen from the origin (van Oosterom and Strackee 1983).

    ``volume``: |a . (b x c)|, given, because the caller has it as plane distance times twice the area, without
    cancellation. Relative error some 1e-6 for small ones; a triangle that fills a hemisphere cancels in ``below``.
    """
    la = wp.length(a)
    lb = wp.length(b)
    lc = wp.length(c)
    below = 1.0 + wp.dot(a / la, b / lb) + wp.dot(a / la, c / lc) + wp.dot(b / lb, c / lc)
    above = volume / la / lb / lc
    return wp.where(above > 0.0, 2.0 * wp.atan2(above, below), 0.0)


@wp.func
def rect_solid_angle(r: RectView, p: wp.vec3, ex: wp.vec3, ey: wp.vec3, height: float, area: float) -> float:
    """Solid angle [sr] of the rectangle of ``area``; relative error some 1e-5 however small or large."""
    result = r.g01 + r.g2 + r.g3 - _TWO_PI
    if result < _SMALL:
        a = p - ex - ey
        b = p + ex - ey
        c = p + ex + ey
        d = p - ex + ey
        result = triangle_solid_angle(a, b, c, height * area) + triangle_solid_angle(a, c, d, height * area)
    return result


@wp.func
def spherical_rect_offset(r: RectView, p: wp.vec3, height: float, u: wp.vec2) -> wp.vec3:
    """Offset from p of a point whose direction is uniform over the solid angle of the rectangle.

    Points err by some 5e-7 / solid angle of an edge's length, so below some 0.02 sr sample the area instead.
    """
    zz = height * height
    k = _TWO_PI - r.g2 - r.g3
    au = u[0] * (r.g01 - k) + k
    sine = wp.sin(au)
    fu = (wp.cos(au) * r.n0 - r.n2) / wp.where(wp.abs(sine) > 1.0e-12, sine, 1.0e-12)
    cu = wp.clamp(wp.where(fu > 0.0, 1.0, -1.0) / wp.sqrt(fu * fu + r.n0 * r.n0), -1.0, 1.0)
    xu = wp.clamp(cu * height / wp.sqrt(wp.max((1.0 - cu) * (1.0 + cu), 1.0e-14)), r.x0, r.x1)
    dd = xu * xu + zz
    h0 = r.y0 / wp.sqrt(dd + r.y0 * r.y0)
    h1 = r.y1 / wp.sqrt(dd + r.y1 * r.y1)
    h = h0 + u[1] * (h1 - h0)
    yv = wp.clamp(h * wp.sqrt(dd / wp.max((1.0 - h) * (1.0 + h), 1.0e-14)), r.y0, r.y1)
    return (xu - wp.dot(p, r.ax)) * r.ax + (yv - wp.dot(p, r.ay)) * r.ay
