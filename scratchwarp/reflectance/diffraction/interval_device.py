"""Where a light lies on one slice of directions, for the renderer: intervals of xi_2, in float32.

A slice holds the directions (u, s sin psi, s cos psi), s = sqrt(1 - u^2), |psi| < pi / 2, in the frame of a scratch.
A light seen from a point is a cap or a convex polygon, so it takes one interval of psi of a slice, at times two.
``slice_device`` does the same in float64 for outlines of any shape.
"""

import warp as wp

_HALF_PI = wp.constant(1.5707963267948966)
_TWO_PI = wp.constant(6.283185307179586)


@wp.struct
class Extent:
    """Least and greatest u of a light; ``low`` >= ``high``: nothing is seen of it."""

    low: float
    high: float


@wp.func
def cap_extent(axis: wp.vec3, half_angle: float) -> Extent:
    """Of a cap about a unit axis, its part above the horizon."""
    e = Extent()
    rho = wp.sqrt(axis[1] * axis[1] + axis[2] * axis[2])
    from_axis = wp.atan2(rho, axis[0])
    if wp.asin(wp.clamp(axis[2], -1.0, 1.0)) > -half_angle:
        e.low = wp.where(from_axis + half_angle >= wp.pi, -1.0, wp.cos(from_axis + half_angle))
        e.high = wp.where(from_axis <= half_angle, 1.0, wp.cos(from_axis - half_angle))
    return e


@wp.func
def without(intervals: wp.vec4, low: float, high: float) -> wp.vec4:
    """Two intervals (a, b), (c, d) without the open interval (low, high)."""
    a = intervals[0]
    b = intervals[1]
    c = intervals[2]
    d = intervals[3]
    if low < high:
        if b > a and low > a and high < b:
            # a gap within the first: the second is empty then, but for rounding
            if c >= d:
                c = high
                d = b
            b = low
        elif b > a:
            if low <= a and high > a:
                a = wp.min(high, b)
            elif high >= b and low < b:
                b = wp.max(low, a)
        if d > c:
            if low <= c and high > c:
                c = wp.min(high, d)
            elif high >= d and low < d:
                d = wp.max(low, c)
    return wp.vec4(a, b, c, d)


@wp.func
def outside_arc(intervals: wp.vec4, middle: float, half: float) -> wp.vec4:
    """What of [-pi / 2, pi / 2] is left without the arc of directions within ``half`` of ``middle``."""
    r = without(intervals, middle - half, middle + half)
    r = without(r, middle - half - _TWO_PI, middle + half - _TWO_PI)
    return without(r, middle - half + _TWO_PI, middle + half + _TWO_PI)


@wp.func
def cut_cap(axis: wp.vec3, half_angle: float, u: float) -> wp.vec4:
    """Intervals of psi of a cap on the slice u; see ``sphere_device`` for the form that small lights need."""
    s = wp.sqrt(wp.max((1.0 - u) * (1.0 + u), 0.0))
    rho = wp.sqrt(axis[1] * axis[1] + axis[2] * axis[2])
    e = wp.atan2(wp.abs(s * axis[0] - rho * u), s * rho + u * axis[0])
    r = wp.vec4(0.0, 0.0, 0.0, 0.0)
    if e < half_angle:
        sine2 = wp.sin(0.5 * (half_angle - e)) * wp.sin(wp.min(0.5 * (half_angle + e), _HALF_PI))
        if sine2 >= s * rho:
            r = wp.vec4(-_HALF_PI, _HALF_PI, 0.0, 0.0)
        else:
            d = 2.0 * wp.asin(wp.sqrt(sine2 / (s * rho)))
            middle = wp.atan2(axis[1], axis[2])
            r[0] = wp.max(middle - d, -_HALF_PI)
            r[1] = wp.min(middle + d, _HALF_PI)
            if middle + d > 3.0 * _HALF_PI:
                r[2] = -_HALF_PI
                r[3] = wp.min(middle + d - _TWO_PI, _HALF_PI)
            elif middle - d < -3.0 * _HALF_PI:
                r[2] = wp.max(middle - d + _TWO_PI, -_HALF_PI)
                r[3] = _HALF_PI
    return r


@wp.func
def behind_edge(intervals: wp.vec4, inward: wp.vec3, u: float) -> wp.vec4:
    """What is left of intervals of psi on the side of a plane through the origin that its unit normal points to."""
    s = wp.sqrt(wp.max((1.0 - u) * (1.0 + u), 0.0))
    rho = wp.sqrt(inward[1] * inward[1] + inward[2] * inward[2])
    level = -inward[0] * u  # inside where s rho cos(psi - middle) >= level
    r = intervals
    if level >= s * rho:
        r = wp.vec4(0.0, 0.0, 0.0, 0.0)
    elif level > -s * rho:
        inside = wp.acos(wp.clamp(level / (s * rho), -1.0, 1.0))
        middle = wp.atan2(inward[1], inward[2])
        r = outside_arc(r, middle + wp.pi, wp.pi - inside)
    return r


@wp.func
def edge_turn(a: wp.vec3, b: wp.vec3) -> float:
    """u where the great circle from a to b turns between them; 4 where it does not."""
    m = wp.cross(a, b - a)
    length = wp.length(m)
    r = float(4.0)
    if length > 0.0:
        m = m / length
        grows = m[1] * a[2] - m[2] * a[1]
        if (grows > 0.0) != (m[1] * b[2] - m[2] * b[1] > 0.0):
            r = wp.sign(grows) * wp.sqrt(m[1] * m[1] + m[2] * m[2])
    return r
