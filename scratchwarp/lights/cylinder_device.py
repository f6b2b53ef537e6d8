"""Cylinder light on the device: its side, shining outward, sampled over the directions it fills.

Across the axis at distance D the side fills |beta| <= asin(R / D); along a beta its near line lies h(beta) from x and
fills elevations of sine z / hypot(z, h). Both beta and the sine are drawn uniformly, and d omega = d sine d beta:
uniform over the solid angle for each beta. Uses center, ex (unit axis), half_length, radius, size, shaping about ez.
"""

import warp as wp

from scratchwarp.lights.cap_device import whole_span
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


@wp.struct
class CylinderView:
    """A cylinder seen from x: ``z`` its centre along the axis, ``away`` unit from x to the axis, ``across`` = axis x
    ``away``, ``distance`` to the axis, ``beta`` half angle across; seen 0: from inside, or nothing there."""

    away: wp.vec3
    across: wp.vec3
    z: float
    distance: float
    beta: float
    seen: int


@wp.func
def cylinder_view(light: Light, x: wp.vec3) -> CylinderView:
    """How x sees the cylinder."""
    c = CylinderView()
    p = light.center - x
    c.z = wp.dot(p, light.ex)
    q = p - c.z * light.ex
    c.distance = wp.length(q)
    if c.distance > light.radius * (1.0 + 2.0e-7) and light.size > 0.0:
        c.away = q / c.distance
        c.across = wp.cross(light.ex, c.away)
        c.beta = wp.atan2(light.radius, wp.sqrt((c.distance - light.radius) * (c.distance + light.radius)))
        c.seen = 1
    return c


@wp.func
def near_line(c: CylinderView, radius: float, sin_beta: float, cos_beta: float) -> float:
    """Distance across the axis to the near side, always positive."""
    half2 = wp.max((radius - c.distance * sin_beta) * (radius + c.distance * sin_beta), 0.0)
    # D cos - sqrt(R^2 - D^2 sin^2), as a quotient without cancellation next to the surface
    return (c.distance - radius) * (c.distance + radius) / (c.distance * cos_beta + wp.sqrt(half2))


@wp.func
def elevation_range(z0: float, z1: float, h: float) -> float:
    """z1 / hypot(z1, h) - z0 / hypot(z0, h), without cancellation where both lie on one side."""
    r0 = wp.sqrt(z0 * z0 + h * h)
    r1 = wp.sqrt(z1 * z1 + h * h)
    result = z1 / r1 - z0 / r0
    if z0 * z1 > 0.0:
        result = (h / r0) * (h / r1) * (z1 - z0) * wp.abs(z0 + z1) / wp.abs(z1 * r0 + z0 * r1)
    return result


@wp.func
def sample_cylinder(arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec2) -> LightSample:
    """A direction across, uniform in angle; then an elevation, uniform in its sine."""
    s = no_sample()
    c = cylinder_view(light, x)
    if c.seen != 0:
        beta = (2.0 * u[0] - 1.0) * c.beta
        sb = wp.sin(beta)
        cb = wp.cos(beta)
        h = near_line(c, light.radius, sb, cb)
        z0 = c.z - light.half_length
        z1 = c.z + light.half_length
        reach = elevation_range(z0, z1, h)
        if reach > 1.0e-30:
            r0 = wp.sqrt(z0 * z0 + h * h)
            r1 = wp.sqrt(z1 * z1 + h * h)
            z = float(0.0)
            if z0 * z1 > 0.0:
                # 1 - |sine| = h^2 / (r (r + |z|)) is what keeps its digits towards the axis
                m0 = (h / r0) * (h / (r0 + wp.abs(z0)))
                m1 = (h / r1) * (h / (r1 + wp.abs(z1)))
                m = m0 + u[1] * (m1 - m0)
                z = wp.sign(z0) * h * (1.0 - m) / wp.sqrt(wp.max(m * (2.0 - m), 1.0e-30))
            else:
                sine = z0 / r0 + u[1] * (z1 / r1 - z0 / r0)
                z = h * sine / wp.sqrt(wp.max((1.0 - sine) * (1.0 + sine), 1.0e-14))
            z = wp.clamp(z, z0, z1)
            s.distance = wp.sqrt(z * z + h * h)
            s.wi = (h / s.distance) * (cb * c.away + sb * c.across) + (z / s.distance) * light.ex
            s.radiance = shaped_radiance(light, s.wi)
            s.pdf = wp.min(1.0 / (2.0 * c.beta) / reach, MOST_PDF)
    return s


@wp.func
def hit_cylinder(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3) -> LightHit:
    """The near side, between the ends."""
    h = no_hit()
    c = cylinder_view(light, x)
    forward = wp.dot(w, c.away)
    sideways = wp.dot(w, c.across)
    level = wp.sqrt(forward * forward + sideways * sideways)
    if c.seen != 0 and forward > 0.0 and c.distance * wp.abs(sideways) <= light.radius * level:
        near = near_line(c, light.radius, sideways / level, forward / level)
        distance = near / level
        z = distance * wp.dot(w, light.ex)
        if wp.abs(z - c.z) <= light.half_length:
            reach = elevation_range(c.z - light.half_length, c.z + light.half_length, near)
            if reach > 1.0e-30:
                h.distance = distance
                h.radiance = shaped_radiance(light, w)
                h.pdf = wp.min(1.0 / (2.0 * c.beta) / reach, MOST_PDF)
    return h


@wp.func
def span_cylinder(
    arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float
) -> Span:
    """That of a rectangle which hides the side: through the axis, as wide as the tangent planes there, as long as the
    ends seem from the nearest and the farthest of its visible points."""
    r = Span()
    c = cylinder_view(light, x)
    if c.seen != 0:
        near = (c.distance - light.radius) / c.distance
        far = (c.distance - light.radius) * (c.distance + light.radius) / (c.distance * c.distance)
        z0 = c.z - light.half_length
        z1 = c.z + light.half_length
        z0 = z0 / wp.where(z0 < 0.0, near, far)
        z1 = z1 / wp.where(z1 > 0.0, near, far)
        width = c.distance * wp.tan(c.beta)
        if width < 1.0e6 * c.distance and wp.abs(z0) + wp.abs(z1) < 1.0e6 * c.distance:
            middle = c.distance * c.away + 0.5 * (z0 + z1) * light.ex
            length = 0.5 * (z1 - z0) * (1.0 + 1.0e-6)
            r = span_outline(middle, length * light.ex, width * (1.0 + 1.0e-6) * c.across, 4, u, v, n, sin_theta)
        else:
            r = whole_span()
    return r
