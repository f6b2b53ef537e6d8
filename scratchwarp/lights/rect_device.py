"""Rect light on the device: uniform over the solid angle of the rectangle, one-sided, textured.

Sampling: Urena, Fajardo and King 2013, "An area-preserving parametrization for spherical rectangles". Rectangles that
fill little (where its angles cancel in float32) and sheared ones are sampled uniformly over their area instead.
Uses center, ex, ey, ez, rx, ry, size, texture, shaping; half_angle holds the solid angle below which the area is
sampled (infinite when sheared).
"""

import warp as wp

from scratchwarp.lights.light_device import (
    Light,
    LightArrays,
    LightHit,
    LightSample,
    Span,
    no_hit,
    no_sample,
    shaped_radiance,
)
from scratchwarp.lights.polygon_device import parallelogram_solid_angle, span_outline
from scratchwarp.reflectance.texture_device import texel_bilinear

_TWO_PI = wp.constant(6.283185307179586)


@wp.func
def rect_radiance(arrays: LightArrays, l: Light, offset: wp.vec3, w: wp.vec3) -> wp.vec3:
    """Radiance towards -w of the point at ``offset`` from the centre. The image's first texel lies at +ex +ey: upright
    for who looks at the lit side with ey up."""
    result = shaped_radiance(l, w)
    if l.texture >= 0:
        uv = wp.vec2(0.5 - 0.5 * wp.dot(offset, l.rx), 0.5 + 0.5 * wp.dot(offset, l.ry))
        t = texel_bilinear(arrays.atlas, l.texture, uv, 1, 1)
        result = wp.cw_mul(result, wp.vec3(t[0], t[1], t[2]))
    return result


@wp.func
def edge_angle(m0: float, z0: float, m1: float, z1: float) -> float:
    """acos(-z0 z1) of two unit normals' heights, with m = 1 - z^2 given so that it holds next to 0 and pi."""
    return wp.atan2(wp.sqrt(wp.max(m0 + m1 - m0 * m1, 0.0)), -z0 * z1)


@wp.func
def spherical_rect_offset(l: Light, p: wp.vec3, height: float, u: wp.vec2) -> wp.vec3:
    """Offset from the centre of a point whose direction is uniform over the solid angle; ``p`` = centre - x."""
    half_x = wp.length(l.ex)
    half_y = wp.length(l.ey)
    ax = l.ex / half_x
    ay = l.ey / half_y
    cx = wp.dot(p, ax)
    cy = wp.dot(p, ay)
    x0 = cx - half_x
    x1 = cx + half_x
    y0 = cy - half_y
    y1 = cy + half_y
    zz = height * height
    n0 = -y0 / wp.sqrt(y0 * y0 + zz)
    n1 = x1 / wp.sqrt(x1 * x1 + zz)
    n2 = y1 / wp.sqrt(y1 * y1 + zz)
    n3 = -x0 / wp.sqrt(x0 * x0 + zz)
    m0 = zz / (y0 * y0 + zz)
    m1 = zz / (x1 * x1 + zz)
    m2 = zz / (y1 * y1 + zz)
    m3 = zz / (x0 * x0 + zz)
    g2 = edge_angle(m2, n2, m3, n3)
    g3 = edge_angle(m3, n3, m0, n0)
    k = _TWO_PI - g2 - g3
    angle = edge_angle(m0, n0, m1, n1) + edge_angle(m1, n1, m2, n2) - k
    au = u[0] * angle + k
    sine = wp.sin(au)
    fu = (wp.cos(au) * n0 - n2) / wp.where(wp.abs(sine) > 1.0e-12, sine, 1.0e-12)
    cu = wp.clamp(wp.where(fu > 0.0, 1.0, -1.0) / wp.sqrt(fu * fu + n0 * n0), -1.0, 1.0)
    xu = wp.clamp(cu * height / wp.sqrt(wp.max((1.0 - cu) * (1.0 + cu), 1.0e-14)), x0, x1)
    dd = xu * xu + zz
    h0 = y0 / wp.sqrt(dd + y0 * y0)
    h1 = y1 / wp.sqrt(dd + y1 * y1)
    h = h0 + u[1] * (h1 - h0)
    yv = wp.clamp(h * wp.sqrt(dd / wp.max((1.0 - h) * (1.0 + h), 1.0e-14)), y0, y1)
    return (xu - cx) * ax + (yv - cy) * ay


@wp.func
def rect_pdf(l: Light, solid_angle: float, height: float, distance: float) -> float:
    """Density [1/sr] of ``sample_rect`` for a point at ``distance``, x being ``height`` over the plane."""
    pdf = 1.0 / solid_angle
    if solid_angle < l.half_angle:
        pdf = (distance / height) * (distance * distance / l.size)
    return pdf


@wp.func
def sample_rect(arrays: LightArrays, l: Light, x: wp.vec3, u: wp.vec2) -> LightSample:
    """Uniform over the solid angle, or over the area where that is small."""
    s = no_sample()
    p = l.center - x
    height = -wp.dot(p, l.ez)
    if height > 1.0e-12 and l.size > 0.0:
        solid_angle = parallelogram_solid_angle(p, l.ex, l.ey, height, l.size)
        if solid_angle > 1.0e-30:
            offset = (2.0 * u[0] - 1.0) * l.ex + (2.0 * u[1] - 1.0) * l.ey
            if solid_angle >= l.half_angle:
                offset = spherical_rect_offset(l, p, height, u)
            d = p + offset
            s.distance = wp.length(d)
            s.wi = d / s.distance
            s.radiance = rect_radiance(arrays, l, offset, s.wi)
            s.pdf = rect_pdf(l, solid_angle, height, s.distance)
    return s


@wp.func
def hit_rect(arrays: LightArrays, l: Light, x: wp.vec3, w: wp.vec3) -> LightHit:
    """The plane's point within the parallelogram, on the lit side."""
    h = no_hit()
    p = l.center - x
    height = -wp.dot(p, l.ez)
    descent = -wp.dot(w, l.ez)
    if height > 1.0e-12 and descent > 0.0 and l.size > 0.0:
        distance = height / descent
        offset = distance * w - p
        if wp.abs(wp.dot(offset, l.rx)) <= 1.0 and wp.abs(wp.dot(offset, l.ry)) <= 1.0:
            solid_angle = parallelogram_solid_angle(p, l.ex, l.ey, height, l.size)
            if solid_angle > 1.0e-30:
                h.distance = distance
                h.radiance = rect_radiance(arrays, l, offset, w)
                h.pdf = rect_pdf(l, solid_angle, height, distance)
    return h


@wp.func
def span_rect(arrays: LightArrays, l: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float) -> Span:
    """Tight, see ``polygon_device``; nothing from behind."""
    p = l.center - x
    return span_outline(p, l.ex, l.ey, 4, -wp.dot(p, l.ez), u, v, n, sin_theta)
