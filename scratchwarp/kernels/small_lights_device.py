"""Light of small lights along the cones of all scratches of a footprint, whichever of them the sample goes on from.

Few scratches lie so that a small light is on their cone, and these are bright: what a sample would see of it if one
layer were drawn for everything is nothing nearly always, and very much now and then. Which cones meet a light is told
by a product each, so each layer is asked. Of the pairs of a layer and a light that meet, one is drawn in proportion to
what it reflects if nothing is in the way, and counts for all (Talbot, Cline and Egbert 2005, with exact weights): one
shadow ray a sample, no bias.
"""

from typing import Any

import warp as wp

from ..lights.arcs_device import above_facet
from ..lights.light_device import Light
from ..optics.frames_device import Frame, frame_with_tangent
from ..optics.hash_device import pcg_hash, unit_float
from ..plan.effects import NARROW
from ..reflectance.cone_sums_device import cone_rows, value_in
from ..reflectance.profile_table_device import TableArrays, cone_direction, phi_bin
from ..scratches.layer_device import LayerHit, random_bits
from ..scratches.variation_device import varied_table
from .cone_device import locate, pieces_of
from .geometry_device import Geometry
from .key import KernelKey
from .lobe_device import Crossed, lent_tint, luminance
from .material_device import MaterialArrays
from .world_device import LightSet, ScratchSet

wp.set_module_options({"enable_backward": False})

SMALL = wp.constant(NARROW)
"""Sine of half the angle up to which lights are small."""
ASIDE = wp.constant(wp.uint32(0x2C9277B5))  # of the seed of what is drawn here


@wp.func
def _ball(light: Light, p: wp.vec3, reach: float) -> wp.vec4:
    way = light.center - p
    d = wp.max(wp.length(way), 1.0e-20)
    way = way / d
    return wp.vec4(way[0], way[1], way[2], wp.where(light.delta == 0, reach / d, 2.0))


@wp.func
def _distant(light: Light, p: wp.vec3) -> wp.vec4:
    c = light.center
    return wp.vec4(c[0], c[1], c[2], wp.where(light.delta == 0, light.half_angle, 2.0))


@wp.func
def _sphere(light: Light, p: wp.vec3) -> wp.vec4:
    return _ball(light, p, light.radius)


@wp.func
def _flat(light: Light, p: wp.vec3) -> wp.vec4:
    return _ball(light, p, wp.length(light.ex) + wp.length(light.ey))


@wp.func
def _cylinder(light: Light, p: wp.vec3) -> wp.vec4:
    return _ball(light, p, light.radius + light.half_length)


CAPS: dict[str, Any] = {
    "distant": _distant,
    "sphere": _sphere,
    "rect": _flat,
    "disk": _flat,
    "cylinder": _cylinder,
}
"""Kind of light -> device function (light, p) of the direction to its middle and the sine of half the angle that holds
it; 2: it has no extent."""


def caps_of(key: KernelKey, models: Any) -> list[Any]:
    """For each kind of light of a key its function of ``CAPS``; None where none of the kind is asked for here."""
    on = key.small_lights and key.closed_form
    return [CAPS.get(model.name) if on and model.arcs is not None else None for model in models]


