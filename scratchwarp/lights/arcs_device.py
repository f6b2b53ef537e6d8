"""Arcs: where exactly a scratch cone crosses a light, as intervals of phi; nothing outside, nothing missing.

The cone {w: w.u = sin_theta} is a circle on the unit sphere. A cap cuts it in one arc, the plane through an edge of a
rectangle in two points, the cone over an ellipse in up to four: with t = tan(phi / 2) and w (1 + t^2) quadratic in t,
its equation is a quartic, whose roots are isolated by those of its derivatives, so that none is missed. Between
neighbouring cuts all is inside or all outside. A half circle can enter and leave a convex light more than once.
"""

from typing import Any

import warp as wp

from scratchwarp.lights.light_device import Light
from scratchwarp.lights.quartic_device import quartic_at, quartic_roots, vec_quartic

wp.set_module_options({"enable_backward": False})

MOST_ARCS = 5  # four entries of a convex quadrilateral, one of them split by the horizon
MOST_CUTS = 16  # of a cylinder: two planes, the middle of each end and its circle
vec_arcs: Any = wp.types.vector(length=MOST_ARCS, dtype=wp.float32)
vec_cuts: Any = wp.types.vector(length=MOST_CUTS, dtype=wp.float32)

_PI = wp.constant(3.141592653589793)


@wp.struct
class Arcs:
    """``count`` intervals of phi, ascending and disjoint."""

    lo: vec_arcs
    hi: vec_arcs
    count: int


@wp.struct
class Cuts:
    """Ascending values of phi where a boundary is crossed, the ends of the range among them."""

    at: vec_cuts
    count: int


@wp.func
def one_arc(lo: float, hi: float) -> Arcs:
    """The interval itself, or nothing when it is empty."""
    r = Arcs()
    if hi > lo:
        r.lo[0] = lo
        r.hi[0] = hi
        r.count = 1
    return r


@wp.func
def add_arc(arcs: Arcs, lo: float, hi: float) -> Arcs:
    """One more interval, beyond those already there; joined to the last one where they touch."""
    r = arcs
    if hi > lo:
        joined = int(0)
        if r.count > 0:
            if r.hi[r.count - 1] >= lo:
                r.hi[r.count - 1] = hi
                joined = 1
        if joined == 0 and r.count < wp.static(MOST_ARCS):
            r.lo[r.count] = lo
            r.hi[r.count] = hi
            r.count = r.count + 1
    return r


@wp.func
def add_cut(cuts: Cuts, phi: float, lo: float, hi: float) -> Cuts:
    """One more crossing, in its place, when it lies between ``lo`` and ``hi``."""
    r = cuts
    if phi > lo and phi < hi and r.count < wp.static(MOST_CUTS):
        k = int(r.count)
        while k > 0 and r.at[wp.max(k - 1, 0)] > phi:
            r.at[k] = r.at[k - 1]
            k = k - 1
        r.at[k] = phi
        r.count = r.count + 1
    return r


@wp.func
def first_cut(lo: float) -> Cuts:
    """The lower end of the range alone."""
    r = Cuts()
    r.at[0] = lo
    r.count = 1
    return r


@wp.func
def end_after(cuts: Cuts, k: int, hi: float) -> float:
    """The end of the interval that begins at cut ``k``."""
    right = hi
    if k + 1 < cuts.count:
        right = cuts.at[wp.min(k + 1, wp.static(MOST_CUTS - 1))]
    return right


@wp.func
def cone_at(u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float, cos_theta: float, phi: float) -> wp.vec3:
    """The cone's direction."""
    return sin_theta * u + cos_theta * (wp.sin(phi) * v + wp.cos(phi) * n)


