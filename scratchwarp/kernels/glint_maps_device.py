"""Masks and directions of layers that diffract: where scratches are, and which way regular ones run."""

import warp as wp

from ..optics.frames_device import Frame
from ..optics.hash_device import pcg_hash, unit_float
from .geometry_device import Geometry, Surface, uv_motion
from .glint_arrays_device import BandData, GlintArrays
from .maps_device import BINS, in_pattern, masked, oriented


@wp.func
def mask_at(a: GlintArrays, index: int, g: Geometry, s: Surface, step_x: wp.vec3, step_y: wp.vec3) -> float:
    """What masks leave of a layer under the footprint; ``index``: its maps, -1 for none."""
    r = float(1.0)
    if index >= 0:
        r = masked(a.maps, index, s, uv_motion(g, s, step_x), uv_motion(g, s, step_y), 0.5)
    return r


@wp.func
def turned_band(
    a: GlintArrays,
    band: BandData,
    g: Geometry,
    s: Surface,
    frame: Frame,
    step_x: wp.vec3,
    step_y: wp.vec3,
    index: wp.uint32,
) -> BandData:
    """A pattern of straight lines along its map: they run as it says, laid out along the nearest of a few ways."""
    r = band
    if band.maps >= 0 and band.kind == 0:
        phase = unit_float(pcg_hash(index))
        local = oriented(a.maps, band.maps, s, uv_motion(g, s, step_x), uv_motion(g, s, step_y), phase)
        if local[0] != 0.0 or local[1] != 0.0:
            du = g.dpdu[s.face]
            dv = g.dpdv[s.face]
            outward = wp.where(s.outside == 1, 1.0, -1.0) * s.ng
            handed = wp.where(wp.dot(wp.cross(du, dv), outward) < 0.0, -1.0, 1.0)
            scale = wp.vec2d(wp.float64(1.0), wp.float64(1.0))
            if band.uv_space == 0:
                scale = g.pattern_scale[s.instance]
            flat = wp.normalize(du)
            along = local[0] * flat + local[1] * wp.cross(outward, flat)
            flip = wp.vec2d(scale[0], wp.float64(handed) * scale[1])
            turned = in_pattern(g, s, along, flip)
            r.cos_a = turned[0]
            r.sin_a = turned[1]
            turn = wp.rint(wp.atan2(turned[1], turned[0]) / wp.pi * float(BINS)) * wp.pi / float(BINS)
            r.cos_y = wp.cos(turn)
            r.sin_y = wp.sin(turn)
    return r