def make_small_lights(key: KernelKey, models: Any, linked: Any, arrives: Any) -> Any:
    """(consider, shine): add what a layer reflects of small lights; the light of the pair drawn; None where off."""
    caps = caps_of(key, models)
    if not any(caps):
        return None
    arcs_of = [model.arcs for model in models]
    lit = [model.lit for model in models]

    @wp.func
    def consider(
        so_far: Crossed,
        scratches: ScratchSet,
        lights: LightSet,
        n: wp.vec3,
        ng: wp.vec3,
        wo: wp.vec3,
        p: wp.vec3,
        instance: int,
        number: int,
        hit: LayerHit,
        along: wp.vec3,
        phase: float,
    ) -> Crossed:
        """``number``: of the layer, whose scratches run ``along`` there and cover ``hit.alpha``."""
        r = so_far
        f = frame_with_tangent(n, along)
        sin_theta = -wp.clamp(wp.dot(wo, f.x), -1.0, 1.0)
        for j in range(wp.static(len(caps))):
            if wp.static(caps[j] is not None):
                for i in range(lights.starts[j], lights.starts[j + 1]):
                    light = lights.lights[i]
                    cap = wp.static(caps[j])(light, p)
                    size = cap[3]
                    off = cap[0] * f.x[0] + cap[1] * f.x[1] + cap[2] * f.x[2] - sin_theta
                    if size < SMALL and wp.abs(off) < 1.01 * size + 1.0e-6 and linked(lights, light, instance):
                        ends = above_facet(ng, f.x, f.y, f.n, sin_theta)
                        arcs = wp.static(arcs_of[j])(light, p, f.x, f.y, f.n, sin_theta, ends[0], ends[1])
                        if arcs.count > 0:
                            table = scratches.layers[number].table
                            if wp.static(key.variation):
                                bits = pcg_hash(pcg_hash(random_bits(phase)))
                                table = varied_table(table, scratches.variations[number], hit, bits)
                            phi_o = wp.atan2(wp.dot(wo, f.y), wp.max(wp.dot(wo, f.n), 0.0))
                            rows = cone_rows(scratches.tables, table, phi_o, sin_theta)
                            pieces = pieces_of(scratches.tables, rows, arcs)
                            weight = hit.alpha * pieces.total[3] * luminance(light.radiance)
                            if wp.static(key.light_multipliers):
                                weight *= light.specular
                            if weight > 0.0:
                                r.total += weight
                                r.bits = pcg_hash(r.bits)
                                if unit_float(r.bits) * r.total < weight:
                                    r.own = weight
                                    r.alpha = hit.alpha
                                    r.layer = number
                                    r.table = table
                                    r.kind = j
                                    r.light = i
                                    r.along = along
        return r

    @wp.func
    def brought(
        g: Geometry,
        arrays: MaterialArrays,
        tables: TableArrays,
        lights: LightSet,
        light: Light,
        f: Frame,
        sin_theta: float,
        ng: wp.vec3,
        wo: wp.vec3,
        p: wp.vec3,
        crossed: Crossed,
        u: float,
    ) -> wp.vec3:
        """What the drawn layer reflects of the drawn light, along one direction drawn by what it reflects."""
        value = wp.vec3(0.0, 0.0, 0.0)
        ends = above_facet(ng, f.x, f.y, f.n, sin_theta)
        phi_o = wp.atan2(wp.dot(wo, f.y), wp.max(wp.dot(wo, f.n), 0.0))
        rows = cone_rows(tables, crossed.table, phi_o, sin_theta)
        for j in range(wp.static(len(caps))):
            if wp.static(caps[j] is not None):
                if crossed.kind == j:
                    arcs = wp.static(arcs_of[j])(light, p, f.x, f.y, f.n, sin_theta, ends[0], ends[1])
                    pieces = pieces_of(tables, rows, arcs)
                    at = locate(tables, rows, arcs, pieces, u * pieces.total[3])
                    rho = value_in(tables, rows, at.row, phi_bin(tables, at.phi))
                    rho = rho * (pieces.total[3] / wp.max(rho[3], 1.0e-20))
                    w = cone_direction(f.x, f.y, f.n, sin_theta, at.phi)
                    hit = wp.static(lit[j])(lights.arrays, light, p, w, 0.0)
                    value = wp.cw_mul(wp.vec3(rho[0], rho[1], rho[2]), hit.radiance)
                    if wp.static(key.shadows):
                        value = wp.cw_mul(value, arrives(g, arrays, light, p, w, hit.distance))
        return value

    @wp.func
    def shine(
        g: Geometry,
        arrays: MaterialArrays,
        scratches: ScratchSet,
        lights: LightSet,
        n: wp.vec3,
        ng: wp.vec3,
        wo: wp.vec3,
        p: wp.vec3,
        f0: wp.vec3,
        crossed: Crossed,
        u: float,
    ) -> wp.vec4:
        """What all of them reflect, and in w the rays it took; ``f0``: of the base there."""
        light = lights.lights[crossed.light]
        f = frame_with_tangent(n, crossed.along)
        sin_theta = -wp.clamp(wp.dot(wo, f.x), -1.0, 1.0)
        value = brought(g, arrays, scratches.tables, lights, light, f, sin_theta, ng, wo, p, crossed, u)
        scale = crossed.alpha * (crossed.total / crossed.own)
        if wp.static(key.light_multipliers):
            scale *= light.specular
        tint = wp.vec3(1.0, 1.0, 1.0)
        if wp.static(key.tints):
            tint = lent_tint(f0, scratches.layers[crossed.layer].f0, sin_theta)
        return wp.vec4(
            scale * tint[0] * value[0], scale * tint[1] * value[1], scale * tint[2] * value[2], float(light.shadow)
        )

    return consider, shine
