"""Device functions of diffraction as kernels, for the tests."""

import warp as wp

from scratchwarp.kernels.glint_arrays_device import GlintArrays, Strand, WaveLayer
from scratchwarp.kernels.glint_energy_device import BINS, COLUMNS, balance_of, take_share

wp.set_module_options({"enable_backward": False})


@wp.kernel
def balances(
    a: GlintArrays,
    layer: WaveLayer,
    areas: wp.array2d(dtype=float),
    parts: wp.array2d(dtype=float),
    depths: wp.array2d(dtype=float),
    left: wp.array(dtype=wp.vec3),
    shared: wp.array(dtype=wp.vec3),
    sums: wp.array2d(dtype=float),
):
    """For each row of strands: factors of base and scratches, and the sums of a |D|^2."""
    i = wp.tid()
    covered = wp.zeros(shape=wp.static(COLUMNS), dtype=float)
    taken = wp.zeros(shape=wp.static(BINS), dtype=float)
    for j in range(areas.shape[1]):
        s = Strand()
        s.depth = depths[i, j]
        s.part = parts[i, j]
        take_share(a, layer, s, areas[i, j] * parts[i, j], covered, taken)
    b = balance_of(a, covered, taken)
    left[i] = b.left
    shared[i] = b.shared
    for k in range(wp.static(COLUMNS)):
        sums[i, k] = covered[k]
