"""A spherical light cut by a slice: the slice's half circle meets the cap around the unit axis p between two points, in
closed form without angles, for lights of any size."""

import warp as wp

from .few_device import Marks
from .quadrature_device import Rules
from .real_device import HALF, ONE, PI, ZERO, real, vec2, vec3, vec4
from .scratch_device import WaveScratch, to_scratch
from .slice_device import Breaks, Lobe, LobeTables, SliceSum, add_crossing

_BEYOND = wp.constant(real(4.0))


@wp.struct
class SphereView:
    """A sphere seen from the origin in the frame of a scratch; ``around``: the origin lies in it. ``marks``: u where
    its rim turns, begins to go all round or meets the horizon, 4 for none."""

    p: vec3
    cosine: real  # of its half angle, the square of the sine, and of that of half of it
    sine2: real
    half_sine2: real
    around: int
    rho: real
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
            share = sine / distance
            r.sine2 = share * share
            r.cosine = wp.sqrt((ONE - share) * (ONE + share))
            r.half_sine2 = HALF * r.sine2 / (ONE + r.cosine)
            r.rho = wp.sqrt(r.p[1] * r.p[1] + r.p[2] * r.p[2])
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
def sphere_marks(light: SphereView, s: WaveScratch, first: real, last: real) -> Marks:
    """Its extent, as a round light without corners."""
    r = Marks()
    r.low = light.extent.low
    r.high = light.extent.high
    r.round = wp.where(light.extent.round_low != 0 and light.extent.round_high != 0, 2, 1)
    return r


@wp.func
def cut_sphere(light: SphereView, lobe: Lobe, tables: LobeTables, rules: Rules, u: real) -> SliceSum:
    """The crossings of the slice at u with the part of the sphere above the horizon.

    p_2 across + p_3 height = cos a - u p_1 =: level meets the circle across^2 + height^2 = s^2 at across = (level p_2 -+
    p_3 root) / rho^2, height = (level p_3 +- p_2 root) / rho^2, where root^2 = s^2 rho^2 - level^2 = sin^2 a - (u -
    p_1)^2 - 4 u p_1 sin^2(a / 2) without its cancellation. The light lies between them, the upper signs where it begins.
    """
    r = SliceSum()
    s2 = wp.max((ONE - u) * (ONE + u), ZERO)
    s = wp.sqrt(s2)
    if light.around != 0:
        r = add_crossing(r, lobe, tables, rules, u, -s, ZERO, -1)
        r = add_crossing(r, lobe, tables, rules, u, s, ZERO, 1)
        return r
    p = light.p
    away = u - p[0]
    root2 = light.sine2 - away * away - real(4.0) * u * p[0] * light.half_sine2
    level = light.cosine - u * p[0]
    if root2 <= ZERO:
        # all of the slice, or none of it
        if level < ZERO:
            r = add_crossing(r, lobe, tables, rules, u, -s, ZERO, -1)
            r = add_crossing(r, lobe, tables, rules, u, s, ZERO, 1)
        return r
    scale = ONE / (light.rho * light.rho)
    root = wp.sqrt(root2)
    a = vec2(level * p[1] - p[2] * root, level * p[2] + p[1] * root) * scale
    b = vec2(level * p[1] + p[2] * root, level * p[2] - p[1] * root) * scale
    begins = a[1] >= ZERO
    ends = b[1] >= ZERO
    # the first half circle's end lies in the light unless the light both begins and ends above the horizon, once
    if (begins and ends and a[0] > b[0]) or (ends and not begins):
        r = add_crossing(r, lobe, tables, rules, u, -s, ZERO, -1)
    if ends:
        r = add_crossing(r, lobe, tables, rules, u, b[0], b[1], 1)
    if begins:
        r = add_crossing(r, lobe, tables, rules, u, a[0], a[1], -1)
    if (begins and ends and a[0] > b[0]) or (begins and not ends):
        r = add_crossing(r, lobe, tables, rules, u, s, ZERO, 1)
    if not begins and not ends and s * p[2] > level:
        r = add_crossing(r, lobe, tables, rules, u, -s, ZERO, -1)
        r = add_crossing(r, lobe, tables, rules, u, s, ZERO, 1)
    return r
