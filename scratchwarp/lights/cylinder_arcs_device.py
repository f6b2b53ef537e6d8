"""Arcs of a cylinder light: its near side is bounded by the tangent planes through x and by its two end circles.

An end's circle seen from x is a cone over an ellipse, whose crossings are roots of a quartic as for a disk; between
neighbouring crossings all is side or none is, and a direction in the middle tells which.
"""

import warp as wp

from scratchwarp.lights.arcs_device import (
    Arcs,
    Cuts,
    add_arc,
    add_cut,
    add_plane,
    cone_at,
    ellipse_quartic,
    end_after,
    first_cut,
    misses_ball,
)
from scratchwarp.lights.cylinder_device import CylinderView, cylinder_view, near_line
from scratchwarp.lights.light_device import Light, LightArrays, LightHit, no_hit, shaped_radiance
from scratchwarp.lights.quartic_device import quartic_roots

wp.set_module_options({"enable_backward": False})


@wp.func
def side_along(c: CylinderView, light: Light, w: wp.vec3) -> wp.vec2:
    """(distance of the near side along w, height over the middle there); a negative distance: not between the tangent
    planes. Distances beyond them are those of the planes."""
    forward = wp.dot(w, c.away)
    sideways = wp.dot(w, c.across)
    level = wp.max(wp.sqrt(forward * forward + sideways * sideways), 1.0e-12)
    r = wp.vec2(-1.0, 0.0)
    if forward > 0.0 and c.distance * wp.abs(sideways) <= light.radius * level * 1.001:
        distance = near_line(c, light.radius, sideways / level, forward / level) / level
        r = wp.vec2(distance, distance * wp.dot(w, light.ex) - c.z)
    return r


@wp.func
def lit_cylinder(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3, width: float) -> LightHit:
    """The near side."""
    h = no_hit()
    h.distance = wp.max(side_along(cylinder_view(light, x), light, w)[0], 0.0)
    h.radiance = shaped_radiance(light, w)
    return h


@wp.func
def add_end(
    cuts: Cuts,
    c: CylinderView,
    light: Light,
    side: float,
    u: wp.vec3,
    v: wp.vec3,
    n: wp.vec3,
    sin_theta: float,
    lo: float,
    hi: float,
) -> Cuts:
    """The cuts of one end's circle."""
    r = cuts
    height = c.z + side * light.half_length
    center = c.distance * c.away + height * light.ex
    axis = wp.where(height > 0.0, -1.0, 1.0) * light.ex
    q = ellipse_quartic(center, axis, c.away / light.radius, c.across / light.radius, u, v, n, sin_theta)
    first = wp.tan(wp.float64(0.5) * wp.float64(lo))
    roots = quartic_roots(q, first, wp.tan(wp.float64(0.5) * wp.float64(hi)))
    for k in range(4):
        if roots[k] < wp.float64(8.0):
            r = add_cut(r, float(wp.float64(2.0) * wp.atan(roots[k])), lo, hi)
    return r


@wp.func
def arcs_cylinder(
    light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float, lo: float, hi: float
) -> Arcs:
    """Of a cylinder light from outside."""
    r = Arcs()
    c = cylinder_view(light, x)
    reach = wp.sqrt(light.radius * light.radius + light.half_length * light.half_length)
    if c.seen != 0 and not misses_ball(light.center - x, reach, u, sin_theta):
        sine = wp.sin(c.beta)
        cosine = wp.cos(c.beta)
        cuts = first_cut(lo)
        cuts = add_plane(cuts, sine * c.away - cosine * c.across, u, v, n, sin_theta, lo, hi)
        cuts = add_plane(cuts, sine * c.away + cosine * c.across, u, v, n, sin_theta, lo, hi)
        # the plane of an end that x lies in has no circle around it
        cuts = add_plane(cuts, light.ex, u, v, n, sin_theta, lo, hi)
        cuts = add_end(cuts, c, light, -1.0, u, v, n, sin_theta, lo, hi)
        cuts = add_end(cuts, c, light, 1.0, u, v, n, sin_theta, lo, hi)
        s = wp.sqrt(wp.max((1.0 - sin_theta) * (1.0 + sin_theta), 0.0))
        for k in range(cuts.count):
            left = cuts.at[k]
            right = end_after(cuts, k, hi)
            w = cone_at(u, v, n, sin_theta, s, 0.5 * (left + right))
            within = wp.min(wp.dot(w, sine * c.away - cosine * c.across), wp.dot(w, sine * c.away + cosine * c.across))
            at = side_along(c, light, w)
            if within > 0.0 and at[0] >= 0.0 and wp.abs(at[1]) < light.half_length:
                r = add_arc(r, left, right)
    return r
