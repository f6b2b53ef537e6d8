"""How much light is left for the surface between scratches, on the device."""

import warp as wp

from .real_device import ONE, ZERO, real, vec2


@wp.func
def balanced_weights(visible: real, dense: int) -> vec2:
    """(weight of the base, factor of the scratches) from ``visible`` = sum over scratches of area share a_m times
    |D_m|^2.

    Scratches of |D|^2 redirect a |D|^2 of the light: their own part and the part that interferes with the base. So the
    base keeps 1 - visible. Where scratches crowd (``dense``) they stand in each other's place: the base keeps
    e^{-visible}, the scratches (1 - e^{-visible}) / visible of their sum. base + factor * visible <= 1 always.
    """
    r = vec2(wp.max(ONE - visible, ZERO), ONE / wp.max(visible, ONE))
    if dense != 0:
        base = wp.exp(-visible)
        factor = ONE - visible / real(2.0) + visible * visible / real(6.0)
        if visible > real(1.0e-5):
            factor = (ONE - base) / visible
        r = vec2(base, factor)
    return r
