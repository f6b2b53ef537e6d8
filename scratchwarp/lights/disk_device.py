"""Disk light on the device: an ellipse, one-sided.

From afar points are uniform over its area. From near by, where the area's density has a huge range, directions are
uniform over the solid angle of the rectangle around it, and those that miss the ellipse bring nothing. Uses center, ex,
ey (orthogonal), ez, rx, ry, size, shaping.
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
from scratchwarp.lights.spherical_rect_device import rect_solid_angle, rect_view, spherical_rect_offset
from scratchwarp.optics.sampling_device import sample_concentric_disk

_SIDES = wp.constant(8)  # of the outline around the ellipse: 5 % more area than the ellipse
_NEAR = wp.constant(0.5)  # [sr] of the rectangle around the ellipse
_CORNERS = wp.constant(1.2732395447351628)  # 4 / pi, the rectangle's area over the ellipse's


@wp.func
def disk_pdf(light: Light, solid_angle: float, height: float, distance: float) -> float:
    """Density [1/sr] of ``sample_disk`` for a point of the ellipse at ``distance``; ``solid_angle`` of the rectangle
    around it."""
    pdf = wp.min((distance / height) * (distance * distance / light.size), MOST_PDF)
    if solid_angle > _NEAR:
        pdf = 1.0 / solid_angle
    return pdf


@wp.func
def sample_disk(arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec2) -> LightSample:
    """Uniform over the area, or over the solid angle of the rectangle around."""
    s = no_sample()
    p = light.center - x
    height = -wp.dot(p, light.ez)
    if height > 1.0e-12 and light.size > 0.0:
        q = sample_concentric_disk(u)
        offset = q[0] * light.ex + q[1] * light.ey
        view = rect_view(p, light.ex, light.ey, height)
        solid_angle = rect_solid_angle(view, p, light.ex, light.ey, height, _CORNERS * light.size)
        if solid_angle > _NEAR:
            offset = spherical_rect_offset(view, p, height, u)
        a = wp.dot(offset, light.rx)
        b = wp.dot(offset, light.ry)
        if a * a + b * b <= 1.000001:
            d = p + offset
            s.distance = wp.length(d)
            s.wi = d / s.distance
            s.radiance = shaped_radiance(light, s.wi)
            s.pdf = disk_pdf(light, solid_angle, height, s.distance)
    return s


@wp.func
def hit_disk(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3) -> LightHit:
    """The plane's point within the ellipse, on the lit side."""
    h = no_hit()
    p = light.center - x
    height = -wp.dot(p, light.ez)
    descent = -wp.dot(w, light.ez)
    if height > 1.0e-12 and descent > 0.0 and light.size > 0.0:
        distance = height / descent
        offset = distance * w - p
        a = wp.dot(offset, light.rx)
        b = wp.dot(offset, light.ry)
        if a * a + b * b <= 1.0:
            h.distance = distance
            h.radiance = shaped_radiance(light, w)
            view = rect_view(p, light.ex, light.ey, height)
            solid_angle = rect_solid_angle(view, p, light.ex, light.ey, height, _CORNERS * light.size)
            h.pdf = disk_pdf(light, solid_angle, height, distance)
    return h


@wp.func
def span_disk(
    arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float
) -> Span:
    """That of the octagon around the ellipse; nothing from behind."""
    r = Span()
    p = light.center - x
    if wp.dot(p, light.ez) < -1.0e-12 and light.size > 0.0:
        r = span_outline(p, light.ex, light.ey, _SIDES, u, v, n, sin_theta)
    return r
