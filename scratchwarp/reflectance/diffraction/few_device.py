"""Radiance of one endless scratch under an area light by at most a few slices, on the device.

The integral over x = sigma k xi_1 of e^{-x^2} g(x), g the closed integral across one slice. A whole sphere takes the
two nodes of the Gauss rule of e^{-x^2} times the chord of a circle (``round_rules``): exact where g is that chord times
a cubic. A polygon with at most one corner where the Gaussian is takes two nodes on either side of it, of the Gauss rule
of e^{-x^2} there by its moments in closed form: exact where g is a cubic; in t = sqrt(x - x0) where an edge turns, and
g begins like a square root. With more corners, or cut by the horizon, a light takes two rules of two nodes of e^{-x^2}
times the lit length of the slice, whose moments are sums over many slices' lengths, which cost little: exact where the
mean of the lobe over the lit length is a cubic in each half.
"""

from collections.abc import Callable
from typing import Any

import warp as wp

from .quadrature_device import Rules, rule_node, rule_weight
from .real_device import HALF, ONE, PI, TWO, ZERO, real, vec4
from .slice_device import LENGTH, Lobe, LobeTables, slice_value

MARKS = wp.constant(7)
"""Corners kept of an outline; with more it is not cut."""

marks_vector = wp.types.vector(length=7, dtype=real)
ends_vector = wp.types.vector(length=9, dtype=real)

_ROOT_PI = wp.constant(real(1.7724538509055159))
_NARROW = wp.constant(real(0.5))
WIDE = wp.constant(real(3.4))  # erfc(3.4) = 1.5e-6
_KEPT = wp.constant(real(4.0))  # |x| within which corners are kept
MERGED = wp.constant(real(0.02))  # pieces narrower than this in x are no pieces of their own
_TINY = wp.constant(real(1.0e-300))
_LENGTHS = wp.constant(8)  # of a piece
_BROAD = wp.constant(real(1.5))  # in x: twice as many
_MOMENTS = wp.constant(16)  # nodes for the moments of a piece that turns
_SEEN = wp.constant(real(3.5))  # corners count where e^{-x^2} is more than e^{-3.5} of its greatest value


@wp.struct
class Marks:
    """Least and greatest u of what is seen of a light (``low`` >= ``high``: nothing); whether it turns there, as a
    square root; whether it is ``profiled`` however few its corners; and the ``count`` corners between, ascending,
    MARKS + 1 where there are more, 1 in ``turns`` where an edge turns."""

    low: real
    high: real
    turn_low: int
    turn_high: int
    profiled: int
    count: int
    at: marks_vector
    turns: marks_vector


@wp.func
def add_mark(marks: Marks, u: real, turn: int, apart: real) -> Marks:
    """Keep one corner more, in order; one of two that are less than ``apart``, one that turns first."""
    r = marks
    if r.count <= MARKS:
        place = int(0)
        known = int(0)
        for i in range(MARKS):
            if i < r.count:
                if r.at[i] < u:
                    place = i + 1
                if wp.abs(r.at[i] - u) < apart:
                    known = 1
                    if turn == 1 and r.turns[i] == ZERO:
                        r.at[i] = u
                        r.turns[i] = ONE
        if known == 0:
            for j in range(MARKS - 1):
                i = MARKS - 1 - j
                if i > place:
                    r.at[i] = r.at[i - 1]
                    r.turns[i] = r.turns[i - 1]
            if place < MARKS:
                r.at[place] = u
                r.turns[place] = real(turn)
            r.count += 1
    return r


@wp.func
def two_nodes(mass: real, first: real, second: real, third: real, a: real, b: real, n: int) -> vec4:
    """(x, weight, x, weight) of the Gauss rule of one or two nodes (the second of weight 0) of a weight by its mass and
    its moments about 0; nodes in [a, b]."""
    variance = wp.max(second - first * first, real(1.0e-12))
    lean = (third - first * (real(3.0) * second - TWO * first * first)) / variance
    r = vec4(first, mass, first, ZERO)
    if n > 1:
        root = wp.sqrt(lean * lean + real(4.0) * variance)
        z0 = HALF * (lean - root)
        z1 = HALF * (lean + root)
        r = vec4(wp.clamp(first + z0, a, b), mass * z1 / root, wp.clamp(first + z1, a, b), -mass * z0 / root)
    return r


