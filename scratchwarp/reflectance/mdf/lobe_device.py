"""Reflection by a distribution of facets that a perturbed normal deforms: value, sampling and density in float32.

f_r = D'(h) h_z / (4 (h . omega_o) max(cos_i, cos_o)), Fresnel left to the caller. It is reciprocal, and since the
deformation keeps the integral of D' times the cosine, no view reflects more than the undeformed distribution holds: 1
for Beckmann, GGX and Ashikhmin-Shirley (scaled here by sqrt((ex + 2)(ey + 2) / ((ex + 1)(ey + 1)))), less for Ward.
The denominator is Ashikhmin and Shirley's, h_z the cosine that makes their density one of projected facets.

Facets are drawn from the undeformed distribution over the disk and moved by the linear map, whose Jacobian is known;
the weight is then at most 1 + |delta|. The square root has no inverse to draw by: a quarter of its samples are
cosine-weighted directions, which cover what the linear map leaves out.
"""

import warp as wp

from ...optics.microfacets_device import half_vector
from ...optics.sampling_device import sample_cosine_hemisphere
from .deform_device import LINEAR, SQUARE_ROOT, deform_jacobian, deform_point, inverse_deform_point
from .distributions_device import ASHIKHMIN_SHIRLEY, GGX, WARD, facet_density, facet_z2

wp.set_module_options({"enable_backward": False})

_INV_PI = wp.constant(0.3183098861837907)
_COSINE_SHARE = wp.constant(0.25)


@wp.struct
class Lobe:
    """``distribution`` and ``kind`` of the deformation by number; ``x``, ``y`` exponents or widths."""

    distribution: int
    kind: int
    x: float
    y: float


@wp.struct
class LobeSample:
    """A direction, f_r cos(theta_i) / pdf and its density [1/sr]; pdf 0: nothing."""

    wi: wp.vec3
    weight: float
    pdf: float


@wp.func
def lobe_normaliser(lobe: Lobe) -> float:
    """Factor that makes the integral of D times the cosine 1 (Ward's, which has no closed form, stays below)."""
    scale = float(1.0)
    if lobe.distribution == ASHIKHMIN_SHIRLEY:
        scale = wp.sqrt((lobe.x + 2.0) / (lobe.x + 1.0) * ((lobe.y + 2.0) / (lobe.y + 1.0)))
    return scale


@wp.func
def facet_sample(lobe: Lobe, u: wp.vec2) -> wp.vec2:
    """A point of the disk with the density of projected facets (for Ward, that of Beckmann's)."""
    angle = 2.0 * wp.pi * u[0]
    c = wp.cos(angle)
    s = wp.sin(angle)
    left = 1.0 - u[1]
    p = wp.vec2(0.0, 0.0)
    if lobe.distribution == ASHIKHMIN_SHIRLEY:
        axis = wp.normalize(wp.vec2(c / wp.sqrt(lobe.x + 2.0), s / wp.sqrt(lobe.y + 2.0)))
        power = (lobe.x + 2.0) * axis[0] * axis[0] + (lobe.y + 2.0) * axis[1] * axis[1]
        x = 2.0 * wp.log(left) / power
        # 1 - exp(x), of a sharp lobe without cancellation
        r2 = wp.where(x > -0.01, -x * (1.0 + x * (0.5 + x * 0.16666667)), 1.0 - wp.exp(x))
        p = wp.sqrt(wp.clamp(r2, 0.0, 1.0)) * axis
    else:
        slope = wp.sqrt(-wp.log(left))
        if lobe.distribution == GGX:
            slope = wp.sqrt(u[1] / left)
        q = slope * wp.vec2(lobe.x * c, lobe.y * s)
        p = q / wp.sqrt(1.0 + wp.dot(q, q))
    return p


@wp.func
def facet_density_ratio(lobe: Lobe, z2: float) -> float:
    """D, normalised, over the density of ``facet_sample``: z^4 for Ward, 1 for the others."""
    return wp.where(lobe.distribution == WARD, z2 * z2, 1.0)


@wp.func
def facet_disk_pdf(lobe: Lobe, p: wp.vec2, z2: float) -> float:
    """Density of ``facet_sample`` a unit of area of the disk."""
    d = lobe_normaliser(lobe) * facet_density(lobe.distribution, p, z2, lobe.x, lobe.y)
    return d / wp.max(facet_density_ratio(lobe, z2), 1.0e-20)


