"""What happens at one surface: which lobe a sample takes, where it goes on, and what the surface itself sheds."""

import warp as wp

from ..lights.mesh_device import mesh_light_hit, span_mesh
from ..optics.frames_device import Frame, frame_with_tangent, to_local, to_world
from ..reflectance.base_device import Base, base_albedo, base_fresnel
from ..reflectance.profile_table_device import TableArrays, cone_direction, table_row, table_sample
from ..reflectance.responses.response_device import ResponseArrays, Spot
from .geometry_device import Geometry, Surface, uv_motion
from .key import KernelKey
from .layers_device import make_gather
from .lobe_device import Lobe, largest, lent_tint, mirrored_at, multiplier, power_heuristic
from .lobe_terms_device import make_lobe_terms, make_place
from .material_device import MaterialArrays, MaterialData, cut_out
from .world_device import LightSet, ScratchSet

wp.set_module_options({"enable_backward": False})


@wp.struct
class Scatter:
    """Where a path goes on: direction, its density (negative: certain), phi on a cone, and f cos / density."""

    alive: int
    direction: wp.vec3
    pdf: float
    phi: float
    weight: wp.vec3
    diffuse_share: wp.vec3


def make_bounce(key: KernelKey, rotated, emission_at, small=None):
    """(choose, scatter, glow, pass_through, pass_probability), compiled for ``key``; ``small``: of
    ``make_small_lights``."""
    consider, shine = small or (None, None)
    gather = make_gather(key, consider)
    covering = make_gather(key)
    terms_of, drawn = make_lobe_terms(key)
    place = make_place(key)

    @wp.func
    def spot_of(g: Geometry, s: Surface, frame: Frame, step_x: wp.vec3, step_y: wp.vec3) -> Spot:
        spot = Spot()
        spot.uv = s.uv
        spot.jx = uv_motion(g, s, step_x)
        spot.jy = uv_motion(g, s, step_y)
        # of the mapping seen from the viewer's side; a mirrored one is mirrored back
        outward = wp.where(s.outside == 1, 1.0, -1.0)
        du = g.dpdu[s.face]
        side = wp.where(wp.dot(wp.cross(du, g.dpdv[s.face]), outward * s.ng) < 0.0, -1.0, 1.0)
        local = frame_with_tangent(outward * s.ns, du)
        spot.u_axis = outward * wp.vec2(wp.dot(local.x, frame.x), wp.dot(local.x, frame.y))
        spot.v_axis = outward * side * wp.vec2(wp.dot(local.y, frame.x), wp.dot(local.y, frame.y))
        return spot

    @wp.func
    def choose(
        g: Geometry,
        scratches: ScratchSet,
        m: MaterialData,
        s: Surface,
        frame: Frame,
        base: Base,
        wo: wp.vec3,
        through: float,
        passing: float,
        step_x: wp.vec3,
        step_y: wp.vec3,
        u_lobe: wp.vec2,
        u_more: wp.vec2,
        resolved: int,
        arrays: MaterialArrays,
        lights: LightSet,
        p: wp.vec3,
        u_aside: wp.vec2,
    ) -> Lobe:
        """Draw the scratches of one layer or the base, in proportion to what each is likely to reflect (Eq. 4)."""
        lobe = Lobe()
        lobe.scale = 1.0
        lobe.w_diffuse = 1.0
        lobe.w_specular = 1.0
        if wp.static(key.scratches):
            if m.layers > 0:
                laid = gather(
                    g, scratches, m, s, frame, step_x, step_y, u_lobe[1], u_more[1], resolved, lights, wo, p, u_aside[1]
                )
                if wp.static(shine is not None):
                    if laid.crossed.total > 0.0:
                        lobe.sent = wp.static(shine)(
                            g, arrays, scratches, lights, frame.n, s.ng, wo, p, base.f0, laid.crossed, u_aside[0]
                        )
                lobe.w_specular = 1.0 - laid.covered
                lobe.w_diffuse = 1.0 - laid.covered + laid.kept
                if laid.chosen >= 0:
                    kept = lobe.w_diffuse - lobe.w_specular
                    of_base = lobe.w_specular * largest(base_albedo(base, to_local(frame, wo)))
                    of_base += kept * largest(base.diffuse)
                    chance = laid.weight / wp.max(laid.weight + of_base, 1.0e-20)
                    if u_lobe[0] < chance:
                        layer = scratches.layers[laid.chosen]
                        lobe.scale = laid.weight / (chance * layer.weight)
                        lobe.scratch = 1
                        lobe.frame = frame_with_tangent(frame.n, laid.direction)
                        lobe.wo = to_local(lobe.frame, wo)
                        if wp.static(key.diffuse_scratches):
                            if layer.table < 0 and layer.response < 0:
                                lobe.scratch = 2
                                lobe.base.diffuse = layer.diffuse
                                lobe.base.clearcoat_alpha = 1.0
                                lobe.base.alpha_x = 1.0
                                lobe.base.alpha_y = 1.0
                                lobe.base.ior = 1.5
                                lobe.w_diffuse = 1.0
                                lobe.w_specular = 0.0
                        if wp.static(len(key.responses) > 0):
                            if layer.response >= 0:
                                lobe.scratch = 3
                                lobe.w_specular = 1.0
                                spot = spot_of(g, s, lobe.frame, step_x, step_y)
                                lobe.response = place(scratches.responses, layer.response, spot)
                        if lobe.scratch == 1:
                            lobe.table = laid.table
                            phi = wp.atan2(lobe.wo[1], wp.max(lobe.wo[2], 0.0))
                            lobe.row = table_row(scratches.tables, phi, laid.xi)
                            lobe.sin_theta = -wp.clamp(lobe.wo[0], -1.0, 1.0)
                            if wp.static(key.tints):
                                lobe.tint = lent_tint(base.f0, layer.f0, lobe.sin_theta)
                    else:
                        lobe.scale = 1.0 / (1.0 - chance)
        if lobe.scratch == 0:
            lobe.frame = frame
            if wp.static(key.measured):
                lobe.frame = rotated(frame, m)
            lobe.wo = to_local(lobe.frame, wo)
            lobe.base = base
            if wp.static(len(key.responses) > 0):
                if m.response >= 0:
                    lobe.response = place(scratches.responses, m.response, spot_of(g, s, frame, step_x, step_y))
            if wp.static(key.opacity):
                lobe.w_diffuse *= 1.0 - through
        if wp.static(key.opacity):
            # what passes through was drawn before with probability ``passing``
            lobe.scale *= 1.0 / wp.max(1.0 - passing, 1.0e-6)
            if cut_out(m):
                if lobe.scratch == 0:
                    lobe.w_specular *= 1.0 - through
                else:
                    lobe.scale *= 1.0 - through
            if wp.static(shine is not None):
                there = wp.where(cut_out(m), 1.0 - through, 1.0) / wp.max(1.0 - passing, 1.0e-6)
                lobe.sent = wp.vec4(there * lobe.sent[0], there * lobe.sent[1], there * lobe.sent[2], lobe.sent[3])
        return lobe

    @wp.func
    def scatter(
        tables: TableArrays, responses: ResponseArrays, lobe: Lobe, s: Surface, u: wp.vec2, v: float
    ) -> Scatter:
        out = Scatter()
        if wp.static(key.scratches):
            if lobe.scratch == 1:
                c = table_sample(tables, lobe.table, lobe.row, lobe.sin_theta, u[0])
                w = cone_direction(lobe.frame.x, lobe.frame.y, lobe.frame.n, lobe.sin_theta, c.phi)
                if c.pdf > 0.0:
                    out.alive = 1
                    out.direction = w
                    out.pdf = c.pdf
                    out.phi = c.phi
                    out.weight = c.weight * lobe.scale
                    if wp.static(key.tints):
                        out.weight = wp.cw_mul(out.weight, lobe.tint)
        if lobe.scratch != 1:
            b = drawn(responses, lobe, u, v)
            if b.pdf > 0.0:
                out.alive = 1
                out.direction = to_world(lobe.frame, b.wi)
                out.pdf = b.pdf
                out.weight = b.weight * lobe.scale
                if b.delta == 1:
                    out.pdf = -1.0
                else:
                    if wp.static(key.light_multipliers):
                        whole = terms_of(responses, lobe, b.wi, lobe.w_diffuse, lobe.w_specular)
                        part = terms_of(responses, lobe, b.wi, lobe.w_diffuse, 0.0)
                        for channel in range(3):
                            share = part.value[channel] / wp.max(whole.value[channel], 1.0e-20)
                            out.diffuse_share[channel] = share
                    folded = to_local(lobe.frame, mirrored_at(out.direction, s.ng))
                    if folded[2] > 0.0:
                        out.pdf += terms_of(responses, lobe, folded, lobe.w_diffuse, lobe.w_specular).pdf
        if out.alive == 1 and wp.dot(out.direction, s.ng) <= 0.0:
            out.direction = mirrored_at(out.direction, s.ng)
            if lobe.scratch == 1:
                # light sampling looks along the cone alone, so this way has to count in full
                out.pdf = -1.0
        return out

    @wp.func
    def pass_through(
        g: Geometry,
        scratches: ScratchSet,
        m: MaterialData,
        base: Base,
        s: Surface,
        frame: Frame,
        wo: wp.vec3,
        step_x: wp.vec3,
        step_y: wp.vec3,
        u_lobe: wp.vec2,
        u_more: wp.vec2,
        resolved: int,
        lights: LightSet,
    ) -> wp.vec3:
        """What specular reflection and scratches leave of light that goes straight through (all of it for cut-outs).

        Nothing passes through scratches of metal and the like; those of glass let through what glass does.
        """
        result = wp.vec3(1.0, 1.0, 1.0)
        if not cut_out(m):
            result = result - base_fresnel(base, wp.dot(s.ns, wo))
            if wp.static(key.scratches):
                if m.layers > 0:
                    laid = covering(
                        g, scratches, m, s, frame, step_x, step_y, u_lobe[1], u_more[1], resolved, lights, wo, s.p, 0.0
                    )
                    result = (1.0 - laid.covered + laid.kept) * result
        return result

    @wp.func
    def pass_probability(m: MaterialData, through: float, straight: wp.vec3) -> float:
        """How often to go on where ``straight`` goes straight on: reflection keeps its share, and a tenth at least."""
        result = through
        if not cut_out(m):
            result = wp.min(largest(straight), 0.9 * through)
        return result

    @wp.func
    def mesh_glow(
        lights: LightSet,
        s: Surface,
        origin: wp.vec3,
        direction: wp.vec3,
        distance: float,
        lobe: Lobe,
        pdf: float,
        phi: float,
        depth: int,
    ) -> wp.vec3:
        hit = mesh_light_hit(lights.arrays, lights.lights[s.light], origin, direction, distance, s.ng)
        weight = float(1.0)
        if hit.distance >= 0.0 and pdf > 0.0:
            other = hit.pdf
            if wp.static(key.scratches):
                if lobe.scratch == 1:
                    other = 0.0
                    if wp.static(key.sample_lights):
                        f = lobe.frame
                        span = span_mesh(lights.arrays, lights.lights[s.light], origin, f.x, f.y, f.n, lobe.sin_theta)
                        if span.ok == 1 and phi >= span.lo and phi <= span.hi:
                            other = 1.0 / wp.max(span.hi - span.lo, 1.0e-7)
                    if wp.static(not key.sample_cones):
                        other = 0.0
                        weight = 0.0
            if other > 0.0:
                weight = power_heuristic(pdf, other)
        radiance = hit.radiance * weight
        if wp.static(key.light_multipliers):
            if depth > 0:
                radiance = wp.cw_mul(radiance, multiplier(lights.lights[s.light], lobe))
        return radiance

    @wp.func
    def glow(
        arrays: MaterialArrays,
        lights: LightSet,
        m: MaterialData,
        s: Surface,
        origin: wp.vec3,
        direction: wp.vec3,
        distance: float,
        lobe: Lobe,
        pdf: float,
        phi: float,
        depth: int,
    ) -> wp.vec3:
        """Emission of the surface towards the ray that found it; mesh lights weighed against light sampling."""
        total = wp.vec3(0.0, 0.0, 0.0)
        if wp.static(key.emission):
            total += emission_at(arrays, m, s.uv)
        if wp.static(key.mesh_lights):
            sought = s.light >= 0 and s.outside == 1
            if wp.static(key.glint_paths):
                sought = sought and lobe.scratch != 5
            if sought:
                total += mesh_glow(lights, s, origin, direction, distance, lobe, pdf, phi, depth)
        return total

    return choose, scatter, glow, pass_through, pass_probability
