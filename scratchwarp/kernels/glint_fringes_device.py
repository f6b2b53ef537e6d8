"""Colours of scratches under lights without extent, all wavelengths at once, off the line xi_1 = 0 too.

``color_device`` has them on the line: sums of G(o) = integral of cmf(lambda) cos(2 pi o / lambda) over five offsets o.
Beside it the Gaussian along the scratch falls as e^{-g k^2}, g = sigma^2 xi_1^2, which is a second dimension of the
table. Where a footprint spreads xi_1, sqrt(s^2 / S^2) e^{-xi_1^2 / 2 S^2} is brought into that form by its values at
two wavelengths; without a spread that is exact.
"""

import warp as wp

from ..reflectance.diffraction.response_device import along_variance
from .glint_fringes import CHANNELS, FALL_STEP, FALLS, STEP

_CHANNELS = wp.constant(wp.vec3(*CHANNELS))
_FALL_STEP = wp.constant(FALL_STEP)
_LAST_FALL = wp.constant(FALLS - 1)
_STEP = wp.constant(STEP)
_SHORT = wp.constant(0.46)  # um, the two wavelengths
_LONG = wp.constant(0.62)
_NEAR = wp.constant(0.1)  # um
_TWO_PI = wp.constant(6.283185307179586)
_vec4f = wp.types.vector(length=4, dtype=float)
# Gauss-Legendre over [0, 1].
_NODES = wp.constant(_vec4f(0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558))
_WEIGHTS = wp.constant(_vec4f(0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226))


@wp.func
def fringe_at(table: wp.array3d(dtype=wp.vec3), row: int, offset: float, column: int) -> wp.vec3:
    """G (column 0) or G'' (column 2) of one fall at an offset [um], cubic Hermite; even; 0 beyond the end."""
    at = wp.abs(offset) / _STEP
    r = wp.vec3(0.0, 0.0, 0.0)
    if at < float(table.shape[1] - 1):
        cell = int(at)
        t = at - float(cell)
        a = table[row, cell, column]
        b = table[row, cell + 1, column]
        rise = b - a
        bend = (1.0 - t) * (_STEP * table[row, cell, column + 1] - rise)
        bend -= t * (_STEP * table[row, cell + 1, column + 1] - rise)
        r = a + t * rise + t * (1.0 - t) * bend
    return r


@wp.func
def fringes_of(table: wp.array3d(dtype=wp.vec3), row: int, width: float, depth: float, xi2: float) -> wp.vec3:
    """2 (W / lambda)^2 sinc^2 |D|^2 over all wavelengths, as ``color_device.scratch_color``, of one fall."""
    a = width * wp.abs(xi2)
    b = 2.0 * depth
    total = wp.vec3(0.0, 0.0, 0.0)
    factor = 2.0 / (wp.pi * wp.pi)
    if a > _NEAR:
        total = fringe_at(table, row, 0.0, 0) - fringe_at(table, row, a, 0) - fringe_at(table, row, b, 0)
        total += 0.5 * (fringe_at(table, row, a + b, 0) + fringe_at(table, row, a - b, 0))
        factor /= xi2 * xi2
    else:
        for i in range(4):
            t = a * _NODES[i]
            f = 0.5 * (fringe_at(table, row, b + t, 2) + fringe_at(table, row, b - t, 2)) - fringe_at(table, row, t, 2)
            total += (_WEIGHTS[i] * (1.0 - _NODES[i])) * f
        factor *= width * width
    return factor * total


@wp.func
def scratch_fringes(
    table: wp.array3d(dtype=wp.vec3), sigma: float, xi1: float, spread: float, width: float, depth: float, xi2: float
) -> wp.vec3:
    """The same times sqrt(s^2 / S^2) e^{-xi_1^2 / (2 S^2)}, see ``response_device``; lengths in micrometres."""
    r = wp.vec3(0.0, 0.0, 0.0)
    own = along_variance(sigma, _SHORT)
    e_short = 0.5 * xi1 * xi1 / (own + spread) - 0.5 * wp.log(own / (own + spread))
    own = along_variance(sigma, _LONG)
    e_long = 0.5 * xi1 * xi1 / (own + spread) - 0.5 * wp.log(own / (own + spread))
    k_short = _TWO_PI / _SHORT
    k_long = _TWO_PI / _LONG
    fall = wp.max((e_short - e_long) / (k_short * k_short - k_long * k_long), 0.0)
    rest = e_long - fall * k_long * k_long
    if e_long < 20.0:
        at = wp.min(fall / _FALL_STEP, float(_LAST_FALL))
        row = wp.min(int(at), _LAST_FALL - 1)
        t = at - float(row)
        r = (1.0 - t) * fringes_of(table, row, width, depth, xi2)
        if t > 1.0e-3:
            r += t * fringes_of(table, row + 1, width, depth, xi2)
        for channel in range(3):
            k = _TWO_PI / _CHANNELS[channel]
            r[channel] *= wp.exp(-rest - fall * k * k)
    return r
