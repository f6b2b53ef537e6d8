"""Integrals of a profile table along its mirror cone, from running sums of its rows: I(a, b) = int_a^b rho cos dphi.

A row is constant within a bin of phi, so a whole bin adds value times bin weight, and part of one value times the
difference of sin(phi). With theta a table is a parabola through three of its steps (see ``profile_table_device``), and
so are its sums: a few look-ups for any interval, however long. The fourth component is the luminance of the first
three; ``place`` inverts that, so that a direction drawn by it reflects with constant luminance over density.
"""

import warp as wp

from .profile_table_device import TableArrays, phi_bin, table_value

wp.set_module_options({"enable_backward": False})

_HALF_PI = wp.constant(1.5707963267948966)


@wp.struct
class ConeRows:
    """What a view meets of a table: rows ``low`` and ``high`` with weights 1 - ``part`` and ``part``, and the parabola
    of ``count`` steps from ``first`` on with ``weights``."""

    table: int
    low: int
    high: int
    part: float
    sin_theta: float
    first: int
    count: int
    weights: wp.vec3


@wp.func
def cone_rows(tables: TableArrays, table: int, phi_o: float, sin_theta: float) -> ConeRows:
    """Rows of ``table`` about ``phi_o``, at the theta of the incident cone."""
    r = ConeRows()
    r.table = table
    r.sin_theta = sin_theta
    at = (phi_o + _HALF_PI) * float(tables.bins) / wp.pi - 0.5
    r.part = at - wp.floor(at)
    r.low = wp.clamp(int(wp.floor(at)), 0, tables.bins - 1)
    r.high = wp.clamp(int(wp.floor(at)) + 1, 0, tables.bins - 1)
    r.first = tables.first_sum[table]
    r.count = 1
    r.weights = wp.vec3(1.0, 0.0, 0.0)
    steps = tables.steps[table]
    if steps > 0:
        mu = wp.sqrt(wp.max(1.0 - sin_theta * sin_theta, 0.0))
        shift = tables.shift[table]
        at = mu * (1.0 + shift) / (mu + shift) * float(steps)
        middle = wp.clamp(int(at + 0.5), 1, steps - 1)
        d = at - float(middle)
        r.first = r.first + middle - 1
        r.count = 3
        r.weights = wp.vec3(0.5 * d * (d - 1.0), 1.0 - d * d, 0.5 * d * (d + 1.0))
    return r


@wp.func
def with_luminance(c: wp.vec3) -> wp.vec4:
    """Linear Rec.709 and its Y."""
    return wp.vec4(c[0], c[1], c[2], 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2])


@wp.func
def sum_before(tables: TableArrays, rows: ConeRows, row: int, column: int) -> wp.vec4:
    """Integral over the bins before ``column``."""
    total = rows.weights[0] * tables.sums[row, rows.first, column]
    if rows.count == 3:
        total += rows.weights[1] * tables.sums[row, rows.first + 1, column]
        total += rows.weights[2] * tables.sums[row, rows.first + 2, column]
    return total


@wp.func
def value_in(tables: TableArrays, rows: ConeRows, row: int, column: int) -> wp.vec4:
    """rho within a bin."""
    return with_luminance(table_value(tables, rows.table, row, column, rows.sin_theta))


@wp.func
def sine_step(a: float, b: float) -> float:
    """sin(b) - sin(a) without cancellation."""
    return 2.0 * wp.sin(0.5 * (b - a)) * wp.cos(0.5 * (a + b))


@wp.func
def cone_integral(tables: TableArrays, rows: ConeRows, row: int, a: float, b: float) -> wp.vec4:
    """int_a^b rho cos dphi of one row, a <= b within [-pi/2, pi/2]."""
    i = phi_bin(tables, a)
    j = phi_bin(tables, b)
    if i == j:
        return value_in(tables, rows, row, i) * sine_step(a, b)
    width = wp.pi / float(tables.bins)
    total = value_in(tables, rows, row, i) * sine_step(a, float(i + 1) * width - _HALF_PI)
    total += value_in(tables, rows, row, j) * sine_step(float(j) * width - _HALF_PI, b)
    if j > i + 1:
        total += sum_before(tables, rows, row, j) - sum_before(tables, rows, row, i + 1)
    return wp.vec4(wp.max(total[0], 0.0), wp.max(total[1], 0.0), wp.max(total[2], 0.0), wp.max(total[3], 0.0))


@wp.func
def place(tables: TableArrays, rows: ConeRows, row: int, a: float, b: float, wanted: float) -> float:
    """phi in [a, b] with luminance of ``cone_integral`` from ``a`` equal to ``wanted``."""
    width = wp.pi / float(tables.bins)
    low = phi_bin(tables, a)
    last = phi_bin(tables, b)
    left = wanted
    start = a
    if last > low:
        first = value_in(tables, rows, row, low)[3] * sine_step(a, float(low + 1) * width - _HALF_PI)
        if wanted > first:
            # the bin whose sums hold what is left
            left = wanted - first
            low = low + 1
            before = sum_before(tables, rows, row, low)[3]
            high = last + 1
            while high - low > 1:
                middle = (low + high) // 2
                if sum_before(tables, rows, row, middle)[3] - before <= left:
                    low = middle
                else:
                    high = middle
            left = left - (sum_before(tables, rows, row, low)[3] - before)
            start = float(low) * width - _HALF_PI
    end = wp.min(float(low + 1) * width - _HALF_PI, b)
    value = value_in(tables, rows, row, low)[3]
    whole = sine_step(start, end)
    part = wp.clamp(left / wp.max(value, 1.0e-20), 0.0, whole)
    phi = wp.asin(wp.clamp(wp.sin(start) + part, -1.0, 1.0))
    return wp.clamp(phi, start, end)
