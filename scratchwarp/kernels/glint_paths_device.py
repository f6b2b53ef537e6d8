"""Light that comes over other surfaces: where a path goes on that a scratch diffracts.

A direction is drawn from the lobe of one of the scratches under the footprint, by itself: along it from the Gaussian of
the longest wavelength, across it from a Lorentzian that is nowhere much below the lobe, cut to what lies above the
surface. What all wavelengths make of it is weighed by that density, so that many paths add up to the lobe. Lights are
not sought this way: they have been integrated. Interference and orders are left out here.
"""

import warp as wp

from ..optics.frames_device import to_local, to_world
from ..optics.hash_device import pcg_hash, unit_float
from ..reflectance.diffraction.response_device import along_variance
from .glint_arrays_device import GlintArrays, Strand
from .glint_sums_device import View, point_light
from .lobe_device import luminance

_SQRT_TWO_PI = wp.constant(2.5066282746)
_MIDDLE = wp.constant(0.55)  # um


@wp.struct
class Way:
    """A direction and what a path that goes on there carries, 0 where none does."""

    direction: wp.vec3
    weight: wp.vec3


@wp.func
def random_after(bits: wp.uint32) -> wp.uint32:
    """The next of a sequence of random bits."""
    return pcg_hash(bits + wp.uint32(747796405))


@wp.func
def diffracted_way(a: GlintArrays, strand: Strand, wo: wp.vec3, random: wp.uint32) -> Way:
    """Drawn from the lobe of one strand; the weight's mean is what it reflects of light from everywhere."""
    r = Way()
    layer = a.layers[strand.layer]
    wave = a.waves[layer.wave]
    bits = random_after(random)
    u0 = unit_float(bits)
    bits = random_after(bits)
    u1 = unit_float(bits)
    bits = random_after(bits)
    u2 = unit_float(bits)
    view = View()
    view.o = to_local(strand.frame, wo)
    deviation = wp.sqrt(along_variance(wave.sigma, wave.longest))
    t = wp.sqrt(-2.0 * wp.log(1.0 - u0)) * wp.cos(2.0 * wp.pi * u1)
    u = deviation * t - view.o[0]
    s2 = (1.0 - u) * (1.0 + u)
    if view.o[2] > 0.0 and s2 > 0.0:
        s = wp.sqrt(s2)
        half = _MIDDLE / (wp.pi * wp.max(strand.width, 0.01))
        if layer.facets > 0:
            # slopes throw the lobe aside
            half += strand.depth / wp.max(strand.width, 0.01)
        low = wp.atan((view.o[1] - s) / half)
        high = wp.atan((view.o[1] + s) / half)
        xi2 = half * wp.tan(low + u2 * (high - low))
        across = xi2 - view.o[1]
        c2 = s2 - across * across
        if c2 > 1.0e-6:
            i = wp.vec3(u, across, wp.sqrt(c2))
            density = wp.exp(-0.5 * t * t) / (_SQRT_TWO_PI * deviation)
            density *= half / ((half * half + xi2 * xi2) * (high - low))
            r.direction = to_world(strand.frame, i)
            r.weight = point_light(a, wave, layer, strand, view, i) / (density * i[2])
    return r


@wp.func
def way_taken(carried: wp.vec3, step: wp.vec3, alive: int, u: float) -> wp.vec2:
    """(1 where a path goes on as a scratch diffracts it and not as the base reflects, 1 / probability of that), by what
    each would carry; ``alive``: whether the base goes on at all."""
    y = luminance(carried)
    r = wp.vec2(0.0, 1.0)
    if y > 0.0:
        chance = float(1.0)
        if alive == 1 and luminance(step) > 0.0:
            chance = wp.clamp(y / (y + luminance(step)), 0.05, 0.95)
        if u < chance:
            r = wp.vec2(1.0, 1.0 / chance)
        else:
            r = wp.vec2(0.0, 1.0 / (1.0 - chance))
    return r
