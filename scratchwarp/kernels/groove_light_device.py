"""Facets of grooves under the lights: what they are made of, and what lights send to them past the other facets."""

import warp as wp

from ..optics.frames_device import Frame, frame_with_tangent, to_local, to_world
from ..optics.sobol_device import sobol_2d
from ..reflectance.base_device import Base, base_eval, base_eval_pdf
from ..reflectance.grooves.follow_device import follow
from ..reflectance.grooves.footprint_device import make_footprint_mean, slope_of
from ..reflectance.grooves.near_device import find_near
from .direct_device import make_arrives, models_of
from .geometry_device import Geometry
from .groove_arrays_device import GROOVE_ROOM, FacetStuff, GrooveSpot
from .key import KernelKey
from .lobe_device import largest, power_heuristic
from .material_device import MaterialArrays
from .world_device import LightSet

wp.set_module_options({"enable_backward": False})

GRAZING = wp.constant(wp.float64(1e-9))


@wp.func
def mapped(m: wp.mat22d, d: wp.vec3d) -> wp.vec3d:
    """A direction whose x and y are multiplied with ``m``, unit."""
    xy = m * wp.vec2d(d[0], d[1])
    return wp.normalize(wp.vec3d(xy[0], xy[1], d[2]))


@wp.func
def rounded(d: wp.vec3d) -> wp.vec3:
    """In float32."""
    return wp.vec3(float(d[0]), float(d[1]), float(d[2]))


@wp.func
def in_pattern(spot: GrooveSpot, w: wp.vec3) -> wp.vec3d:
    """A world direction in the pattern, where it may run at other angles to others."""
    d = to_local(spot.frame, w)
    return mapped(spot.there, wp.vec3d(wp.float64(d[0]), wp.float64(d[1]), wp.float64(d[2])))


@wp.func
def out_of_pattern(spot: GrooveSpot, d: wp.vec3d) -> wp.vec3:
    """A direction in the pattern in the world."""
    return to_world(spot.frame, rounded(mapped(spot.back, d)))


@wp.func
def normal_of(spot: GrooveSpot, n: wp.vec3d) -> wp.vec3:
    """A facet's normal in the pattern in the world, where it is that of the stretched facet."""
    return to_world(spot.frame, rounded(mapped(wp.transpose(spot.there), n)))


@wp.func
def facet_base(stuff: FacetStuff, path: int) -> Base:
    """What a facet of a path is made of, as rough as the surface."""
    result = stuff.base
    if path >= 0 and stuff.smooth > 0.0:
        result.alpha_x = stuff.smooth
        result.alpha_y = stuff.smooth
    if path >= 0:
        own = stuff.own[path]
        if own >= 0:
            result = stuff.bases[own]
            if result.alpha_x < 0.0:
                result.alpha_x = wp.where(stuff.smooth > 0.0, stuff.smooth, stuff.base.alpha_x)
                result.alpha_y = wp.where(stuff.smooth > 0.0, stuff.smooth, stuff.base.alpha_y)
    return result


@wp.func
def stuff_radiance(stuff: FacetStuff, path: int, n: wp.vec3d, o: wp.vec3d, i: wp.vec3d) -> wp.vec3d:
    """Radiance of a facet towards ``o`` under unit perpendicular irradiance from ``i``."""
    frame = frame_with_tangent(rounded(mapped(wp.transpose(stuff.there), n)), stuff.x)
    wo = to_local(frame, rounded(mapped(stuff.back, o)))
    wi = to_local(frame, rounded(mapped(stuff.back, i)))
    value = base_eval(facet_base(stuff, path), wo, wi, stuff.w_diffuse, stuff.w_specular)
    return wp.vec3d(wp.float64(value[0]), wp.float64(value[1]), wp.float64(value[2]))


