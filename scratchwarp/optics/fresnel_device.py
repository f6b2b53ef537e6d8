"""Unpolarised Fresnel reflectance on the device: exact dielectric and conductor, Schlick, Lazanyi.

``cos_theta`` is the cosine to the facet normal, clamped to [0, 1]; indices are relative to the medium of incidence.
Every result is finite and in [0, 1]. Sources: see ``fresnel``, whose float64 formulas are written differently on
purpose.
"""

import warp as wp


@wp.func
def fresnel_dielectric(cos_theta: float, ior: float) -> float:
    """Exact reflectance of a dielectric of relative index ``ior`` (> 0); 1 beyond the critical angle."""
    c = wp.clamp(cos_theta, 0.0, 1.0)
    # ior^2 ct^2 = ior^2 - sin^2, written so that ior = 1 gives exactly 0
    axial2 = (ior - 1.0) * (ior + 1.0) + c * c
    result = 1.0
    if axial2 > 0.0 and c > 0.0:
        axial = wp.sqrt(axial2)
        r_s = (c - axial) / (c + axial)
        r_p = (ior * ior * c - axial) / (ior * ior * c + axial)
        result = wp.min(0.5 * (r_s * r_s + r_p * r_p), 1.0)
    return result


@wp.func
def fresnel_conductor(cos_theta: float, eta: float, k: float) -> float:
    """Exact reflectance of a conductor of index eta + i k, one channel."""
    c = wp.clamp(cos_theta, 0.0, 1.0)
    s2 = (1.0 - c) * (1.0 + c)
    # a + i b = sqrt((eta + i k)^2 - sin^2): the larger part from the sum without cancellation, the other from a b =
    # eta k
    t = (eta - k) * (eta + k) - s2
    ab = eta * k
    modulus = wp.sqrt(t * t + 4.0 * ab * ab)
    larger = wp.sqrt(0.5 * (modulus + wp.abs(t)))
    smaller = ab / wp.max(larger, 1.0e-20)
    a = wp.where(t >= 0.0, larger, smaller)
    b = wp.where(t >= 0.0, smaller, larger)
    r_s = ((a - c) * (a - c) + b * b) / wp.max((a + c) * (a + c) + b * b, 1.0e-20)
    ac = a * c
    bc2 = b * b * c * c
    r_p = r_s * ((ac - s2) * (ac - s2) + bc2) / wp.max((ac + s2) * (ac + s2) + bc2, 1.0e-20)
    return wp.where(c > 0.0, wp.min(0.5 * (r_s + r_p), 1.0), 1.0)


@wp.func
def fresnel_conductor_rgb(cos_theta: float, eta: wp.vec3, k: wp.vec3) -> wp.vec3:
    """``fresnel_conductor`` for three channels."""
    return wp.vec3(
        fresnel_conductor(cos_theta, eta[0], k[0]),
        fresnel_conductor(cos_theta, eta[1], k[1]),
        fresnel_conductor(cos_theta, eta[2], k[2]),
    )


@wp.func
def schlick_weight(cos_theta: float) -> float:
    """(1 - cos)^5, the share of the grazing reflectance in Schlick's formula."""
    m = 1.0 - wp.clamp(cos_theta, 0.0, 1.0)
    m2 = m * m
    return m2 * m2 * m


@wp.func
def fresnel_schlick(cos_theta: float, f0: wp.vec3) -> wp.vec3:
    """Schlick's formula with white at grazing."""
    return f0 + schlick_weight(cos_theta) * (wp.vec3(1.0, 1.0, 1.0) - f0)


@wp.func
def fresnel_schlick_f90(cos_theta: float, f0: wp.vec3, f90: wp.vec3) -> wp.vec3:
    """Schlick's formula between ``f0`` at normal incidence and ``f90`` at grazing."""
    return f0 + schlick_weight(cos_theta) * (f90 - f0)


@wp.func
def fresnel_schlick_scalar(cos_theta: float, f0: float) -> float:
    """Schlick's formula, one channel, white at grazing."""
    return f0 + schlick_weight(cos_theta) * (1.0 - f0)


@wp.func
def fresnel_lazanyi(cos_theta: float, eta: float, k: float) -> float:
    """Lazanyi's base formula for metals, one channel."""
    k2 = k * k
    return ((eta - 1.0) * (eta - 1.0) + 4.0 * eta * schlick_weight(cos_theta) + k2) / ((eta + 1.0) * (eta + 1.0) + k2)


@wp.func
def fresnel_lazanyi_error(cos_theta: float, eta: float, k: float, a: float, alpha: float) -> float:
    """Lazanyi's formula less its error term a c (1 - c)^alpha (``fresnel.fit_lazanyi_error``), clamped to [0, 1]."""
    c = wp.clamp(cos_theta, 0.0, 1.0)
    return wp.clamp(fresnel_lazanyi(c, eta, k) - a * c * wp.pow(1.0 - c, alpha), 0.0, 1.0)
