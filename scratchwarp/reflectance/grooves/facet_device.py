"""What a facet reflects, in float64: Lambert, GGX, a mirror under a light of the sun's size."""

import warp as wp

from ...optics.fresnel_device import fresnel_conductor, fresnel_dielectric

wp.set_module_options({"enable_backward": False})

DIFFUSE = wp.constant(0)
GLOSSY = wp.constant(1)
MIRROR = wp.constant(2)
CLEAR = wp.constant(3)

PI = wp.constant(wp.float64(3.14159265358979323846))


@wp.struct
class FacetMaterial:
    """Kind (DIFFUSE, GLOSSY, MIRROR, CLEAR), albedo, GGX roughness.

    ``metal``: 1, index ``eta + i k``; 2, a dielectric of index ``eta[0]``; 0, F = 1. A CLEAR facet lets through what it
    does not reflect. ``cos_source``: cosine of the angular radius of the light that a mirror sees.
    """

    kind: int
    metal: int
    albedo: wp.vec3d
    eta: wp.vec3d
    k: wp.vec3d
    alpha: wp.float64
    cos_source: wp.float64


@wp.struct
class FacetMaterials:
    """Materials of the grooves by the number of their path, that of the ground last."""

    of: wp.array(dtype=FacetMaterial)


@wp.func
def material_of(materials: FacetMaterials, path: int) -> FacetMaterial:
    """The material of a path; of the ground for -1."""
    index = path
    if path < 0:
        index = materials.of.shape[0] - 1
    return materials.of[index]


@wp.func
def facet_fresnel(material: FacetMaterial, cosine: wp.float64) -> wp.vec3d:
    """Reflectance at a cosine to the (micro-)facet's normal."""
    result = wp.vec3d(wp.float64(1.0), wp.float64(1.0), wp.float64(1.0))
    if material.metal == 1:
        c = float(cosine)
        for i in range(3):
            result[i] = wp.float64(fresnel_conductor(c, float(material.eta[i]), float(material.k[i])))
    elif material.metal == 2:
        result = wp.float64(fresnel_dielectric(float(cosine), float(material.eta[0]))) * result
    return result


@wp.func
def smith_g1(cosine: wp.float64, alpha: wp.float64) -> wp.float64:
    """Smith's masking of GGX at a cosine > 0."""
    tan2 = (wp.float64(1.0) - cosine * cosine) / (cosine * cosine)
    return wp.float64(2.0) / (wp.float64(1.0) + wp.sqrt(wp.float64(1.0) + alpha * alpha * tan2))


@wp.func
def facet_radiance(materials: FacetMaterials, path: int, n: wp.vec3d, o: wp.vec3d, i: wp.vec3d) -> wp.vec3d:
    """Radiance towards ``o`` of a facet of normal ``n`` under unit perpendicular irradiance from ``i``.

    That is f (n . i): the cosine is the facet's own. 0 unless both lie above the facet. A mirror sees the irradiance
    spread evenly over a disc of the sky about ``i``.
    """
    zero = wp.float64(0.0)
    one = wp.float64(1.0)
    result = wp.vec3d(zero, zero, zero)
    material = material_of(materials, path)
    cos_o = wp.dot(n, o)
    cos_i = wp.dot(n, i)
    if cos_o > zero and cos_i > zero:
        if material.kind == DIFFUSE:
            result = (cos_i / PI) * material.albedo
        elif material.kind == GLOSSY:
            h = wp.normalize(o + i)
            cos_h = wp.min(wp.dot(n, h), one)
            a2 = material.alpha * material.alpha
            # cos^2 (a^2 - 1) + 1, without cancellation for small a
            spread = cos_h * cos_h * a2 + wp.dot(h - cos_h * n, h - cos_h * n)
            d = a2 / (PI * spread * spread)
            g = smith_g1(wp.min(cos_o, one), material.alpha) * smith_g1(wp.min(cos_i, one), material.alpha)
            result = (d * g / (wp.float64(4.0) * cos_o)) * facet_fresnel(material, wp.dot(o, h))
        elif wp.dot(wp.float64(2.0) * cos_o * n - o, i) >= material.cos_source:
            sine2 = (one - material.cos_source) * (one + material.cos_source)
            result = (one / (PI * sine2)) * facet_fresnel(material, cos_o)
    return result
