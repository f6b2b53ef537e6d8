"""Light that reaches a point: shadow rays, light sampling, and what a sampled direction sees (Raymond 2016 section 5).

On a scratch both ways of sampling work along the mirror cone in the measure d(phi): light sampling draws phi uniformly
from the interval in which the cone may meet the light and asks the light what lies there; cone sampling inverts the
table. They are combined by the power heuristic. A light without extent never lies on the cone; it is spread over the
kernel f(psi) = (1 - (psi / Psi)^2)^2 of section 5.2, normalised: L(psi) = 3 E / (pi Psi^2) f(psi).
"""

import warp as wp

from ..lights.cap_device import span_cap
from ..lights.light_device import Light, LightSample, Span
from ..lights.mesh_device import mesh_light_hit
from ..lights.registry import MODELS
from ..optics.frames_device import to_local
from ..optics.fresnel_device import fresnel_dielectric
from ..optics.sobol_device import sobol_2d
from ..reflectance.profile_table_device import (
    TableArrays,
    cone_direction,
    phi_bin,
    table_pdf,
    table_value,
)
from ..reflectance.responses.response_device import ResponseArrays
from .cone_device import make_cone_lights
from .geometry_device import Geometry, interpolate_uv, intersect
from .key import KernelKey
from .lobe_device import Lobe, largest, mirrored_at, multiplier, power_heuristic
from .lobe_terms_device import make_lobe_terms
from .material_device import MaterialArrays, cut_out
from .small_lights_device import SMALL, caps_of
from .world_device import LightSet

PSI = wp.constant(0.5 * 3.14159265 / 180.0)  # half the support of one degree
MOST_PASSES = 32  # transparent surfaces along one ray


def models_of(key: KernelKey):
    """The light models of a key, in order."""
    by_name = {model.name: model for model in MODELS.values()}
    return [by_name[name] for name in key.lights]


def make_transmittance(key: KernelKey, opacity_at):
    """Device function: the part of the light that arrives along a shadow ray."""

    @wp.func
    def transmittance(
        g: Geometry, arrays: MaterialArrays, origin: wp.vec3, direction: wp.vec3, distance: float, sharp: int
    ) -> float:
        """``sharp`` 1: the light has no extent, so that no path finds it through glass; it shines straight through."""
        result = float(1.0)
        if wp.static(key.shadows):
            if wp.static(key.opacity):
                start = origin
                left = distance
                for _i in range(wp.static(MOST_PASSES)):
                    if result > 0.0:
                        s = intersect(g, start, direction, left)
                        if s.face < 0:
                            return result
                        m = arrays.materials[s.material]
                        result *= 1.0 - opacity_at(arrays, m, interpolate_uv(g, s))
                        if not cut_out(m):
                            result *= m.veil
                        if wp.static(key.groove_glass):
                            if m.refracts == 1:
                                cosine = wp.abs(wp.dot(direction, s.ng))
                                result *= float(sharp) * (1.0 - fresnel_dielectric(cosine, m.ior))
                        start = s.p - s.offset * s.ng
                        left = left - s.t
                return result
            else:
                if g.empty == 0:
                    if wp.mesh_query_ray_anyhit(g.mesh, origin, direction, distance):
                        result = 0.0
        return result

    return transmittance


def make_arrives(key: KernelKey, transmittance):
    """(linked, arrives): whether a light lights an instance, and what of it reaches a point."""

    @wp.func
    def linked(lights: LightSet, light: Light, instance: int) -> bool:
        if wp.static(key.light_links):
            if light.link >= 0 and instance >= 0:
                return lights.links[light.link, instance] != wp.uint8(0)
        return True

    @wp.func
    def arrives(
        g: Geometry,
        arrays: MaterialArrays,
        light: Light,
        origin: wp.vec3,
        wi: wp.vec3,
        distance: float,
    ) -> wp.vec3:
        result = wp.vec3(1.0, 1.0, 1.0)
        if light.shadow != 0:
            reach = wp.min(distance * 0.9999, light.shadow_distance)
            t = transmittance(g, arrays, origin, wi, reach, light.delta)
            result = t * result + (1.0 - t) * light.shadow_color
        return result

    return linked, arrives


