"""What a footprint holds of a stretch of scratch."""

import warp as wp

_SQRT_TWO_PI = wp.constant(2.5066282746)


@wp.struct
class Stretch:
    """A Gaussian between two ends: what it holds, its mean and variance there."""

    part: float
    mean: float
    variance: float


@wp.func
def tail(x: float) -> float:
    """What a Gaussian holds beyond ``x`` in [0, 8], over exp(-x^2 / 2): within 5e-7 of its value.

    A minimax fit in 1 / (1 + 0.35 x). The mean needs that exponential anyway; erf would bring a call and one more.
    """
    t = 1.0 / (1.0 + 0.35 * x)
    r = 0.0474985895
    r = r * t - 0.195792618
    r = r * t + 0.229097652
    r = r * t - 0.00568385144
    r = r * t + 0.149499859
    r = r * t + 0.135485991
    r = r * t + 0.139894502
    return r * t


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
        at_a = wp.exp(-0.5 * a * a)
        at_b = wp.exp(-0.5 * b * b)
        # From the tails, so that nothing cancels where both ends lie on one side.
        tail_a = tail(wp.abs(a)) * at_a
        tail_b = tail(wp.abs(b)) * at_b
        if a > 0.0:
            r.part = tail_a - tail_b
        elif b < 0.0:
            r.part = tail_b - tail_a
        else:
            r.part = 1.0 - tail_a - tail_b
        if r.part > 1.0e-6:
            scale = 1.0 / (_SQRT_TWO_PI * r.part)
            r.mean = (at_a - at_b) * scale
            r.variance = wp.clamp(1.0 + (a * at_a - b * at_b) * scale - r.mean * r.mean, 0.0, 1.0)
        else:
            r.part = 0.0
    return r
