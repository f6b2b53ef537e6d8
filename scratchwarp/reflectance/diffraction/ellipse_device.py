"""What a pixel's footprint on the surface, an ellipse, sees of one scratch: means over it, on the device.

Across the scratch the ellipse reaches h = hypot(a1 sin, a2 cos), ``angle`` from the scratch to axis a1; at a distance y
it is 2 a1 a2 sqrt(1 - y^2 / h^2) / h long. What is averaged is e^{-y^2 / w^2} around the scratch: w = sigma for
|eta_s|^2 (Velinov et al. 2018 Eq. 13), sqrt(2) sigma for the density of Eq. 17.
"""

import warp as wp

from .quadrature_device import Rules, rule_node, rule_weight
from .real_device import HALF, ONE, PI, TWO, ZERO, real

GAUSSIAN = wp.constant(0)
"""A Gaussian of the same second moments in place of the ellipse: closed form, antialiased along and across."""
PAPER = wp.constant(1)
"""Eq. 16 with its missing pi, Eq. 15 once A_P >= 2 A_C; Eq. 18 for the density."""
EXACT = wp.constant(2)
"""The ellipse itself."""

_REACH = wp.constant(real(6.5))  # of the Gaussian: e^{-42}
_PANELS = wp.constant(4)
_PANEL = wp.constant(real(0.25))  # share of a panel
_NODES = wp.constant(16)
_SQRT_PI = wp.constant(real(1.7724538509055159))


@wp.struct
class Ellipse:
    """Half-axes [um] and the half-width ``h`` across the scratch."""

    a1: real
    a2: real
    h: real


@wp.func
def make_ellipse(a1: real, a2: real, angle: real) -> Ellipse:
    """From half-axes and the angle between the scratch and a1."""
    r = Ellipse()
    r.a1 = a1
    r.a2 = a2
    x = a1 * wp.sin(angle)
    y = a2 * wp.cos(angle)
    r.h = wp.sqrt(x * x + y * y)
    return r


@wp.func
def chord(e: Ellipse, offset: real) -> real:
    """Length [um] of the line along the scratch at ``offset`` from the centre that lies in the ellipse."""
    y = wp.abs(offset)
    r = ZERO
    if e.h > ZERO:
        if y < e.h:
            # (h - y)(h + y) keeps the digits that 1 - y^2 / h^2 loses next to the edge
            r = TWO * (e.a1 / e.h) * (e.a2 / e.h) * wp.sqrt((e.h - y) * (e.h + y))
    elif y == ZERO:
        r = TWO * wp.max(e.a1, e.a2)
    return r


@wp.func
def _gaussian_mean(e: Ellipse, offset: real, w: real) -> real:
    """A Gaussian of variance h^2 / 4 across."""
    wide = w * w + HALF * e.h * e.h
    return w / wp.sqrt(wide) * wp.exp(-offset * offset / wide)


@wp.func
def _exact_mean(e: Ellipse, offset: real, w: real, rules: Rules) -> real:
    """y = h sin tau: (2 / pi) integral of cos^2 tau e^{-(y - offset)^2 / w^2}, where the Gaussian reaches."""
    total = real(0.0)
    y = wp.abs(offset)
    if e.h <= ZERO:
        total = wp.exp(-(y / w) * (y / w))
    else:
        lo = wp.max((y - _REACH * w) / e.h, -ONE)
        hi = wp.min((y + _REACH * w) / e.h, ONE)
        if lo < hi:
            t0 = wp.asin(lo)
            step = (wp.asin(hi) - t0) * _PANEL
            for i in range(_PANELS):
                for j in range(_NODES):
                    tau = t0 + step * (real(i) + rule_node(rules, _NODES, j))
                    d = (e.h * wp.sin(tau) - y) / w
                    c = wp.cos(tau)
                    total += rule_weight(rules, _NODES, j) * step * c * c * wp.exp(-d * d)
            total *= TWO / PI
    return total


@wp.func
def ellipse_footprint(e: Ellipse, offset: real, sigma: real, method: int, rules: Rules) -> real:
    """Mean of |eta_s|^2 = 2 A_C e^{-s_b^2 / sigma^2} [um^2] over the footprint."""
    coherence_area = PI * sigma * sigma
    mean = real(0.0)
    if method == GAUSSIAN:
        mean = _gaussian_mean(e, offset, sigma)
    elif method == EXACT:
        mean = _exact_mean(e, offset, sigma, rules)
    else:
        area = PI * e.a1 * e.a2
        alpha = wp.min(HALF * area / coherence_area, ONE)
        x = offset / sigma
        mean = (ONE - alpha) * wp.exp(-x * x)
        # alpha / A_P, which is 1 / (2 A_C) for the small ones
        mean += HALF / wp.max(coherence_area, HALF * area) * sigma * _SQRT_PI * chord(e, offset)
    return TWO * coherence_area * mean


@wp.func
def ellipse_coverage(e: Ellipse, offset: real, width: real, sigma: real, method: int, rules: Rules) -> real:
    """Scratch area density rho_P of Eq. 18, at most 1; its mean over offsets is twice the share of the area, as Eq. 17
    has it."""
    r = real(0.0)
    w = wp.sqrt(TWO) * sigma
    peak = width * wp.sqrt(TWO / PI) / sigma  # Eq. 17 at s_b = 0
    if method == GAUSSIAN:
        r = peak * _gaussian_mean(e, offset, w)
    elif method == EXACT:
        r = peak * _exact_mean(e, offset, w, rules)
    else:
        length = chord(e, offset)
        if length > ZERO and width > ZERO:
            area = PI * e.a1 * e.a2
            r = ONE
            if TWO * width * length < area:
                r = TWO * width * length / area
    return wp.min(r, ONE)
