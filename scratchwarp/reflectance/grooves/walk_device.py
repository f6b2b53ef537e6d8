"""Light that goes on inside grooves: bounces from facet to facet until it leaves (Bosch et al. 2008, section 7).

One path a sample in place of the paper's beams, so that mirrors, rough and diffuse facets and refraction are one code.
A path that leaves goes on into the scene: the walk says from where and whither.
"""

from typing import Any

import warp as wp

from ...optics.sobol_device import sobol_2d
from .cast_device import cast, path_of
from .solid_device import GrooveSet

wp.set_module_options({"enable_backward": False})


@wp.struct
class Walk:
    """A path followed backwards from the viewer.

    ``p``, ``d``: where it is and the way it goes; ``weight``: what light found there is multiplied with; ``inside``: 1
    in the solid; ``met``: surfaces met; ``left``: 1 when it meets no other one; ``light``: what a light of unit
    perpendicular irradiance adds on the way, from the second surface on.
    """

    p: wp.vec3d
    d: wp.vec3d
    weight: wp.vec3d
    light: wp.vec3d
    inside: int
    met: int
    left: int


def make_walk(Material: Any, scatter: Any, radiance: Any) -> Any:
    """The device function ``walk(grooves, ids, count, p, d, material, i, bounces, index, seed) -> Walk``.

    ``p`` in the air above everything, ``d`` (unit) the way to look; ``scatter(material, path, n, o, u) -> Scattered``;
    ``radiance(material, path, n, o, i)`` as in ``make_footprint_mean``, asked at each surface from the second on that
    ``i`` reaches. ``bounces`` >= 1: after the last one a path that still meets a surface ends with ``left`` 0.
    """

    @wp.func
    def walk(
        grooves: GrooveSet, ids: wp.array(dtype=int), count: int, p: wp.vec3d, d: wp.vec3d, material: Material,
        i: wp.vec3d, bounces: int, index: wp.uint32, seed: wp.uint32,
    ) -> Walk:  # fmt: skip
        zero = wp.float64(0.0)
        one = wp.float64(1.0)
        far = wp.float64(wp.inf)
        result = Walk()
        result.p = p
        result.d = d
        result.weight = wp.vec3d(one, one, one)
        going = int(1)
        while going == 1:
            going = int(0)
            hit = cast(grooves, ids, count, result.p, result.d, far, 0, result.inside)
            if hit.distance == far:
                result.left = 1
            else:
                q = result.p + hit.distance * result.d
                n = hit.normal
                path = path_of(grooves, hit.piece)
                if result.met > 0 and result.inside == 0 and i[2] > wp.float64(1e-9) and wp.dot(n, i) > zero:
                    lit = cast(grooves, ids, count, q + wp.float64(2.0) * grooves.skin * n, i, far, 1, 0)
                    if lit.distance == far:
                        result.light += wp.cw_mul(result.weight, radiance(material, path, n, -result.d, i))
                result.met += 1
                if result.met <= bounces:
                    u = sobol_2d(index, result.met, seed)
                    next = scatter(material, path, n, -result.d, wp.vec2d(wp.float64(u[0]), wp.float64(u[1])))
                    result.weight = wp.cw_mul(result.weight, next.weight)
                    result.d = next.d
                    if next.through == 1:
                        result.inside = 1 - result.inside
                    side = wp.float64(2 - 4 * result.inside)
                    result.p = q + side * grooves.skin * n
                    if wp.max(result.weight) > zero:
                        going = int(1)
        return result

    return walk
