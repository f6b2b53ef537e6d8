"""Rect light on the device: uniform over the solid angle of the rectangle, one-sided, textured.

Rectangles that fill little (where the spherical map's angles cancel in float32) and sheared ones are sampled uniformly
over their area instead.
Uses center, ex, ey, ez, rx, ry, size, texture, shaping; half_angle holds the solid angle below which the area is
sampled (infinite when sheared).
"""

import warp as wp

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
from scratchwarp.lights.polygon_device import span_outline
from scratchwarp.lights.spherical_rect_device import RectView, rect_solid_angle, rect_view, spherical_rect_offset
from scratchwarp.reflectance.texture_device import texel_bilinear


@wp.func
def rect_radiance(arrays: LightArrays, light: Light, offset: wp.vec3, w: wp.vec3) -> wp.vec3:
    """Radiance towards -w of the point at ``offset`` from the centre. The image's first texel lies at +ex +ey: upright
    for who looks at the lit side with ey up."""
    result = shaped_radiance(light, w)
    if light.texture >= 0:
        uv = wp.vec2(0.5 - 0.5 * wp.dot(offset, light.rx), 0.5 + 0.5 * wp.dot(offset, light.ry))
        t = texel_bilinear(arrays.atlas, light.texture, uv, 1, 1)
        result = wp.cw_mul(result, wp.vec3(t[0], t[1], t[2]))
    return result


@wp.func
def sampled_solid_angle(light: Light, view: RectView, p: wp.vec3, height: float) -> float:
    """The solid angle where directions are sampled uniformly over it, else 0."""
    result = 0.0
    if light.half_angle < 100.0:
        result = rect_solid_angle(view, p, light.ex, light.ey, height, light.size)
        if result < light.half_angle:
            result = 0.0
    return result


@wp.func
def rect_pdf(light: Light, solid_angle: float, height: float, distance: float) -> float:
    """Density [1/sr] of ``sample_rect`` for a point at ``distance``, x being ``height`` over the plane."""
    pdf = wp.min((distance / height) * (distance * distance / light.size), MOST_PDF)
    if solid_angle > 0.0:
        pdf = 1.0 / solid_angle
    return pdf


@wp.func
def sample_rect(arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec2) -> LightSample:
    """Uniform over the solid angle, or over the area where that is small."""
    s = no_sample()
    p = light.center - x
    height = -wp.dot(p, light.ez)
    if height > 1.0e-12 and light.size > 0.0:
        view = rect_view(p, light.ex, light.ey, height)
        solid_angle = sampled_solid_angle(light, view, p, height)
        offset = (2.0 * u[0] - 1.0) * light.ex + (2.0 * u[1] - 1.0) * light.ey
        if solid_angle > 0.0:
            offset = spherical_rect_offset(view, p, height, u)
        d = p + offset
        s.distance = wp.length(d)
        s.wi = d / s.distance
        s.radiance = rect_radiance(arrays, light, offset, s.wi)
        s.pdf = rect_pdf(light, solid_angle, height, s.distance)
    return s


@wp.func
def hit_rect(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3) -> LightHit:
    """The plane's point within the parallelogram, on the lit side."""
    h = no_hit()
    p = light.center - x
    height = -wp.dot(p, light.ez)
    descent = -wp.dot(w, light.ez)
    if height > 1.0e-12 and descent > 0.0 and light.size > 0.0:
        distance = height / descent
        offset = distance * w - p
        if wp.abs(wp.dot(offset, light.rx)) <= 1.0 and wp.abs(wp.dot(offset, light.ry)) <= 1.0:
            h.distance = distance
            h.radiance = rect_radiance(arrays, light, offset, w)
            view = rect_view(p, light.ex, light.ey, height)
            h.pdf = rect_pdf(light, sampled_solid_angle(light, view, p, height), height, distance)
    return h


@wp.func
def span_rect(
    arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float
) -> Span:
    """Tight, see ``polygon_device``; nothing from behind."""
    r = Span()
    p = light.center - x
    if wp.dot(p, light.ez) < -1.0e-12 and light.size > 0.0:
        r = span_outline(p, light.ex, light.ey, 4, u, v, n, sin_theta)
    return r
