"""The kernel: one thread a pixel, all of a launch's samples, the code of one KernelKey."""

from functools import lru_cache

import warp as wp

from ..optics.frames_device import Frame, to_local
from ..optics.hash_device import pcg_hash, pixel_seed
from ..optics.sobol_device import sobol_2d
from ..reflectance.base_device import Base, base_albedo
from .base_at_device import make_base_at
from .bounce_device import Scatter, make_bounce
from .camera_device import CameraData, footprint_step, lens_point, orthographic_ray, perspective_ray
from .direct_device import MOST_PASSES, make_arrives, make_direct, make_transmittance, models_of
from .film_device import FilmArrays, Window
from .geometry_device import (
    Geometry,
    Surface,
    interpolate_normal,
    interpolate_tangent,
    interpolate_uv,
    intersect,
    lifted,
)
from .glint_paths_device import way_taken
from .glints_device import left_of_base, less_specular, make_glints
from .grooves_device import PARTS, make_grooves
from .highlights_device import highlights_of, make_place
from .key import KernelKey
from .lobe_device import Lobe, largest, luminance
from .material_device import MaterialArrays
from .small_lights_device import ASIDE, make_small_lights
from .stamp import stamp
from .world_device import LightSet, ScratchSet

# Sample dimensions: pair 0 the filter, 1 the lens, then for each surface OWN pairs and one a light.
OWN_PAIRS = 4