def make_facet_lit(key: KernelKey, transmittance):
    """Device function: light sampling at a facet, compiled for ``key``."""
    models = models_of(key)
    linked, arrives = make_arrives(key, transmittance)
    footprint_mean = make_footprint_mean(FacetStuff, stuff_radiance, key.groove_crossings, key.groove_tapers)

    @wp.func
    def lit(spot: GrooveSpot, q: wp.vec3d, n: wp.vec3d, i: wp.vec3d) -> bool:
        """Whether no groove stands between ``q`` on a facet and the light."""
        result = bool(False)
        if i[2] > GRAZING and wp.dot(n, i) > wp.float64(0.0):
            result = bool(True)
            if q[2] < spot.grooves.top - spot.grooves.skin:
                ids = wp.zeros(shape=GROOVE_ROOM, dtype=int)
                p = q + wp.float64(2.0) * spot.grooves.skin * n
                dark = follow(spot.grooves, spot.grid, p, i, 1, 0, ids, GROOVE_ROOM)
                result = dark.distance == wp.float64(wp.inf)
        return result

    @wp.func
    def facet_lit(
        g: Geometry, arrays: MaterialArrays, lights: LightSet, spot: GrooveSpot, stuff: FacetStuff, bounce: int,
        base: Base, share: float, frame: Frame, wo: wp.vec3, q: wp.vec3d, n: wp.vec3d, p: wp.vec3, ng: wp.vec3,
        instance: int, slices: int, index: wp.uint32, dimension: int, seed: wp.uint32,
    ) -> wp.vec4:  # fmt: skip
        """What lights send to ``wo`` (in the facet's ``frame``) by light sampling at ``q``, and in w the rays it took.

        ``share``: how often a direction is drawn from the facet's lobes. At the first facet lights without extent count
        with their mean over the footprint.
        """
        total = wp.vec3(0.0, 0.0, 0.0)
        rays = float(0.0)
        for j in range(wp.static(len(models))):
            for k in range(lights.starts[j], lights.starts[j + 1]):
                light = lights.lights[k]
                if linked(lights, light, instance):
                    ls = wp.static(models[j].sample)(lights.arrays, light, p, sobol_2d(index, dimension + k, seed))
                    if ls.pdf != 0.0 and wp.dot(ls.wi, ng) > 0.0:
                        w_diffuse = stuff.w_diffuse
                        w_specular = stuff.w_specular
                        if wp.static(key.light_multipliers):
                            w_diffuse *= light.diffuse
                            w_specular *= light.specular
                        i = in_pattern(spot, ls.wi)
                        value = wp.vec3(0.0, 0.0, 0.0)
                        exact = int(0)
                        if bounce == 0 and light.delta == 1 and i[2] > GRAZING:
                            ids = wp.zeros(shape=GROOVE_ROOM, dtype=int)
                            f = spot.footprint
                            found = find_near(
                                spot.grooves, spot.grid, f, slope_of(spot.o), slope_of(i), ids, GROOVE_ROOM
                            )
                            if found <= GROOVE_ROOM:
                                exact = 1
                                own = stuff
                                own.w_diffuse = w_diffuse
                                own.w_specular = w_specular
                                seen = footprint_mean(spot.grooves, ids, found, f, spot.o, i, own, slices, 1)
                                r = seen.radiance
                                value = wp.cw_mul(wp.vec3(float(r[0]), float(r[1]), float(r[2])), ls.radiance)
                        if exact == 0 and lit(spot, q, n, i):
                            terms = base_eval_pdf(base, wo, to_local(frame, ls.wi), w_diffuse, w_specular)
                            density = terms.pdf
                            if wp.static(key.light_multipliers):
                                drawn = base_eval_pdf(
                                    base, wo, to_local(frame, ls.wi), stuff.w_diffuse, stuff.w_specular
                                )
                                density = drawn.pdf
                            if wp.static(key.groove_glass):
                                density *= share
                            value = wp.cw_mul(terms.value, ls.radiance)
                            if ls.pdf > 0.0:
                                value = value * (power_heuristic(ls.pdf, density) / ls.pdf)
                        if largest(value) > 0.0:
                            total += wp.cw_mul(value, arrives(g, arrays, light, p, ls.wi, ls.distance))
                            if wp.static(key.shadows):
                                rays += float(light.shadow)
        return wp.vec4(total[0], total[1], total[2], rays)

    return facet_lit
