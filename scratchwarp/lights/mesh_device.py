"""Mesh light on the device: the outsides of an instance's triangles, sampled uniformly over their area.

Its triangles are scene geometry, so ``hit_mesh`` always misses: a ray that meets one asks ``mesh_light_hit``. Uses
first, count, cdf, size, center and radius (a ball around all), shaping about ez.
"""

import warp as wp

from scratchwarp.lights.cap_device import span_cap, whole_span
from scratchwarp.lights.cdf_device import interval_of
from scratchwarp.lights.light_device import (
    MOST_PDF,
    Light,
    LightArrays,
    LightHit,
    LightSample,
    Span,
    no_hit,
    no_sample,
    shaped_radiance,
)
from scratchwarp.lights.polygon_device import join_spans, span_triangle

_FEW = wp.constant(16)  # triangles whose scratch-cone intervals are taken one by one


@wp.func
def sample_mesh(arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec2) -> LightSample:
    """A triangle by its area, then a point uniform on it; nothing when x is behind it."""
    s = no_sample()
    if light.size > 0.0:
        k = interval_of(arrays.cdf, light.cdf, light.count, u[0])
        low = arrays.cdf[light.cdf + k]
        high = arrays.cdf[light.cdf + k + 1]
        t = wp.clamp((u[0] - low) / wp.max(high - low, 1.0e-30), 0.0, 1.0)
        corner = 3 * (light.first + k)
        a = arrays.triangles[corner]
        ab = arrays.triangles[corner + 1] - a
        ac = arrays.triangles[corner + 2] - a
        root = wp.sqrt(t)
        d = (a - x) + root * (1.0 - u[1]) * ab + root * u[1] * ac
        normal = wp.cross(ab, ac)
        twice = wp.length(normal)
        height = -wp.dot(d, normal)
        s.distance = wp.length(d)
        if height > 1.0e-12 * twice and s.distance > 0.0:
            s.wi = d / s.distance
            s.radiance = shaped_radiance(light, s.wi)
            s.pdf = wp.min((s.distance * twice / height) * (s.distance * s.distance / light.size), MOST_PDF)
    return s


@wp.func
def hit_mesh(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3) -> LightHit:
    """Always misses, see ``mesh_light_hit``."""
    return no_hit()


@wp.func
def mesh_light_hit(
    arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3, distance: float, normal: wp.vec3
) -> LightHit:
    """What the light sends along a ray that met one of its triangles.

    Args:
        x, w: the ray; distance: where it met the triangle [m].
        normal: the triangle's outward geometric normal, unit.
    """
    h = no_hit()
    descent = -wp.dot(w, normal)
    if descent > 0.0 and light.size > 0.0:
        h.distance = distance
        h.radiance = shaped_radiance(light, w)
        h.pdf = wp.min((distance / wp.max(descent, 1.0e-12)) * (distance / light.size), MOST_PDF)
    return h


@wp.func
def span_mesh(
    arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float
) -> Span:
    """Of a few triangles, what holds the intervals of those that face x; of many, that of the ball around them."""
    r = Span()
    if light.size > 0.0 and light.count <= _FEW:
        for k in range(light.count):
            corner = 3 * (light.first + k)
            a = arrays.triangles[corner] - x
            b = arrays.triangles[corner + 1] - x
            c = arrays.triangles[corner + 2] - x
            if wp.dot(wp.cross(b - a, c - a), a) < 0.0:
                r = join_spans(r, span_triangle(a, b, c, u, v, n, sin_theta))
    elif light.size > 0.0:
        p = light.center - x
        d = wp.length(p)
        r = whole_span()
        if d > light.radius:
            half_angle = wp.atan2(light.radius, wp.sqrt((d - light.radius) * (d + light.radius)))
            r = span_cap(p / d, half_angle, u, v, n, sin_theta)
    return r
