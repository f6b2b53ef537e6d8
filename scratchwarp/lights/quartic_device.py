"""Real roots of a polynomial of degree four within an interval, in float64, none missed.

Between neighbouring roots of its derivative a polynomial is monotone and has one root at most. The roots of the
derivative, a cubic, lie between those of its own derivative, which are known in closed form.
"""

from typing import Any

import warp as wp

wp.set_module_options({"enable_backward": False})

vec_quartic: Any = wp.types.vector(length=5, dtype=wp.float64)
_NEWTON = wp.constant(60)  # at most: bisection alone would need some 50


@wp.func
def quartic_at(q: vec_quartic, order: int, t: wp.float64) -> wp.float64:
    """The polynomial sum q_k t^k (order 0) or its derivative (order 1)."""
    two = wp.float64(2.0)
    three = wp.float64(3.0)
    four = wp.float64(4.0)
    if order == 0:
        return q[0] + t * (q[1] + t * (q[2] + t * (q[3] + t * q[4])))
    return q[1] + t * (two * q[2] + t * (three * q[3] + t * (four * q[4])))


@wp.func
def quartic_slope(q: vec_quartic, order: int, t: wp.float64) -> wp.float64:
    """Derivative of ``quartic_at``."""
    if order == 0:
        return quartic_at(q, 1, t)
    return wp.float64(2.0) * q[2] + t * (wp.float64(6.0) * q[3] + t * (wp.float64(12.0) * q[4]))


@wp.func
def root_between(q: vec_quartic, order: int, lo: wp.float64, hi: wp.float64) -> wp.float64:
    """The root within [lo, hi], where the polynomial is monotone: Newton's steps, bisection where they leave; 9 when
    the ends have one sign."""
    a = wp.float64(lo)
    b = wp.float64(hi)
    at_a = quartic_at(q, order, a)
    at_b = quartic_at(q, order, b)
    if (at_a > wp.float64(0.0)) == (at_b > wp.float64(0.0)):
        return wp.float64(9.0)
    t = wp.float64(0.5) * (a + b)
    for _i in range(_NEWTON):
        value = quartic_at(q, order, t)
        if (value > wp.float64(0.0)) == (at_a > wp.float64(0.0)):
            a = t
        else:
            b = t
        slope = quartic_slope(q, order, t)
        new = wp.float64(0.5) * (a + b)
        if slope != wp.float64(0.0):
            step = t - value / slope
            if step > a and step < b:
                new = step
        if wp.abs(new - t) < wp.float64(1.0e-10):
            return new
        t = new
    return t


@wp.func
def quadratic_roots(c: wp.float64, b: wp.float64, a: wp.float64) -> wp.vec2d:
    """Ascending real roots of c + b t + a t^2; 9 for those that there are not."""
    none = wp.float64(9.0)
    r = wp.vec2d(none, none)
    d = b * b - wp.float64(4.0) * a * c
    if d > wp.float64(0.0):
        # the larger in size first, the other by their product
        h = wp.float64(-0.5) * (b + wp.where(b < wp.float64(0.0), -wp.sqrt(d), wp.sqrt(d)))
        one = none
        two = none
        if wp.abs(a) > wp.float64(1.0e-300):
            one = h / a
        if wp.abs(h) > wp.float64(1.0e-300):
            two = c / h
        r = wp.vec2d(wp.min(one, two), wp.max(one, two))
    return r


@wp.func
def monotone_roots(q: vec_quartic, order: int, knots: vec_quartic, lo: wp.float64, hi: wp.float64) -> vec_quartic:
    """Roots within [lo, hi], ascending, 9 where there are no more; ``knots``: ascending turning points."""
    none = wp.float64(9.0)
    r = vec_quartic(none, none, none, none, none)
    count = int(0)
    left = wp.float64(lo)
    for k in range(5):
        right = wp.min(wp.max(knots[k], lo), hi)
        if right > left:
            root = root_between(q, order, left, right)
            if root < none:
                r[count] = root
                count = count + 1
            left = right
    if hi > left:
        root = root_between(q, order, left, hi)
        if root < none and count < 5:
            r[count] = root
    return r


@wp.func
def quartic_roots(q: vec_quartic, lo: wp.float64, hi: wp.float64) -> vec_quartic:
    """All roots of sum q_k t^k within [lo, hi], ascending, then 9."""
    none = wp.float64(9.0)
    bends = quadratic_roots(wp.float64(2.0) * q[2], wp.float64(6.0) * q[3], wp.float64(12.0) * q[4])
    knots = monotone_roots(q, 1, vec_quartic(bends[0], bends[1], none, none, none), lo, hi)
    return monotone_roots(q, 0, knots, lo, hi)
