"""Caps: all directions within an angle of an axis. Spheres and distant lights are seen as caps.

Scratch-cone interval: the cone {w: w.u = sin_theta} is a circle on the unit sphere whose point nearest to the axis p is
the angle e away; the cap of half angle a cuts it in psi0 +- d with sin^2(d/2) = sin((a-e)/2) sin((a+e)/2) / (s rho),
psi0 = atan2(p.v, p.n), s = cos_theta, rho = hypot(p.v, p.n). This is 1 - cos d without its cancellation, so that it
holds for a light of any size, down to tangency.
"""

import warp as wp

from scratchwarp.lights.light_device import Span

HALF_PI = wp.constant(1.5707963267948966)
_SLACK = wp.constant(3.0e-7)  # widens the cap by the error of e in float32, so that the interval contains the light


@wp.func
def whole_span() -> Span:
    """The whole upper half of the cone."""
    r = Span()
    r.lo = -HALF_PI
    r.hi = HALF_PI
    r.ok = 1
    return r


@wp.func
def span_cap(axis: wp.vec3, half_angle: float, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float) -> Span:
    """Interval of phi in which the scratch cone lies within ``half_angle`` of the unit ``axis``, above the horizon.

    Where the cap covers both ends but not the middle, the interval is the whole.
    """
    p1 = wp.dot(axis, u)
    p2 = wp.dot(axis, v)
    p3 = wp.dot(axis, n)
    s = wp.sqrt(wp.max((1.0 - sin_theta) * (1.0 + sin_theta), 0.0))
    rho = wp.sqrt(p2 * p2 + p3 * p3)
    e = wp.atan2(wp.abs(s * p1 - rho * sin_theta), s * rho + sin_theta * p1)
    a = half_angle + _SLACK
    r = Span()
    if e < a:
        half = wp.sin(0.5 * (a - e)) * wp.sin(wp.min(0.5 * (a + e), 2.0 * HALF_PI)) / wp.max(s * rho, 1.0e-20)
        if half >= 1.0:
            r = whole_span()
        else:
            d = 2.0 * wp.asin(wp.sqrt(wp.max(half, 0.0))) + _SLACK
            middle = wp.atan2(p2, p3)
            r.lo = wp.max(middle - d, -HALF_PI)
            r.hi = wp.min(middle + d, HALF_PI)
            over = middle + d > 3.0 * HALF_PI  # comes back over the horizon at -pi/2
            under = middle - d < -3.0 * HALF_PI
            r.ok = wp.where(r.lo < r.hi, 1, 0)
            if over or under:
                if r.ok != 0:
                    r = whole_span()
                elif over:
                    r.lo = -HALF_PI
                    r.hi = middle + d - 4.0 * HALF_PI
                    r.ok = 1
                else:
                    r.lo = middle - d + 4.0 * HALF_PI
                    r.hi = HALF_PI
                    r.ok = 1
    return r