@wp.func
def above_facet(ng: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float) -> wp.vec2:
    """(lo, hi) of the part of the upper half of the cone that lies above the plane across ``ng``; lo >= hi: none."""
    s = wp.sqrt(wp.max((1.0 - sin_theta) * (1.0 + sin_theta), 0.0))
    g2 = wp.dot(ng, v)
    g3 = wp.dot(ng, n)
    level = -sin_theta * wp.dot(ng, u)
    rho = s * wp.sqrt(g2 * g2 + g3 * g3)
    half = 0.5 * _PI
    r = wp.vec2(-half, half)
    if level >= rho:
        r = wp.vec2(0.0, 0.0)
    elif level > -rho:
        d = wp.atan2(wp.sqrt((rho - level) * (rho + level)), level)
        middle = wp.atan2(g2, g3)
        r = wp.vec2(wp.max(-half, middle - d), wp.min(half, middle + d))
    return r


@wp.func
def arcs_cap(
    axis: wp.vec3,
    half_angle: float,
    u: wp.vec3,
    v: wp.vec3,
    n: wp.vec3,
    sin_theta: float,
    lo: float,
    hi: float,
) -> Arcs:
    """Where [lo, hi] of the cone lies within ``half_angle`` of the unit ``axis``; formula as in ``cap_device``."""
    p1 = wp.dot(axis, u)
    p2 = wp.dot(axis, v)
    p3 = wp.dot(axis, n)
    s = wp.sqrt(wp.max((1.0 - sin_theta) * (1.0 + sin_theta), 0.0))
    rho = wp.sqrt(p2 * p2 + p3 * p3)
    e = wp.atan2(wp.abs(s * p1 - rho * sin_theta), s * rho + sin_theta * p1)
    r = Arcs()
    if e < half_angle:
        half = wp.sin(0.5 * (half_angle - e)) * wp.sin(wp.min(0.5 * (half_angle + e), _PI)) / wp.max(s * rho, 1.0e-20)
        if half >= 1.0:
            r = one_arc(lo, hi)
        else:
            d = 2.0 * wp.asin(wp.sqrt(wp.max(half, 0.0)))
            middle = wp.atan2(p2, p3)
            for k in range(3):
                turned = middle + 2.0 * _PI * float(k - 1)
                r = add_arc(r, wp.max(turned - d, lo), wp.min(turned + d, hi))
    return r


@wp.func
def edge_normal(a: wp.vec3, b: wp.vec3, turn: float) -> wp.vec3:
    """Unit normal of the plane through the origin and an edge, inward by ``turn``; zero for no edge."""
    m = wp.cross(a, b - a)
    length = wp.length(m)
    if length > 0.0:
        m = m * (turn / length)
    return m


@wp.func
def add_plane(
    cuts: Cuts, m: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float, lo: float, hi: float
) -> Cuts:
    """The cuts of the plane across ``m`` through the origin; see ``polygon_device.cross_edge``."""
    r = cuts
    m2 = wp.dot(m, v)
    m3 = wp.dot(m, n)
    s = wp.sqrt(wp.max((1.0 - sin_theta) * (1.0 + sin_theta), 0.0))
    rho = s * wp.sqrt(m2 * m2 + m3 * m3)
    level = -sin_theta * wp.dot(m, u)
    if wp.abs(level) < rho:
        middle = wp.atan2(m2, m3)
        d = wp.atan2(wp.sqrt((rho - level) * (rho + level)), level)
        for side in range(2):
            psi = middle + float(2 * side - 1) * d
            psi = wp.where(psi > _PI, psi - 2.0 * _PI, psi)
            psi = wp.where(psi < -_PI, psi + 2.0 * _PI, psi)
            r = add_cut(r, psi, lo, hi)
    return r


