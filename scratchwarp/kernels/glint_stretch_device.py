"""What a footprint holds of a stretch of scratch."""

import warp as wp

_SQRT_HALF = wp.constant(0.70710678)
_SQRT_TWO_PI = wp.constant(2.5066282746)


@wp.struct
class Stretch:
    """A Gaussian between two ends: what it holds, its mean and variance there."""

    part: float
    mean: float
    variance: float


@wp.func
def between(low: float, high: float) -> Stretch:
    """A Gaussian of mean 0 and variance 1 cut to [low, high]."""
    r = Stretch()
    a = wp.clamp(low, -8.0, 8.0)
    b = wp.clamp(high, -8.0, 8.0)
    middle = 0.5 * (a + b)
    width = b - a
    if width < 0.2:
        # flat but for its slope
        r.part = width / _SQRT_TWO_PI * wp.exp(-0.5 * middle * middle)
        r.mean = middle * (1.0 - width * width / 12.0)
        r.variance = width * width / 12.0
    else:
        r.part = 0.5 * (wp.erf(b * _SQRT_HALF) - wp.erf(a * _SQRT_HALF))
        if r.part > 1.0e-6:
            at_a = wp.exp(-0.5 * a * a) / _SQRT_TWO_PI
            at_b = wp.exp(-0.5 * b * b) / _SQRT_TWO_PI
            r.mean = (at_a - at_b) / r.part
            r.variance = wp.clamp(1.0 + (a * at_a - b * at_b) / r.part - r.mean * r.mean, 0.0, 1.0)
        else:
            r.part = 0.0
    return r
