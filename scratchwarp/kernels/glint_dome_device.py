"""A dome over a scratch: the integral along the half circle xi_1 = 0 in few parts, short where the lobe is high.

Parts end at squares of even steps from the mirror direction xi_2 = 0 outwards. Over each the lobe's integral is exact,
and the dome's radiance is its mean over about the part (the image's smaller copies, as for cones). Neighbours share
their ends in the table of ``wide_integral``. Rays find out what of the dome is seen, one for each of some cells of the
hemisphere that a part lies in, for all scratches of a point.
"""

import warp as wp

from ..lights.light_device import Light
from ..optics.frames_device import frame_around, to_local, to_world
from .direct_device import models_of
from .geometry_device import Geometry
from .glint_arrays_device import GlintArrays, Strand, WaveLayer, WaveMaterial, reflectance_color, wide_integral
from .glint_sums_device import View
from .key import KernelKey
from .lobe_device import largest
from .material_device import MaterialArrays
from .world_device import LightSet

CELLS = 16
"""Of the hemisphere, in which rays for a dome are shared."""


@wp.func
def cell_of(ng: wp.vec3, w: wp.vec3) -> int:
    """The cell of the hemisphere around ``ng`` in which a direction above it lies: two rings of eight."""
    i = to_local(frame_around(ng), w)
    cell = wp.where(i[0] < 0.0, 1, 0) + wp.where(i[1] < 0.0, 2, 0)
    cell += wp.where(wp.abs(i[0]) < wp.abs(i[1]), 4, 0)
    # half of the projected solid angle each
    return cell + wp.where(i[2] < 0.70710678, 8, 0)


def make_dome_light(key: KernelKey, transmittance, radiance_of):
    """Device function: a dome of specular 1 over a strand; None where ``key`` has none."""
    model = next((m for m in models_of(key) if m.name == "dome"), None)
    if model is None:
        return None
    lit = model.lit
    tabled = key.glint_lookup

    @wp.func
    def seen_of(
        g: Geometry,
        arrays: MaterialArrays,
        p: wp.vec3,
        ng: wp.vec3,
        light: Light,
        number: int,
        first: int,
        known: wp.array(dtype=wp.vec4),
        w: wp.vec3,
        toward: wp.vec3,
    ) -> wp.vec2:
        """What of the dome arrives from about ``w``, asked towards ``toward``; and the rays that took."""
        r = wp.vec2(0.0, 0.0)
        if wp.dot(w, ng) > 0.0:
            cell = first + cell_of(ng, w)
            kept = known[cell]
            if kept[3] == float(number + 1):
                r = wp.vec2(kept[0], 0.0)
            else:
                ray = wp.where(wp.dot(toward, ng) > 0.0, toward, w)
                r = wp.vec2(transmittance(g, arrays, p, ray, light.shadow_distance, light.delta), 1.0)
                known[cell] = wp.vec4(r[0], 0.0, 0.0, float(number + 1))
        return r

    @wp.func
    def dome_light(
        a: GlintArrays,
        wave: WaveMaterial,
        layer: WaveLayer,
        strand: Strand,
        view: View,
        lights: LightSet,
        light: Light,
        number: int,
        first: int,
        known: wp.array(dtype=wp.vec4),
        g: Geometry,
        arrays: MaterialArrays,
        p: wp.vec3,
        ng: wp.vec3,
        jitter: wp.vec2,
    ) -> wp.vec4:
        """Radiance, and the rays in w. ``known[first ...]``: what is known of cells."""
        total = wp.vec3(0.0, 0.0, 0.0)
        rays = float(0.0)
        u = wp.clamp(-view.o[0] - view.shift, -1.0, 1.0)
        s = wp.max(wp.sqrt((1.0 - u) * (1.0 + u)), 1.0e-6)
        mirror = wp.clamp(-view.o[1] / s, -1.0, 1.0)
        places = wp.zeros(shape=1, dtype=wp.vec3)
        cuts = wp.zeros(shape=1, dtype=wp.vec4)
        scale = 2.0 / wp.pi * strand.length * strand.width
        table = wp.static(tabled) and layer.wide_depths > 0 and strand.pitch == 0.0
        if wp.static(key.glint_pairs):
            table = table and strand.pair.kind == 0
        parts = wp.max(a.slices - 1, 1)  # on either side of the mirror direction
        for side in range(2):
            sign = float(2 * side - 1)
            span = 1.0 - sign * mirror
            at = float(mirror)
            before = wp.vec3(0.0, 0.0, 0.0)
            if wp.static(tabled):
                if table and span > 1.0e-4:
                    before = wide_integral(a, layer, strand.depth, strand.width * (view.o[1] + s * at))
            for k in range(parts):
                if span > 1.0e-4:
                    t = float(k + 1) / float(parts)
                    following = mirror + sign * span * t * t
                    middle = 0.5 * (at + following)
                    height = wp.sqrt((1.0 - middle) * (1.0 + middle))
                    i = wp.vec3(u, s * middle, s * height)
                    w = to_world(strand.frame, i)
                    width = wp.abs(following - at) / wp.max(height, 0.25)
                    radiance = wp.static(lit)(lights.arrays, light, p, w, width).radiance
                    if wp.static(key.shadows):
                        if light.shadow != 0 and largest(radiance) > 0.0:
                            aside = at + jitter[0] * (following - at)
                            ray = wp.vec3(u, s * aside, s * wp.sqrt(wp.max((1.0 - aside) * (1.0 + aside), 0.0)))
                            seen = seen_of(
                                g, arrays, p, ng, light, number, first, known, w, to_world(strand.frame, ray)
                            )
                            rays += seen[1]
                            radiance = seen[0] * radiance + (1.0 - seen[0]) * wp.cw_mul(radiance, light.shadow_color)
                    cosine = wp.sqrt(wp.max(0.5 + 0.5 * wp.dot(i, view.o), 0.0))
                    part = wp.vec3(0.0, 0.0, 0.0)
                    if wp.static(tabled):
                        if table:
                            after = wide_integral(a, layer, strand.depth, strand.width * (view.o[1] + s * following))
                            whole = reflectance_color(a, layer.reflect, cosine)
                            part = sign * scale * wp.cw_mul(after - before, whole)
                            before = after
                    if not table and largest(radiance) > 0.0:
                        places[0] = wp.vec3(0.0, 1.0, cosine)
                        low = view.o[1] + s * wp.min(at, following)
                        high = view.o[1] + s * wp.max(at, following)
                        cuts[0] = wp.vec4(low, high, 0.0, 0.0)
                        part = radiance_of(a, wave, layer, strand, view, 1, 1, places, cuts)
                    total += wp.cw_mul(radiance, part)
                    at = following
        return wp.vec4(total[0], total[1], total[2], rays)

    return dome_light
