"""The colour of a single scratch under a wide white light, all wavelengths at once, on the device.

T(X, D) = integral of cmf(lambda) (1 - cos(4 pi D / lambda)) M(2 pi X / lambda) over wavelengths, odd in X = W q: the
integral over xi_2 of every wavelength's sinc^2 and |D|^2, a look-up table in two dimensions. Interpolated by cubics
(Catmull-Rom). Beyond the table in X the fringes have washed out, and T goes to its limit like 1 / X.
"""

import warp as wp

from .real_device import HALF, ONE, TWO, ZERO, real, vec3


@wp.struct
class WideTable:
    """Rows of even depths from 0, columns of even X from 0 [um], linear Rec.709; ``limit``: of X without end."""

    depth_step: real
    reach_step: real
    values: wp.array2d(dtype=vec3)
    limit: wp.array(dtype=vec3)


@wp.func
def _cubic(a: vec3, b: vec3, c: vec3, d: vec3, t: real) -> vec3:
    """Catmull-Rom between b and c."""
    rise = c - b
    from_b = HALF * (c - a)
    from_c = HALF * (d - b)
    return b + t * rise + (t * (ONE - t)) * ((ONE - t) * (from_b - rise) - t * (from_c - rise))


@wp.func
def _limit(table: WideTable, row: int) -> vec3:
    return table.limit[wp.clamp(wp.abs(row), 0, table.limit.shape[0] - 1)]


@wp.func
def _value(table: WideTable, row: int, column: int) -> vec3:
    """Even in the depth, odd in X."""
    i = wp.clamp(wp.abs(row), 0, table.values.shape[0] - 1)
    value = table.values[i, wp.min(wp.abs(column), table.values.shape[1] - 1)]
    if column < 0:
        value = -value
    return value


@wp.func
def _along(table: WideTable, row: int, column: int, t: real) -> vec3:
    return _cubic(
        _value(table, row, column - 1),
        _value(table, row, column),
        _value(table, row, column + 1),
        _value(table, row, column + 2),
        t,
    )


@wp.func
def wide_integral(table: WideTable, reach: real, depth: real) -> vec3:
    """T at X = ``reach`` and D = ``depth`` [um]; depths beyond the table as its last."""
    down = wp.min(depth / table.depth_step, real(table.values.shape[0] - 1))
    row = wp.min(int(down), table.values.shape[0] - 2)
    y = down - real(row)
    last = table.values.shape[1] - 2
    at = wp.abs(reach) / table.reach_step
    total = vec3(ZERO, ZERO, ZERO)
    if at < real(last):
        column = int(at)
        x = at - real(column)
        total = _cubic(
            _along(table, row - 1, column, x),
            _along(table, row, column, x),
            _along(table, row + 1, column, x),
            _along(table, row + 2, column, x),
            y,
        )
    else:
        limit = _cubic(_limit(table, row - 1), _limit(table, row), _limit(table, row + 1), _limit(table, row + 2), y)
        edge = _cubic(
            _value(table, row - 1, last),
            _value(table, row, last),
            _value(table, row + 1, last),
            _value(table, row + 2, last),
            y,
        )
        total = limit - (real(last) / at) * (limit - edge)
    if reach < ZERO:
        total = -total
    return total


@wp.func
def wide_color(table: WideTable, width: real, depth: real, q0: real, q1: real) -> vec3:
    """Linear Rec.709 of the integral of |D|^2 sinc^2 over xi_2, times k W."""
    return TWO * (wide_integral(table, width * q1, depth) - wide_integral(table, width * q0, depth))
