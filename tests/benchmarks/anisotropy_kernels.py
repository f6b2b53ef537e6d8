"""Shading a point by each technique of Kang and Cho's figure 11, for the benchmark."""

import warp as wp

from scratchwarp.optics.microfacets_device import half_vector
from scratchwarp.reflectance.mdf.distributions_device import facet_density, facet_z2
from scratchwarp.reflectance.mdf.lobe_device import (
    Lobe,
    facet_density_ratio,
    facet_sample,
    lobe_normaliser,
    lobe_sample,
    lobe_terms,
)

wp.set_module_options({"enable_backward": False})

TECHNIQUES = ("Lambert", "anisotropic", "normal map", "deformed")


@wp.func
def turned(n: wp.vec3, w: wp.vec3):
    """``w`` in the frame of ``n`` whose x lies above the surface's x."""
    x = wp.normalize(wp.vec3(1.0, 0.0, 0.0) - n[0] * n)
    y = wp.cross(n, x)
    return wp.vec3(wp.dot(w, x), wp.dot(w, y), wp.dot(w, n))


@wp.func
def plain_terms(lobe: Lobe, wo: wp.vec3, wi: wp.vec3):
    """``lobe_terms`` of facets that are not deformed, without the code for it."""
    value = float(0.0)
    pdf = float(0.0)
    if wo[2] > 0.0 and wi[2] > 0.0:
        h = half_vector(wo, wi)
        z2 = facet_z2(h)
        d = lobe_normaliser(lobe) * facet_density(lobe.distribution, wp.vec2(h[0], h[1]), z2, lobe.x, lobe.y)
        facing = wp.max(wp.dot(h, wo), 1.0e-20)
        value = 0.25 * d * h[2] / wp.max(facing * wp.max(wi[2], wo[2]), 1.0e-20)
        pdf = 0.25 * d * h[2] / wp.max(facet_density_ratio(lobe, z2) * facing, 1.0e-30)
    return wp.vec2(value, pdf)


@wp.func
def plain_sample(lobe: Lobe, wo: wp.vec3, u: wp.vec2):
    """The weight of ``lobe_sample`` likewise."""
    weight = float(0.0)
    if wo[2] > 0.0:
        p = facet_sample(lobe, u)
        h = wp.vec3(p[0], p[1], wp.sqrt(wp.max(1.0 - wp.dot(p, p), 0.0)))
        facing = wp.dot(h, wo)
        wi = wp.where(facing > 0.0, wp.normalize(2.0 * facing * h - wo), wp.vec3(0.0, 0.0, -1.0))
        t = plain_terms(lobe, wo, wi)
        if t[1] > 0.0:
            weight = t[0] * wi[2] / t[1]
    return weight


@wp.kernel
def shade(
    technique: int,
    lobe: Lobe,
    wi: wp.array(dtype=wp.vec3),
    wo: wp.array(dtype=wp.vec3),
    normal: wp.array(dtype=wp.vec3),
    out: wp.array(dtype=float),
):
    """Value, density and a sampled direction."""
    i = wp.tid()
    a = wi[i]
    b = wo[i]
    n = normal[i]
    value = float(0.0)
    if technique == 0:
        value = wp.max(a[2], 0.0) * 0.3183
    else:
        u = wp.vec2(wp.frac(float(i) * 0.618034), wp.frac(float(i) * 0.754878))
        if technique == 3:
            delta = wp.vec2(n[0], n[1])
            t = lobe_terms(lobe, delta, b, a)
            s = lobe_sample(lobe, delta, b, u, 0.5)
            value = t[0] * wp.max(a[2], 0.0) + t[1] + s.weight
        else:
            if technique == 2:
                a = turned(n, a)
                b = turned(n, b)
            t2 = plain_terms(lobe, b, a)
            value = t2[0] * wp.max(a[2], 0.0) + t2[1] + plain_sample(lobe, b, u)
    out[i] = value
