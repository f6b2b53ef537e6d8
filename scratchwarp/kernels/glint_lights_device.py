"""One scratch under the lights of a scene: its diffracted radiance, in closed form across each light.

Lights are cut into slices of constant xi_1; of those that the scratch's Gaussian reaches, a few are taken, and over
each the light's intervals of xi_2 are integrated exactly (``interval_device``, ``response_device``).
"""

import warp as wp

from ..lights.light_device import Light, LightArrays
from ..optics.frames_device import to_local, to_world
from ..optics.sobol_device import sobol_2d
from ..reflectance.diffraction.interval_device import (
    behind_edge,
    cap_extent,
    cut_cap,
    edge_turn,
)
from ..reflectance.diffraction.response_device import (
    across_integral,
    across_integral_paper,
    along_variance,
    depth_response,
    sinc2,
)
from .direct_device import models_of
from .geometry_device import Geometry
from .glint_arrays_device import GlintArrays, Strand, WaveLayer, WaveMaterial, reflectance_at, reflectance_color
from .key import KernelKey
from .lobe_device import largest
from .material_device import MaterialArrays
from .world_device import LightSet

_vec8 = wp.types.vector(length=8, dtype=float)
# Gauss-Legendre over [0, 1].
_NODES = wp.constant(
    _vec8(
        0.0198550718, 0.1016667613, 0.2372337950, 0.4082826788, 0.5917173212, 0.7627662050, 0.8983332387, 0.9801449282
    )
)
_WEIGHTS = wp.constant(
    _vec8(
        0.0506142681, 0.1111905172, 0.1568533229, 0.1813418917, 0.1813418917, 0.1568533229, 0.1111905172, 0.0506142681
    )
)
_SLICES = wp.constant(8)
_REACH = wp.constant(3.3)  # standard deviations
_CORNERS = wp.constant(12)  # of the polygon that stands for a disk
_DOME = wp.constant(16)  # parts of a dome's half circle
_SQRT_PI = wp.constant(1.7724538509)
_SQRT_TWO_PI = wp.constant(2.5066282746)
FLAT = ("rect", "disk", "cylinder", "mesh")
_MOST_KNOWN = 8  # lights whose visibility is kept from scratch to scratch


@wp.struct
class View:
    """A strand from a viewer: omega_o in its frame, its layer and material, the spread of xi_1 over the footprint and
    its shift, and the longest standard deviation of xi_1 among the wavelengths."""

    o: wp.vec3
    spread: float
    shift: float
    deviation: float


@wp.struct
class Slices:
    """Which slices: ``count`` from u0 to u1; ``whole``: they stand for the whole Gaussian. ``round``: the light begins
    and ends round."""

    count: int
    whole: int
    u0: float
    u1: float
    round: int


