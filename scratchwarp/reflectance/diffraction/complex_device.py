"""Complex numbers on the device as pairs (real, imaginary)."""

import warp as wp

from .real_device import ONE, PI, TWO, real, vec2


@wp.func
def complex_product(a: vec2, b: vec2) -> vec2:
    """a b."""
    return vec2(a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0])


@wp.func
def complex_quotient(a: vec2, b: vec2) -> vec2:
    """a / b, b not 0."""
    r = ONE / (b[0] * b[0] + b[1] * b[1])
    return vec2((a[0] * b[0] + a[1] * b[1]) * r, (a[1] * b[0] - a[0] * b[1]) * r)


@wp.func
def conjugate(a: vec2) -> vec2:
    """The complex conjugate."""
    return vec2(a[0], -a[1])


@wp.func
def power(a: vec2) -> real:
    """|a|^2."""
    return a[0] * a[0] + a[1] * a[1]


@wp.func
def phasor(cycles: real) -> vec2:
    """e^{2 pi i cycles}; whole cycles are dropped first, so that a large phase keeps the digits it came with."""
    angle = TWO * PI * (cycles - wp.rint(cycles))
    return vec2(wp.cos(angle), wp.sin(angle))
