"""A scratch under light from all around, on the device: the half circle xi_1 = 0 in parts of even cosine across the
scratch, over each the light of its middle times the integral across in closed form.

The Gaussian along the scratch is a thousandth wide, and a dome does not change over it.
"""

import warp as wp

from .quadrature_device import Rules
from .real_device import HALF, ONE, PI, TWO, ZERO, real, vec3
from .scratch_device import along_share, offset_weight
from .slice_device import Lobe, LobeTables, SliceSum, add_crossing, slice_value

PARTS = wp.constant(256)

_SQRT_PI = wp.constant(real(1.7724538509055159))


@wp.func
def dome_value(values: wp.array2d(dtype=real), w: vec3) -> real:
    """The cell of ``DomeLight.values`` in a direction of the shading frame."""
    rows = values.shape[0]
    columns = values.shape[1]
    row = int(wp.floor(wp.acos(wp.clamp(w[2], -ONE, ONE)) / PI * real(rows)))
    turn = wp.atan2(w[1], w[0]) / (TWO * PI)
    column = int(wp.floor((turn - wp.floor(turn)) * real(columns)))
    return values[wp.min(row, rows - 1), wp.min(column, columns - 1)]


@wp.func
def dome_radiance(values: wp.array2d(dtype=real), lobe: Lobe, tables: LobeTables, rules: Rules) -> real:
    """Radiance towards omega_o; 0 from below the horizon."""
    s = lobe.scratch
    total = real(0.0)
    if lobe.omega_o[2] > ZERO:
        u = -lobe.omega_o[0]
        reach = wp.sqrt(wp.max((ONE - u) * (ONE + u), ZERO))
        for i in range(PARTS):
            low = TWO * real(i) / real(PARTS) - ONE
            high = TWO * real(i + 1) / real(PARTS) - ONE
            middle = HALF * (low + high)
            across = reach * middle
            up = reach * wp.sqrt((ONE - middle) * (ONE + middle))
            w = vec3(u * s.cosine - across * s.sine, u * s.sine + across * s.cosine, up)
            light = dome_value(values, w)
            if light > ZERO:
                part = SliceSum()
                bottom = reach * wp.sqrt(wp.max((ONE - low) * (ONE + low), ZERO))
                top = reach * wp.sqrt(wp.max((ONE - high) * (ONE + high), ZERO))
                part = add_crossing(part, lobe, tables, rules, u, reach * low, bottom, -1)
                part = add_crossing(part, lobe, tables, rules, u, reach * high, top, 1)
                total += light * slice_value(part, lobe)
        total *= along_share(s) * _SQRT_PI * lobe.wavelength / (TWO * PI * s.sigma)
    return TWO * offset_weight(s) * total
