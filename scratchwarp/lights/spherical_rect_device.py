"""Uniform sampling of the solid angle of a rectangle.

Source: Urena, Fajardo and King 2013, "An area-preserving parametrization for spherical rectangles"; the angles between
its planes come from the heights of their normals by atan2, which holds next to 0 and pi where acos loses half the
digits.
"""

import warp as wp

_TWO_PI = wp.constant(6.283185307179586)


@wp.func
def edge_angle(m0: float, z0: float, m1: float, z1: float) -> float:
    """acos(-z0 z1) of two unit normals' heights, with m = 1 - z^2 given so that it holds next to 0 and pi."""
    return wp.atan2(wp.sqrt(wp.max(m0 + m1 - m0 * m1, 0.0)), -z0 * z1)


@wp.func
def spherical_rect_offset(p: wp.vec3, ex: wp.vec3, ey: wp.vec3, height: float, u: wp.vec2) -> wp.vec3:
    """Offset from the centre of a point whose direction is uniform over the solid angle of the rectangle p +- ex +- ey.

    ``ex``, ``ey`` orthogonal; the origin is ``height`` > 0 over the plane. Points err by some 5e-7 / solid angle of an
    edge's length, so below some 0.02 sr sample the area instead.
    """
    half_x = wp.length(ex)
    half_y = wp.length(ey)
    ax = ex / half_x
    ay = ey / half_y
    cx = wp.dot(p, ax)
    cy = wp.dot(p, ay)
    x0 = cx - half_x
    x1 = cx + half_x
    y0 = cy - half_y
    y1 = cy + half_y
    zz = height * height
    n0 = -y0 / wp.sqrt(y0 * y0 + zz)
    n1 = x1 / wp.sqrt(x1 * x1 + zz)
    n2 = y1 / wp.sqrt(y1 * y1 + zz)
    n3 = -x0 / wp.sqrt(x0 * x0 + zz)
    m0 = zz / (y0 * y0 + zz)
    m1 = zz / (x1 * x1 + zz)
    m2 = zz / (y1 * y1 + zz)
    m3 = zz / (x0 * x0 + zz)
    g2 = edge_angle(m2, n2, m3, n3)
    g3 = edge_angle(m3, n3, m0, n0)
    k = _TWO_PI - g2 - g3
    angle = edge_angle(m0, n0, m1, n1) + edge_angle(m1, n1, m2, n2) - k
    au = u[0] * angle + k
    sine = wp.sin(au)
    fu = (wp.cos(au) * n0 - n2) / wp.where(wp.abs(sine) > 1.0e-12, sine, 1.0e-12)
    cu = wp.clamp(wp.where(fu > 0.0, 1.0, -1.0) / wp.sqrt(fu * fu + n0 * n0), -1.0, 1.0)
    xu = wp.clamp(cu * height / wp.sqrt(wp.max((1.0 - cu) * (1.0 + cu), 1.0e-14)), x0, x1)
    dd = xu * xu + zz
    h0 = y0 / wp.sqrt(dd + y0 * y0)
    h1 = y1 / wp.sqrt(dd + y1 * y1)
    h = h0 + u[1] * (h1 - h0)
    yv = wp.clamp(h * wp.sqrt(dd / wp.max((1.0 - h) * (1.0 + h), 1.0e-14)), y0, y1)
    return (xu - cx) * ax + (yv - cy) * ay
