"""Radiance of one scratch under an area light of radiance 1, by slices of constant xi_1.

L = 2 e^{-s_b^2 / sigma^2} integral over xi_1 of e^{-(sigma k xi_1)^2} g(xi_1), g the integral over xi_2 in closed form.
With x = sigma k xi_1 the Gaussian is e^{-x^2}. Velinov et al. 2018 Eq. 27 takes g at x = 0, which fails where the light
ends within a few x. Up to four slices are placed by ``few_device``. More are for reference: the range between two
corners of the light is walked from where the Gaussian is greatest, in steps over which it falls by e^{-4} or so, with
Gauss-Legendre nodes, fewer in each further step, and closer where the light begins or ends round.
"""

from collections.abc import Callable
from typing import Any

import warp as wp

from .complex_device import power
from .quadrature_device import Rules, rule_node, rule_weight
from .real_device import HALF, ONE, PI, TWO, ZERO, real
from .scratch_device import along_amplitude, along_share, is_finite, offset_weight
from .slice_device import Breaks, Lobe, LobeTables, slice_value

SLICES = wp.constant(0)
"""Method: slices."""
CLOSED_FORM = wp.constant(1)
"""Method: the slice xi_1 = 0 alone, Eq. 27."""

_SQRT_PI = wp.constant(real(1.7724538509055159))
_FEW = wp.constant(4)  # slices up to which ``few_device`` places them
_STEP = wp.constant(real(1.5))
_FALL = wp.constant(real(1.5))
_CLOSE = wp.constant(real(0.25))  # to the peak: too little for a step of its own
_SHORT = wp.constant(real(0.8))  # what one step takes with both of its ends round
_LAST = wp.constant(real(30.0))  # e^{-30}, of the greatest, is where it stops
_END_NODES = wp.constant(16)  # for each slice, where ends make the lobe wide and fringed


@wp.struct
class Range:
    """Part of a light between u0 and u1, x0 and x1; whether it ``begins`` round at the one and ``ends`` round at the
    other; ``nearest``: the least |x| of the whole light."""

    u0: real
    u1: real
    x0: real
    x1: real
    begins: int
    ends: int
    nearest: real
    sharpness: real
    slices: int


@wp.struct
class Node:
    """Where in [0, 1], and with which weight."""

    x: real
    weight: real


@wp.func
def edge_node(t: real, begins: int, ends: int) -> Node:
    """The node at ``t`` moved so that it takes out the square roots with which a round light begins and ends: t^2, t^2
    (3 - 2 t), ..."""
    r = Node()
    r.x = t
    r.weight = ONE
    if begins != 0 and ends != 0:
        r.x = t * t * (real(3.0) - TWO * t)
        r.weight = real(6.0) * t * (ONE - t)
    elif begins != 0:
        r.x = t * t
        r.weight = TWO * t
    elif ends != 0:
        r.x = t * (TWO - t)
        r.weight = TWO * (ONE - t)
    return r


@wp.func
def step_nodes(slices: int, step: int) -> int:
    """Nodes in the first, second, third, ... step away from the greatest value."""
    n = slices
    if step == 1:
        n = (3 * slices + 3) // 4
    elif step == 2:
        n = (slices + 1) // 2
    elif step > 2:
        n = (slices + 3) // 4
    return n


@wp.func
def at_edge(p: Range, x: real) -> int:
    """Whether the light begins or ends at x."""
    return wp.where((x == p.x0 and p.begins != 0) or (x == p.x1 and p.ends != 0), 1, 0)


