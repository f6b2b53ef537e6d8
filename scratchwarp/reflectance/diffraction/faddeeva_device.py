"""The Faddeeva function on the device, for the ends of finite scratches."""

import warp as wp

from .complex_device import complex_product, complex_quotient, phasor
from .faddeeva_tables import SCALE, SERIES, TERMS
from .real_device import ONE, PI, TWO, ZERO, real, vec2

_SERIES = wp.constant(wp.types.vector(length=TERMS, dtype=real)(*SERIES))
_SCALE = wp.constant(real(SCALE))
_INV_SQRT_PI = wp.constant(real(0.5641895835477563))
_FAR = wp.constant(real(26.0))  # e^{-26^2} = 3e-294: nothing of the Gaussian is left


@wp.func
def faddeeva(z: vec2) -> vec2:
    """w(z) = e^{-z^2} erfc(-i z) for Im z >= 0, absolute error 1e-13 (Weideman 1994)."""
    minus = vec2(_SCALE + z[1], -z[0])  # L - i z
    unit = complex_quotient(vec2(_SCALE - z[1], z[0]), minus)
    p = vec2(ZERO, ZERO)
    for i in range(wp.static(TERMS)):
        p = complex_product(p, unit) + vec2(_SERIES[i], ZERO)
    return complex_quotient(complex_quotient(TWO * p, minus) + vec2(_INV_SQRT_PI, ZERO), minus)


@wp.func
def _tail(x: real, y: real) -> vec2:
    """e^{-x^2 - 2 i x y} w(-y + i x), x >= 0."""
    r = vec2(ZERO, ZERO)
    if x < _FAR:
        r = wp.exp(-x * x) * complex_product(phasor(-x * y / PI), faddeeva(vec2(-y, x)))
    return r


@wp.func
def damped_erf_between(x0: real, x1: real, y: real) -> vec2:
    """e^{-y^2} [erf(x1 + i y) - erf(x0 + i y)]; x0 and x1 may be infinite, and y as large as it likes.

    e^{-y^2} erf(x + i y) = e^{-y^2} - e^{-x^2 - 2 i x y} w(-y + i x) for x >= 0, where the naive product is 0 inf; erf
    is odd.
    """
    steps = ZERO
    r = vec2(ZERO, ZERO)
    if x1 >= ZERO:
        steps += ONE
        r -= _tail(x1, y)
    else:
        steps -= ONE
        t = _tail(-x1, y)
        r += vec2(t[0], -t[1])
    if x0 >= ZERO:
        steps -= ONE
        r += _tail(x0, y)
    else:
        steps += ONE
        t = _tail(-x0, y)
        r -= vec2(t[0], -t[1])
    return r + vec2(steps * wp.exp(-y * y), ZERO)
