"""Distant light on the device: a uniform cap around ``center`` (towards the light), or a single direction.

Uses center, half_angle, size (solid angle), delta.
"""

import warp as wp

from scratchwarp.lights.cap_device import span_cap
from scratchwarp.lights.light_device import FAR, Light, LightArrays, LightHit, LightSample, Span, no_hit, no_sample
from scratchwarp.optics.frames_device import frame_around, to_world
from scratchwarp.optics.sampling_device import cone_one_minus_cos, sample_cone


@wp.func
def sample_distant(arrays: LightArrays, l: Light, x: wp.vec3, u: wp.vec2) -> LightSample:
    """Uniform within the cap, or its one direction."""
    s = no_sample()
    s.distance = FAR
    s.radiance = l.radiance
    if l.delta != 0:
        s.wi = l.center
        s.pdf = -1.0
    else:
        s.wi = to_world(frame_around(l.center), sample_cone(u, cone_one_minus_cos(l.half_angle)))
        s.pdf = 1.0 / l.size
    return s


@wp.func
def hit_distant(arrays: LightArrays, l: Light, x: wp.vec3, w: wp.vec3) -> LightHit:
    """Compares the chord from the axis, which keeps its digits for a cap as small as the sun."""
    h = no_hit()
    if l.delta == 0:
        chord = w - l.center
        limit = 2.0 * wp.sin(0.5 * l.half_angle)
        if wp.dot(chord, chord) <= limit * limit:
            h.distance = FAR
            h.radiance = l.radiance
            h.pdf = 1.0 / l.size
    return h


@wp.func
def span_distant(
    arrays: LightArrays, l: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float
) -> Span:
    """Exact, see ``cap_device``."""
    r = Span()
    if l.delta == 0:
        r = span_cap(l.center, l.half_angle, u, v, n, sin_theta)
    return r
