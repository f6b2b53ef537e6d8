"""Regular patterns: parallel lines, circles, a spiral. Their coverage under a footprint is a closed form.

A set of bands [i P, i P + W] along a coordinate x covers F(x) = floor(x / P) W + min(x - floor(x / P) P, W) of
[0, x], so a footprint of extent e about x is covered to (F(x + e/2) - F(x - e/2)) / e, and to 0 or 1 as e -> 0.
"""

import warp as wp

from ..optics.hash_device import hash_combine, pcg_hash, unit_float
from .layer_device import LayerData, LayerHit, random_bits
from .variation_device import drawn_stretch, stretch

wp.set_module_options({"enable_backward": False})

COUNTED = wp.constant(12.0)
STRAIGHT = wp.constant(0)
CIRCLES = wp.constant(1)
SPIRAL = wp.constant(2)


@wp.func
def band_coverage(x: wp.float64, extent: wp.float64, pitch: wp.float64, width: wp.float64) -> float:
    """Fraction of [x - extent / 2, x + extent / 2] covered by bands of ``width`` every ``pitch``."""
    half = wp.float64(0.5)
    cell = wp.floor(x / pitch)
    at = x - cell * pitch
    result = float(0.0)
    if extent < wp.float64(1.0e-6) * pitch:
        if at < width:
            result = 1.0
    else:
        low = at - half * extent
        high = at + half * extent
        i0 = wp.floor(low / pitch)
        i1 = wp.floor(high / pitch)
        f0 = i0 * width + wp.min(low - i0 * pitch, width)
        f1 = i1 * width + wp.min(high - i1 * pitch, width)
        result = wp.clamp(float((f1 - f0) / extent), 0.0, 1.0)
    return result


@wp.func
def fraction(x: wp.float64) -> float:
    """What is above the integer below: far along a scratch, waves are counted from the last whole one."""
    return float(x - wp.floor(x))


@wp.func
def drawn_band(layer: LayerData, phase: float) -> LayerHit:
    """Some scratch of the layer, by what it covers."""
    hit = LayerHit()
    bits = pcg_hash(random_bits(phase) ^ layer.seed)
    hit.alpha = layer.mean
    hit.scratch = pcg_hash(bits)
    hit.stretch = drawn_stretch(unit_float(pcg_hash(hit.scratch)), layer.width_variation, 1.0)
    return hit


@wp.func
def varied_bands(
    layer: LayerData, x: wp.float64, extent: wp.float64, along: wp.float64, turn: wp.float64, shape: int, phase: float
) -> LayerHit:
    """Bands of varying width under [x - extent / 2, x + extent / 2], and one of them drawn by what it covers.

    ``shape``: STRAIGHT, where ``along`` is the place on the bands in wavelengths, else CIRCLES or SPIRAL, where
    ``turn`` in [-1/2, 1/2] is.
    """
    half = wp.float64(0.5)
    hit = drawn_band(layer, phase)
    if extent < wp.float64(COUNTED) * layer.pitch:
        # in pitches, the middle of band i at i
        at = (x - half * layer.width) / layer.pitch
        reach = float(half * extent / layer.pitch)
        base = wp.floor(at)
        off = float(at - base)
        bits = pcg_hash(hit.scratch)
        covered = float(0.0)
        for i in range(int(wp.floor(off - reach - 0.5)), int(wp.ceil(off + reach + 0.5)) + 1):
            number = wp.int64(base) + wp.int64(i)
            scratch = hash_combine(layer.seed, wp.uint32(number))
            place = fraction(along)
            if shape == CIRCLES:
                # whole waves around
                round = wp.rint(wp.float64(2.0 * wp.pi * layer.wave) * wp.float64(number) * layer.pitch)
                place = fraction(round * turn)
            if shape == SPIRAL:
                # the length of the groove from the middle: the integral of r dangle, with r = pitch * turns
                scratch = pcg_hash(layer.seed)
                turns = wp.float64(number) - layer.offset[1] + turn
                place = fraction(wp.float64(wp.pi) * layer.pitch * turns * turns * wp.float64(layer.wave))
            wide = stretch(scratch, place, layer.width_variation)
            side = wp.min(0.5 * float(layer.width / layer.pitch) * wide, 0.5)
            part = float(0.0)
            if reach < 1.0e-6:
                if wp.abs(off - float(i)) <= side:
                    part = 1.0
            else:
                part = wp.min(off + reach, float(i) + side) - wp.max(off - reach, float(i) - side)
                part = wp.max(part, 0.0) / (2.0 * reach)
            if part > 0.0:
                covered += part
                bits = pcg_hash(bits)
                if unit_float(bits) * covered < part:
                    hit.scratch = scratch
                    hit.along = place
                    hit.stretch = wide
        hit.alpha = wp.min(covered, 1.0)
    return hit


