"""A spherical light cut by a slice: an interval of psi around psi_p = atan2(p_2, p_3), p the unit axis.

The slice's point nearest to the axis is the angle e away, and the cap of half angle a reaches d to both sides of psi_p,
sin^2(d / 2) = sin((a - e) / 2) sin((a + e) / 2) / (s rho), rho = hypot(p_2, p_3): 1 - cos d without its cancellation,
without quadratic equations, for lights of any size.
"""

import warp as wp

from .quadrature_device import Rules
from .real_device import HALF, ONE, PI, TWO, ZERO, real, vec3, vec4
from .scratch_device import WaveScratch, to_scratch
from .slice_device import Breaks, Lobe, LobeTables, SliceSum, add_crossing

_BEYOND = wp.constant(real(4.0))


@wp.struct
class SphereView:
    """A sphere seen from the origin in the frame of a scratch; ``around``: the origin lies in it. ``marks``: u where
    its rim turns, begins to go all round or meets the horizon, 4 for none."""

    p: vec3
    half_angle: real
    around: int
    rho: real
    middle: real
    extent: Breaks
    marks: vec4


@wp.func
def view_sphere(center: vec3, radius: real, s: WaveScratch) -> SphereView:
    """Look at a sphere given in the shading frame."""
    r = SphereView()
    e = Breaks()
    r.marks = vec4(_BEYOND, _BEYOND, _BEYOND, _BEYOND)
    biggest = wp.max(wp.max(wp.abs(center[0]), wp.abs(center[1])), wp.max(wp.abs(center[2]), radius))
    if radius > ZERO:
        c = to_scratch(s, center / biggest)
        distance = wp.length(c)
        sine = radius / biggest
        if distance <= sine:
            r.around = 1
            e.low = -ONE
            e.high = ONE
        else:
            r.p = c / distance
            # asin(R / d) in a form that is exact for both small and grazing spheres
            a = wp.atan2(sine, wp.sqrt((distance - sine) * (distance + sine)))
            r.half_angle = a
            r.rho = wp.sqrt(r.p[1] * r.p[1] + r.p[2] * r.p[2])
            r.middle = wp.atan2(r.p[1], r.p[2])
            from_axis = wp.atan2(r.rho, r.p[0])
            rim_low = wp.cos(from_axis + a)
            rim_high = wp.cos(from_axis - a)
            r.marks = vec4(rim_low, rim_high, _BEYOND, _BEYOND)
            e.low = wp.where(from_axis + a >= PI, -ONE, rim_low)
            e.high = wp.where(from_axis <= a, ONE, rim_high)
            e.round_low = 1
            e.round_high = 1
            flat = wp.sqrt(r.p[0] * r.p[0] + r.p[1] * r.p[1])
            level = wp.cos(a)
            if flat > level:
                at = wp.atan2(r.p[1], r.p[0])
                spread = wp.acos(level / flat)
                left = wp.cos(at - spread)
                right = wp.cos(at + spread)
                r.marks = vec4(rim_low, rim_high, left, right)
                if r.p[2] < ZERO:
                    # its widest part is below the horizon, where the rest begins and ends flat
                    if e.low > -ONE:
                        e.low = wp.min(left, right)
                        e.round_low = 0
                    if e.high < ONE:
                        e.high = wp.max(left, right)
                        e.round_high = 0
            elif r.p[2] < ZERO:
                e.low = ZERO
                e.high = ZERO
    r.extent = e
    return r


@wp.func
def sphere_breaks(light: SphereView, s: WaveScratch, after: real) -> Breaks:
    """Its extent, and the next of its marks beyond ``after``."""
    r = light.extent
    r.following = _BEYOND
    for i in range(4):
        if light.marks[i] > after:
            r.following = wp.min(r.following, light.marks[i])
    return r


@wp.func
def _add_interval(
    acc: SliceSum, lobe: Lobe, tables: LobeTables, rules: Rules, u: real, lo: real, hi: real
) -> SliceSum:
    r = acc
    if lo < hi:
        s = wp.sqrt(wp.max((ONE - u) * (ONE + u), ZERO))
        r = add_crossing(r, lobe, tables, rules, u, s * wp.sin(lo), s * wp.cos(lo), -1)
        r = add_crossing(r, lobe, tables, rules, u, s * wp.sin(hi), s * wp.cos(hi), 1)
    return r


@wp.func
def cut_sphere(light: SphereView, lobe: Lobe, tables: LobeTables, rules: Rules, u: real) -> SliceSum:
    """The crossings of the slice at u with the part of the sphere above the horizon."""
    r = SliceSum()
    half_turn = HALF * PI
    if light.around != 0:
        return _add_interval(r, lobe, tables, rules, u, -half_turn, half_turn)
    p = light.p
    s = wp.sqrt(wp.max((ONE - u) * (ONE + u), ZERO))
    rho = light.rho
    e = wp.atan2(wp.abs(s * p[0] - rho * u), s * rho + u * p[0])
    a = light.half_angle
    if e < a:
        sine2 = wp.sin(HALF * (a - e)) * wp.sin(wp.min(HALF * (a + e), half_turn))
        middle = light.middle
        if sine2 >= s * rho:
            r = _add_interval(r, lobe, tables, rules, u, -half_turn, half_turn)
        else:
            d = TWO * wp.asin(wp.sqrt(sine2 / (s * rho)))
            lo = middle - d
            hi = middle + d
            r = _add_interval(r, lobe, tables, rules, u, wp.max(lo, -half_turn), wp.min(hi, half_turn))
            # an axis far below the horizon: the cap comes back a whole turn later
            if hi > real(3.0) * half_turn:
                r = _add_interval(r, lobe, tables, rules, u, -half_turn, wp.min(hi - TWO * PI, half_turn))
            if lo < -real(3.0) * half_turn:
                r = _add_interval(r, lobe, tables, rules, u, wp.max(lo + TWO * PI, -half_turn), half_turn)
    return r