def make_direct(key: KernelKey, transmittance):
    """(direct, seen): light sampling at a point, and what a ray sampled from a lobe sees of the lights."""
    models = models_of(key)
    finite = [model.name != "dome" for model in models]
    of_mesh = [model.geometry for model in models]
    terms_of, _ = make_lobe_terms(key)
    integrated = [key.closed_form and model.arcs is not None for model in models]
    # a dome is all around: cones find it
    sought = [key.sample_lights and (near or not key.sample_cones) for near in finite]

    linked, arrives = make_arrives(key, transmittance)
    from_cone = make_cone_lights(key, models, arrives)
    caps = caps_of(key, models)

    @wp.func
    def on_base(responses: ResponseArrays, lobe: Lobe, light: Light, ls: LightSample, ng: wp.vec3) -> wp.vec3:
        wi = to_local(lobe.frame, ls.wi)
        w_diffuse = lobe.w_diffuse
        w_specular = lobe.w_specular
        if wp.static(key.light_multipliers):
            w_diffuse *= light.diffuse
            w_specular *= light.specular
        terms = terms_of(responses, lobe, wi, w_diffuse, w_specular)
        reflected = terms.value
        density = terms.pdf
        if wp.static(key.light_multipliers):
            # the lobe is sampled without knowing the light
            density = terms_of(responses, lobe, wi, lobe.w_diffuse, lobe.w_specular).pdf
        folded = to_local(lobe.frame, mirrored_at(ls.wi, ng))
        if folded[2] > 0.0:
            more = terms_of(responses, lobe, folded, w_diffuse, w_specular)
            reflected += more.value
            density += more.pdf
        value = wp.cw_mul(reflected, ls.radiance)
        if ls.pdf > 0.0:
            value = value * (power_heuristic(ls.pdf, density) / ls.pdf)
        return value

    @wp.func
    def cone_span(lights: LightSet, kind: int, light: Light, p: wp.vec3, lobe: Lobe, toward: wp.vec3) -> Span:
        span = Span()
        if light.delta == 1:
            span = span_cap(toward, PSI, lobe.frame.x, lobe.frame.y, lobe.frame.n, lobe.sin_theta)
        else:
            for j in range(wp.static(len(models))):
                if wp.static(finite[j] or sought[j]):
                    if kind == j:
                        span = wp.static(models[j].span)(
                            lights.arrays, light, p, lobe.frame.x, lobe.frame.y, lobe.frame.n, lobe.sin_theta
                        )
        return span

    @wp.func
    def direct(
        g: Geometry,
        arrays: MaterialArrays,
        tables: TableArrays,
        responses: ResponseArrays,
        lights: LightSet,
        p: wp.vec3,
        ng: wp.vec3,
        instance: int,
        lobe: Lobe,
        index: wp.uint32,
        dimension: int,
        seed: wp.uint32,
    ) -> wp.vec4:
        """Light sampling of every light, and in w the rays it took; ``p`` is already off the surface."""
        total = wp.vec3(0.0, 0.0, 0.0)
        rays = float(0.0)
        for j in range(wp.static(len(models))):
            for i in range(lights.starts[j], lights.starts[j + 1]):
                light = lights.lights[i]
                if linked(lights, light, instance):
                    u = sobol_2d(index, dimension + i, seed)
                    if lobe.scratch != 1:
                        ls = wp.static(models[j].sample)(lights.arrays, light, p, u)
                        if ls.pdf != 0.0 and wp.dot(ls.wi, ng) > 0.0:
                            value = on_base(responses, lobe, light, ls, ng)
                            if largest(value) > 0.0:
                                total += wp.cw_mul(value, arrives(g, arrays, light, p, ls.wi, ls.distance))
                                if wp.static(key.shadows):
                                    rays += float(light.shadow)
                    if wp.static(key.scratches):
                        closed = int(0)
                        if wp.static(integrated[j]):
                            if lobe.scratch == 1 and light.delta == 0:
                                closed = 1
                                wide = int(1)
                                if wp.static(caps[j] is not None):
                                    if wp.static(caps[j])(light, p)[3] < SMALL:
                                        wide = 0  # all layers were asked
                                if wide == 1:
                                    received = wp.static(from_cone[j])(g, arrays, tables, lights, light, p, ng, lobe, u)
                                    total += wp.vec3(received[0], received[1], received[2])
                                    rays += received[3]
                        if lobe.scratch == 1 and closed == 0:
                            if light.delta == 1 or wp.static(sought[j]):
                                toward = wp.vec3(0.0, 0.0, 1.0)
                                e = wp.vec3(0.0, 0.0, 0.0)
                                far = float(0.0)
                                if light.delta == 1:
                                    ls = wp.static(models[j].sample)(lights.arrays, light, p, u)
                                    toward = ls.wi
                                    e = ls.radiance
                                    far = ls.distance
                                span = cone_span(lights, j, light, p, lobe, toward)
                                if span.ok == 1 and span.hi > span.lo:
                                    phi = span.lo + u[0] * (span.hi - span.lo)
                                    w = cone_direction(lobe.frame.x, lobe.frame.y, lobe.frame.n, lobe.sin_theta, phi)
                                    row_value = table_value(
                                        tables, lobe.table, lobe.row, phi_bin(tables, phi), lobe.sin_theta
                                    )
                                    value = row_value * (wp.cos(phi) * (span.hi - span.lo))
                                    if light.delta == 1:
                                        x = wp.acos(wp.clamp(wp.dot(w, toward), -1.0, 1.0)) / PSI
                                        f = wp.max(1.0 - x * x, 0.0)
                                        value = wp.cw_mul(value, e) * (3.0 * f * f / (wp.pi * PSI * PSI))
                                        w = toward
                                    else:
                                        hit = wp.static(models[j].hit)(lights.arrays, light, p, w)
                                        if wp.static(of_mesh[j]):
                                            met = intersect(g, p, w, 1.0e10)
                                            if met.face >= 0:
                                                if met.light == i and met.outside == 1:
                                                    hit = mesh_light_hit(lights.arrays, light, p, w, met.t, met.ng)
                                        far = hit.distance
                                        weight = float(0.0)
                                        if hit.distance >= 0.0:
                                            weight = 1.0
                                            if wp.static(key.sample_cones):
                                                weight = power_heuristic(
                                                    1.0 / (span.hi - span.lo),
                                                    table_pdf(tables, lobe.table, lobe.row, phi),
                                                )
                                        value = wp.cw_mul(value, hit.radiance) * weight
                                    if wp.static(key.light_multipliers):
                                        value = value * light.specular
                                    if largest(value) > 0.0 and wp.dot(w, ng) > 0.0:
                                        total += wp.cw_mul(value, arrives(g, arrays, light, p, w, far))
                                        if wp.static(key.shadows):
                                            rays += float(light.shadow)
        total = total * lobe.scale
        return wp.vec4(total[0], total[1], total[2], rays)

    @wp.func
    def seen(
        lights: LightSet,
        p: wp.vec3,
        w: wp.vec3,
        gone: float,
        reach: float,
        instance: int,
        lobe: Lobe,
        pdf: float,
        phi: float,
        depth: int,
    ) -> wp.vec4:
        """Radiance (and in w whether any bounded light lies there) of lights along a ray, from ``gone`` to ``reach``.

        ``pdf``: density with which the ray was drawn, per solid angle or per phi on a scratch; negative: certain.
        ``depth`` 0: the camera looks.
        """
        total = wp.vec3(0.0, 0.0, 0.0)
        met = float(0.0)
        for j in range(wp.static(len(models))):
            if wp.static(not of_mesh[j]):
                for i in range(lights.starts[j], lights.starts[j + 1]):
                    light = lights.lights[i]
                    wanted = linked(lights, light, instance)
                    if depth == 0 and light.camera_visible == 0:
                        wanted = False
                    if wp.static(key.scratches and (integrated[j] or not key.sample_cones)):
                        # the scratch has counted this light already
                        if lobe.scratch == 1 and pdf > 0.0:
                            wanted = False
                    if wp.static(key.glint_paths):
                        # a diffracting scratch has, too
                        if lobe.scratch == 5:
                            wanted = False
                    if wanted:
                        hit = wp.static(models[j].hit)(lights.arrays, light, p, w)
                        if hit.distance >= gone and hit.distance < reach:
                            weight = float(1.0)
                            if pdf > 0.0:
                                other = hit.pdf
                                if wp.static(key.scratches):
                                    if lobe.scratch == 1:
                                        other = 0.0
                                        if wp.static(sought[j]):
                                            span = cone_span(lights, j, light, p, lobe, w)
                                            if span.ok == 1 and span.hi > span.lo:
                                                if phi >= span.lo and phi <= span.hi:
                                                    other = 1.0 / (span.hi - span.lo)
                                if other > 0.0:
                                    weight = power_heuristic(pdf, other)
                            radiance = hit.radiance * weight
                            if wp.static(key.light_multipliers):
                                if depth > 0:
                                    radiance = wp.cw_mul(radiance, multiplier(light, lobe))
                            total += radiance
                            if wp.static(finite[j]):
                                met = 1.0
        return wp.vec4(total[0], total[1], total[2], met)

    return direct, seen