def make_strand_light(key: KernelKey, transmittance):
    """Device function: the light that one scratch sends to the viewer, compiled for the lights of ``key``."""
    models = models_of(key)
    names = [model.name for model in models]
    paper = key.glint_method == "paper"
    single = key.glint_method != "slices"
    across = across_integral_paper if paper else across_integral

    @wp.func
    def xi1_slices(view: View, low: float, high: float, rounded: int) -> Slices:
        """The slices to take of a light that fills u from ``low`` to ``high``."""
        r = Slices()
        middle = -view.o[0] - view.shift
        if wp.static(single):
            if middle > low and middle < high:
                r.count = 1
                r.whole = 1
                r.u0 = middle
        else:
            reach = _REACH * view.deviation
            a = wp.max(low, middle - reach)
            b = wp.min(high, middle + reach)
            if a < b:
                r.u0 = a
                r.u1 = b
                r.round = rounded
                r.count = _SLICES
                if a > low and b < high:
                    r.whole = 1
                    r.count = 2
                    r.u0 = middle - view.deviation
                    r.u1 = middle + view.deviation
        return r

    @wp.func
    def slice_at(s: Slices, i: int) -> wp.vec2:
        """(u, weight) of a slice; the weight of a whole Gaussian adds up to 1, else to the range of u."""
        r = wp.vec2(s.u0, 1.0)
        if s.whole == 1:
            if s.count == 2:
                r = wp.vec2(wp.where(i == 0, s.u0, s.u1), 0.5)
        else:
            t = _NODES[i]
            w = _WEIGHTS[i] * (s.u1 - s.u0)
            if s.round == 1:
                # takes out the square roots with which a round light begins and ends
                w = w * 6.0 * t * (1.0 - t)
                t = t * t * (3.0 - 2.0 * t)
            r = wp.vec2(s.u0 + t * (s.u1 - s.u0), w)
        return r

    @wp.func
    def radiance_of(
        a: GlintArrays,
        wave: WaveMaterial,
        layer: WaveLayer,
        strand: Strand,
        view: View,
        whole: int,
        count: int,
        places: wp.array(dtype=wp.vec3),
        cuts: wp.array(dtype=wp.vec4),
    ) -> wp.vec3:
        """Sum over wavelengths and slices. ``places``: (xi_1, weight, cosine of the half angle); ``cuts``: intervals
        of xi_2."""
        total = wp.vec3(0.0, 0.0, 0.0)
        for k in range(wave.count):
            wavelength = a.wavelengths[wave.first + k]
            ratio = strand.width / wavelength
            own = along_variance(wave.sigma, wavelength)
            variance = own + view.spread
            value = float(0.0)
            for i in range(count):
                along = places[i][1] * _SQRT_TWO_PI * wp.sqrt(own)
                if whole == 0:
                    x = places[i][0]
                    along = places[i][1] * wp.sqrt(own / variance) * wp.exp(-0.5 * x * x / variance)
                c = cuts[i]
                seen = across(ratio, c[0], c[1]) + across(ratio, c[2], c[3])
                if layer.per_wavelength == 1:
                    seen *= reflectance_at(a, layer.reflect, k, places[i][2])
                value += along * seen
            value *= ratio * ratio * depth_response(strand.depth, wavelength, 2.0, layer.depth_spread, layer.roughness)
            total += value * a.colors[wave.first + k]
        total = total * (2.0 * _SQRT_PI * wave.sigma * strand.length)
        if layer.per_wavelength == 0:
            total = wp.cw_mul(total, reflectance_color(a, layer.reflect, places[count / 2][2]))
        return total

    @wp.func
    def cosine_of(o: wp.vec3, u: float, psi: float) -> float:
        s = wp.sqrt(wp.max((1.0 - u) * (1.0 + u), 0.0))
        i = wp.vec3(u, s * wp.sin(psi), s * wp.cos(psi))
        return wp.sqrt(wp.max(0.5 + 0.5 * wp.dot(i, o), 0.0))

    @wp.func
    def as_xi2(o: wp.vec3, u: float, psi: wp.vec4) -> wp.vec4:
        s = wp.sqrt(wp.max((1.0 - u) * (1.0 + u), 0.0))
        r = wp.vec4(0.0, 0.0, 0.0, 0.0)
        if psi[1] > psi[0]:
            r[0] = o[1] + s * wp.sin(psi[0])
            r[1] = r[0] + 2.0 * s * wp.cos(0.5 * (psi[0] + psi[1])) * wp.sin(0.5 * (psi[1] - psi[0]))
        if psi[3] > psi[2]:
            r[2] = o[1] + s * wp.sin(psi[2])
            r[3] = o[1] + s * wp.sin(psi[3])
        return r

    @wp.func
    def point_light(
        a: GlintArrays, wave: WaveMaterial, layer: WaveLayer, strand: Strand, view: View, i: wp.vec3
    ) -> wp.vec3:
        """Irradiance 1 from one direction, times the cosine."""
        total = wp.vec3(0.0, 0.0, 0.0)
        x = i[0] + view.o[0] + view.shift
        xi2 = i[1] + view.o[1]
        cosine = wp.sqrt(wp.max(0.5 + 0.5 * wp.dot(i, view.o), 0.0))
        for k in range(wave.count):
            wavelength = a.wavelengths[wave.first + k]
            ratio = strand.width / wavelength
            own = along_variance(wave.sigma, wavelength)
            variance = own + view.spread
            value = wp.sqrt(own / variance) * wp.exp(-0.5 * x * x / variance) * ratio * ratio * sinc2(ratio * xi2)
            value *= depth_response(strand.depth, wavelength, 2.0, layer.depth_spread, layer.roughness)
            if layer.per_wavelength == 1:
                value *= reflectance_at(a, layer.reflect, k, cosine)
            total += value * a.colors[wave.first + k]
        total = total * (2.0 * _SQRT_PI * wave.sigma * strand.length * i[2])
        if layer.per_wavelength == 0:
            total = wp.cw_mul(total, reflectance_color(a, layer.reflect, cosine))
        return total

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
        s = xi1_slices(view, e.low, e.high, 1)
        if s.count > 0:
            places = wp.zeros(shape=8, dtype=wp.vec3)
            cuts = wp.zeros(shape=8, dtype=wp.vec4)
            for i in range(s.count):
                at = slice_at(s, i)
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
        s = xi1_slices(view, low, high, 0)
        if s.count > 0:
            places = wp.zeros(shape=8, dtype=wp.vec3)
            cuts = wp.zeros(shape=8, dtype=wp.vec4)
            for i in range(s.count):
                at = slice_at(s, i)
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
    def dome_light(
        a: GlintArrays,
        wave: WaveMaterial,
        layer: WaveLayer,
        strand: Strand,
        view: View,
        lights: LightSet,
        light: Light,
        g: Geometry,
        arrays: MaterialArrays,
        p: wp.vec3,
        ng: wp.vec3,
        jitter: float,
    ) -> wp.vec3:
        """The half circle xi_1 = 0 in parts of even cosine, each with the dome's radiance somewhere in it."""
        total = wp.vec3(0.0, 0.0, 0.0)
        u = wp.clamp(-view.o[0] - view.shift, -1.0, 1.0)
        s = wp.sqrt((1.0 - u) * (1.0 + u))
        places = wp.zeros(shape=1, dtype=wp.vec3)
        cuts = wp.zeros(shape=1, dtype=wp.vec4)
        for j in range(wp.static(len(models))):
            if wp.static(names[j] == "dome"):
                for k in range(_DOME):
                    low = 2.0 * float(k) / float(_DOME) - 1.0
                    high = 2.0 * float(k + 1) / float(_DOME) - 1.0
                    middle = low + jitter * (high - low)
                    i = wp.vec3(u, s * middle, s * wp.sqrt((1.0 - middle) * (1.0 + middle)))
                    w = to_world(strand.frame, i)
                    seen = float(1.0)
                    if wp.static(key.shadows):
                        if light.shadow != 0:
                            seen = 0.0
                            if wp.dot(w, ng) > 0.0:
                                seen = transmittance(g, arrays, p, w, light.shadow_distance)
                    radiance = wp.static(models[j].hit)(lights.arrays, light, p, w).radiance
                    radiance = seen * radiance + (1.0 - seen) * wp.cw_mul(radiance, light.shadow_color)
                    if largest(radiance) > 0.0:
                        places[0] = wp.vec3(0.0, 1.0, wp.sqrt(wp.max(0.5 + 0.5 * wp.dot(i, view.o), 0.0)))
                        cuts[0] = wp.vec4(view.o[1] + s * low, view.o[1] + s * high, 0.0, 0.0)
                        part = radiance_of(a, wave, layer, strand, view, 1, 1, places, cuts)
                        total += wp.cw_mul(radiance, part)
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
                        total += light.specular * dome_light(
                            a, wave, layer, strand, view, lights, light, g, arrays, p, ng, u[0]
                        )
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
                        if ls.pdf != 0.0 and wp.abs(h[0] + view.shift) < half_angle + _REACH * view.deviation:
                            part = wp.vec3(0.0, 0.0, 0.0)
                            if light.delta == 1:
                                if i[2] > 0.0:
                                    part = point_light(a, wave, layer, strand, view, i)
                            else:
                                if wp.static(key.glint_areas and names[j] in ("distant", "sphere")):
                                    part = cap_light(a, wave, layer, strand, view, i, half_angle)
                                if wp.static(key.glint_areas and names[j] in FLAT):
                                    part = flat_light(a, wave, layer, strand, view, lights.arrays, light, j, p)
                            if largest(part) > 0.0:
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
                                            t = transmittance(g, arrays, p, ls.wi, reach)
                                            rays += 1.0
                                            for c in range(3):
                                                seen[c] = t + (1.0 - t) * light.shadow_color[c]
                                    if n < wp.static(_MOST_KNOWN):
                                        known[n] = seen
                                arriving = wp.cw_mul(ls.radiance, wp.vec3(seen[0], seen[1], seen[2]))
                                total += light.specular * wp.cw_mul(part, arriving)
        return wp.vec4(total[0], total[1], total[2], rays)

    return strand_light
