"""What each layer covers under a sample's footprint, and one of them drawn in proportion (Raymond 2016 Eq. 3, 4).

Together layers cover 1 - product (1 - alpha_k), shared in proportion to alpha_k. Where one layer at most is there or
all are resolved, that is Eq. 4 as printed; where footprints hold many scratches of several layers, Eq. 4's plain sum
would count the area twice where they cross, and a material would grow more scratched with distance.
"""

import warp as wp

from ..optics.frames_device import Frame
from ..optics.hash_device import pcg_hash, unit_float
from ..scratches import device_function, kind_number
from ..scratches.curves_device import curves, drawn_curve
from ..scratches.layer_device import LayerData, LayerHit, random_bits
from ..scratches.variation_device import varied_table
from .geometry_device import Geometry, Surface, uv_motion
from .key import KernelKey
from .lobe_device import Layers
from .maps_device import follow, in_pattern, laid_along, masked, oriented
from .material_device import MaterialData
from .world_device import LightSet, ScratchSet

# Layers that cover less than this are culled (Raymond 2016 section 6.1).
SMALLEST_COVERAGE = wp.constant(1.0e-6)


def make_gather(key: KernelKey, consider=None):
    """Device function that runs through a material's layers, compiled for the distributions of ``key``; ``consider``:
    what each is to be asked of small lights (``small_lights_device``)."""
    patterns = [name for name in key.distributions if name != "curves"]
    functions = [device_function(name, key.variation) for name in patterns]
    numbers = [kind_number(name) for name in patterns]
    strokes_number = kind_number("curves")

    @wp.func
    def laid_to(
        frame: Frame,
        s: Surface,
        du: wp.vec3,
        dv: wp.vec3,
        flat: wp.vec3,
        across: wp.vec3,
        direction: wp.vec2,
        sx: float,
        sy: float,
        stroke: wp.vec3,
    ) -> wp.vec3:
        """From pattern space to the surface: along the mapped direction, as an angle from dP/du."""
        mapped = du * (direction[0] / sx) + dv * (direction[1] / sy) + stroke
        along = wp.dot(mapped, flat)
        aside = wp.dot(mapped, across)
        norm = wp.sqrt(along * along + aside * aside)
        if norm > 0.0:
            along = along / norm
            aside = aside / norm
        else:
            along = 1.0
        side = wp.where(s.outside == 1, aside, -aside)
        return along * frame.x + side * frame.y

    @wp.func
    def covered(layer: LayerData, q: wp.vec2d, scale: wp.vec2d, ax: wp.vec2, ay: wp.vec2, phase: float) -> LayerHit:
        hit = LayerHit()
        for j in range(wp.static(len(functions))):
            if layer.kind == wp.static(numbers[j]):
                hit = wp.static(functions[j])(layer, q, scale, ax, ay, phase)
        return hit

    @wp.func
    def gather(
        g: Geometry,
        scratches: ScratchSet,
        m: MaterialData,
        s: Surface,
        frame: Frame,
        step_x: wp.vec3,
        step_y: wp.vec3,
        phase: float,
        u: float,
        resolved: int,
        lights: LightSet,
        wo: wp.vec3,
        p: wp.vec3,
        aside: float,
    ) -> Layers:
        """``step_x``, ``step_y``: edges of the footprint in the triangle's plane [m]; ``frame``: x the tangent;
        ``resolved`` 1: what may be laid out groove by groove is."""
        du = g.dpdu[s.face]
        dv = g.dpdv[s.face]
        outward = wp.where(s.outside == 1, 1.0, -1.0) * s.ng
        # a mirrored mapping is mirrored back, so that angles turn counter-clockwise seen from outside
        handed = wp.where(wp.dot(wp.cross(du, dv), outward) < 0.0, -1.0, 1.0)
        jx = uv_motion(g, s, step_x)
        jy = uv_motion(g, s, step_y)
        flat = wp.normalize(du)
        across = wp.cross(outward, flat)

        total = float(0.0)
        bare = float(1.0)
        kept = float(0.0)
        weight = float(0.0)
        xi = float(u)
        result = Layers()
        result.chosen = -1
        if wp.static(consider is not None):
            result.crossed.bits = pcg_hash(random_bits(aside))
        met = LayerHit()
        for k in range(m.layers):
            layer = scratches.layers[m.first_layer + k]
            scale = wp.vec2d(wp.float64(1.0), wp.float64(1.0))
            if layer.uv_space == 0:
                scale = g.pattern_scale[s.instance]
            flip = wp.vec2d(scale[0], wp.float64(handed) * scale[1])
            sx = float(flip[0])
            sy = float(flip[1])
            turned = wp.vec2(0.0, 0.0)  # direction that a map gives, in pattern space
            if wp.static(key.orientations):
                random = wp.frac(phase + 0.381966 * float(k))
                along_du = oriented(scratches.maps, layer.maps, s, jx, jy, random)
                if along_du[0] != 0.0 or along_du[1] != 0.0:
                    turned = in_pattern(g, s, along_du[0] * flat + along_du[1] * across, flip)
                    layer = laid_along(layer, turned, unit_float(pcg_hash(random_bits(random))))
            hit = covered(
                layer,
                wp.vec2d(s.uv[0] * flip[0], s.uv[1] * flip[1]),
                flip,
                wp.vec2(jx[0] * sx, jx[1] * sy),
                wp.vec2(jy[0] * sx, jy[1] * sy),
                wp.frac(phase + 0.618034 * float(k)),
            )
            if wp.static(key.orientations):
                if turned[0] != 0.0 or turned[1] != 0.0:
                    hit.direction = follow(hit.direction, layer, turned)
            stroke = wp.vec3(0.0, 0.0, 0.0)
            if wp.static("curves" in key.distributions):
                if layer.kind == wp.static(strokes_number) and layer.bvh != wp.uint64(0):
                    drawn = curves(scratches.segments, layer, s.p, outward, s.uv, du, dv, step_x, step_y, jx, jy, phase)
                    hit.alpha = drawn.alpha
                    stroke = drawn.direction
                    if wp.static(key.variation):
                        hit = drawn_curve(scratches.segments, layer, drawn)
            if wp.static(key.masks):
                hit.alpha *= masked(scratches.maps, layer.maps, s, jx, jy, wp.frac(phase + 0.7548777 * float(k)))
            if wp.static(key.groove_handover):
                if resolved == 1 and layer.near == 1:
                    hit.alpha = 0.0
            if hit.alpha > SMALLEST_COVERAGE:
                total += hit.alpha
                bare *= 1.0 - wp.min(hit.alpha, 1.0)
                if layer.keeps_diffuse == 1:
                    kept += hit.alpha
                part = hit.alpha * layer.weight
                weight += part
                chance = part / wp.max(weight, 1.0e-30)
                along_it = wp.vec3(0.0, 0.0, 0.0)
                if wp.static(consider is not None):
                    along_it = laid_to(frame, s, du, dv, flat, across, hit.direction, sx, sy, stroke)
                    if layer.table >= 0 and layer.response < 0:
                        number = m.first_layer + k
                        result.crossed = wp.static(consider)(
                            result.crossed, scratches, lights, frame.n, s.ng, wo, p, s.instance, number, hit, along_it,
                            phase,
                        )  # fmt: skip
                if xi < chance:
                    xi = xi / chance
                    result.chosen = m.first_layer + k
                    result.table = layer.table
                    met = hit
                    if wp.static(consider is None):
                        along_it = laid_to(frame, s, du, dv, flat, across, hit.direction, sx, sy, stroke)
                    result.direction = along_it
                else:
                    xi = (xi - chance) / wp.max(1.0 - chance, 1.0e-7)
        if wp.static(key.variation):
            if result.chosen >= 0 and result.table >= 0:
                bits = pcg_hash(random_bits(phase) ^ wp.uint32(0x5E3779B9))
                result.table = varied_table(result.table, scratches.variations[result.chosen], met, bits)
        share = float(0.0)
        if total > 0.0:
            if wp.static(key.sum_coverage):
                bare = 1.0 - wp.min(total, 1.0)  # Raymond 2016 Eq. 4
            share = (1.0 - bare) / total
        result.covered = 1.0 - bare
        result.kept = kept * share
        result.weight = weight * share
        if wp.static(consider is not None):
            result.crossed.alpha *= share
        result.xi = wp.clamp(xi, 0.0, 0.9999999)
        return result

    return gather
