"""Radiance of one endless scratch under an area light by at most a few slices, on the device.

The integral over x = sigma k xi_1 of e^{-x^2} g(x), g the closed integral across one slice. Nodes stand where the
Gaussian's mass is. A round light, whose g begins and ends like a square root, takes nodes even in the mass, pulled half
way towards its two ends (error of a chord of any size 0.4 % at worst; nodes even in the mass alone leave 1.2 %). A
polygon is cut at its corners; each piece takes the Gauss rule of e^{-x^2} over it, two nodes or one, from its mass,
mean, variance and third moment in closed form: exact where g is a cubic there, or linear. Where corners are more than
slices, all of it takes nodes even in the mass.
"""

from collections.abc import Callable
from typing import Any

import warp as wp

from .quadrature_device import Rules, rule_node, rule_weight
from .real_device import HALF, ONE, TWO, ZERO, real, vec4
from .slice_device import Lobe, LobeTables, slice_value

MARKS = wp.constant(5)
"""Corners kept of an outline; with more it is not cut."""

marks_vector = wp.types.vector(length=5, dtype=real)

_ROOT_PI = wp.constant(real(1.7724538509055159))
BEYOND = wp.constant(real(1.25))  # the light is so far from the peak that e^{-x^2} is taken as an exponential there
_NARROW = wp.constant(real(0.5))
WIDE = wp.constant(real(3.4))  # erfc(3.4) = 1.5e-6
_KEPT = wp.constant(real(4.0))  # |x| within which corners are kept
_SEEN = wp.constant(real(3.5))  # corners count where e^{-x^2} is more than e^{-3.5} of its greatest value


@wp.struct
class Marks:
    """Least and greatest u of what is seen of a light (``low`` >= ``high``: nothing); whether it is ``round``, 1 where
    only in part; and the ``count`` corners between, ascending, MARKS + 1 where there are more."""

    low: real
    high: real
    round: int
    count: int
    at: marks_vector


@wp.func
def add_mark(marks: Marks, u: real) -> Marks:
    """Keep one corner more, in order; once where two are the same."""
    r = marks
    if r.count <= MARKS:
        place = int(0)
        known = int(0)
        for i in range(MARKS):
            if i < r.count:
                if r.at[i] < u:
                    place = i + 1
                if wp.abs(r.at[i] - u) < real(1.0e-12):
                    known = 1
        if known == 0:
            for j in range(MARKS - 1):
                i = MARKS - 1 - j
                if i > place:
                    r.at[i] = r.at[i - 1]
            if place < MARKS:
                r.at[place] = u
            r.count += 1
    return r


@wp.func
def inverse_erf(v: real) -> real:
    """erf^-1 within 2e-4 up to 3.3, which is enough to place nodes: a rational function of -log(1 - v^2), fitted."""
    w = -wp.log((ONE - v) * (ONE + v))
    top = real(0.88709795) + w * (real(0.34308575) + w * (real(0.06164061) + w * real(0.00189357)))
    return v * top / (ONE + w * (real(0.12936388) + w * real(0.018376)))


@wp.func
def spread_node(t: real, pull: real) -> real:
    """The node at ``t`` in [0, 1], pulled towards both ends: 0 not at all, 1 to where a square root ends there."""
    return t * (ONE + pull * (t * (real(3.0) - TWO * t) - ONE))


@wp.func
def spread_weight(t: real, pull: real) -> real:
    """Derivative of ``spread_node``."""
    return ONE + pull * (real(6.0) * t * (ONE - t) - ONE)


@wp.func
def piece_nodes(a: real, b: real, n: int) -> vec4:
    """(x, weight, x, weight) of the Gauss rule of one or two nodes (the second of weight 0) of e^{-x^2} over [a, b]."""
    width = b - a
    middle = HALF * (a + b)
    r = vec4(middle, ZERO, middle, ZERO)
    if width < _NARROW:
        step = width * real(0.28867513459481287)
        left = HALF * width * wp.exp(-(middle - step) * (middle - step))
        right = HALF * width * wp.exp(-(middle + step) * (middle + step))
        r = vec4(middle - step, left, middle + step, right)
        if n == 1:
            r = vec4(middle + step * (right - left) / wp.max(left + right, real(1.0e-300)), left + right, middle, ZERO)
    else:
        ea = wp.exp(-a * a)
        eb = wp.exp(-b * b)
        mass = real(0.0)
        if a > ZERO:
            mass = HALF * _ROOT_PI * (wp.erfc(a) - wp.erfc(b))
        elif b < ZERO:
            mass = HALF * _ROOT_PI * (wp.erfc(-b) - wp.erfc(-a))
        else:
            mass = HALF * _ROOT_PI * (wp.erf(b) - wp.erf(a))
        if mass > real(1.0e-280):
            # moments about 0 by parts; a e^{-a^2} is 0 where a is infinite in effect
            first = HALF * (ea - eb) / mass
            second = HALF + HALF * (a * ea - b * eb) / mass
            third = first + HALF * (a * a * ea - b * b * eb) / mass
            variance = wp.max(second - first * first, real(1.0e-12))
            lean = (third - first * (real(3.0) * second - TWO * first * first)) / variance
            if n == 1:
                r = vec4(first, mass, first, ZERO)
            else:
                root = wp.sqrt(lean * lean + real(4.0) * variance)
                z0 = HALF * (lean - root)
                z1 = HALF * (lean + root)
                r = vec4(wp.clamp(first + z0, a, b), mass * z1 / root, wp.clamp(first + z1, a, b), -mass * z0 / root)
    return r