@wp.func
def arcs_quad(
    center: wp.vec3,
    ex: wp.vec3,
    ey: wp.vec3,
    u: wp.vec3,
    v: wp.vec3,
    n: wp.vec3,
    sin_theta: float,
    lo: float,
    hi: float,
) -> Arcs:
    """Where [lo, hi] of the cone meets the parallelogram center +- ex +- ey seen from the origin."""
    turn = wp.where(wp.dot(wp.cross(ex, ey), center) > 0.0, 1.0, -1.0)
    a = center - ex - ey
    b = center + ex - ey
    c = center + ex + ey
    d = center - ex + ey
    m0 = edge_normal(a, b, turn)
    m1 = edge_normal(b, c, turn)
    m2 = edge_normal(c, d, turn)
    m3 = edge_normal(d, a, turn)
    cuts = first_cut(lo)
    cuts = add_plane(cuts, m0, u, v, n, sin_theta, lo, hi)
    cuts = add_plane(cuts, m1, u, v, n, sin_theta, lo, hi)
    cuts = add_plane(cuts, m2, u, v, n, sin_theta, lo, hi)
    cuts = add_plane(cuts, m3, u, v, n, sin_theta, lo, hi)
    s = wp.sqrt(wp.max((1.0 - sin_theta) * (1.0 + sin_theta), 0.0))
    r = Arcs()
    for k in range(cuts.count):
        left = cuts.at[k]
        right = end_after(cuts, k, hi)
        w = cone_at(u, v, n, sin_theta, s, 0.5 * (left + right))
        within = wp.min(wp.min(wp.dot(w, m0), wp.dot(w, m1)), wp.min(wp.dot(w, m2), wp.dot(w, m3)))
        if within > 0.0:
            r = add_arc(r, left, right)
    return r


@wp.func
def along_t(m: wp.vec3d, u: wp.vec3, v: wp.vec3, n: wp.vec3, sine: wp.float64, cosine: wp.float64) -> wp.vec3d:
    """Coefficients of m.w (1 + t^2) in t = tan(phi / 2)."""
    m1 = m[0] * wp.float64(u[0]) + m[1] * wp.float64(u[1]) + m[2] * wp.float64(u[2])
    m2 = m[0] * wp.float64(v[0]) + m[1] * wp.float64(v[1]) + m[2] * wp.float64(v[2])
    m3 = m[0] * wp.float64(n[0]) + m[1] * wp.float64(n[1]) + m[2] * wp.float64(n[2])
    return wp.vec3d(sine * m1 + cosine * m3, wp.float64(2.0) * cosine * m2, sine * m1 - cosine * m3)


@wp.func
def squared(a: wp.vec3d) -> vec_quartic:
    """Coefficients of (a0 + a1 t + a2 t^2)^2."""
    two = wp.float64(2.0)
    return vec_quartic(a[0] * a[0], two * a[0] * a[1], a[1] * a[1] + two * a[0] * a[2], two * a[1] * a[2], a[2] * a[2])


@wp.func
def ellipse_quartic(
    center: wp.vec3,
    axis: wp.vec3,
    rx: wp.vec3,
    ry: wp.vec3,
    u: wp.vec3,
    v: wp.vec3,
    n: wp.vec3,
    sin_theta: float,
) -> vec_quartic:
    """Negative where w or -w meets the ellipse {center + o: (rx.o)^2 + (ry.o)^2 <= 1, axis.o = 0} seen from the origin:
    A^2 + B^2 - D^2 with A = (h rx + (rx.center) axis).w, B alike, D = -axis.w, h = -center.axis."""
    p = wp.vec3d(wp.float64(center[0]), wp.float64(center[1]), wp.float64(center[2]))
    z = wp.vec3d(wp.float64(axis[0]), wp.float64(axis[1]), wp.float64(axis[2]))
    x = wp.vec3d(wp.float64(rx[0]), wp.float64(rx[1]), wp.float64(rx[2]))
    y = wp.vec3d(wp.float64(ry[0]), wp.float64(ry[1]), wp.float64(ry[2]))
    height = -wp.dot(p, z)
    sine = wp.float64(sin_theta)
    cosine = wp.sqrt(wp.max((wp.float64(1.0) - sine) * (wp.float64(1.0) + sine), wp.float64(0.0)))
    a = along_t(height * x + wp.dot(x, p) * z, u, v, n, sine, cosine)
    b = along_t(height * y + wp.dot(y, p) * z, u, v, n, sine, cosine)
    d = along_t(-z, u, v, n, sine, cosine)
    return squared(a) + squared(b) - squared(d)


