"""Kernels behind ``walks``: one thread a footprint, its samples in a loop."""

import warp as wp

from ...optics.sampling_device import sample_concentric_disk
from ...optics.sobol_device import sobol_2d
from ...scratches.grid_device import Grid
from .facet_device import FacetMaterials, facet_radiance
from .footprint_device import Footprint, slope_of
from .near_device import find_near, with_room
from .scatter_device import scatter_facet
from .solid_device import GrooveSet, Piece
from .walk_device import make_walk

wp.set_module_options({"enable_backward": False})


NEAR = wp.constant(512)  # grooves near a footprint that paths are followed among

walk = make_walk(FacetMaterials, scatter_facet, facet_radiance)


@wp.kernel
def walks(
    grooves: GrooveSet,
    materials: FacetMaterials,
    bounces: int,
    samples: int,
    grid: Grid,
    reach: wp.float64,
    center: wp.array(dtype=wp.vec2d),
    axis1: wp.array(dtype=wp.vec2d),
    axis2: wp.array(dtype=wp.vec2d),
    omega_o: wp.array(dtype=wp.vec3d),
    omega_i: wp.array(dtype=wp.vec3d),
    light: wp.array(dtype=wp.vec3d),
    position: wp.array2d(dtype=wp.vec3d),
    direction: wp.array2d(dtype=wp.vec3d),
    weight: wp.array2d(dtype=wp.vec3d),
    state: wp.array2d(dtype=wp.vec3i),
):
    """Paths from points all over each footprint, grooves within ``reach`` of it counted.

    ``light``: mean of what unit perpendicular irradiance adds by bounces. The end of each path when ``position`` has
    columns: where, whither, weight, (inside, surfaces met, left).
    """
    t = wp.tid()
    f = Footprint()
    f.center = center[t]
    f.a1 = axis1[t]
    f.a2 = axis2[t]
    o = omega_o[t]
    if o[2] > wp.float64(1e-9):
        slope = slope_of(o)
        wide = Footprint()
        wide.center = f.center
        long = reach + wp.length(f.a1) + wp.length(f.a2)
        wide.a1 = wp.vec2d(long, wp.float64(0.0))
        wide.a2 = wp.vec2d(wp.float64(0.0), long)
        flat = wp.vec2d(wp.float64(0.0), wp.float64(0.0))
        room = wp.zeros(shape=NEAR, dtype=Piece)
        ids = wp.zeros(shape=NEAR, dtype=int)
        held = with_room(grooves, room)
        count = wp.min(find_near(held, grid, wide, slope, flat, ids, NEAR), NEAR)
        above = grooves.top + wp.float64(1.0e6) * grooves.skin
        total = wp.vec3d(wp.float64(0.0), wp.float64(0.0), wp.float64(0.0))
        for k in range(samples):
            q = sample_concentric_disk(sobol_2d(wp.uint32(k), 0, wp.uint32(t)))
            x = f.center + wp.float64(q[0]) * f.a1 + wp.float64(q[1]) * f.a2 + above * slope
            start = wp.vec3d(x[0], x[1], above)
            end = walk(held, ids, count, start, -o, materials, omega_i[t], bounces, wp.uint32(k), wp.uint32(t))
            total += end.light
            if k < position.shape[1]:
                position[t, k] = end.p
                direction[t, k] = end.d
                weight[t, k] = end.weight
                state[t, k] = wp.vec3i(end.inside, end.met, end.left)
        light[t] = total / wp.float64(samples)
