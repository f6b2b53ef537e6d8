"""Radiance under domes over arrays."""

import warp as wp

from .dome_device import dome_radiance
from .quadrature_device import Rules
from .radiance_kernels import Queries
from .real_device import real
from .slice_device import LobeTables, make_lobe

wp.set_module_options({"enable_backward": False})


@wp.kernel
def dome_kernel(
    q: Queries, tables: LobeTables, rules: Rules, values: wp.array2d(dtype=real), out: wp.array(dtype=real)
):
    """Under one dome all."""
    i = wp.tid()
    lobe = make_lobe(q.scratch[i], q.omega_o[i], q.wavelength[i], q.kind, q.table[i, 0], q.table[i, 1])
    out[i] = dome_radiance(values, lobe, tables, rules)