@wp.func
def lobe_eval(lobe: Lobe, delta: wp.vec2, wo: wp.vec3, wi: wp.vec3) -> float:
    """f_r [1/sr]; 0 below the horizon."""
    value = float(0.0)
    if wo[2] > 0.0 and wi[2] > 0.0:
        h = half_vector(wo, wi)
        p = inverse_deform_point(lobe.kind, wp.vec2(h[0], h[1]), delta)
        z2 = wp.where(wp.dot(delta, delta) > 0.0, 1.0 - wp.dot(p, p), facet_z2(h))
        if z2 > 0.0:
            d = lobe_normaliser(lobe) * facet_density(lobe.distribution, p, z2, lobe.x, lobe.y)
            value = 0.25 * d * h[2] / wp.max(wp.dot(h, wo) * wp.max(wi[2], wo[2]), 1.0e-20)
    return value


@wp.func
def lobe_pdf(lobe: Lobe, delta: wp.vec2, wo: wp.vec3, wi: wp.vec3) -> float:
    """Density with which ``lobe_sample`` finds ``wi`` [1/sr]."""
    pdf = float(0.0)
    if wo[2] > 0.0 and wi[2] > 0.0:
        h = half_vector(wo, wi)
        p = inverse_deform_point(LINEAR, wp.vec2(h[0], h[1]), delta)
        z2 = wp.where(wp.dot(delta, delta) > 0.0, 1.0 - wp.dot(p, p), facet_z2(h))
        if z2 > 0.0:
            moved = facet_disk_pdf(lobe, p, z2) / wp.max(deform_jacobian(p, delta), 1.0e-6)
            pdf = 0.25 * moved * h[2] / wp.max(wp.dot(h, wo), 1.0e-20)
        if lobe.kind == SQUARE_ROOT:
            pdf = (1.0 - _COSINE_SHARE) * pdf + _COSINE_SHARE * _INV_PI * wi[2]
    return pdf


@wp.func
def lobe_terms(lobe: Lobe, delta: wp.vec2, wo: wp.vec3, wi: wp.vec3) -> wp.vec2:
    """(``lobe_eval``, ``lobe_pdf``), of the linear map from one density."""
    value = float(0.0)
    pdf = float(0.0)
    if lobe.kind == SQUARE_ROOT:
        value = lobe_eval(lobe, delta, wo, wi)
        pdf = lobe_pdf(lobe, delta, wo, wi)
    elif wo[2] > 0.0 and wi[2] > 0.0:
        h = half_vector(wo, wi)
        p = inverse_deform_point(LINEAR, wp.vec2(h[0], h[1]), delta)
        z2 = wp.where(wp.dot(delta, delta) > 0.0, 1.0 - wp.dot(p, p), facet_z2(h))
        if z2 > 0.0:
            d = lobe_normaliser(lobe) * facet_density(lobe.distribution, p, z2, lobe.x, lobe.y)
            facing = wp.max(wp.dot(h, wo), 1.0e-20)
            value = 0.25 * d * h[2] / wp.max(facing * wp.max(wi[2], wo[2]), 1.0e-20)
            spread = wp.max(facet_density_ratio(lobe, z2), 1.0e-20) * wp.max(deform_jacobian(p, delta), 1.0e-6)
            pdf = 0.25 * d * h[2] / wp.max(spread * facing, 1.0e-30)
    return wp.vec2(value, pdf)


@wp.func
def lobe_sample(lobe: Lobe, delta: wp.vec2, wo: wp.vec3, u: wp.vec2, u_lobe: float) -> LobeSample:
    """Draw ``wi``; ``u`` and ``u_lobe`` uniform in [0, 1)."""
    s = LobeSample()
    s.wi = wp.vec3(0.0, 0.0, 1.0)
    if wo[2] > 0.0:
        if lobe.kind == SQUARE_ROOT and u_lobe < _COSINE_SHARE:
            s.wi = sample_cosine_hemisphere(u)
        else:
            p = deform_point(LINEAR, facet_sample(lobe, u), delta)
            h = wp.vec3(p[0], p[1], wp.sqrt(wp.max(1.0 - wp.dot(p, p), 0.0)))
            facing = wp.dot(h, wo)
            # a facet seen from behind mirrors to a direction whose half vector is its opposite
            s.wi = wp.where(facing > 0.0, wp.normalize(2.0 * facing * h - wo), wp.vec3(0.0, 0.0, -1.0))
        t = lobe_terms(lobe, delta, wo, s.wi)
        s.pdf = t[1]
        if s.pdf > 0.0:
            s.weight = t[0] * s.wi[2] / s.pdf
    return s