@wp.func
def arcs_ellipse(
    center: wp.vec3,
    axis: wp.vec3,
    rx: wp.vec3,
    ry: wp.vec3,
    u: wp.vec3,
    v: wp.vec3,
    n: wp.vec3,
    sin_theta: float,
    lo: float,
    hi: float,
) -> Arcs:
    """Where [lo, hi] of the cone meets an ellipse that faces the origin; arguments as of ``ellipse_quartic``."""
    q = ellipse_quartic(center, axis, rx, ry, u, v, n, sin_theta)
    left = wp.tan(wp.float64(0.5) * wp.float64(lo))
    last = wp.tan(wp.float64(0.5) * wp.float64(hi))
    roots = quartic_roots(q, left, last)
    s = wp.sqrt(wp.max((1.0 - sin_theta) * (1.0 + sin_theta), 0.0))
    r = Arcs()
    for k in range(5):
        right = last
        if k < 4:
            right = wp.min(roots[k], last)
        if right > left:
            t = wp.float64(0.5) * (left + right)
            if quartic_at(q, 0, t) < wp.float64(0.0):
                w = cone_at(u, v, n, sin_theta, s, float(wp.float64(2.0) * wp.atan(t)))
                if wp.dot(w, axis) < 0.0:
                    r = add_arc(r, float(wp.float64(2.0) * wp.atan(left)), float(wp.float64(2.0) * wp.atan(right)))
            left = right
    return r


@wp.func
def misses_ball(p: wp.vec3, radius: float, u: wp.vec3, sin_theta: float) -> bool:
    """Whether the cone passes a ball about ``p`` seen from the origin, and so all that lies in it."""
    d2 = wp.dot(p, p)
    result = False
    if d2 > radius * radius:
        d = wp.sqrt(d2)
        g = wp.clamp(wp.dot(p, u) / d, -1.0, 1.0)
        # of the angle between the ball's middle and the cone
        across = wp.sqrt(1.0 - g * g)
        cosine = wp.sqrt(wp.max((1.0 - sin_theta) * (1.0 + sin_theta), 0.0))
        result = across * cosine + g * sin_theta < 0.0 or wp.abs(g * cosine - across * sin_theta) * d > 1.0001 * radius
    return result


@wp.func
def may_meet(light: Light, p: wp.vec3, reach: float, u: wp.vec3, sin_theta: float) -> bool:
    """Whether a flat light about ``p``, no farther than ``reach`` from there, is seen from its lit side and near to the
    cone."""
    return wp.dot(p, light.ez) < -1.0e-12 and light.size > 0.0 and not misses_ball(p, reach, u, sin_theta)


@wp.func
def arcs_sphere(
    light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float, lo: float, hi: float
) -> Arcs:
    """Of a sphere light from outside."""
    r = Arcs()
    p = light.center - x
    d = wp.length(p)
    if d > light.radius:
        half_angle = wp.atan2(light.radius, wp.sqrt((d - light.radius) * (d + light.radius)))
        r = arcs_cap(p / d, half_angle, u, v, n, sin_theta, lo, hi)
    return r


@wp.func
def arcs_distant(
    light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float, lo: float, hi: float
) -> Arcs:
    """Of a distant light."""
    return arcs_cap(light.center, light.half_angle, u, v, n, sin_theta, lo, hi)


@wp.func
def arcs_rect(
    light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float, lo: float, hi: float
) -> Arcs:
    """Of a rect light from its lit side."""
    r = Arcs()
    p = light.center - x
    if may_meet(light, p, wp.length(light.ex) + wp.length(light.ey), u, sin_theta):
        r = arcs_quad(p, light.ex, light.ey, u, v, n, sin_theta, lo, hi)
    return r


@wp.func
def arcs_disk(
    light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float, lo: float, hi: float
) -> Arcs:
    """Of a disk light from its lit side."""
    r = Arcs()
    p = light.center - x
    if may_meet(light, p, wp.max(wp.length(light.ex), wp.length(light.ey)), u, sin_theta):
        r = arcs_ellipse(p, light.ez, light.rx, light.ry, u, v, n, sin_theta, lo, hi)
    return r


@wp.func
def arcs_dome(
    light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float, lo: float, hi: float
) -> Arcs:
    """All of it."""
    return one_arc(lo, hi)
