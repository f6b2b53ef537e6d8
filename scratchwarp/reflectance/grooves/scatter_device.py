"""Where light goes on after a facet: one direction drawn, for facets of ``facet_device``, and a smooth dielectric."""

import warp as wp

from ...optics.fresnel_device import fresnel_dielectric
from ...optics.refraction_device import axial_squared, refract
from .facet_device import CLEAR, DIFFUSE, GLOSSY, PI, FacetMaterials, facet_fresnel, material_of, smith_g1

wp.set_module_options({"enable_backward": False})


@wp.struct
class Scattered:
    """Direction away from the facet, what the light is multiplied with, and 1 where it went through the facet."""

    d: wp.vec3d
    weight: wp.vec3d
    through: int


@wp.func
def to_world(n: wp.vec3d, x: wp.float64, y: wp.float64, z: wp.float64) -> wp.vec3d:
    """(x, y, z) in a frame whose third axis is ``n`` (Duff et al. 2017)."""
    one = wp.float64(1.0)
    sign = wp.where(n[2] >= wp.float64(0.0), one, -one)
    a = -one / (sign + n[2])
    b = n[0] * n[1] * a
    s = wp.vec3d(one + sign * n[0] * n[0] * a, sign * b, -sign * n[0])
    t = wp.vec3d(b, sign + n[1] * n[1] * a, -n[1])
    return x * s + y * t + z * n


@wp.func
def visible_facet(n: wp.vec3d, o: wp.vec3d, alpha: wp.float64, u: wp.vec2d) -> wp.vec3d:
    """A GGX micro-normal about ``n`` with the density that ``o`` sees (Dupuy and Benyoub 2023)."""
    one = wp.float64(1.0)
    z_o = wp.dot(n, o)
    v = wp.normalize(alpha * (o - z_o * n) + z_o * n)  # o where the facets are stretched to a sphere
    phi = wp.float64(2.0) * PI * u[0]
    z = (one - u[1]) * (one + wp.dot(v, n)) - wp.dot(v, n)
    r = wp.sqrt(wp.max((one - z) * (one + z), wp.float64(0.0)))
    h = v + to_world(n, r * wp.cos(phi), r * wp.sin(phi), z)
    h_z = wp.max(wp.dot(h, n), wp.float64(1e-12))
    return wp.normalize(alpha * (h - wp.dot(h, n) * n) + h_z * n)


@wp.func
def scatter_facet(
    materials: FacetMaterials, path: int, normal: wp.vec3d, o: wp.vec3d, u: wp.vec2d
) -> Scattered:  # fmt: skip
    """Where the light seen along ``o`` came from, drawn with ``u`` in [0, 1)^2; the normal points into the air.

    Weight 0: from nowhere. A dielectric reflects or lets through by its Fresnel reflectance, from within as well (total
    reflection included); radiance is not scaled by the square of the index.
    """
    zero = wp.float64(0.0)
    one = wp.float64(1.0)
    two = wp.float64(2.0)
    white = wp.vec3d(one, one, one)
    result = Scattered()
    material = material_of(materials, path)
    n = normal
    if wp.dot(normal, o) < zero:
        n = -normal
    cos_o = wp.min(wp.dot(n, o), one)
    if material.kind == DIFFUSE:
        r = wp.sqrt(u[0])
        phi = two * PI * u[1]
        result.d = to_world(n, r * wp.cos(phi), r * wp.sin(phi), wp.sqrt(one - u[0]))
        result.weight = material.albedo
    elif material.kind == GLOSSY:
        h = visible_facet(n, o, material.alpha, u)
        result.d = wp.normalize(two * wp.dot(o, h) * h - o)
        cos_i = wp.dot(n, result.d)
        if cos_i > zero:
            result.weight = smith_g1(wp.min(cos_i, one), material.alpha) * facet_fresnel(material, wp.dot(o, h))
    else:
        result.d = wp.normalize(two * cos_o * n - o)
        result.weight = white
        if material.kind == CLEAR:
            eta = material.eta[0]
            if wp.dot(normal, o) < zero:
                eta = one / eta
            reflected = wp.float64(fresnel_dielectric(float(cos_o), float(eta)))
            if u[0] >= reflected and axial_squared(cos_o, eta) > zero:
                result.d = refract(o, n, cos_o, eta)
                result.through = 1
        else:
            result.weight = facet_fresnel(material, cos_o)
    return result
