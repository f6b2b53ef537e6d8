"""Radiance of one scratch under an area light of radiance 1, by slices of constant xi_1.

L = 2 e^{-s_b^2 / sigma^2} integral over xi_1 of e^{-(sigma k xi_1)^2} g(xi_1), g the integral over xi_2 in closed form.
The Gaussian is narrow, a few thousandths: Velinov et al. 2018 Eq. 27 takes g at xi_1 = 0, which fails where the light
is not much wider. Here nodes lie where the Gaussian's distribution function is Gauss-Legendre, between the corners of
the light.
"""

from collections.abc import Callable
from typing import Any

import warp as wp

from .complex_device import power
from .quadrature_device import Rules, rule_node, rule_weight
from .real_device import HALF, ONE, PI, TWO, ZERO, real, vec3
from .scratch_device import along_amplitude, along_share, is_finite, offset_weight
from .slice_device import Lobe, LobeTables, slice_value

SLICES = wp.constant(0)
"""Method: slices."""
CLOSED_FORM = wp.constant(1)
"""Method: the slice xi_1 = 0 alone, Eq. 27."""

_SQRT_PI = wp.constant(real(1.7724538509055159))
_WINDOW = wp.constant(real(9.0))  # e^{-81}: nothing comes from beyond
_TAIL = wp.constant(real(1.0))
_NARROW = wp.constant(real(0.25))
_LEAST_STEP = wp.constant(real(0.04))
_END_NODES = wp.constant(8)  # for each slice, where ends make the lobe wide and fringed


@wp.struct
class GaussNode:
    """A node x of an integral with e^{-x^2}, and its weight."""

    x: real
    weight: real


@wp.func
def gauss_node(x0: real, width: real, t: real) -> GaussNode:
    """The node at share ``t`` of the Gaussian between x0 and x0 + width; weights times those of a rule over [0, 1] add
    up to the integral of e^{-x^2}.

    Next to nothing of the Gaussian's distribution function is left in its tails, and of its difference in narrow
    intervals: there the nodes follow e^{-2 x x0} or lie even.
    """
    r = GaussNode()
    x1 = x0 + width
    if width < _NARROW:
        r.x = x0 + width * t
        r.weight = width * wp.exp(-r.x * r.x)
    elif x0 >= _TAIL or x1 <= -_TAIL:
        near = wp.min(wp.abs(x0), wp.abs(x1))
        share = ONE - wp.exp(-width * (TWO * near + width))
        from_near = wp.where(x0 > ZERO, t, ONE - t)
        x = wp.sqrt(near * near - wp.log(ONE - share * from_near))
        r.x = wp.where(x0 > ZERO, x, -x)
        r.weight = HALF * share * wp.exp(-near * near) / x
    else:
        v0 = wp.erf(x0)
        v1 = wp.erf(x1)
        r.x = wp.clamp(wp.erfinv(v0 + (v1 - v0) * t), x0, x1)
        r.weight = HALF * _SQRT_PI * (v1 - v0)
    return r


def make_radiance(view: Any, breaks: Callable[..., Any], cut: Callable[..., Any]) -> Any:
    """The device function ``radiance(light, lobe, tables, rules, method, slices)`` of a kind of light: its struct, where
    it begins, ends or has corners in u, and what a slice cuts out of it."""

    @wp.func
    def piece(
        light: view, lobe: Lobe, tables: LobeTables, rules: Rules, u0: real, u1: real, nodes: int, sharpness: real
    ) -> real:
        """Integral of e^{-x^2} g over x = sigma k xi_1 between two u."""
        total = real(0.0)
        x0 = sharpness * (u0 + lobe.omega_o[0])
        width = sharpness * (u1 - u0)
        for i in range(nodes):
            node = gauss_node(x0, width, rule_node(rules, nodes, i))
            u = wp.clamp(u0 + (node.x - x0) / sharpness, u0, u1)
            value = slice_value(cut(light, lobe, tables, rules, u), lobe)
            total += rule_weight(rules, nodes, i) * node.weight * value
        return total

    @wp.func
    def piece_with_ends(
        light: view, lobe: Lobe, tables: LobeTables, rules: Rules, u0: real, u1: real, nodes: int, scale: real
    ) -> real:
        """Integral of the finite scratch's |eta|^2 g over xi_1, with nodes even in atan(xi_1 / scale): the tails of a
        scratch that ends fall with xi_1^-2."""
        total = real(0.0)
        t0 = wp.atan((u0 + lobe.omega_o[0]) / scale)
        width = wp.atan((u1 + lobe.omega_o[0]) / scale) - t0
        for i in range(nodes):
            slope = wp.tan(t0 + width * rule_node(rules, nodes, i))
            xi1 = scale * slope
            along = power(along_amplitude(lobe.scratch, lobe.wavelength, xi1))
            u = wp.clamp(xi1 - lobe.omega_o[0], u0, u1)
            value = slice_value(cut(light, lobe, tables, rules, u), lobe)
            total += rule_weight(rules, nodes, i) * width * scale * (ONE + slope * slope) * along * value
        return total

    @wp.func
    def radiance(
        light: view, lobe: Lobe, tables: LobeTables, rules: Rules, method: int, slices: int
    ) -> real:
        """Radiance [1] towards omega_o; 0 from below the horizon."""
        r = real(0.0)
        s = lobe.scratch
        sharpness = TWO * PI * s.sigma / lobe.wavelength
        extent = breaks(light, s, -TWO)
        if lobe.omega_o[2] > ZERO and extent[0] < extent[1]:
            if method == CLOSED_FORM:
                u = -lobe.omega_o[0]
                if u > extent[0] and u < extent[1]:
                    value = slice_value(cut(light, lobe, tables, rules, u), lobe)
                    r = value * along_share(s) * _SQRT_PI / sharpness
            elif is_finite(s):
                length = wp.min(s.end, TWO * s.sigma) - wp.max(s.start, -TWO * s.sigma)
                scale = (ONE / s.sigma + ONE / wp.max(length, real(0.01) * s.sigma)) * lobe.wavelength / (TWO * PI)
                u = real(extent[0])
                while u < extent[1]:
                    following = breaks(light, s, u)
                    end = wp.min(following[2], extent[1])
                    r += piece_with_ends(light, lobe, tables, rules, u, end, _END_NODES * slices, scale)
                    u = end
            else:
                reach = _WINDOW / sharpness
                u = wp.max(extent[0], -lobe.omega_o[0] - reach)
                last = wp.min(extent[1], -lobe.omega_o[0] + reach)
                while u < last:
                    following = breaks(light, s, u + _LEAST_STEP / sharpness)
                    end = wp.min(following[2], last)
                    r += piece(light, lobe, tables, rules, u, end, slices, sharpness) / sharpness
                    u = end
        return TWO * offset_weight(s) * r

    return radiance
