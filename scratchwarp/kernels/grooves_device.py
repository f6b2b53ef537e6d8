"""Grooves one by one in a render: where a footprint lies on their pattern, and what is seen there.

Lights without extent are exact, the mean over the footprint (``reflectance.grooves``). All else is found by paths: one
ray from a random point of the footprint finds a facet, which is lit like any surface - by light sampling and by its own
lobes, weighed against one another - but for the shadows of the other facets; a path that meets another facet goes on
there until it leaves, above or - where grooves are cut in glass - below the surface, from which it may also have come.
"""

import warp as wp

from ..optics.frames_device import Frame, frame_with_tangent, to_local, to_world
from ..optics.hash_device import pcg_hash
from ..optics.sampling_device import sample_concentric_disk
from ..optics.sobol_device import sobol_2d
from ..reflectance.base_device import DIELECTRIC, BaseSample, base_eval_pdf, base_sample
from ..reflectance.grooves.cast_device import path_of
from ..reflectance.grooves.follow_device import follow
from ..reflectance.grooves.footprint_device import slope_of
from ..reflectance.grooves.near_device import anything_near, as_array
from ..reflectance.grooves.solid_device import Piece
from .bounce_device import Scatter
from .geometry_device import Geometry, Surface, uv_motion
from .groove_arrays_device import GROOVE_ROOM, FacetStuff, GrooveArrays, GrooveSpot
from .groove_glass_device import chance_shed, chance_through, from_within, glass_base, refracted, shed_within
from .groove_light_device import GRAZING, facet_base, in_pattern, make_facet_lit, normal_of, out_of_pattern
from .key import KernelKey
from .lobe_device import Lobe, largest, mirrored_at
from .material_device import MaterialArrays
from .world_device import LightSet

wp.set_module_options({"enable_backward": False})

LOW = wp.constant(wp.float64(0.05))  # lines lower than this are not followed to the plane
SEED = wp.constant(wp.uint32(0x6A09E667))
PARTS = wp.constant(wp.uint32(0x510E527F))


@wp.struct
class GrooveLight:
    """Light that lights send along grooves to the viewer and in w the rays it took; where a path goes on: ``inside`` 1
    in the glass, ``aside`` from the surface's point, to where its line crosses the plane."""

    received: wp.vec4
    out: Scatter
    inside: int
    aside: wp.vec3


@wp.func
def aside(g: Geometry, s: Surface, spot: GrooveSpot, q: wp.vec3d, d: wp.vec3d) -> wp.vec3:
    """From the surface's point to where the line through ``q`` along ``d`` crosses the plane, or near to there."""
    result = wp.vec3(0.0, 0.0, 0.0)
    if spot.scale[0] != wp.float64(0.0):
        back = -q[2] / wp.where(d[2] < wp.float64(0.0), wp.min(d[2], -LOW), wp.max(d[2], LOW))
        u = (q[0] + back * d[0]) / spot.scale[0] - s.uv[0]
        v = (q[1] + back * d[1]) / spot.scale[1] - s.uv[1]
        result = float(u) * g.dpdu[s.face] + float(v) * g.dpdv[s.face]
    return result