@wp.func
def turning_nodes(rules: Rules, a: real, b: real, side: int, n: int) -> vec4:
    """The same of e^{-x^2} over [a, b] for what begins (``side`` 0) or ends (1) like a square root there: the rule in
    t, x = a + t^2 or b - t^2."""
    near = wp.max(wp.max(a, -b), ZERO)
    far = wp.sqrt(real(20.0) + near * near)
    low = wp.max(a, -far)
    high = wp.min(b, far)
    sign = wp.where(side == 0, ONE, -ONE)
    start = wp.where(side == 0, a, b)
    t0 = wp.sqrt(wp.where(side == 0, low - a, b - high))
    t1 = wp.sqrt(wp.where(side == 0, high - a, b - low))
    mass = real(0.0)
    first = real(0.0)
    second = real(0.0)
    third = real(0.0)
    for i in range(_MOMENTS):
        t = t0 + (t1 - t0) * rule_node(rules, _MOMENTS, i)
        x = start + sign * t * t
        weight = rule_weight(rules, _MOMENTS, i) * t * wp.exp(near * near - x * x)
        mass += weight
        first += weight * t
        second += weight * t * t
        third += weight * t * t * t
    r = vec4(HALF * (low + high), ZERO, HALF * (low + high), ZERO)
    if mass > _TINY:
        r = two_nodes(mass, first / mass, second / mass, third / mass, t0, t1, n)
        scale = TWO * (t1 - t0) * wp.exp(-near * near)
        r = vec4(start + sign * r[0] * r[0], scale * r[1], start + sign * r[2] * r[2], scale * r[3])
    return r


@wp.func
def piece_nodes(a: real, b: real, n: int) -> vec4:
    """The same of e^{-x^2} over [a, b]."""
    width = b - a
    middle = HALF * (a + b)
    r = vec4(middle, ZERO, middle, ZERO)
    if width < _NARROW:
        step = width * real(0.28867513459481287)
        left = HALF * width * wp.exp(-(middle - step) * (middle - step))
        right = HALF * width * wp.exp(-(middle + step) * (middle + step))
        r = vec4(middle - step, left, middle + step, right)
        if n == 1:
            r = vec4(middle + step * (right - left) / wp.max(left + right, _TINY), left + right, middle, ZERO)
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
            r = two_nodes(mass, first, second, third, a, b, n)
    return r


@wp.struct
class Pieces:
    """What corners cut a light into: ``count`` pieces between the values ``at`` of x, 1 in ``turns`` where the outline
    turns; ``far``: |x| beyond which there is nothing to speak of."""

    count: int
    at: ends_vector
    turns: ends_vector
    far: real


@wp.func
def pieces_of(m: Marks, sharp: real, along: real) -> Pieces:
    """The pieces; more than MARKS + 1 where corners are too many. A turn beyond ``far`` is none."""
    r = Pieces()
    x0 = sharp * (m.low + along)
    x1 = sharp * (m.high + along)
    nearest = wp.max(wp.max(x0, -x1), ZERO)
    r.far = wp.sqrt(_SEEN + nearest * nearest)
    r.at[0] = x0
    r.turns[0] = wp.where(x0 > -r.far - ONE, real(m.turn_low), ZERO)
    r.count = 1
    for i in range(MARKS):
        if i < m.count:
            x = sharp * (m.at[i] + along)
            if wp.abs(x) < r.far and x > x0 + MERGED and x < x1 - MERGED:
                if x > r.at[r.count - 1] + MERGED:
                    r.at[r.count] = x
                    r.turns[r.count] = m.turns[i]
                    r.count += 1
                elif m.turns[i] > ZERO:
                    r.at[r.count - 1] = x
                    r.turns[r.count - 1] = ONE
    r.at[r.count] = x1
    r.turns[r.count] = wp.where(x1 < r.far + ONE, real(m.turn_high), ZERO)
    if m.count > MARKS:
        # too many: even parts
        first = wp.max(x0, -wp.sqrt(real(10.0) + nearest * nearest))
        last = wp.min(x1, wp.sqrt(real(10.0) + nearest * nearest))
        for i in range(MARKS + 2):
            r.at[i] = first + (last - first) * real(i) / real(MARKS + 1)
        r.count = MARKS + 1
    return r


