"""The lobe of a cross-section made of facets, of all sizes and wavelengths at once, from a table.

|P|^2 / lambda^2 = (w / lambda)^2 L(w xi_2 / lambda, d g / lambda) of a scratch of width w and depth d, g the sum of the
cosines: L is that of a width and a depth of 1. It holds no cycles finer than 1 of either argument.
"""

import warp as wp

from ..reflectance.diffraction.outline_device import outline_transform
from .glint_arrays_device import GlintArrays, WaveLayer

wp.set_module_options({"enable_backward": False})

PER_CYCLE = wp.constant(16.0)
"""Places of the table a unit of its arguments: cubic between, 6e-4 of what has the finest cycles."""


@wp.kernel
def tabulate(outlines: wp.array(dtype=wp.vec4d), first: float, reaches: int, out: wp.array(dtype=float)):
    """L at ``first`` and every step on, ``reaches`` in a row; rows from one step below 0 on."""
    t = wp.tid()
    x = wp.float64(first + float(t % reaches) / PER_CYCLE)
    y = wp.float64(float(t / reaches - 1) / PER_CYCLE)
    one = wp.float64(1.0)
    p = outline_transform(outlines, 0, outlines.shape[0], one, one, x, y)
    out[t] = float(p[0] * p[0] + p[1] * p[1])


@wp.func
def cubic(t: float) -> wp.vec4:
    """Weights of places -1, 0, 1 and 2 at ``t`` in [0, 1]."""
    a = t + 1.0
    b = t - 1.0
    c = t - 2.0
    return wp.vec4(-t * b * c / 6.0, 0.5 * a * b * c, -0.5 * a * t * c, a * t * b / 6.0)


@wp.func
def lobe_at(a: GlintArrays, layer: WaveLayer, reach: float, deep: float) -> float:
    """L of a layer's cross-section; -1 outside its table, or where it has none."""
    if layer.lobe_depths == 0:
        return -1.0
    x = (wp.where(layer.lobe_even == 1, wp.abs(reach), reach) - layer.lobe_first) * PER_CYCLE
    y = deep * PER_CYCLE + 1.0
    if x < 1.0 or y < 1.0 or x >= float(layer.lobe_reaches - 2) or y >= float(layer.lobe_depths - 2):
        return -1.0
    i = int(x)
    j = int(y)
    across = cubic(x - float(i))
    along = cubic(y - float(j))
    total = float(0.0)
    for k in range(4):
        at = layer.lobe + (j + k - 1) * layer.lobe_reaches + i
        row = across[0] * a.lobes[at - 1] + across[1] * a.lobes[at]
        row += across[2] * a.lobes[at + 1] + across[3] * a.lobes[at + 2]
        total += along[k] * row
    return wp.max(total, 0.0)
