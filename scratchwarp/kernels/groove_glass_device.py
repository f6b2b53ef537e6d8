"""Facets of glass: how much goes through, and which way.

A facet reflects F, lets through ``clear`` (1 - F) and leaves the rest to its diffuse lobe, F the exact reflectance of a
dielectric, from either side (beyond the critical angle 1); from within the diffuse lobe is that of what lies behind.
Rough facets refract at GGX micro-facets (Walter et al. 2007). Radiance is not scaled by the square of the index: what
goes in comes out again.
"""

import warp as wp

from ..optics.fresnel_device import fresnel_dielectric
from ..optics.microfacets_device import ggx_g1, ggx_sample_visible
from ..optics.refraction_device import axial_squared, refract
from ..optics.sampling_device import sample_cosine_hemisphere
from ..reflectance.base_device import DELTA_ALPHA, DIELECTRIC, Base, BaseSample, mean3

wp.set_module_options({"enable_backward": False})


MEAN_STEPS = wp.constant(16)


@wp.struct
class Refracted:
    """A direction on the facet's other side, in its frame, and what light from there is multiplied with (0: none)."""

    wi: wp.vec3
    weight: float


@wp.func
def glass_base(b: Base) -> Base:
    """A base as the surface of glass: reflectance by its index alone, no coat."""
    result = b
    result.fresnel = DIELECTRIC
    result.specular = 1.0
    result.ior = wp.max(b.ior, 1.0e-3)
    result.clearcoat = 0.0
    return result


@wp.func
def from_within(b: Base) -> Base:
    """The surface of glass seen from within."""
    result = b
    result.ior = 1.0 / b.ior
    return result


@wp.func
def chance_through(b: Base, wo: wp.vec3, clear: float, w_diffuse: float) -> float:
    """How often to go through: by what passes, of what passes and what is reflected."""
    f = fresnel_dielectric(wo[2], b.ior)
    passed = clear * (1.0 - f)
    result = passed / wp.max(passed + f + w_diffuse * (1.0 - f) * mean3(b.diffuse), 1.0e-6)
    if wp.max(b.alpha_x, b.alpha_y) >= DELTA_ALPHA:
        # micro-facets pass where the facet as a whole does not, and the other way round
        result = wp.clamp(result, 0.1 * wp.min(clear, 1.0), 0.9)
    return result


@wp.func
def mean_passed(ior: float) -> float:
    """1 - F, averaged over all directions by their cosines (to 0.1 %); below an index of 1 most are totally
    reflected."""
    n = wp.max(ior, 1.0 / ior)
    total = float(0.0)
    for k in range(MEAN_STEPS):
        c = (float(k) + 0.5) / float(MEAN_STEPS)
        total += 2.0 * c * (1.0 - fresnel_dielectric(c, n))
    denser = wp.min(ior, 1.0)
    return denser * denser * total / float(MEAN_STEPS)


@wp.func
def chance_shed(b: Base, wo: wp.vec3, chance: float, w_diffuse: float) -> float:
    """How often, from within, to leave by what is neither reflected nor gone through: by the diffuse lobe.

    ``chance``: of going through.
    """
    f = fresnel_dielectric(wo[2], b.ior)
    shed = w_diffuse * (1.0 - f) * mean3(b.diffuse)
    return (1.0 - chance) * wp.min(shed / wp.max(shed + f, 1.0e-6), 0.9)


@wp.func
def shed_within(b: Base, wo: wp.vec3, u: wp.vec2, w_diffuse: float, chance: float) -> BaseSample:
    """A direction of the diffuse lobe from within, where pigment lies behind the surface: light passes it twice,
    diffuse (1 - F(o)) (1 - F(i)) / (pi mean(1 - F)); ``chance``: of having asked."""
    s = BaseSample()
    s.wi = sample_cosine_hemisphere(u)
    s.pdf = 1.0
    passed = (1.0 - fresnel_dielectric(wo[2], b.ior)) * (1.0 - fresnel_dielectric(s.wi[2], b.ior))
    s.weight = (w_diffuse * passed / (wp.max(mean_passed(b.ior), 1.0e-6) * wp.max(chance, 1.0e-6))) * b.diffuse
    return s


@wp.func
def refracted(b: Base, wo: wp.vec3, u: wp.vec2, clear: float, chance: float) -> Refracted:
    """Where light that goes through towards ``wo`` comes from, drawn with ``u``; ``chance``: of having asked."""
    result = Refracted()
    h = wp.vec3(0.0, 0.0, 1.0)
    rough = wp.max(b.alpha_x, b.alpha_y) >= DELTA_ALPHA
    if rough:
        h = ggx_sample_visible(wo, b.alpha_x, b.alpha_y, u)
    c = wp.min(wp.dot(wo, h), 1.0)
    if c > 0.0 and axial_squared(c, b.ior) > 0.0:
        wi = refract(wo, h, c, b.ior)
        if wi[2] < 0.0:
            result.wi = wi
            result.weight = clear * (1.0 - fresnel_dielectric(c, b.ior)) / wp.max(chance, 1.0e-6)
            if rough:
                result.weight *= ggx_g1(wp.vec3(wi[0], wi[1], -wi[2]), b.alpha_x, b.alpha_y)
    return result
