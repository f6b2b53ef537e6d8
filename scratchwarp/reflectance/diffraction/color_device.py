"""The colour of a single scratch under a distant white light, all wavelengths at once, on the device.

With G(o) = integral of cmf(lambda) cos(2 pi o / lambda), |S|^2 / (A_C lambda^2) = 2 (W / lambda)^2 sinc^2 |D|^2 becomes
[2 / (pi^2 xi_2^2)] [G(0) - G(a) - G(b) + G(a + b) / 2 + G(a - b) / 2], a = W xi_2, b = 2 D [um]: a look-up table in one
dimension, exact but for its interpolation. For small a, where the bracket cancels, it is the integral over t in [0, a]
of (a - t) [F(b + t) / 2 + F(b - t) / 2 - F(t)] with F = G'', a table too.
"""

import warp as wp

from .quadrature_device import Rules, rule_node, rule_weight
from .real_device import HALF, ONE, PI, TWO, ZERO, real, vec3

_NEAR = wp.constant(real(0.1))  # um
_NODES = wp.constant(8)


@wp.struct
class FringeTable:
    """G and F = G'' for offsets 0, ``step``, 2 ``step``, ... [um], each with its slope: rows (G, G', F, F') of linear
    Rec.709. Beyond the end the fringes have washed out and G is 0."""

    step: real
    rows: wp.array2d(dtype=vec3)


@wp.func
def fringe(table: FringeTable, offset: real, column: int) -> vec3:
    """G (column 0) or F (column 2) at an offset [um], cubic Hermite; even."""
    at = wp.abs(offset) / table.step
    r = vec3(ZERO, ZERO, ZERO)
    if at < real(table.rows.shape[0] - 1):
        cell = int(at)
        t = at - real(cell)
        a = table.rows[cell, column]
        b = table.rows[cell + 1, column]
        slope_a = table.rows[cell, column + 1] * table.step
        slope_b = table.rows[cell + 1, column + 1] * table.step
        rise = b - a
        r = a + t * rise + (t * (ONE - t)) * ((ONE - t) * (slope_a - rise) - t * (slope_b - rise))
    return r


@wp.func
def scratch_color(table: FringeTable, rules: Rules, width: real, depth: real, xi2: real) -> vec3:
    """Linear Rec.709 of the BRDF [1/sr] at xi_1 = 0, s_b = 0."""
    a = width * wp.abs(xi2)
    b = TWO * depth
    total = vec3(ZERO, ZERO, ZERO)
    factor = TWO / (PI * PI)
    if a > _NEAR:
        total = fringe(table, ZERO, 0) - fringe(table, a, 0) - fringe(table, b, 0)
        total += HALF * (fringe(table, a + b, 0) + fringe(table, a - b, 0))
        factor /= xi2 * xi2
    else:
        # over a^2, so that nothing is left to divide by where xi_2 is 0
        for i in range(_NODES):
            x = rule_node(rules, _NODES, i)
            t = a * x
            f = HALF * (fringe(table, b + t, 2) + fringe(table, b - t, 2)) - fringe(table, t, 2)
            total += (rule_weight(rules, _NODES, i) * (ONE - x)) * f
        factor *= width * width
    return factor * total
