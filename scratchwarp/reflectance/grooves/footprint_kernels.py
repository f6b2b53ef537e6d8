"""Kernel behind ``footprint``: one thread a footprint, in float64."""

import warp as wp

from ...scratches.grid_device import Grid
from .facet_device import FacetMaterials, facet_radiance
from .footprint_device import Footprint, make_footprint_mean, slope_of
from .near_device import find_near
from .solid_device import GrooveSet

wp.set_module_options({"enable_backward": False})

footprint_mean = make_footprint_mean(FacetMaterials, facet_radiance)


@wp.kernel
def means(
    grooves: GrooveSet,
    materials: FacetMaterials,
    slices: int,
    chord: int,
    grid: Grid,
    near: wp.array2d(dtype=int),
    center: wp.array(dtype=wp.vec2d),
    axis1: wp.array(dtype=wp.vec2d),
    axis2: wp.array(dtype=wp.vec2d),
    omega_o: wp.array(dtype=wp.vec3d),
    omega_i: wp.array(dtype=wp.vec3d),
    out: wp.array(dtype=wp.vec3d),
    found: wp.array(dtype=wp.float64),
):
    """Mean radiance and the share of each footprint in which a surface was found; -1: ``near`` is too narrow."""
    t = wp.tid()
    f = Footprint()
    f.center = center[t]
    f.a1 = axis1[t]
    f.a2 = axis2[t]
    o = omega_o[t]
    i = omega_i[t]
    count = int(0)
    if o[2] > wp.float64(0.0):
        slope_i = wp.vec2d(wp.float64(0.0), wp.float64(0.0))
        if i[2] > wp.float64(1e-9):
            slope_i = slope_of(i)
        count = find_near(grooves, grid, f, slope_of(o), slope_i, near[t], near.shape[1])
    found[t] = wp.float64(-1.0)
    if count <= near.shape[1]:
        mean = footprint_mean(grooves, near[t], count, f, o, i, materials, slices, chord)
        out[t] = mean.radiance
        found[t] = mean.found
