"""The Gauss rule of two nodes of e^{-x^2} sqrt((x - x0) (x1 - x)), from the table of ``round_rules``."""

import warp as wp

from .real_device import ONE, ZERO, real, vec4
from .round_rules import COLUMNS, FIRST, LAST, ROWS

_ROWS = wp.constant(ROWS)
_COLUMNS = wp.constant(COLUMNS)
_FIRST = wp.constant(real(FIRST))
_ROW_STEP = wp.constant(real((LAST - FIRST) / (ROWS - 1)))


@wp.func
def round_nodes(table: wp.array2d(dtype=vec4), x0: real, length: real) -> vec4:
    """(y, weight, y, weight) of the rule over y = x - x0 in [0, length], x0 + length >= |x0|. The weights are those of
    a function divided by sqrt(y (length - y)), and e^{-max(x0, 0)^2} is left out of them."""
    long = wp.sqrt(ONE + x0 * x0)
    reach = wp.where(x0 > ZERO, ONE / (long + x0), long - x0)
    scale = length * reach / (length + reach)
    at_row = wp.clamp((ONE / (ONE + reach) - _FIRST) / _ROW_STEP, ZERO, real(_ROWS - 1))
    at_column = length / (length + reach) * real(_COLUMNS - 1)
    i = wp.min(int(at_row), _ROWS - 2)
    j = wp.min(int(at_column), _COLUMNS - 2)
    s = at_row - real(i)
    t = at_column - real(j)
    low = (ONE - t) * table[i, j] + t * table[i, j + 1]
    high = (ONE - t) * table[i + 1, j] + t * table[i + 1, j + 1]
    r = (ONE - s) * low + s * high
    norm = scale * wp.sqrt(scale * length)
    return vec4(r[0] * scale, r[1] * norm, r[2] * scale, r[3] * norm)


@wp.func
def fewer_nodes(pair: vec4, n: int) -> vec4:
    """One node where no more are wanted: the mean of both."""
    r = pair
    if n == 1:
        mass = pair[1] + pair[3]
        r = vec4((pair[0] * pair[1] + pair[2] * pair[3]) / wp.max(mass, real(1.0e-300)), mass, pair[2], ZERO)
    return r
