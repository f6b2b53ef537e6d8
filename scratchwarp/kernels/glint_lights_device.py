"""One scratch under the lights of a scene: its diffracted radiance, in closed form across each light.

Lights are cut into slices of constant xi_1; of those that the scratch's Gaussian reaches, a few are taken, and over
each the light's intervals of xi_2 are integrated exactly (``interval_device``, ``response_device``).
"""

import warp as wp

from ..lights.light_device import Light, LightArrays
from ..optics.frames_device import to_local
from ..optics.sobol_device import sobol_2d
from ..reflectance.diffraction.interval_device import (
    behind_edge,
    cap_extent,
    cut_cap,
    edge_turn,
)
from ..reflectance.diffraction.response_device import along_variance
from .direct_device import models_of
from .geometry_device import Geometry
from .glint_arrays_device import MOST_SLICES, GlintArrays, Strand, WaveLayer, WaveMaterial
from .glint_dome_device import CELLS, make_dome_light
from .glint_sums_device import REACH, View, as_xi2, cosine_of, make_glint_sums, slice_at
from .key import KernelKey
from .lobe_device import largest
from .material_device import MaterialArrays
from .world_device import LightSet

_CORNERS = wp.constant(12)  # of the polygon that stands for a disk
FLAT = ("rect", "disk", "cylinder", "mesh")
_MOST_KNOWN = 8  # lights whose visibility is kept from scratch to scratch
KNOWN = _MOST_KNOWN + CELLS
"""What is kept from scratch to scratch: of lights, and of cells of the hemisphere under a dome."""


