"""Explicit scratches: the segments near a footprint, found in a bounding volume hierarchy.

A segment covers a strip of its full width. Seen from the shading point the strip and the footprint are taken as boxes
along and across the segment, so the covered fraction is a product of two interval overlaps; what strips cover together
is 1 - product (1 - a_i). One segment is drawn in proportion to what it covers and gives the direction.
"""

import warp as wp

from ..optics.hash_device import hash_combine
from .layer_device import LayerData, LayerHit

wp.set_module_options({"enable_backward": False})

# How far off the tangent plane a segment may lie, as a part of its length: curves on a smooth shape leave its facets.
OFF_PLANE = wp.constant(0.1)


@wp.struct
class SegmentArrays:
    """Segments of all curve layers: ends (metres, or u, v, 0) and half widths (metres, or fractions of the square)."""

    a: wp.array(dtype=wp.vec3)
    b: wp.array(dtype=wp.vec3)
    half: wp.array(dtype=float)
    # read where scratches vary: curve number; length before a segment and its own (micrometres, or of the uv square)
    curve: wp.array(dtype=int)
    run: wp.array(dtype=wp.vec2)
    aspects: wp.array(dtype=wp.vec2)  # depth over width at both ends


@wp.struct
class CurveHit:
    """Covered fraction, and the direction of the drawn segment in the world (zero when nothing is covered)."""

    alpha: float
    direction: wp.vec3
    xi: float
    segment: int  # the drawn one, -1: none
    at: float  # where on it, in [0, 1]


@wp.func
def overlap(center: float, extent: float, low: float, high: float) -> float:
    """Fraction of [center - extent / 2, center + extent / 2] inside [low, high]; 0 or 1 for extent 0."""
    result = float(0.0)
    if extent <= 1.0e-6 * (high - low):
        if center >= low and center < high:
            result = 1.0
    else:
        covered = wp.min(center + 0.5 * extent, high) - wp.max(center - 0.5 * extent, low)
        result = wp.clamp(covered / extent, 0.0, 1.0)
    return result


@wp.func
def curves(
    segments: SegmentArrays,
    layer: LayerData,
    p: wp.vec3,
    n: wp.vec3,
    uv: wp.vec2d,
    du: wp.vec3,
    dv: wp.vec3,
    step_x: wp.vec3,
    step_y: wp.vec3,
    jx: wp.vec2,
    jy: wp.vec2,
    u: float,
) -> CurveHit:
    """Coverage at ``p`` (uv there, dP/du, dP/dv) under a footprint with edges ``step_x``, ``step_y`` (in uv jx, jy)."""
    here = p
    reach = wp.vec3(layer.reach, layer.reach, layer.reach)
    box = 0.5 * (
        wp.vec3(wp.abs(step_x[0]), wp.abs(step_x[1]), wp.abs(step_x[2]))
        + wp.vec3(wp.abs(step_y[0]), wp.abs(step_y[1]), wp.abs(step_y[2]))
    )
    if layer.curve_uv == 1:
        here = wp.vec3(float(uv[0]), float(uv[1]), 0.0)
        reach_u = layer.reach
        reach_v = layer.reach
        if layer.width_uv == 0:
            reach_u = layer.reach / wp.max(wp.length(du), 1.0e-20)
            reach_v = layer.reach / wp.max(wp.length(dv), 1.0e-20)
        reach = wp.vec3(reach_u, reach_v, 1.0e-6)
        box = 0.5 * wp.vec3(wp.abs(jx[0]) + wp.abs(jy[0]), wp.abs(jx[1]) + wp.abs(jy[1]), 0.0)
    to_metres = float(1.0)
    if layer.width_uv == 1:
        to_metres = wp.sqrt(wp.length(du) * wp.length(dv))

    hit = CurveHit()
    hit.xi = u
    hit.segment = -1
    clear = float(1.0)
    total = float(0.0)
    query = wp.bvh_query_aabb(layer.bvh, here - box - reach, here + box + reach)
    index = int(0)
    while wp.bvh_query_next(query, index):
        k = layer.first + index
        a = segments.a[k]
        run = segments.b[k] - a
        rel = here - a
        if layer.curve_uv == 1:
            run = run[0] * du + run[1] * dv
            rel = rel[0] * du + rel[1] * dv
        half = segments.half[k] * to_metres
        height = wp.abs(wp.dot(rel, n))
        flat = run - wp.dot(run, n) * n
        length = wp.length(flat)
        if length > 0.0 and height <= half + OFF_PLANE * length:
            t = flat / length
            v = wp.cross(n, t)
            across = wp.max(wp.abs(wp.dot(step_x, v)), wp.abs(wp.dot(step_y, v)))
            along = wp.max(wp.abs(wp.dot(step_x, t)), wp.abs(wp.dot(step_y, t)))
            part = overlap(wp.dot(rel, v), across, -half, half) * overlap(wp.dot(rel, t), along, 0.0, length)
            if part > 0.0:
                clear *= 1.0 - part
                total += part
                chance = part / total
                if hit.xi < chance:
                    hit.xi = hit.xi / chance
                    hit.direction = t
                    hit.segment = k
                    hit.at = wp.clamp(wp.dot(rel, t) / length, 0.0, 1.0)
                else:
                    hit.xi = (hit.xi - chance) / wp.max(1.0 - chance, 1.0e-7)
    hit.alpha = 1.0 - clear
    hit.xi = wp.clamp(hit.xi, 0.0, 0.9999999)
    return hit


@wp.func
def drawn_curve(segments: SegmentArrays, layer: LayerData, drawn: CurveHit) -> LayerHit:
    """The scratch of a drawn segment: which, where on it, and its aspect there."""
    hit = LayerHit()
    hit.alpha = drawn.alpha
    hit.stretch = 1.0
    hit.aspect = -1.0
    k = drawn.segment
    if k >= 0:
        run = segments.run[k]
        ends = segments.aspects[k]
        hit.scratch = hash_combine(layer.seed, wp.uint32(segments.curve[k]))
        hit.along = (run[0] + drawn.at * run[1]) * layer.wave
        hit.aspect = wp.lerp(ends[0], ends[1], drawn.at)
    return hit
