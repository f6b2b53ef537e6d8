"""What lies along a direction that is known to meet a light: distance and radiance, without asking whether it does.

Rounding at an edge of an arc (``arcs_device``) cannot lose the light then. ``width`` [rad] is how far apart the
directions are that a dome's image is looked up for; it is averaged over about that much, other lights are not.
"""

import warp as wp

from scratchwarp.lights.light_device import FAR, Light, LightArrays, LightHit, no_hit, shaped_radiance
from scratchwarp.lights.rect_device import rect_radiance
from scratchwarp.lights.sphere_device import near_distance
from scratchwarp.reflectance.texture_device import texel_bilinear

wp.set_module_options({"enable_backward": False})

_PI = wp.constant(3.141592653589793)


@wp.func
def lit_sphere(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3, width: float) -> LightHit:
    """The near side, or the rim."""
    h = no_hit()
    p = light.center - x
    d = wp.length(p)
    along = wp.dot(p, w)
    across = p - along * w
    chord2 = light.radius * light.radius - wp.dot(across, across)
    h.distance = near_distance(d, light.radius, wp.max(along, 1.0e-3 * d), chord2)
    h.radiance = shaped_radiance(light, w)
    return h


@wp.func
def lit_distant(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3, width: float) -> LightHit:
    """The same everywhere."""
    h = no_hit()
    h.distance = FAR
    h.radiance = light.radiance
    return h


@wp.func
def lit_rect(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3, width: float) -> LightHit:
    """The plane's point."""
    h = no_hit()
    p = light.center - x
    h.distance = wp.dot(p, light.ez) / wp.min(wp.dot(w, light.ez), -1.0e-12)
    h.radiance = rect_radiance(arrays, light, h.distance * w - p, w)
    return h


@wp.func
def lit_disk(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3, width: float) -> LightHit:
    """The plane's point."""
    h = no_hit()
    h.distance = wp.dot(light.center - x, light.ez) / wp.min(wp.dot(w, light.ez), -1.0e-12)
    h.radiance = shaped_radiance(light, w)
    return h


@wp.func
def lit_dome(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3, width: float) -> LightHit:
    """The image, from the two copies whose texels are next to ``width`` wide."""
    h = no_hit()
    h.distance = FAR
    h.radiance = light.radiance
    if light.texture >= 0:
        a = wp.dot(w, light.ex)
        b = wp.dot(w, light.ey)
        c = wp.dot(w, light.ez)
        polar = wp.atan2(wp.sqrt(a * a + c * c), b)
        uv = wp.vec2(0.5 - 0.5 * wp.atan2(a, c) / _PI, 1.0 - polar / _PI)
        level = wp.log2(wp.max(width * float(arrays.atlas.height[light.texture]) / _PI, 1.0e-6))
        level = wp.clamp(level, 0.0, float(light.levels))
        low = wp.min(int(level), wp.max(light.levels - 1, 0))
        part = level - float(low)
        image = light.texture
        if low > 0:
            image = light.first_level + low - 1
        t = texel_bilinear(arrays.atlas, image, uv, 2, 1)
        if part > 0.0:
            t = wp.lerp(t, texel_bilinear(arrays.atlas, light.first_level + low, uv, 2, 1), part)
        h.radiance = wp.cw_mul(light.radiance, wp.vec3(t[0], t[1], t[2]))
    return h
