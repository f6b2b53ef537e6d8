"""One light path through a cross-section, from the base line until it leaves: mirror reflections, and the rates of
the exit angle.

A ray and its neighbour are followed together: ``y`` is the distance between them across the ray and ``a`` the angle,
for a neighbour that entered beside it (at the same angle) and one that entered at another angle (in the same place).
Flight over L: y += L a; reflection off curvature K at cosine c: y -> -y, a -> 2 K y / c - a (the mirror equation of
geometrical optics).
"""

from functools import lru_cache
from typing import Any

import warp as wp

from scratchwarp.profiles.tracer_device import ESCAPED, GROUND, Outline, cross2, entry_facet, march, on_facet, search

wp.set_module_options({"enable_backward": False})

_RATE_LIMIT = wp.constant(1.0e6)
_SHALLOW = wp.constant(1.0e-6)


@wp.struct
class Cosines:
    """A pool that paths write their bounces to: the cosine to the facet's normal, with the sign of the side the light
    comes from."""

    value: wp.array(dtype=float)
    capacity: int  # of one line; what does not fit is counted, not written


@wp.func
def bound(rate: float) -> float:
    """Keep a rate finite: it grows with every reflection off a hump."""
    return wp.clamp(rate, -_RATE_LIMIT, _RATE_LIMIT)


@lru_cache(maxsize=2)
def path_function(height_field: bool) -> Any:
    """The device function ``follow`` for height fields (march) or for outlines with overhangs (search).

    follow(outline, x, phi, max_bounces, cosines, first, used) -> (phi_o, rate_x, rate_phi, bounces): the ray that
    enters the base line at x in [0, 1] from direction phi leaves in direction phi_o [rad], which changes by rate_x
    for each unit of x and rate_phi for each radian of phi. bounces is -1 for a path that is lost (more than
    max_bounces). Cosines go to first + used, first + used + 1, ...
    """
    next_hit = march if height_field else search

    @wp.func
    def follow(outline: Outline, x: float, phi: float, max_bounces: int, cosines: Cosines, first: int, used: int):
        d = wp.vec2(-wp.sin(phi), -wp.cos(phi))
        o = wp.vec2(x, 0.0)
        k = int(0)
        if outline.height_field != 0:
            k = entry_facet(outline, x)
        t = float(-1.0)
        y_x = -d[1]
        a_x = float(0.0)
        y_phi = float(0.0)
        a_phi = float(-1.0)
        bounces = int(0)
        inside = bool(True)
        while inside:
            hit, where, shift = next_hit(outline, o, d, k, t)
            if (hit >= 0 or hit == GROUND) and bounces < max_bounces:
                n = wp.vec2(0.0, 1.0)
                p = o
                curvature = float(0.0)
                if hit >= 0:
                    p = on_facet(outline, hit, where)
                    if outline.turn[hit] == 0:
                        n = outline.normal[hit]
                    else:
                        along = outline.rise[hit] + where * outline.bend[hit]
                        size = wp.length(along)
                        n = wp.vec2(-along[1], along[0]) / size
                        curvature = 0.5 * cross2(along, outline.bend[hit]) / (size * size * size)
                    flight = wp.dot(p - wp.vec2(o[0] - shift, o[1]), d)
                    y_x = bound(y_x + flight * a_x)
                    y_phi = bound(y_phi + flight * a_phi)
                cosine = wp.clamp(-wp.dot(d, n), 0.0, 1.0)
                if used + bounces < cosines.capacity:
                    side = wp.where(cross2(n, d) > 0.0, 1.0, -1.0)
                    cosines.value[first + used + bounces] = side * wp.max(cosine, 1.0e-9)
                power = 2.0 * curvature / wp.max(cosine, _SHALLOW)
                a_x = bound(power * y_x - a_x)
                a_phi = bound(power * y_phi - a_phi)
                y_x = -y_x
                y_phi = -y_phi
                d = wp.normalize(d + 2.0 * cosine * n)
                o = p
                k = hit
                t = where
                bounces += 1
                if hit == GROUND:
                    inside = False
            else:
                inside = False
                if hit != ESCAPED or bounces == 0:
                    bounces = -1
        return wp.atan2(d[0], d[1]), -a_x, -a_phi, bounces

    return follow
