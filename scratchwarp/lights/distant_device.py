"""Distant light on the device: a uniform cap around ``center`` (towards the light), or a single direction.

Uses center, half_angle, size (solid angle), delta.
"""

import warp as wp

from scratchwarp.lights.cap_device import span_cap
from scratchwarp.lights.light_device import FAR, Light, LightArrays, LightHit, LightSample, Span, no_hit, no_sample
from scratchwarp.optics.frames_device import frame_around, to_world
from scratchwarp.optics.sampling_device import cone_one_minus_cos, sample_cone


@wp.func
def sample_distant(arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec2) -> LightSample:
    """Uniform within the cap, or its one direction."""
    s = no_sample()
    s.distance = FAR
    s.radiance = light.radiance
    if light.delta != 0:
        s.wi = light.center
        s.pdf = -1.0
    else:
        s.wi = to_world(frame_around(light.center), sample_cone(u, cone_one_minus_cos(light.half_angle)))
        s.pdf = 1.0 / light.size
    return s


@wp.func
def hit_distant(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3) -> LightHit:
    """Compares the chord from the axis, which keeps its digits for a cap as small as the sun."""
    h = no_hit()
    if light.delta == 0:
        chord = w - light.center
        limit = 2.0 * wp.sin(0.5 * light.half_angle)
        if wp.dot(chord, chord) <= limit * limit:
            h.distance = FAR
            h.radiance = light.radiance
            h.pdf = 1.0 / light.size
    return h


@wp.func
def span_distant(
    arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float
) -> Span:
    """Exact, see ``cap_device``."""
    r = Span()
    if light.delta == 0:
        r = span_cap(light.center, light.half_angle, u, v, n, sin_theta)
    return r
