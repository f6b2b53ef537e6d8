"""What a scratch makes of the intervals that a light takes of its slices, for the renderer.

Everything is the lobe of ``scratch_device`` with the Gaussian along widened by what a footprint holds: over the part of
a scratch that a sample sees, xi_1 changes with the curvature of the surface and of the scratch and with both
directions, so e^{-(sigma k xi_1)^2} becomes (s / S) e^{-xi_1^2 / (2 S^2)}, s^2 = 1 / (2 sigma^2 k^2), S^2 = s^2 +
spread. Its integral stays.
"""

import warp as wp

from .lobe_device import lobe_integral, lobe_integral_paper
from .real_device import HALF, PI, real

_TWO_PI = wp.constant(6.283185307179586)
_SMALL = wp.constant(1.0e-3)


@wp.func
def sinc2(t: float) -> float:
    """(sin(pi t) / (pi t))^2."""
    r = 1.0 - (wp.pi * wp.pi / 3.0) * t * t
    if wp.abs(t) > _SMALL:
        x = wp.sin(wp.pi * (t - wp.rint(t))) / (wp.pi * t)
        r = x * x
    return r


@wp.func
def across_integral(ratio: float, low: float, high: float) -> float:
    """Integral of sinc^2(ratio xi_2) over [low, high]; ``ratio`` = width / wavelength."""
    r = float(0.0)
    extent = high - low
    if extent > 0.0:
        if ratio * extent < 0.25:
            # two nodes: error 1e-5 of the peak
            middle = 0.5 * (low + high)
            d = 0.28867513 * extent
            r = 0.5 * extent * (sinc2(ratio * (middle - d)) + sinc2(ratio * (middle + d)))
        else:
            a = lobe_integral(real(ratio) * real(low))
            b = lobe_integral(real(ratio) * real(high))
            value = real(b.half - a.half) * HALF * PI + (b.rest - a.rest)
            r = wp.max(float(value / PI), 0.0) / wp.max(ratio, 1.0e-12)
    return r


@wp.func
def across_integral_paper(ratio: float, low: float, high: float) -> float:
    """The same with Si of Velinov et al. 2018 Eq. 29; negative at times."""
    r = float(0.0)
    if high > low:
        value = lobe_integral_paper(real(ratio) * real(high)) - lobe_integral_paper(real(ratio) * real(low))
        r = float(value / PI) / wp.max(ratio, 1.0e-12)
    return r


@wp.func
def depth_response(depth: float, wavelength: float, g: float, depth_spread: float, roughness: float) -> float:
    """Mean |D|^2, as ``scratch_device.depth_power``; lengths in micrometres."""
    cycles = g * depth / wavelength
    sine = wp.sin(wp.pi * (cycles - wp.rint(cycles)))
    r = 4.0 * sine * sine
    if depth_spread > 0.0 or roughness > 0.0:
        wave = _TWO_PI * g / wavelength
        rough = wp.exp(-0.5 * wave * wave * roughness * roughness)
        spread = wp.exp(-0.5 * wave * wave * depth_spread * depth_spread)
        r = (1.0 - rough) * (1.0 - rough) + 2.0 * rough * (1.0 - spread) + rough * spread * r
    return r


@wp.func
def along_variance(sigma: float, wavelength: float) -> float:
    """s^2 = lambda^2 / (8 pi^2 sigma^2): the variance in xi_1 of the Gaussian along a scratch."""
    x = wavelength / sigma
    return x * x / (2.0 * _TWO_PI * _TWO_PI)