def _patterns(varied: bool):
    """(linear, concentric, spiral, full) device functions; ``varied``: they also draw one of the scratches."""

    @wp.func
    def linear(layer: LayerData, q: wp.vec2d, scale: wp.vec2d, ax: wp.vec2, ay: wp.vec2, phase: float) -> LayerHit:
        """Parallel lines; see ``worley_device.worley`` for the arguments."""
        y = wp.float64(layer.cos_a) * q[1] - wp.float64(layer.sin_a) * q[0]
        ex = wp.abs(layer.cos_a * ax[1] - layer.sin_a * ax[0])
        ey = wp.abs(layer.cos_a * ay[1] - layer.sin_a * ay[0])
        hit = LayerHit()
        extent = wp.float64(wp.max(ex, ey))
        hit.alpha = band_coverage(y + layer.offset[1] * layer.pitch, extent, layer.pitch, layer.width)
        if wp.static(varied):
            if layer.varied == 1:
                x = wp.float64(layer.cos_a) * q[0] + wp.float64(layer.sin_a) * q[1]
                along = (x + layer.offset[0] * layer.pitch) * wp.float64(layer.wave)
                y += layer.offset[1] * layer.pitch
                hit = varied_bands(layer, y, extent, along, wp.float64(0.0), STRAIGHT, phase)
        hit.direction = wp.vec2(layer.cos_a, layer.sin_a)
        return hit

    @wp.func
    def concentric(layer: LayerData, q: wp.vec2d, scale: wp.vec2d, ax: wp.vec2, ay: wp.vec2, phase: float) -> LayerHit:
        """Circles about ``layer.center``."""
        dx = q[0] - layer.center[0] * scale[0]
        dy = q[1] - layer.center[1] * scale[1]
        r = wp.sqrt(dx * dx + dy * dy)
        radial = wp.vec2(1.0, 0.0)
        if r > wp.float64(0.0):
            radial = wp.vec2(float(dx / r), float(dy / r))
        extent = wp.float64(wp.max(wp.abs(wp.dot(ax, radial)), wp.abs(wp.dot(ay, radial))))
        hit = LayerHit()
        r += layer.offset[1] * layer.pitch
        hit.alpha = band_coverage(r, extent, layer.pitch, layer.width)
        if wp.static(varied):
            if layer.varied == 1:
                turn = wp.atan2(dy, dx) / wp.float64(2.0 * wp.pi)
                hit = varied_bands(layer, r, extent, wp.float64(0.0), turn, CIRCLES, phase)
        hit.direction = wp.vec2(-radial[1], radial[0])
        return hit

    @wp.func
    def spiral(layer: LayerData, q: wp.vec2d, scale: wp.vec2d, ax: wp.vec2, ay: wp.vec2, phase: float) -> LayerHit:
        """One groove that winds outwards by ``pitch`` a turn, counter-clockwise."""
        dx = q[0] - layer.center[0] * scale[0]
        dy = q[1] - layer.center[1] * scale[1]
        r = wp.sqrt(dx * dx + dy * dy)
        radial = wp.vec2(1.0, 0.0)
        climb = float(0.0)
        turn = wp.float64(0.0)
        if r > wp.float64(0.0):
            radial = wp.vec2(float(dx / r), float(dy / r))
            turn = wp.atan2(dy, dx) / wp.float64(2.0 * wp.pi)
            climb = float(layer.pitch / (wp.float64(2.0 * wp.pi) * r))
        across = wp.normalize(radial - climb * wp.vec2(-radial[1], radial[0]))
        extent = wp.float64(wp.max(wp.abs(wp.dot(ax, across)), wp.abs(wp.dot(ay, across))))
        hit = LayerHit()
        x = r - layer.pitch * turn + layer.offset[1] * layer.pitch
        hit.alpha = band_coverage(x, extent, layer.pitch, layer.width)
        if wp.static(varied):
            if layer.varied == 1:
                hit = varied_bands(layer, x, extent, wp.float64(0.0), turn, SPIRAL, phase)
        hit.direction = wp.vec2(-across[1], across[0])
        return hit

    @wp.func
    def full(layer: LayerData, q: wp.vec2d, scale: wp.vec2d, ax: wp.vec2, ay: wp.vec2, phase: float) -> LayerHit:
        """Scratches that leave nothing between them."""
        hit = LayerHit()
        hit.alpha = layer.mean
        if wp.static(varied):
            hit = drawn_band(layer, phase)
        hit.direction = wp.vec2(layer.cos_a, layer.sin_a)
        return hit

    return linear, concentric, spiral, full


linear, concentric, spiral, full = _patterns(False)
linear_varied, concentric_varied, spiral_varied, full_varied = _patterns(True)
