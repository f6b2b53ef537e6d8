"""Anisotropic GGX microfacets on the device: distribution, height-correlated Smith shadowing, visible-normal sampling.

Directions are unit, in the shading frame (n = +z, alpha_x along x); ``alpha_x``, ``alpha_y`` >= 1e-4. Everything is
written with s(w) = sqrt(w_z^2 + alpha_x^2 w_x^2 + alpha_y^2 w_y^2), so that no cosine is ever divided by: Smith's
Lambda is (s / w_z - 1) / 2. Sources: Trowbridge and Reitz 1975; Heitz 2014 (Smith, eq. 72 and 99); Heitz 2018 and Dupuy
and Benyoub 2023 (visible normals by a spherical cap).
"""

import warp as wp

_PI = wp.constant(3.141592653589793)


@wp.func
def ggx_d(h: wp.vec3, alpha_x: float, alpha_y: float) -> float:
    """Density D(h) of facet normals a unit of area and solid angle; its integral times h_z is 1."""
    sx = h[0] / alpha_x
    sy = h[1] / alpha_y
    e = sx * sx + sy * sy + h[2] * h[2]
    return wp.where(h[2] > 0.0, 1.0 / (_PI * alpha_x * alpha_y * wp.max(e * e, 1.0e-30)), 0.0)


@wp.func
def ggx_stretched_length(w: wp.vec3, alpha_x: float, alpha_y: float) -> float:
    """s(w), the projected area of the microsurface times two, less w_z."""
    ax = alpha_x * w[0]
    ay = alpha_y * w[1]
    return wp.sqrt(w[2] * w[2] + ax * ax + ay * ay)


@wp.func
def ggx_g1(w: wp.vec3, alpha_x: float, alpha_y: float) -> float:
    """Smith masking of one direction, 2 w_z / (w_z + s); 0 below the horizon."""
    z = wp.max(w[2], 0.0)
    return 2.0 * z / wp.max(z + ggx_stretched_length(w, alpha_x, alpha_y), 1.0e-30)


@wp.func
def ggx_g2(wo: wp.vec3, wi: wp.vec3, alpha_x: float, alpha_y: float) -> float:
    """Height-correlated Smith masking and shadowing 1 / (1 + Lambda_o + Lambda_i); 0 below the horizon."""
    zo = wp.max(wo[2], 0.0)
    zi = wp.max(wi[2], 0.0)
    so = ggx_stretched_length(wo, alpha_x, alpha_y)
    si = ggx_stretched_length(wi, alpha_x, alpha_y)
    return 2.0 * zo * zi / wp.max(so * zi + si * zo, 1.0e-30)


@wp.func
def ggx_sample_visible(wo: wp.vec3, alpha_x: float, alpha_y: float, u: wp.vec2) -> wp.vec3:
    """A facet normal with the density that ``wo`` sees, G1(wo) max(wo . h, 0) D(h) / wo_z."""
    v = wp.normalize(wp.vec3(alpha_x * wo[0], alpha_y * wo[1], wp.max(wo[2], 0.0)))
    phi = 2.0 * _PI * u[0]
    # uniform on the cap of the unit sphere that mirrors v into directions above the plane
    z = (1.0 - u[1]) * (1.0 + v[2]) - v[2]
    r = wp.sqrt(wp.max((1.0 - z) * (1.0 + z), 0.0))
    return wp.normalize(
        wp.vec3(alpha_x * (r * wp.cos(phi) + v[0]), alpha_y * (r * wp.sin(phi) + v[1]), wp.max(z + v[2], 1.0e-12))
    )


@wp.func
def ggx_visible_pdf(wo: wp.vec3, h: wp.vec3, alpha_x: float, alpha_y: float) -> float:
    """Density of ``ggx_sample_visible`` a solid angle of h."""
    z = wp.max(wo[2], 0.0)
    s = ggx_stretched_length(wo, alpha_x, alpha_y)
    return 2.0 * wp.max(wp.dot(wo, h), 0.0) * ggx_d(h, alpha_x, alpha_y) / wp.max(z + s, 1.0e-30)


@wp.func
def ggx_reflection_pdf(wo: wp.vec3, h: wp.vec3, alpha_x: float, alpha_y: float) -> float:
    """Density a solid angle of the direction mirrored at a visible normal h: the above over 4 wo . h."""
    z = wp.max(wo[2], 0.0)
    return 0.5 * ggx_d(h, alpha_x, alpha_y) / wp.max(z + ggx_stretched_length(wo, alpha_x, alpha_y), 1.0e-30)


@wp.func
def ggx_reflection(wo: wp.vec3, wi: wp.vec3, h: wp.vec3, alpha_x: float, alpha_y: float) -> float:
    """D G2 / (4 wo_z wi_z), the BRDF of facets that reflect all, h the unit half vector; 0 below the horizon."""
    so = ggx_stretched_length(wo, alpha_x, alpha_y)
    si = ggx_stretched_length(wi, alpha_x, alpha_y)
    value = 0.5 * ggx_d(h, alpha_x, alpha_y) / wp.max(so * wi[2] + si * wo[2], 1.0e-30)
    return wp.where(wo[2] > 0.0 and wi[2] > 0.0, value, 0.0)


@wp.func
def ggx_reflection_weight(wo: wp.vec3, wi: wp.vec3, alpha_x: float, alpha_y: float) -> float:
    """BRDF times wi_z over ``ggx_reflection_pdf``: G2 / G1(wo), in [0, 1], with no D to cancel."""
    so = ggx_stretched_length(wo, alpha_x, alpha_y)
    si = ggx_stretched_length(wi, alpha_x, alpha_y)
    value = wi[2] * (wo[2] + so) / wp.max(so * wi[2] + si * wo[2], 1.0e-30)
    return wp.where(wo[2] > 0.0 and wi[2] > 0.0, wp.min(value, 1.0), 0.0)


@wp.func
def half_vector(wo: wp.vec3, wi: wp.vec3) -> wp.vec3:
    """Unit vector half-way between; +z where the two are opposite."""
    h = wo + wi
    length2 = wp.dot(h, h)
    return wp.where(length2 > 1.0e-20, h / wp.sqrt(wp.max(length2, 1.0e-20)), wp.vec3(0.0, 0.0, 1.0))


@wp.func
def mirrored(w: wp.vec3, h: wp.vec3) -> wp.vec3:
    """The direction ``w`` mirrored about the unit normal ``h``, both pointing away."""
    return wp.normalize(2.0 * wp.dot(w, h) * h - w)