def make_few(view: Any, marks_of: Callable[..., Any], cut: Callable[..., Any], short: Callable[..., Any]) -> Any:
    """The device function ``few(light, lobe, tables, rules, slices)`` of a kind of light: its struct, its ``Marks``
    (corners between two values of u), what a slice cuts out of it, and a short cut, negative where there is none. It is
    the integral over u of the Gaussian and the lobe."""

    @wp.func
    def at(light: view, lobe: Lobe, tables: LobeTables, rules: Rules, u: real) -> real:
        return slice_value(cut(light, lobe, tables, rules, u), lobe)

    @wp.func
    def even(
        light: view, lobe: Lobe, tables: LobeTables, rules: Rules, m: Marks, x0: real, x1: real, sharp: real, n: int
    ) -> real:
        """Nodes even in the mass of the Gaussian between x0 and x1."""
        total = real(0.0)
        pull = wp.where(m.round > 0, HALF, ZERO)
        nearest = wp.max(x0, -x1)
        if nearest > BEYOND:
            # by the side that is nearer: e^{-x^2} = e^{-near^2} e^{-2 near y} e^{-y^2}
            side = wp.where(x0 > ZERO, ONE, -ONE)
            rate = TWO * nearest
            mass = ONE - wp.exp(-rate * (x1 - x0))
            for i in range(n):
                t = rule_node(rules, n, i)
                y = -wp.log(ONE - spread_node(t, pull) * mass) / rate
                u = wp.clamp((side * (nearest + y)) / sharp - lobe.omega_o[0], m.low, m.high)
                weight = rule_weight(rules, n, i) * spread_weight(t, pull) * wp.exp(-y * y)
                total += weight * at(light, lobe, tables, rules, u)
            total *= mass / rate * wp.exp(-nearest * nearest)
        else:
            lo = wp.erf(x0)
            mass = wp.erf(x1) - lo
            for i in range(n):
                t = rule_node(rules, n, i)
                x = inverse_erf(lo + mass * spread_node(t, pull))
                u = wp.clamp(x / sharp - lobe.omega_o[0], m.low, m.high)
                total += rule_weight(rules, n, i) * spread_weight(t, pull) * at(light, lobe, tables, rules, u)
            total *= HALF * _ROOT_PI * mass
        return total

    @wp.func
    def few(light: view, lobe: Lobe, tables: LobeTables, rules: Rules, slices: int) -> real:
        """Integral over u of e^{-(sigma k xi_1)^2} times the integral across, by at most ``slices`` slices (4)."""
        sharp = real(6.283185307179586) * lobe.scratch.sigma / lobe.wavelength
        total = short(light, lobe, rules, sharp, slices)
        if total >= ZERO:
            return total
        total = real(0.0)
        m = marks_of(light, lobe.scratch, -lobe.omega_o[0] - _KEPT / sharp, -lobe.omega_o[0] + _KEPT / sharp)
        if m.low < m.high:
            x0 = sharp * (m.low + lobe.omega_o[0])
            x1 = sharp * (m.high + lobe.omega_o[0])
            nearest = wp.max(wp.max(x0, -x1), ZERO)
            if nearest < real(26.0):
                farthest = wp.sqrt(_SEEN + nearest * nearest)
                first = -lobe.omega_o[0] - farthest / sharp
                last = -lobe.omega_o[0] + farthest / sharp
                # the ends of the pieces
                inner = int(0)
                begin = int(0)
                for i in range(MARKS):
                    if i < m.count and m.at[i] > wp.max(first, m.low) and m.at[i] < wp.min(last, m.high):
                        if inner == 0:
                            begin = i
                        inner += 1
                if m.round == 0 and m.count <= MARKS and inner < slices:
                    spare = slices - 1 - inner
                    widest = real(0.0)
                    chosen = int(0)
                    a = real(x0)
                    for i in range(MARKS + 1):
                        if i <= inner:
                            b = real(x1)
                            if i < inner:
                                b = sharp * (m.at[begin + i] + lobe.omega_o[0])
                            wide = wp.min(b, farthest) - wp.max(a, -farthest)
                            if wide > widest:
                                widest = wide
                                chosen = i
                            a = b
                    a = x0
                    for i in range(MARKS + 1):
                        if i <= inner:
                            b = real(x1)
                            if i < inner:
                                b = sharp * (m.at[begin + i] + lobe.omega_o[0])
                            # each piece one node, the widest two, and all of them where there are enough
                            n = wp.where(spare > inner or (spare > 0 and i == chosen), 2, 1)
                            node = piece_nodes(a, b, n)
                            for j in range(n):
                                u = wp.clamp(node[2 * j] / sharp - lobe.omega_o[0], m.low, m.high)
                                total += node[2 * j + 1] * at(light, lobe, tables, rules, u)
                            a = b
                elif m.round != 0 and slices > 1 and wp.min(-x0, x1) >= WIDE:
                    # the Gauss-Hermite rule of two nodes
                    for j in range(2):
                        u = real(2 * j - 1) * real(0.7071067811865476) / sharp - lobe.omega_o[0]
                        total += HALF * _ROOT_PI * at(light, lobe, tables, rules, u)
                else:
                    total = even(light, lobe, tables, rules, m, x0, x1, sharp, slices)
        return total / sharp

    return few
