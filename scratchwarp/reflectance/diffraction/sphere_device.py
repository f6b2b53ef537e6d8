"""A spherical light cut by a slice: the slice's half circle meets the cap around the unit axis p between two points, in
closed form without angles, for lights of any size."""

import warp as wp

from .few_device import WIDE, Marks, add_mark
from .lobe_device import sinc
from .quadrature_device import Rules
from .real_device import HALF, ONE, PI, TWO, ZERO, real, vec2, vec3, vec4
from .round_device import fewer_nodes, round_nodes
from .scratch_device import WaveScratch, to_scratch
from .slice_device import EXACT, Breaks, Lobe, LobeTables, SliceSum, add_crossing, slice_value

_BEYOND = wp.constant(real(4.0))
_SHORT = wp.constant(real(0.016))  # of a fringe to either side: a parabola, within 1e-4 of its height
_STEEP = wp.constant(real(0.1))
_SQRT_PI = wp.constant(real(1.7724538509055159))
_NARROW = wp.constant(real(0.15))  # of a fringe: 4e-7


@wp.struct
class SphereView:
    """A sphere seen from the origin in the frame of a scratch; ``around``: the origin lies in it. ``marks``: u where
    its rim turns, begins to go all round or meets the horizon, 4 for none."""

    p: vec3
    cosine: real  # of its half angle; its sine, the square of that, and the square of the sine of half of it
    share: real
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
            share = sine / distance
            r.share = share
            r.sine2 = share * share
            r.cosine = wp.sqrt((ONE - share) * (ONE + share))
            r.half_sine2 = HALF * r.sine2 / (ONE + r.cosine)
            r.rho = wp.sqrt(r.p[1] * r.p[1] + r.p[2] * r.p[2])
            # the rim turns at the cosines of the axis' angle from u plus and minus the half angle
            rim_low = r.p[0] * r.cosine - r.rho * share
            rim_high = r.p[0] * r.cosine + r.rho * share
            r.marks = vec4(rim_low, rim_high, _BEYOND, _BEYOND)
            e.low = wp.where(r.rho * r.cosine + r.p[0] * share <= ZERO, -ONE, rim_low)
            e.high = wp.where(r.rho * r.cosine - r.p[0] * share <= ZERO, ONE, rim_high)
            e.round_low = 1
            e.round_high = 1
            if r.p[2] < share:
                flat2 = r.p[0] * r.p[0] + r.p[1] * r.p[1]
                above = flat2 - r.cosine * r.cosine
                if above > ZERO:
                    # where its rim meets the horizon
                    spread = wp.abs(r.p[1]) * wp.sqrt(above)
                    left = (r.p[0] * r.cosine - spread) / flat2
                    right = (r.p[0] * r.cosine + spread) / flat2
                    r.marks = vec4(rim_low, rim_high, left, right)
                    if r.p[2] < ZERO:
                        # its widest part is below the horizon, where the rest begins and ends flat
                        if e.low > -ONE:
                            e.low = left
                            e.round_low = 0
                        if e.high < ONE:
                            e.high = right
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
    """Its extent and, of one that the horizon cuts, its marks between ``first`` and ``last``."""
    r = Marks()
    r.low = light.extent.low
    r.high = light.extent.high
    # it turns where its rim does, and where the slices themselves end
    r.turn_low = wp.where(light.extent.round_low != 0 or r.low <= -ONE, 1, 0)
    r.turn_high = wp.where(light.extent.round_high != 0 or r.high >= ONE, 1, 0)
    r.profiled = 1 - light.around
    for i in range(4):
        u = light.marks[i]
        if u > wp.max(first, r.low) and u < wp.min(last, r.high):
            r = add_mark(r, u, wp.where(i < 2, 1, 0), ZERO)
    return r


