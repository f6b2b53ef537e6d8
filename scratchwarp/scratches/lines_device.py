"""Regular patterns: parallel lines, circles, a spiral. Their coverage under a footprint is a closed form.

A set of bands [i P, i P + W] along a coordinate x covers F(x) = floor(x / P) W + min(x - floor(x / P) P, W) of
[0, x], so a footprint of extent e about x is covered to (F(x + e/2) - F(x - e/2)) / e, and to 0 or 1 as e -> 0.
"""

import warp as wp

from .layer_device import LayerData, LayerHit

wp.set_module_options({"enable_backward": False})


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
def linear(layer: LayerData, q: wp.vec2d, scale: wp.vec2d, ax: wp.vec2, ay: wp.vec2, phase: float) -> LayerHit:
    """Parallel lines; see ``worley_device.worley`` for the arguments."""
    y = wp.float64(layer.cos_a) * q[1] - wp.float64(layer.sin_a) * q[0]
    ex = wp.abs(layer.cos_a * ax[1] - layer.sin_a * ax[0])
    ey = wp.abs(layer.cos_a * ay[1] - layer.sin_a * ay[0])
    hit = LayerHit()
    hit.alpha = band_coverage(y + layer.offset[1] * layer.pitch, wp.float64(wp.max(ex, ey)), layer.pitch, layer.width)
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
    extent = wp.max(wp.abs(wp.dot(ax, radial)), wp.abs(wp.dot(ay, radial)))
    hit = LayerHit()
    hit.alpha = band_coverage(r + layer.offset[1] * layer.pitch, wp.float64(extent), layer.pitch, layer.width)
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
    extent = wp.max(wp.abs(wp.dot(ax, across)), wp.abs(wp.dot(ay, across)))
    hit = LayerHit()
    hit.alpha = band_coverage(
        r - layer.pitch * turn + layer.offset[1] * layer.pitch, wp.float64(extent), layer.pitch, layer.width
    )
    hit.direction = wp.vec2(-across[1], across[0])
    return hit


@wp.func
def full(layer: LayerData, q: wp.vec2d, scale: wp.vec2d, ax: wp.vec2, ay: wp.vec2, phase: float) -> LayerHit:
    """Scratches that leave nothing between them."""
    hit = LayerHit()
    hit.alpha = layer.mean
    hit.direction = wp.vec2(layer.cos_a, layer.sin_a)
    return hit