@lru_cache(maxsize=256)
def make_kernel(key: KernelKey):
    """The render kernel of a key; the same key gives the same kernel."""
    number = stamp(key)
    camera_ray = orthographic_ray if key.orthographic else perspective_ray
    place_of = make_place(key.filter, key.highlights)
    base_at, opacity_at, emission_at, frame_at, rotated = make_base_at(key)
    transmittance = make_transmittance(key, opacity_at)
    direct, seen = make_direct(key, transmittance)
    glints = make_glints(key, transmittance) if key.glints else None
    spot_at, grooves, is_near, handed = make_grooves(key, transmittance) if key.grooves else (None,) * 4
    small = make_small_lights(key, models_of(key), *make_arrives(key, transmittance)) if key.small_lights else None
    choose, scatter, glow, pass_through, pass_probability = make_bounce(key, rotated, emission_at, small)

    @wp.kernel(module="unique", module_options={"enable_backward": False})
    def render_pixels(
        window: Window,
        camera: CameraData,
        g: Geometry,
        arrays: MaterialArrays,
        scratches: ScratchSet,
        lights: LightSet,
        film: FilmArrays,
    ):
        tid = wp.tid()
        if wp.static(number) == 0:  # never: the stamp makes the module's name that of this device code
            return
        column = window.tile_x + tid % window.tile_w
        line = window.tile_y + tid // window.tile_w
        px = window.x0 + column
        py = window.y0 + line
        seed = pixel_seed(px, py, window.seed)
        nlights = lights.starts[wp.static(len(key.lights))]
        own_seed = seed
        near = wp.vec2i(0, 0)
        ways = int(1)
        bright = float(0.0)
        if wp.static(key.highlights):
            near = highlights_of(lights.highlights, px, py)
            ways = wp.where(near[1] > near[0], 2, 1)

        for trial in range(ways * window.count):
            place = place_of(lights.highlights, near, window.first, trial, own_seed, window.filter_width)
            index = place.index
            seed = place.seed
            extra = place.extra
            jitter = place.at
            weight = camera.exposure * place.weight
            lens = wp.vec2(0.0, 0.0)
            if wp.static(key.lens):
                lens = lens_point(sobol_2d(index, 1, seed))
            ray = wp.static(camera_ray)(camera, float(px) + 0.5 + jitter[0], float(py) + 0.5 + jitter[1], lens)
            start = ray.origin + ray.start * ray.direction
            direction = ray.direction
            reach = ray.reach - ray.start

            lobe = Lobe()
            throughput = wp.vec3(weight, weight, weight)
            color = wp.vec3(0.0, 0.0, 0.0)
            part_base = wp.vec3(0.0, 0.0, 0.0)
            part_scratch = wp.vec3(0.0, 0.0, 0.0)
            first_scratch = int(0)
            rays = int(0)
            alpha = float(0.0)
            traveled = float(ray.start)  # from the camera to the last surface, along the path
            depth = int(0)
            most = int(window.max_depth)  # surfaces; those of glass that are gone through do not count
            passes = int(0)
            within = int(-1)  # glass of the last surface: 1 in it, 0 outside
            veil = float(1.0)  # what all that was passed through lets through
            pdf = float(-1.0)
            phi = float(0.0)
            instance = int(-1)
            origin = start  # of the straight segment that the path is on
            gone = float(0.0)  # part of it that lies behind
            alive = wp.where(weight > 0.0 or extra == 0, 1, 0)
            while alive == 1:
                entered = depth
                lit = wp.vec3(0.0, 0.0, 0.0)  # what this surface reflects
                diffracted = wp.vec3(0.0, 0.0, 0.0)
                s = Surface()
                s.face = -1
                known = wp.vec4(0.0, 0.0, 0.0, 0.0)
                last = int(0)
                if wp.static(not (key.emission or key.mesh_lights or key.opacity)):
                    if depth >= window.max_depth:
                        # nothing but lights can be found: look for geometry only where there is one to hide
                        last = 1
                        known = seen(
                            lights, origin, direction, gone, 1.0e30, instance, lobe, pdf, phi, depth
                        )  # fmt: skip
                if last == 0 or known[0] + known[1] + known[2] > 0.0:
                    s = intersect(g, start, direction, reach)
                    rays += 1
                    limit = wp.where(s.face >= 0, gone + s.t, 1.0e30)
                    known = seen(
                        lights, origin, direction, gone, limit, instance, lobe, pdf, phi, depth
                    )  # fmt: skip
                found = wp.cw_mul(throughput, wp.vec3(known[0], known[1], known[2]))
                if depth == 0 and known[3] > 0.0:
                    alpha = 1.0
                alive = 0
                if s.face >= 0 and last == 0:
                    wo = -direction
                    m = arrays.materials[s.material]
                    s.ns = interpolate_normal(g, s, wo)
                    s.uv = interpolate_uv(g, s)
                    pair = 2 + (depth + passes) * (wp.static(OWN_PAIRS) + nlights)
                    u_lobe = sobol_2d(index, pair, seed)
                    u_base = sobol_2d(index, pair + 1, seed)
                    u_more = sobol_2d(index, pair + 2, seed)
                    frame = Frame()
                    base = Base()
                    step_x = wp.vec3(0.0, 0.0, 0.0)
                    step_y = wp.vec3(0.0, 0.0, 0.0)
                    if wp.static(key.opacity) or depth < window.max_depth:
                        tangent = wp.vec3(0.0, 0.0, 0.0)
                        if wp.static(key.directed):
                            # other materials keep the samples that they have without any tangents
                            if m.layers > 0 or m.alpha_x != m.alpha_y or m.response >= 0:
                                tangent = interpolate_tangent(g, s)
                        frame = frame_at(g, arrays, m, s, tangent, wo)
                        # edges of the footprint in the triangle's plane
                        far = float(1.0)
                        if wp.static(not key.orthographic):
                            far = (traveled + (gone + s.t)) / wp.length(ray.raw)
                        step_x = far * (camera.pixel_x * camera.footprint) * camera.right
                        step_y = far * (-camera.pixel_y * camera.footprint) * camera.up
                        if depth > 0:
                            step_y = frame.y * wp.length(step_y)
                            step_x = frame.x * wp.length(step_x)
                        step_x = footprint_step(step_x, direction, s.ng)
                        step_y = footprint_step(step_y, direction, s.ng)
                        base = base_at(g, arrays, m, s)
                    through = float(0.0)
                    passing = float(0.0)
                    glass = int(0)
                    if wp.static(key.groove_glass):
                        glass = m.refracts
                    if wp.static(key.opacity):
                        if passes < wp.static(MOST_PASSES):
                            through = 1.0 - opacity_at(arrays, m, s.uv)
                    resolved = int(1)  # grooves are laid out here
                    if wp.static(key.groove_handover):
                        laid_out = is_near(scratches.grooves, g, s, step_x, step_y)
                        if sobol_2d(index, pair + 3, seed)[1] >= laid_out:
                            resolved = 0
                    straight = wp.vec3(1.0, 1.0, 1.0)
                    if wp.static(key.opacity):
                        if through > 0.0 and glass == 0:
                            straight = through * pass_through(
                                g, scratches, m, base, s, frame, wo, step_x, step_y, u_lobe, u_more, resolved,
                                lights,
                            )  # fmt: skip
                            passing = pass_probability(m, through, straight)
                    if wp.static(key.groove_glass):
                        # what left grooves aside of where it met them starts on the wrong side where the surface bends
                        if glass == 1 and instance == s.instance and within == s.outside:
                            passing = wp.where(passes < wp.static(MOST_PASSES), 1.0, 0.0)
                    if wp.static(key.opacity) and sobol_2d(index, pair + 3, seed)[0] < passing:
                        throughput = wp.cw_mul(throughput, straight / passing)
                        veil *= luminance(straight) / passing
                        passes += 1
                        gone += s.t
                        start = s.p - s.offset * s.ng
                        alive = 1
                    else:
                        if depth == 0:
                            alpha = 1.0
                        traveled += gone + s.t
                        glowing = glow(arrays, lights, m, s, origin, direction, gone + s.t, lobe, pdf, phi, depth)
                        found += wp.cw_mul(throughput, glowing)
                        if depth < most or glass == 1:
                            p = lifted(g, s)
                            kept = wp.vec3(1.0, 1.0, 1.0)
                            if wp.static(key.glint_paths):
                                way = wp.vec3(0.0, 0.0, 0.0)
                                carried = wp.vec3(0.0, 0.0, 0.0)
                            if wp.static(key.glints):
                                shining = scratches.glints.material[s.material] >= 0
                                if wp.static(key.groove_handover):
                                    shining = shining and not (resolved == 1 and handed(scratches.grooves, s.face))
                                if shining:
                                    closeness = float(0.0)
                                    if wp.static(not key.orthographic):
                                        closeness = 1.0 / wp.max(traveled, 1.0e-20)
                                    sparkle = glints(
                                        scratches.glints, lights, g, arrays, s, frame, p, wo, step_x, step_y,
                                        closeness, index, pair + wp.static(OWN_PAIRS), seed,
                                    )  # fmt: skip
                                    diffracted = wp.cw_mul(throughput, sparkle.radiance)
                                    if wp.static(key.opacity):
                                        diffracted = diffracted * ((1.0 - through) / wp.max(1.0 - passing, 1.0e-6))
                                    if wp.static(key.glint_paths):
                                        way = sparkle.way
                                        carried = wp.cw_mul(throughput, sparkle.carried)
                                        if wp.static(key.opacity):
                                            carried = carried * ((1.0 - through) / wp.max(1.0 - passing, 1.0e-6))
                                    rays += int(sparkle.rays)
                                    kept = left_of_base(base, sparkle.left)
                                    base = less_specular(base, sparkle.left)
                            clear = float(0.0)
                            if wp.static(key.groove_glass):
                                if glass == 1:
                                    clear = through
                                    through = 0.0
                            u_aside = wp.vec2(0.0, 0.0)
                            if wp.static(small is not None):
                                u_aside = sobol_2d(index, pair, pcg_hash(seed ^ ASIDE))
                            lobe = choose(
                                g, scratches, m, s, frame, base, wo, through, passing, step_x, step_y, u_lobe, u_more,
                                resolved, arrays, lights, p, u_aside,
                            )  # fmt: skip
                            received = wp.vec4(0.0, 0.0, 0.0, 0.0)
                            out = Scatter()
                            grooved = int(0)
                            crossed = int(0)
                            onward = p
                            within = -1
                            if wp.static(key.grooves):
                                if lobe.scratch == 0:
                                    where = sobol_2d(index, pair, pcg_hash(seed ^ PARTS))
                                    spot = spot_at(
                                        scratches.grooves, g, s, frame, wo, step_x, step_y, glass, resolved, where
                                    )
                                    if spot.near == 1:
                                        if wp.static(key.groove_glass):
                                            # clear: of what scratches leave, what is not the diffuse lobe's
                                            whole = clear * lobe.w_diffuse
                                            lobe.w_diffuse *= 1.0 - clear
                                            clear = whole
                                        grooved = 1
                                        lobe.scratch = 4
                                        there = grooves(
                                            scratches.grooves, g, arrays, lights, spot, lobe, s, p, u_base,
                                            u_more[1], index, pair, pair + wp.static(OWN_PAIRS), seed, glass, clear,
                                        )  # fmt: skip
                                        received = there.received
                                        out = there.out
                                        if wp.static(key.groove_glass):
                                            crossed = wp.where(there.inside == spot.inside, 0, 1)
                                            if glass == 1:
                                                within = there.inside
                                            if within == 1 or crossed == 1:
                                                rise = wp.abs(wp.dot(out.direction, s.ng))
                                                onward = s.p + there.aside
                                                onward += s.offset / wp.max(rise, 0.05) * out.direction
                            if depth == 0:
                                first_scratch = lobe.scratch
                            instance = s.instance
                            if wp.static(not key.grooves) or grooved == 0:
                                received = direct(
                                    g, arrays, scratches.tables, scratches.responses, lights, p, s.ng, instance,
                                    lobe, index, pair + wp.static(OWN_PAIRS), seed,
                                )  # fmt: skip
                                out = scatter(scratches.tables, scratches.responses, lobe, s, u_base, u_more[1])
                            if wp.static(small is not None):
                                arriving = throughput
                            if wp.static(key.glints):
                                if lobe.scratch == 0:
                                    throughput = wp.cw_mul(throughput, kept)
                            if wp.static(key.groove_glass):
                                if depth >= most:
                                    received = wp.vec4(0.0, 0.0, 0.0, received[3])
                                    out.alive = wp.where(crossed == 1 or within == 1, out.alive, 0)
                            lit = wp.cw_mul(throughput, wp.vec3(received[0], received[1], received[2]))
                            if wp.static(key.tints):
                                if lobe.scratch == 1:
                                    lit = wp.cw_mul(lit, lobe.tint)
                            if wp.static(small is not None):
                                if depth < most:
                                    sent = wp.vec3(lobe.sent[0], lobe.sent[1], lobe.sent[2])
                                    if depth == 0:
                                        diffracted += wp.cw_mul(arriving, sent)
                                    else:
                                        lit += wp.cw_mul(arriving, sent)
                                    rays += int(lobe.sent[3])
                            rays += int(received[3])
                            step = wp.cw_mul(throughput, out.weight)
                            lobe.diffuse_share = out.diffuse_share
                            if wp.static(key.glint_paths):
                                turn = way_taken(carried, step, out.alive, sobol_2d(index, pair + 3, seed)[1])
                                step = turn[1] * step
                                if turn[0] > 0.0:
                                    lobe.scratch = 5
                                    out.alive = 1
                                    out.pdf = -1.0
                                    out.direction = way
                                    step = turn[1] * carried
                            if depth == 0 and extra == 0:
                                film.normal[line, column] = film.normal[line, column] + frame.n
                                film.albedo[line, column] = film.albedo[line, column] + base_albedo(
                                    base, to_local(frame, wo)
                                )
                                film.position[line, column] = film.position[line, column] + s.p
                                away = -wp.dot(s.p - ray.origin, camera.back)
                                film.depth[line, column] = film.depth[line, column] + away
                                film.hits[line, column] = film.hits[line, column] + 1
                                if away < film.nearest[line, column]:
                                    film.nearest[line, column] = away
                                    film.instance[line, column] = s.instance
                            depth += 1
                            keep = float(1.0)
                            if wp.static(key.path):
                                if depth >= 4:
                                    keep = wp.clamp(largest(step) / wp.max(camera.exposure, 1.0e-20), 0.02, 0.95)
                            if out.alive == 1 and u_more[0] < keep:
                                throughput = step / keep
                                direction = out.direction
                                start = p
                                if wp.static(key.groove_glass):
                                    start = onward
                                    if crossed == 1 or within == 1:
                                        most = wp.min(most + 1, window.max_depth + wp.static(MOST_PASSES))
                                origin = start
                                gone = 0.0
                                reach = 1.0e10
                                pdf = out.pdf
                                phi = out.phi
                                alive = 1
                color += found + lit + diffracted
                # light and glow that the camera sees directly belong to no lobe
                part = lit + wp.where(entered > 0, 1.0, 0.0) * found
                part_scratch += diffracted
                if first_scratch > 0:
                    part_scratch += part
                else:
                    part_base += part
                if wp.static(key.glint_paths):
                    if entered == 0 and lobe.scratch == 5:
                        first_scratch = 5  # what comes this way

            if wp.isfinite(color[0] + color[1] + color[2]):
                film.color[line, column] = film.color[line, column] + color
                film.base[line, column] = film.base[line, column] + part_base
                film.scratches[line, column] = film.scratches[line, column] + part_scratch
                y = luminance(color)
                if wp.static(key.highlights):
                    # of a pair together
                    y += float(extra) * bright
                    bright = y
                    y = wp.where(extra == ways - 1, y, 0.0)
                film.square[line, column] = film.square[line, column] + y * y
            else:
                bright = 0.0
                film.invalid[line, column] = film.invalid[line, column] + 1
            if wp.static(key.opacity):
                if alpha == 0.0:
                    alpha = 1.0 - veil
            if extra == 0:
                film.alpha[line, column] = film.alpha[line, column] + alpha
            film.rays[line, column] = film.rays[line, column] + rays

    return render_pixels