@wp.func
def cut_sphere(light: SphereView, lobe: Lobe, tables: LobeTables, rules: Rules, u: real) -> SliceSum:
    """The crossings of the slice at u with the part of the sphere above the horizon.

    p_2 across + p_3 height = cos a - u p_1 =: level meets the circle across^2 + height^2 = s^2 at across = (level p_2
    -+ p_3 root) / rho^2, height = (level p_3 +- p_2 root) / rho^2, where root^2 = s^2 rho^2 - level^2 = sin^2 a - (u -
    p_1)^2 - 4 u p_1 sin^2(a / 2) without its cancellation. The light begins at the upper signs and ends at the lower.
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
    if lobe.kind == EXACT and begins and ends:
        # narrow lights by three nodes of Gauss: error (2 pi t)^6 / 2e6
        t = lobe.ratio * (b[0] - a[0])
        if t > ZERO and t < _NARROW:
            middle = lobe.ratio * (lobe.omega_o[1] + HALF * (a[0] + b[0]))
            mean = sinc(middle)
            left = sinc(middle - real(0.3872983346207417) * t)
            right = sinc(middle + real(0.3872983346207417) * t)
            r.rest = PI * t * (real(8.0) * mean * mean + real(5.0) * (left * left + right * right)) / real(18.0)
            r.length = t
            return r
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


@wp.func
def _narrow(
    light: SphereView, lobe: Lobe, node: vec4, side: real, near: real, reach: real, sharp: real, count: int
) -> real:
    """``short_sphere`` where sinc^2 is a parabola across all of it."""
    p = light.p
    step = light.share
    across = lobe.omega_o[1] + p[1]
    left = sinc(lobe.ratio * (across - step))
    level = sinc(lobe.ratio * across)
    right = sinc(lobe.ratio * (across + step))
    c0 = level * level
    c1 = (right * right - left * left) * HALF / step
    c2 = (HALF * (right * right + left * left) - c0) / (step * step)
    scale = ONE / (light.rho * light.rho)
    grow = p[2] * scale / sharp
    total = real(0.0)
    for j in range(count):
        y = node[2 * j]
        u = side * (near + y) / sharp - lobe.omega_o[0]
        half2 = y * (TWO * reach - y) * grow * grow
        d = ((light.cosine - u * p[0]) * scale - ONE) * p[1]
        total += node[2 * j + 1] * (c0 + d * (c1 + d * c2) + c2 * half2 / real(3.0))
    gone = wp.max(near, ZERO)
    return total * TWO * lobe.peak * PI * lobe.ratio * grow * wp.exp(-gone * gone) / sharp


@wp.func
def short_sphere(light: SphereView, lobe: Lobe, tables: LobeTables, rules: Rules, sharp: real, slices: int) -> real:
    """``few`` of a whole sphere above the horizon, by two slices; -1 where it is not one."""
    p = light.p
    if light.around != 0 or p[2] < light.share:
        return -ONE
    reach = sharp * light.rho * light.share
    middle = sharp * (p[0] * light.cosine + lobe.omega_o[0])
    near = wp.abs(middle) - reach  # of the nearer end; what is left of the other side is beyond
    if near >= real(26.0):
        return ZERO
    side = wp.where(middle < ZERO, -ONE, ONE)
    node = vec4(ZERO, ZERO, ZERO, ZERO)
    if near <= -WIDE:
        # the Gauss-Hermite rule of two nodes, as weights of what is divided by the root
        for j in range(2):
            y = -near + real(2 * j - 1) * real(0.7071067811865476)
            node[2 * j] = y
            node[2 * j + 1] = HALF * _SQRT_PI * wp.sqrt(y * (TWO * reach - y))
    else:
        node = round_nodes(tables.rounds, near, TWO * reach)
    node = fewer_nodes(node, slices)
    total = real(0.0)
    if lobe.kind == EXACT and lobe.ratio * light.share <= _SHORT and light.rho * light.rho >= _STEEP:
        return wp.max(_narrow(light, lobe, node, side, near, reach, sharp, wp.min(slices, 2)), ZERO)
    for j in range(wp.min(slices, 2)):
        y = node[2 * j]
        weight = node[2 * j + 1]
        root = wp.sqrt(wp.max(y * (TWO * reach - y), real(1.0e-300)))
        u = side * (near + y) / sharp - lobe.omega_o[0]
        total += weight / root * slice_value(cut_sphere(light, lobe, tables, rules, u), lobe)
    return wp.max(total, ZERO) * wp.exp(-wp.max(near, ZERO) * wp.max(near, ZERO)) / sharp
