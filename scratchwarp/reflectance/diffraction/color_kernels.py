"""Colours of single scratches over arrays."""

import warp as wp

from .color_device import FringeTable, scratch_color
from .quadrature_device import Rules
from .real_device import real, vec3

wp.set_module_options({"enable_backward": False})


@wp.kernel
def color_kernel(
    table: FringeTable,
    rules: Rules,
    width: wp.array(dtype=real),
    depth: wp.array(dtype=real),
    xi2: wp.array(dtype=real),
    out: wp.array(dtype=vec3),
):
    """Linear Rec.709."""
    i = wp.tid()
    out[i] = scratch_color(table, rules, width[i], depth[i], xi2[i])
