"""Rays of any length over a pattern: in stretches short enough for the pieces near each to be listed."""

import warp as wp

from ...scratches.grid_device import Grid
from .cast_device import Crossing, cast
from .footprint_device import Footprint
from .near_device import find_near
from .solid_device import GrooveSet

wp.set_module_options({"enable_backward": False})

CELLS = wp.constant(wp.float64(4.0))  # longest stretch, in cells of the grid
STRETCHES = wp.constant(256)


@wp.func
def near_stretch(
    grooves: GrooveSet, grid: Grid, p: wp.vec3d, d: wp.vec3d, length: wp.float64, ids: wp.array(dtype=int), room: int
) -> int:  # fmt: skip
    """The pieces that a ray from ``p`` may meet within ``length``: how many there are, ``room`` of them written."""
    f = Footprint()
    f.center = wp.vec2d(p[0], p[1])
    tall = wp.max(grooves.top - grooves.bottom, grooves.skin)
    slope = (length / tall) * wp.vec2d(d[0], d[1])
    none = wp.vec2d(wp.float64(0.0), wp.float64(0.0))
    return find_near(grooves, grid, f, none, slope, ids, room)


@wp.func
def follow(
    grooves: GrooveSet, grid: Grid, p: wp.vec3d, d: wp.vec3d, anything: int, inside: int, ids: wp.array(dtype=int),
    room: int,
) -> Crossing:  # fmt: skip
    """``cast`` along the unit direction ``d`` from ``p`` until the ray lies above or below everything.

    ``ids`` [room]: written over. Rays that stay level are followed over ``STRETCHES`` stretches.
    """
    zero = wp.float64(0.0)
    far = wp.float64(wp.inf)
    slack = wp.float64(1.0e-3) * (grooves.top - grooves.bottom) + wp.float64(4.0) * grooves.skin
    left = far
    if d[2] > zero:
        left = (wp.max(grooves.top - p[2], zero) + slack) / d[2]
    if d[2] < zero:
        left = (wp.min(grooves.bottom - p[2], zero) - slack) / d[2]
    hit = Crossing()
    hit.distance = far
    hit.piece = -1
    gone = zero
    stretches = int(0)
    while left > zero and stretches < STRETCHES:
        stretches += 1
        here = p + gone * d
        length = wp.min(left, CELLS * grid.cell)
        count = near_stretch(grooves, grid, here, d, length, ids, room)
        halved = int(0)
        while count > room and halved < 8:
            halved += 1
            length = wp.float64(0.5) * length
            count = near_stretch(grooves, grid, here, d, length, ids, room)
        met = cast(grooves, ids, wp.min(count, room), here, d, wp.float64(1.0 + 1e-9) * length, anything, inside)
        gone += length
        left -= length
        if met.distance < far:
            hit = met
            hit.distance = met.distance + gone - length
            left = zero
    return hit
