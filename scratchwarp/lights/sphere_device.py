"""Sphere light on the device: the cone it fills, sampled uniformly; or a point.

A sphere shines outward: from inside nothing is seen. Uses center, radius, delta, shaping about ez.
"""

import warp as wp

from scratchwarp.lights.cap_device import span_cap
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
from scratchwarp.optics.frames_device import frame_around, to_world
from scratchwarp.optics.sampling_device import sample_cone

_TWO_PI = wp.constant(6.283185307179586)


@wp.func
def sphere_one_minus_cos(distance: float, radius: float) -> float:
    """1 - cos of the half angle a sphere fills from outside, without cancellation for a small one."""
    sine = radius / distance
    cosine = wp.sqrt((1.0 - sine) * (1.0 + sine))
    return sine * sine / (1.0 + cosine)


@wp.func
def near_distance(distance: float, radius: float, along: float, chord2: float) -> float:
    """Distance to the near side of a ray that passes the centre after ``along`` and is inside for 2 sqrt(chord2)."""
    return (distance - radius) * (distance + radius) / (along + wp.sqrt(wp.max(chord2, 0.0)))


@wp.func
def sample_sphere(arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec2) -> LightSample:
    """Uniform within the cone from outside; a point light's only direction."""
    s = no_sample()
    p = light.center - x
    d = wp.length(p)
    if light.delta != 0:
        if d > 1.0e-15:
            s.wi = p / d
            s.distance = d
            s.radiance = shaped_radiance(light, s.wi) / (d * d)
            s.pdf = -1.0
    elif d > light.radius:
        versine = sphere_one_minus_cos(d, light.radius)
        if versine > 1.0e-30:
            local = sample_cone(u, versine)
            s.wi = to_world(frame_around(p / d), local)
            across2 = d * d * (local[0] * local[0] + local[1] * local[1])
            s.distance = near_distance(d, light.radius, d * local[2], light.radius * light.radius - across2)
            s.radiance = shaped_radiance(light, s.wi)
            s.pdf = wp.min(1.0 / (_TWO_PI * versine), MOST_PDF)
    return s


@wp.func
def hit_sphere(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3) -> LightHit:
    """Nearest point of the sphere from outside."""
    h = no_hit()
    p = light.center - x
    d = wp.length(p)
    along = wp.dot(p, w)
    if light.delta == 0 and d > light.radius and along > 0.0:
        across = p - along * w
        chord2 = light.radius * light.radius - wp.dot(across, across)
        versine = sphere_one_minus_cos(d, light.radius)
        if chord2 >= 0.0 and versine > 1.0e-30:
            h.distance = near_distance(d, light.radius, along, chord2)
            h.radiance = shaped_radiance(light, w)
            h.pdf = wp.min(1.0 / (_TWO_PI * versine), MOST_PDF)
    return h


@wp.func
def span_sphere(
    arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float
) -> Span:
    """Exact, see ``cap_device``; nothing from inside."""
    r = Span()
    p = light.center - x
    d = wp.length(p)
    if light.delta == 0 and d > light.radius:
        half_angle = wp.atan2(light.radius, wp.sqrt((d - light.radius) * (d + light.radius)))
        r = span_cap(p / d, half_angle, u, v, n, sin_theta)
    return r