def make_strand_light(key: KernelKey, transmittance):
    """Device function: the light that one scratch sends to the viewer, compiled for the lights of ``key``."""
    models = models_of(key)
    names = [model.name for model in models]
    xi1_slices, radiance_of, radiance_from = make_glint_sums(
        key.glint_method, key.glint_gratings, key.glint_lookup, key.glint_numeric, key.glint_pairs, key.glint_fringes
    )
    dome_light = make_dome_light(key, transmittance, radiance_of)

    @wp.func
    def cap_light(
        a: GlintArrays,
        wave: WaveMaterial,
        layer: WaveLayer,
        strand: Strand,
        view: View,
        axis: wp.vec3,
        half_angle: float,
    ) -> wp.vec3:
        total = wp.vec3(0.0, 0.0, 0.0)
        e = cap_extent(axis, half_angle)
        s = xi1_slices(a, view, e.low, e.high, 1)
        if s.count > 0:
            places = wp.zeros(shape=MOST_SLICES, dtype=wp.vec3)
            cuts = wp.zeros(shape=MOST_SLICES, dtype=wp.vec4)
            for i in range(s.count):
                at = slice_at(a, s, i)
                psi = cut_cap(axis, half_angle, at[0])
                cuts[i] = as_xi2(view.o, at[0], psi)
                cosine = cosine_of(view.o, at[0], 0.5 * (psi[0] + psi[1]))
                places[i] = wp.vec3(at[0] + view.o[0] + view.shift, at[1], cosine)
            total = radiance_of(a, wave, layer, strand, view, s.whole, s.count, places, cuts)
        return total

    @wp.func
    def polygon_light(
        a: GlintArrays,
        wave: WaveMaterial,
        layer: WaveLayer,
        strand: Strand,
        view: View,
        corners: wp.array(dtype=wp.vec3),
        count: int,
    ) -> wp.vec3:
        """A convex polygon given by its corners in the frame of the strand, from the shading point."""
        total = wp.vec3(0.0, 0.0, 0.0)
        center = wp.vec3(0.0, 0.0, 0.0)
        for k in range(count):
            center += corners[k]
        low = float(2.0)
        high = float(-2.0)
        ahead = int(1)
        behind = int(1)
        normals = wp.zeros(shape=12, dtype=wp.vec3)
        for k in range(count):
            p = corners[k]
            q = corners[wp.where(k + 1 < count, k + 1, 0)]
            reached = p[0] / wp.max(wp.length(p), 1.0e-30)
            low = wp.min(low, reached)
            high = wp.max(high, reached)
            turn = edge_turn(p, q)
            if turn < 2.0:
                low = wp.min(low, turn)
                high = wp.max(high, turn)
            m = wp.cross(p, q - p)
            length = wp.length(m)
            if length > 0.0:
                m = m / length
            if wp.dot(m, center) < 0.0:
                m = -m
            normals[k] = m
            if m[0] < 0.0:
                ahead = 0
            if m[0] > 0.0:
                behind = 0
        if ahead == 1:
            high = 1.0
        if behind == 1:
            low = -1.0
        s = xi1_slices(a, view, low, high, 0)
        if s.count > 0:
            places = wp.zeros(shape=MOST_SLICES, dtype=wp.vec3)
            cuts = wp.zeros(shape=MOST_SLICES, dtype=wp.vec4)
            for i in range(s.count):
                at = slice_at(a, s, i)
                psi = wp.vec4(-0.5 * wp.pi, 0.5 * wp.pi, 0.0, 0.0)
                for k in range(count):
                    psi = behind_edge(psi, normals[k], at[0])
                cuts[i] = as_xi2(view.o, at[0], psi)
                cosine = cosine_of(view.o, at[0], 0.5 * (psi[0] + psi[1]))
                places[i] = wp.vec3(at[0] + view.o[0] + view.shift, at[1], cosine)
            total = radiance_of(a, wave, layer, strand, view, s.whole, s.count, places, cuts)
        return total

    @wp.func
    def flat_light(
        a: GlintArrays,
        wave: WaveMaterial,
        layer: WaveLayer,
        strand: Strand,
        view: View,
        arrays: LightArrays,
        light: Light,
        kind: int,
        p: wp.vec3,
    ) -> wp.vec3:
        """Rect, disk, cylinder and mesh lights of radiance 1 as polygons."""
        total = wp.vec3(0.0, 0.0, 0.0)
        corners = wp.zeros(shape=12, dtype=wp.vec3)
        center = light.center - p
        for j in range(wp.static(len(models))):
            if wp.static(names[j] == "rect"):
                if kind == j:
                    corners[0] = to_local(strand.frame, center - light.ex - light.ey)
                    corners[1] = to_local(strand.frame, center + light.ex - light.ey)
                    corners[2] = to_local(strand.frame, center + light.ex + light.ey)
                    corners[3] = to_local(strand.frame, center - light.ex + light.ey)
                    total = polygon_light(a, wave, layer, strand, view, corners, 4)
            if wp.static(names[j] == "disk"):
                if kind == j:
                    # the polygon of the same area
                    grow = wp.sqrt(wp.pi / (6.0 * wp.sin(wp.pi / 6.0)))
                    for k in range(_CORNERS):
                        angle = float(k) * wp.pi / 6.0
                        rim = wp.cos(angle) * light.ex + wp.sin(angle) * light.ey
                        corners[k] = to_local(strand.frame, center + grow * rim)
                    total = polygon_light(a, wave, layer, strand, view, corners, 12)
            if wp.static(names[j] == "cylinder"):
                if kind == j:
                    q = -center - wp.dot(-center, light.ex) * light.ex
                    far = wp.length(q)
                    if far > light.radius:
                        q = q / far
                        aside = wp.cross(light.ex, q)
                        cosine = light.radius / far
                        sine = wp.sqrt((1.0 - cosine) * (1.0 + cosine))
                        one = center + light.radius * (cosine * q + sine * aside)
                        two = center + light.radius * (cosine * q - sine * aside)
                        end = light.half_length * light.ex
                        corners[0] = to_local(strand.frame, one - end)
                        corners[1] = to_local(strand.frame, one + end)
                        corners[2] = to_local(strand.frame, two + end)
                        corners[3] = to_local(strand.frame, two - end)
                        total = polygon_light(a, wave, layer, strand, view, corners, 4)
            if wp.static(names[j] == "mesh"):
                if kind == j:
                    for k in range(light.count):
                        first = 3 * (light.first + k)
                        x = arrays.triangles[first] - p
                        y = arrays.triangles[first + 1] - p
                        z = arrays.triangles[first + 2] - p
                        if wp.dot(wp.cross(y - x, z - x), x) < 0.0:
                            corners[0] = to_local(strand.frame, x)
                            corners[1] = to_local(strand.frame, y)
                            corners[2] = to_local(strand.frame, z)
                            total += polygon_light(a, wave, layer, strand, view, corners, 3)
        return total

    @wp.func
    def strand_light(
        a: GlintArrays,
        strand: Strand,
        lights: LightSet,
        g: Geometry,
        arrays: MaterialArrays,
        p: wp.vec3,
        ng: wp.vec3,
        instance: int,
        wo: wp.vec3,
        closeness: float,
        known: wp.array(dtype=wp.vec4),
        index: wp.uint32,
        dimension: int,
        seed: wp.uint32,
    ) -> wp.vec4:
        """Radiance, and in w the shadow rays. ``closeness``: 1 / distance of the viewer [1/m]; ``known``: what of each
        of the first lights arrives at ``p``, w 1 where that was found out."""
        total = wp.vec3(0.0, 0.0, 0.0)
        rays = float(0.0)
        layer = a.layers[strand.layer]
        wave = a.waves[layer.wave]
        view = View()
        view.o = to_local(strand.frame, wo)
        longest = along_variance(wave.sigma, wave.longest)
        for j in range(wp.static(len(models))):
            for n in range(lights.starts[j], lights.starts[j + 1]):
                light = lights.lights[n]
                wanted = view.o[2] > 0.0
                if wp.static(key.light_links):
                    if light.link >= 0 and instance >= 0:
                        wanted = wanted and lights.links[light.link, instance] != wp.uint8(0)
                if wanted:
                    u = sobol_2d(index, dimension + n, seed)
                    if wp.static(names[j] == "dome"):
                        slope = strand.bend_n * view.o[2] - closeness * (1.0 - view.o[0] * view.o[0])
                        view.shift = slope * strand.mean
                        over = dome_light(
                            a, wave, layer, strand, view, lights, light, n, _MOST_KNOWN, known, g, arrays, p, ng, u
                        )
                        total += light.specular * wp.vec3(over[0], over[1], over[2])
                        rays += over[3]
                    else:
                        ls = wp.static(models[j].sample)(lights.arrays, light, p, u)
                        axis = ls.wi
                        half_angle = float(0.0)
                        near = float(0.0)  # 1 / distance
                        if wp.static(names[j] == "distant"):
                            axis = light.center
                            half_angle = light.half_angle
                        else:
                            c = light.center - p
                            d = wp.max(wp.length(c), 1.0e-20)
                            near = 1.0 / d
                            axis = c / d
                            radius = light.radius
                            if wp.static(names[j] == "rect" or names[j] == "disk"):
                                radius = wp.length(light.ex) + wp.length(light.ey)
                            if wp.static(names[j] == "cylinder"):
                                radius = light.radius + light.half_length
                            half_angle = wp.asin(wp.clamp(radius * near, 0.0, 1.0))
                        if light.delta == 1:
                            half_angle = 0.0
                        i = to_local(strand.frame, axis)
                        # how xi_1 changes along the scratch: it turns, and both directions do
                        h = i + view.o
                        slope = strand.bend_n * h[2]
                        slope -= closeness * (1.0 - view.o[0] * view.o[0]) + near * (1.0 - i[0] * i[0])
                        view.shift = slope * strand.mean
                        slope += strand.bend_y * h[1]
                        view.spread = slope * slope * strand.variance
                        view.deviation = wp.sqrt(longest + view.spread)
                        if ls.pdf != 0.0 and wp.abs(h[0] + view.shift) < half_angle + REACH * view.deviation:
                            part = wp.vec3(0.0, 0.0, 0.0)
                            if light.delta == 1:
                                if i[2] > 0.0:
                                    part = radiance_from(a, wave, layer, strand, view, i)
                            else:
                                if wp.static(key.glint_areas and names[j] in ("distant", "sphere")):
                                    part = cap_light(a, wave, layer, strand, view, i, half_angle)
                                if wp.static(key.glint_areas and names[j] in FLAT):
                                    part = flat_light(a, wave, layer, strand, view, lights.arrays, light, j, p)
                            shows = largest(part) > 0.0
                            if wp.static(key.glint_pairs):
                                # what a pair adds may be negative
                                shows = wp.length_sq(part) > 0.0
                            if shows:
                                seen = wp.vec4(0.0, 0.0, 0.0, 0.0)
                                if n < wp.static(_MOST_KNOWN):
                                    seen = known[n]
                                if seen[3] == 0.0:
                                    seen = wp.vec4(1.0, 1.0, 1.0, 1.0)
                                    if wp.dot(ls.wi, ng) <= 0.0:
                                        seen = wp.vec4(0.0, 0.0, 0.0, 1.0)
                                    elif wp.static(key.shadows):
                                        if light.shadow != 0:
                                            reach = wp.min(ls.distance * 0.9999, light.shadow_distance)
                                            t = transmittance(g, arrays, p, ls.wi, reach, light.delta)
                                            rays += 1.0
                                            for channel in range(3):
                                                seen[channel] = t + (1.0 - t) * light.shadow_color[channel]
                                    if n < wp.static(_MOST_KNOWN):
                                        known[n] = seen
                                arriving = wp.cw_mul(ls.radiance, wp.vec3(seen[0], seen[1], seen[2]))
                                total += light.specular * wp.cw_mul(part, arriving)
        return wp.vec4(total[0], total[1], total[2], rays)

    return strand_light