def make_few(view: Any, marks_of: Callable[..., Any], cut: Callable[..., Any], short: Callable[..., Any]) -> Any:
    """The device function ``few(light, lobe, tables, rules, slices)`` of a kind of light: its struct, its ``Marks``
    (corners between two values of u), what a slice cuts out of it, and a short cut, negative where there is none. It is
    the integral over u of the Gaussian and the lobe."""

    @wp.func
    def at(light: view, lobe: Lobe, tables: LobeTables, rules: Rules, u: real) -> real:
        return slice_value(cut(light, lobe, tables, rules, u), lobe)

    @wp.func
    def pieces(
        light: view, lobe: Lobe, tables: LobeTables, rules: Rules, m: Marks, cuts: Pieces, sharp: real, slices: int
    ) -> real:
        """One or two nodes in each of at most two pieces."""
        total = real(0.0)
        if slices < cuts.count:
            cuts.at[1] = cuts.at[2]
            cuts.turns[1] = cuts.turns[2]
            cuts.count = 1
        n = wp.where(slices >= 2 * cuts.count, 2, 1)
        for i in range(cuts.count):
            a = cuts.at[i]
            b = cuts.at[i + 1]
            from_a = cuts.turns[i] > ZERO
            from_b = cuts.turns[i + 1] > ZERO
            node = vec4(ZERO, ZERO, ZERO, ZERO)
            if from_a or from_b:
                side = wp.where(from_a and (not from_b or wp.abs(a) < wp.abs(b)), 0, 1)
                node = turning_nodes(rules, a, b, side, n)
            else:
                node = piece_nodes(a, b, n)
            for j in range(n):
                u = wp.clamp(node[2 * j] / sharp - lobe.omega_o[0], m.low, m.high)
                total += node[2 * j + 1] * at(light, lobe, tables, rules, u)
        return total

    @wp.func
    def profiled(
        light: view, lobe: Lobe, tables: LobeTables, rules: Rules, m: Marks, cuts: Pieces, sharp: real, slices: int
    ) -> real:
        """One or two Gauss rules of two nodes of e^{-x^2} times the lit length of the slice, by moments of many slices'
        lengths: exact where the mean of the lobe over what is lit is a cubic."""
        bare = lobe
        bare.kind = LENGTH
        mass = ends_vector()
        first = ends_vector()
        second = ends_vector()
        third = ends_vector()
        # e^{-10} of the greatest is nothing
        near = wp.max(wp.max(cuts.at[0], -cuts.at[cuts.count]), ZERO)
        far = wp.sqrt(real(10.0) + near * near)
        parts = int(cuts.count)
        if parts == 1:
            parts = 2
            cuts.at[2] = cuts.at[1]
            cuts.at[1] = HALF * (wp.max(cuts.at[0], -far) + wp.min(cuts.at[2], far))
        whole = real(0.0)
        for i in range(parts):
            a = wp.max(cuts.at[i], -far)
            b = wp.min(cuts.at[i + 1], far)
            if a < b:
                nodes = wp.where(b - a < _BROAD, _LENGTHS, 2 * _LENGTHS)
                for j in range(nodes):
                    turn = PI * rule_node(rules, nodes, j)
                    x = HALF * (a + b) - HALF * (b - a) * wp.cos(turn)
                    u = wp.clamp(x / sharp - lobe.omega_o[0], m.low, m.high)
                    weight = rule_weight(rules, nodes, j) * (b - a) * wp.sin(turn) * wp.exp(near * near - x * x)
                    weight *= wp.abs(cut(light, bare, tables, rules, u).length)
                    mass[i] += weight
                    first[i] += weight * x
                    second[i] += weight * x * x
                    third[i] += weight * x * x * x
                whole += mass[i]
        total = real(0.0)
        done = real(0.0)
        group = vec4(ZERO, ZERO, ZERO, ZERO)
        begin = int(0)
        for i in range(parts):
            group += vec4(mass[i], first[i], second[i], third[i])
            done += mass[i]
            last = i == parts - 1
            # two groups of about the same mass
            half = slices >= 4 and begin == 0 and not last and done + HALF * mass[i + 1] > HALF * whole
            if (half or last) and group[0] > _TINY:
                mean = group / group[0]
                node = two_nodes(group[0], mean[1], mean[2], mean[3], cuts.at[begin], cuts.at[i + 1], slices)
                for j in range(wp.min(slices, 2)):
                    u = wp.clamp(node[2 * j] / sharp - lobe.omega_o[0], m.low, m.high)
                    length = wp.abs(cut(light, bare, tables, rules, u).length)
                    total += node[2 * j + 1] * at(light, lobe, tables, rules, u) / wp.max(length, _TINY)
                group = vec4(ZERO, ZERO, ZERO, ZERO)
                begin = i + 1
        return total * HALF * PI * wp.exp(-near * near)

    @wp.func
    def few(light: view, lobe: Lobe, tables: LobeTables, rules: Rules, slices: int) -> real:
        """Integral over u of e^{-(sigma k xi_1)^2} times the integral across, by at most ``slices`` slices (4)."""
        sharp = real(6.283185307179586) * lobe.scratch.sigma / lobe.wavelength
        total = short(light, lobe, tables, rules, sharp, slices)
        if total >= ZERO:
            return total
        total = real(0.0)
        m = marks_of(light, lobe.scratch, -lobe.omega_o[0] - _KEPT / sharp, -lobe.omega_o[0] + _KEPT / sharp)
        if m.low < m.high:
            x0 = sharp * (m.low + lobe.omega_o[0])
            x1 = sharp * (m.high + lobe.omega_o[0])
            if wp.max(x0, -x1) < real(26.0):
                cuts = pieces_of(m, sharp, lobe.omega_o[0])
                whole = cuts.count == 1 and wp.min(-x0, x1) >= WIDE
                if cuts.count > 2 or (m.profiled == 1 and not whole):
                    total = profiled(light, lobe, tables, rules, m, cuts, sharp, slices)
                else:
                    total = pieces(light, lobe, tables, rules, m, cuts, sharp, slices)
        return total / sharp

    return few