def make_radiance(view: Any, breaks: Callable[..., Any], cut: Callable[..., Any], few: Callable[..., Any]) -> Any:
    """The device function ``radiance(light, lobe, tables, rules, method, slices)`` of a kind of light: its struct,
    where it begins, ends or has corners in u, what a slice cuts out of it, and its ``few``."""

    @wp.func
    def at(light: view, lobe: Lobe, tables: LobeTables, rules: Rules, p: Range, x: real) -> real:
        u = wp.clamp(p.u0 + (x - p.x0) / p.sharpness, p.u0, p.u1)
        return slice_value(cut(light, lobe, tables, rules, u), lobe)

    @wp.func
    def walk(light: view, lobe: Lobe, tables: LobeTables, rules: Rules, p: Range, start: real, stop: real) -> real:
        """Integral of e^{-x^2} g from ``start``, near 0 or nearest to it, to ``stop``."""
        total = real(0.0)
        side = wp.where(stop > start, ONE, -ONE)
        x = real(start)
        step = int(0)
        limit = _LAST + p.nearest * p.nearest
        while side * (stop - x) > ZERO and x * x < limit:
            width = _STEP
            if side * x * _STEP > _FALL:
                width = _FALL / (side * x)
            # what is left is not worth a step of its own
            if side * (stop - x) < real(1.3) * width:
                width = side * (stop - x)
                if at_edge(p, x) != 0 and at_edge(p, stop) != 0 and width > _SHORT:
                    width = HALF * width
            following = wp.where(side * (stop - x) > width, x + side * width, stop)
            first = at_edge(p, x)
            last = at_edge(p, following)
            n = step_nodes(p.slices, step)
            for i in range(n):
                node = edge_node(rule_node(rules, n, i), first, last)
                y = x + side * width * node.x
                weight = rule_weight(rules, n, i) * node.weight * width * wp.exp(-y * y)
                total += weight * at(light, lobe, tables, rules, p, y)
            x = following
            step += 1
        return total

    @wp.func
    def ranged(light: view, lobe: Lobe, tables: LobeTables, rules: Rules, p: Range) -> real:
        """Integral of e^{-x^2} g over the range."""
        total = real(0.0)
        if p.x0 >= -_CLOSE or (p.x1 > ZERO and p.x1 - p.x0 < _STEP):
            total = walk(light, lobe, tables, rules, p, p.x0, p.x1)
        elif p.x1 <= _CLOSE:
            total = walk(light, lobe, tables, rules, p, p.x1, p.x0)
        else:
            total = walk(light, lobe, tables, rules, p, ZERO, p.x1)
            total += walk(light, lobe, tables, rules, p, ZERO, p.x0)
        return total

    @wp.func
    def ranged_with_ends(
        light: view, lobe: Lobe, tables: LobeTables, rules: Rules, p: Range, nodes: int, scale: real
    ) -> real:
        """Integral of the finite scratch's |eta|^2 g over x, with nodes even in atan(x / scale): the tails of a scratch
        that ends fall with x^-2."""
        total = real(0.0)
        t0 = wp.atan(p.x0 / scale)
        width = wp.atan(p.x1 / scale) - t0
        for i in range(nodes):
            slope = wp.tan(t0 + width * rule_node(rules, nodes, i))
            x = scale * slope
            along = power(along_amplitude(lobe.scratch, lobe.wavelength, x / p.sharpness))
            weight = rule_weight(rules, nodes, i) * width * scale * (ONE + slope * slope)
            total += weight * along * at(light, lobe, tables, rules, p, x)
        return total

    @wp.func
    def sliced(light: view, lobe: Lobe, tables: LobeTables, rules: Rules, extent: Breaks, slices: int) -> real:
        """Integral of the Gaussian, or of |eta|^2, and g over x from corner to corner."""
        total = real(0.0)
        s = lobe.scratch
        p = Range()
        p.sharpness = TWO * PI * s.sigma / lobe.wavelength
        p.slices = slices
        low = extent.low
        high = extent.high
        x0 = p.sharpness * (low + lobe.omega_o[0])
        x1 = p.sharpness * (high + lobe.omega_o[0])
        p.nearest = wp.max(wp.max(x0, -x1), ZERO)
        finite = is_finite(s)
        length = wp.min(s.end, TWO * s.sigma) - wp.max(s.start, -TWO * s.sigma)
        scale = ONE + s.sigma / wp.max(length, real(0.01) * s.sigma)
        first = real(low)
        last = real(high)
        if not finite:
            reach = wp.sqrt(_LAST + p.nearest * p.nearest) / p.sharpness
            first = wp.max(low, -lobe.omega_o[0] - reach)
            last = wp.min(high, -lobe.omega_o[0] + reach)
        p.u0 = first
        p.begins = wp.where(first == low, extent.round_low, 0)
        while p.u0 < last:
            following = breaks(light, s, p.u0)
            p.u1 = wp.min(following.following, last)
            p.ends = wp.where(p.u1 == high, extent.round_high, 0)
            p.x0 = p.sharpness * (p.u0 + lobe.omega_o[0])
            p.x1 = p.x0 + p.sharpness * (p.u1 - p.u0)
            if finite:
                total += ranged_with_ends(light, lobe, tables, rules, p, _END_NODES * slices, scale)
            else:
                total += ranged(light, lobe, tables, rules, p)
            p.u0 = p.u1
            p.begins = 0
        return total / p.sharpness

    @wp.func
    def radiance(light: view, lobe: Lobe, tables: LobeTables, rules: Rules, method: int, slices: int) -> real:
        """Radiance [1] towards omega_o; 0 from below the horizon."""
        r = real(0.0)
        s = lobe.scratch
        if lobe.omega_o[2] > ZERO and method == SLICES and slices <= _FEW and not is_finite(s):
            r = few(light, lobe, tables, rules, slices)
        elif lobe.omega_o[2] > ZERO:
            extent = breaks(light, s, -TWO)
            if extent.low >= extent.high:
                r = ZERO
            elif method == SLICES:
                r = sliced(light, lobe, tables, rules, extent, slices)
            else:
                u = -lobe.omega_o[0]
                if u > extent.low and u < extent.high:
                    value = slice_value(cut(light, lobe, tables, rules, u), lobe)
                    r = value * along_share(s) * _SQRT_PI * lobe.wavelength / (TWO * PI * s.sigma)
        return TWO * offset_weight(s) * r

    return radiance
