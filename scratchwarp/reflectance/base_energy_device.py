"""How much a GGX lobe over Schlick's Fresnel can reflect: the bound that the energy balance of the base rests on.

A lobe whose facets have F = f0 + (f90 - f0) w, w = (1 - cos)^5, has the directional albedo f0 A + f90 B with A + B <=
1: at most f0 + (f90 - f0) B. B depends on view and roughness alone. The bound g = c (1 - cos)^p + d >= B is exactly w
for roughness 0; else c, p and d are functions of alpha that lie above B as integrated numerically (15 values of alpha,
43 cosines), by 0.009 or less in the cosine-weighted mean. For an anisotropic lobe take the smaller alpha. Exact
dielectrics reflect up to 0.03 more than Schlick's formula between 40 and 80 degrees: for them p is less by 1 and d more
by 0.006, which lies above the exact reflectance for every index above 1.
"""

import warp as wp


@wp.func
def bound_shape(alpha: float, dielectric: bool) -> wp.vec3:
    """(c, p, d) of the bound for a roughness (0: smooth) and for Schlick's formula or the exact dielectric."""
    c = 1.0 / (1.0 + 14.0 * alpha * alpha / (alpha + 0.035))
    p = 2.5 + 2.5 * wp.exp(-10.0 * alpha)
    d = wp.min(alpha / 3000.0, 1.0e-4)
    return wp.where(dielectric, wp.vec3(c, p - 1.0, d + 0.006), wp.vec3(c, p, d))


@wp.func
def bound_at(shape: wp.vec3, cos_theta: float) -> float:
    """g at a cosine, at most 1: the share of f90 - f0 that a lobe may reflect."""
    return wp.min(shape[0] * wp.pow(1.0 - wp.clamp(cos_theta, 0.0, 1.0), shape[1]) + shape[2], 1.0)


@wp.func
def bound_mean(shape: wp.vec3) -> float:
    """Cosine-weighted mean of g over the hemisphere, 2 times the integral of g cos d(cos)."""
    return 2.0 * shape[0] / ((shape[1] + 1.0) * (shape[1] + 2.0)) + shape[2]
