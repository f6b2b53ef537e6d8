"""Kernel behind ``footprint``: one thread a footprint, in float64."""

import warp as wp

from ...scratches.grid_device import Grid
from .facet_device import FacetMaterials, facet_radiance
from .footprint_device import Footprint, FootprintMean, make_footprint_mean, slope_of
from .near_device import find_near, with_room
from .solid_device import GrooveSet, Piece

wp.set_module_options({"enable_backward": False})

footprint_mean = make_footprint_mean(FacetMaterials, facet_radiance)


NEAR = wp.constant(64)  # grooves near a footprint, before a larger list is made for it


@wp.func
def mean_among(
    grooves: GrooveSet, materials: FacetMaterials, slices: int, chord: int, grid: Grid, ids: wp.array(dtype=int),
    room: int, f: Footprint, o: wp.vec3d, i: wp.vec3d,
) -> FootprintMean:  # fmt: skip
    """The mean over one footprint; -1 for ``found``: there is no room for all that is near."""
    count = int(0)
    if o[2] > wp.float64(0.0):
        slope_i = wp.vec2d(wp.float64(0.0), wp.float64(0.0))
        if i[2] > wp.float64(1e-9):
            slope_i = slope_of(i)
        count = find_near(grooves, grid, f, slope_of(o), slope_i, ids, room)
    mean = FootprintMean()
    mean.found = wp.float64(-1.0)
    if count <= room:
        mean = footprint_mean(grooves, ids, count, f, o, i, materials, slices, chord)
    return mean


@wp.kernel
def means(
    grooves: GrooveSet,
    materials: FacetMaterials,
    slices: int,
    chord: int,
    grid: Grid,
    center: wp.array(dtype=wp.vec2d),
    axis1: wp.array(dtype=wp.vec2d),
    axis2: wp.array(dtype=wp.vec2d),
    omega_o: wp.array(dtype=wp.vec3d),
    omega_i: wp.array(dtype=wp.vec3d),
    out: wp.array(dtype=wp.vec3d),
    found: wp.array(dtype=wp.float64),
):
    """Mean radiance and the share of each footprint in which a surface was found; -1: more than ``NEAR`` are near."""
    t = wp.tid()
    f = Footprint()
    f.center = center[t]
    f.a1 = axis1[t]
    f.a2 = axis2[t]
    room = wp.zeros(shape=NEAR, dtype=Piece)
    ids = wp.zeros(shape=NEAR, dtype=int)
    held = with_room(grooves, room)
    mean = mean_among(held, materials, slices, chord, grid, ids, NEAR, f, omega_o[t], omega_i[t])
    out[t] = mean.radiance
    found[t] = mean.found


@wp.kernel
def mean_wide(
    grooves: GrooveSet,
    materials: FacetMaterials,
    slices: int,
    chord: int,
    grid: Grid,
    ids: wp.array(dtype=int),
    f: Footprint,
    o: wp.vec3d,
    i: wp.vec3d,
    out: wp.array(dtype=wp.vec3d),
    found: wp.array(dtype=wp.float64),
):
    """``means`` of one footprint with as much room as ``ids`` and ``grooves.pieces`` have."""
    mean = mean_among(grooves, materials, slices, chord, grid, ids, ids.shape[0], f, o, i)
    out[0] = mean.radiance
    found[0] = mean.found
