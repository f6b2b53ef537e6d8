"""The Fourier transform of a piecewise-linear cross-section on the device."""

import warp as wp

from .complex_device import complex_product, phasor
from .lobe_device import sinc
from .real_device import real, vec2, vec4


@wp.func
def outline_transform(
    outlines: wp.array(dtype=vec4), first: int, count: int, width: real, depth: real, xi2: real, g: real
) -> vec2:
    """P / lambda, P(xi_2) = integral of (1 - e^{-i k g h(v)}) e^{-i k xi_2 v} dv; ``width`` and ``depth`` in
    wavelengths.

    A facet from v - d/2 to v + d/2 that rises by r around height h adds d e^{-i k xi_2 v} [sinc(k xi_2 d / 2) - e^{-i k
    g h} sinc(k (xi_2 d + g r) / 2)]; rows hold (v, h, d, r) in widths and depths, h below 0 in a groove. Walls (d = 0)
    add nothing.
    """
    total = vec2(real(0.0), real(0.0))
    for i in range(count):
        row = outlines[first + i]
        d = row[2] * width
        flat = sinc(xi2 * d)
        tilted = sinc(xi2 * d + g * row[3] * depth)
        bounced = tilted * phasor(-g * row[1] * depth)
        facet = d * vec2(flat - bounced[0], -bounced[1])
        total += complex_product(facet, phasor(-xi2 * row[0] * width))
    return total
