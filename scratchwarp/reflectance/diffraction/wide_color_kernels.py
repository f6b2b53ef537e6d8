"""Colours of single scratches under wide lights over arrays."""

import warp as wp

from .real_device import real, vec3
from .wide_color_device import WideTable, wide_color

wp.set_module_options({"enable_backward": False})


@wp.struct
class WideQueries:
    """Width and depth [um], and the interval of xi_2 that the light fills, one row for each value."""

    width: wp.array(dtype=real)
    depth: wp.array(dtype=real)
    q0: wp.array(dtype=real)
    q1: wp.array(dtype=real)


@wp.kernel
def wide_color_kernel(table: WideTable, q: WideQueries, out: wp.array(dtype=vec3)):
    """Linear Rec.709 before the factor W / (pi^(3/2) sigma)."""
    i = wp.tid()
    out[i] = wide_color(table, q.width[i], q.depth[i], q.q0[i], q.q1[i])