def make_grooves(key: KernelKey, transmittance):
    """(spot, grooves, is_near, handed): a footprint's place on a pattern, and what is seen there, compiled for
    ``key``."""
    facet_lit = make_facet_lit(key, transmittance)

    @wp.func
    def spot_at(
        arrays: GrooveArrays, g: Geometry, s: Surface, frame: Frame, wo: wp.vec3, step_x: wp.vec3, step_y: wp.vec3,
        glass: int, resolved: int, u: wp.vec2,
    ) -> GrooveSpot:  # fmt: skip
        """The footprint whose edges are ``step_x``, ``step_y`` as an ellipse of the same area on the pattern.

        Bare glass (``glass`` 1), too, is laid out, without a groove. Of a footprint that is wider than the pattern's
        ``most`` a part as wide as that, at random by ``u``.
        """
        spot = GrooveSpot()
        number = arrays.of_face[s.face]
        outward = frame.n
        if wp.static(key.groove_glass):
            if glass == 1:
                spot.inside = 1 - s.outside
                if spot.inside == 1:
                    outward = -frame.n
                if resolved == 0:
                    number = -1
        if number >= 0:
            record = arrays.records[number]
            spot.smooth = record.smooth
            spot.grooves.paths = arrays.paths
            spot.grooves.points = arrays.points
            spot.grooves.vertices = arrays.vertices
            spot.grooves.bottom = record.bottom
            spot.grooves.top = record.top
            spot.grooves.skin = record.skin
            spot.grooves.mixed = record.mixed
            spot.grooves.wide = record.wide
            spot.grooves.sets = record.sets
            spot.grooves.first_path = record.first_path
            spot.grooves.path_count = record.path_count
            spot.grooves.first_step = record.first_step
            spot.grooves.tapers = arrays.tapers
            spot.grooves.steps = arrays.steps
            spot.grid.origin = record.origin
            spot.grid.cell = record.cell
            spot.grid.columns = record.columns
            spot.grid.rows = record.rows
            spot.grid.first = record.first
            spot.grid.halved = record.halved
            spot.grid.starts = arrays.starts
            spot.grid.items = arrays.items
            sx = record.scale[0]
            sy = record.scale[1]
            spot.scale = record.scale
            spot.frame = frame_with_tangent(outward, g.dpdu[s.face])
            flat = frame_with_tangent(wp.where(spot.inside == 1, -1.0, 1.0) * s.ng, g.dpdu[s.face])
            mx = uv_motion(g, s, flat.x)
            my = uv_motion(g, s, flat.y)
            # micrometres for a metre
            there = wp.float64(1.0e-6) * wp.mat22d(
                wp.float64(mx[0]) * sx, wp.float64(my[0]) * sx, wp.float64(mx[1]) * sy, wp.float64(my[1]) * sy
            )
            spot.there = wp.identity(n=2, dtype=wp.float64)
            spot.back = spot.there
            if wp.abs(wp.determinant(there)) > wp.float64(1.0e-9) * wp.ddot(there, there):
                spot.there = there
                spot.back = wp.inverse(there)
            spot.o = in_pattern(spot, wo)
            ax = uv_motion(g, s, step_x)
            ay = uv_motion(g, s, step_y)
            equal = wp.float64(0.5641895835477563)  # 1 / sqrt(pi)
            spot.footprint.center = wp.vec2d(s.uv[0] * sx, s.uv[1] * sy)
            spot.footprint.a1 = equal * wp.vec2d(wp.float64(ax[0]) * sx, wp.float64(ax[1]) * sy)
            spot.footprint.a2 = equal * wp.vec2d(wp.float64(ay[0]) * sx, wp.float64(ay[1]) * sy)
            wide = wp.float64(2.0) * wp.max(wp.length(spot.footprint.a1), wp.length(spot.footprint.a2))
            if wide > record.most and glass == 0:
                part = record.most / wide
                disk = sample_concentric_disk(u)
                rest = wp.float64(1.0) - part
                spot.footprint.center += rest * (
                    wp.float64(disk[0]) * spot.footprint.a1 + wp.float64(disk[1]) * spot.footprint.a2
                )
                spot.footprint.a1 = part * spot.footprint.a1
                spot.footprint.a2 = part * spot.footprint.a2
            if spot.o[2] > GRAZING:
                none = wp.vec2d(wp.float64(0.0), wp.float64(0.0))
                # what stands out of the plane casts shadows on bare ground, too
                found = bool(spot.grooves.top > wp.float64(0.0))
                if not found:
                    found = anything_near(spot.grooves, spot.grid, spot.footprint, slope_of(spot.o), none)
                if found:
                    spot.near = resolved
        if wp.static(key.groove_glass):
            if glass == 1:
                spot.near = 1
                if number < 0:
                    spot.frame = frame_with_tangent(outward, frame.x)
                    spot.there = wp.identity(n=2, dtype=wp.float64)
                    spot.back = spot.there
                    spot.grooves.skin = wp.float64(1.0e-6)
                    spot.grid.cell = wp.float64(1.0)
                    spot.o = in_pattern(spot, wo)
        return spot

    @wp.func
    def handed(arrays: GrooveArrays, face: int) -> bool:
        """Whether what diffracts of a triangle's material goes over to grooves near by."""
        number = arrays.of_face[face]
        result = bool(False)
        if number >= 0:
            result = arrays.records[number].handover == 2
        return result

    @wp.func
    def is_near(arrays: GrooveArrays, g: Geometry, s: Surface, step_x: wp.vec3, step_y: wp.vec3) -> float:
        """How often grooves are laid out under a footprint: always, or less and less where it is many of them wide."""
        result = float(1.0)
        number = arrays.of_face[s.face]
        if number >= 0:
            record = arrays.records[number]
            if record.handover > 0:
                ax = uv_motion(g, s, step_x)
                ay = uv_motion(g, s, step_y)
                sx = float(record.scale[0])
                sy = float(record.scale[1])
                wide = wp.length(wp.vec2(ax[0] * sx, ax[1] * sy)) + wp.length(wp.vec2(ay[0] * sx, ay[1] * sy))
                ratio = 0.5641896 * wide / float(record.width)
                t = wp.clamp((arrays.far - ratio) / (arrays.far - arrays.near), 0.0, 1.0)
                result = t * t * (3.0 - 2.0 * t)
        return result

    @wp.func
    def grooves(
        data: GrooveArrays, g: Geometry, arrays: MaterialArrays, lights: LightSet, spot: GrooveSpot, lobe: Lobe,
        s: Surface, lifted: wp.vec3, u: wp.vec2, v: float, index: wp.uint32, pair: int, dimension: int,
        seed: wp.uint32, glass: int, clear: float,
    ) -> GrooveLight:  # fmt: skip
        """What a footprint shows of the lights, and one path that leaves it; ``lobe`` is that of the surface's base.

        ``glass`` 1: what facets do not reflect goes through, as much of it as ``clear``.
        """
        result = GrooveLight()
        out = Scatter()
        room = wp.zeros(shape=GROOVE_ROOM, dtype=Piece)
        spot.grooves.pieces = as_array(room)
        stuff = FacetStuff()
        stuff.base = lobe.base
        stuff.w_diffuse = lobe.w_diffuse
        stuff.w_specular = lobe.w_specular
        stuff.x = to_local(spot.frame, lobe.frame.x)
        stuff.there = spot.there
        stuff.back = spot.back
        stuff.own = data.own
        stuff.smooth = spot.smooth
        stuff.bases = data.bases
        p = lifted
        ng = s.ng
        if wp.static(key.groove_glass):
            if glass == 1:
                stuff.base = glass_base(lobe.base)
                stuff.clear = clear
                if spot.inside == 1:
                    p = s.p - s.offset * s.ng
                    ng = -s.ng
        more = pcg_hash(seed ^ SEED)
        disk = sample_concentric_disk(sobol_2d(index, pair, more))
        f = spot.footprint
        at = f.center + wp.float64(disk[0]) * f.a1 + wp.float64(disk[1]) * f.a2
        above = spot.grooves.top + wp.float64(1.0e6) * spot.grooves.skin
        if wp.static(key.groove_glass):
            if spot.inside == 1:
                above = spot.grooves.bottom - wp.float64(1.0e6) * spot.grooves.skin
        slope = slope_of(spot.o)
        start = wp.vec3d(at[0] + above * slope[0], at[1] + above * slope[1], above)
        d = -spot.o
        ids = wp.zeros(shape=GROOVE_ROOM, dtype=int)
        weight = wp.vec3(lobe.scale, lobe.scale, lobe.scale)
        bounce = int(0)
        going = int(1)
        drawn = wp.vec2(u[0], u[1])
        choice = float(v)
        lights_seed = wp.uint32(seed)
        inside = int(spot.inside)
        hit = follow(spot.grooves, spot.grid, start, d, 0, inside, ids, GROOVE_ROOM)
        while going == 1:
            going = int(0)
            if hit.distance < wp.float64(wp.inf):
                q = start + hit.distance * d
                n = hit.normal
                base = facet_base(stuff, path_of(spot.grooves, hit.piece))
                chance = float(0.0)  # of going through
                if wp.static(key.groove_glass):
                    if inside == 1:
                        n = -n
                        base = from_within(base)
                frame = frame_with_tangent(normal_of(spot, n), lobe.frame.x)
                own_wo = to_local(frame, out_of_pattern(spot, -d))
                if wp.static(key.groove_glass):
                    if stuff.clear > 0.0 and base.fresnel == DIELECTRIC:
                        chance = chance_through(base, own_wo, stuff.clear, stuff.w_diffuse)
                if inside == 0:
                    received = facet_lit(
                        g, arrays, lights, spot, stuff, bounce, base, 1.0 - chance, frame, own_wo, q, n, p, ng,
                        s.instance, data.slices, index, dimension, lights_seed,
                    )  # fmt: skip
                    result.received += wp.cw_mul(wp.vec4(weight[0], weight[1], weight[2], 1.0), received)
                b = BaseSample()
                shed = float(0.0)  # chance of the diffuse lobe from within
                if wp.static(key.groove_glass):
                    if inside == 1 and stuff.w_diffuse > 0.0:
                        shed = chance_shed(base, own_wo, chance, stuff.w_diffuse)
                if choice >= chance + shed:
                    choice = (choice - chance - shed) / (1.0 - chance - shed)
                    b = base_sample(base, own_wo, drawn, choice, stuff.w_diffuse, stuff.w_specular)
                    if wp.static(key.groove_glass):
                        b.pdf *= 1.0 - chance - shed
                        b.weight = b.weight / (1.0 - chance - shed)
                elif wp.static(key.groove_glass) and choice >= chance:
                    b = shed_within(base, own_wo, drawn, stuff.w_diffuse, shed)
                elif wp.static(key.groove_glass):
                    gone = refracted(base, own_wo, drawn, stuff.clear, chance)
                    b.wi = gone.wi
                    b.weight = wp.vec3(gone.weight, gone.weight, gone.weight)
                    b.pdf = wp.where(gone.weight > 0.0, 1.0, 0.0)
                    b.delta = 1
                    inside = 1 - inside
                    n = -n
                if b.pdf > 0.0:
                    weight = wp.cw_mul(weight, b.weight)
                    away = to_world(frame, b.wi)
                    d = in_pattern(spot, away)
                    start = q + wp.float64(2.0) * spot.grooves.skin * n
                    hit = follow(spot.grooves, spot.grid, start, d, 0, inside, ids, GROOVE_ROOM)
                    if hit.distance == wp.float64(wp.inf):
                        if d[2] * wp.float64(1 - 2 * inside) > wp.float64(0.0):
                            out.alive = 1
                            out.direction = away
                            out.pdf = wp.where(b.delta == 1 or inside == 1, -1.0, b.pdf)
                            out.weight = weight
                            if wp.static(key.groove_glass):
                                result.inside = inside
                                if inside + spot.inside > 0:
                                    result.aside = aside(g, s, spot, start, d)
                            beyond = wp.where(inside == 1, -1.0, 1.0) * ng
                            if wp.dot(away, beyond) <= 0.0:
                                out.direction = mirrored_at(away, beyond)
                                out.pdf = -1.0
                            if wp.static(key.light_multipliers):
                                whole = base_eval_pdf(base, own_wo, b.wi, stuff.w_diffuse, stuff.w_specular)
                                part = base_eval_pdf(base, own_wo, b.wi, stuff.w_diffuse, 0.0)
                                for c in range(3):
                                    out.diffuse_share[c] = part.value[c] / wp.max(whole.value[c], 1.0e-20)
                    elif wp.static(key.groove_bounces):
                        if bounce < data.bounces and largest(weight) > 0.0:
                            bounce += 1
                            going = int(1)
                            again = pcg_hash(more + wp.uint32(bounce))
                            lights_seed = pcg_hash(again ^ SEED)
                            drawn = sobol_2d(index, pair, again)
                            choice = sobol_2d(index, pair + 1, again)[0]
        result.out = out
        return result

    return spot_at, grooves, is_near, handed
