"""What a sublayer covers of each cell of a grid over the uv square, by the device functions that the renderer runs."""

import warp as wp

from .layer_device import LayerData, LayerHit
from .lines_device import concentric, full, linear, spiral
from .worley_device import worley

wp.set_module_options({"enable_backward": False})

# Positions in scratches.KINDS.
WORLEY = wp.constant(0)
LINEAR = wp.constant(1)
CONCENTRIC = wp.constant(2)
SPIRAL = wp.constant(3)


@wp.kernel
def cells(
    layer: LayerData,
    low: wp.vec2d,
    step: wp.vec2d,
    scale: wp.vec2d,
    rows: int,
    samples: int,
    out: wp.array2d(dtype=wp.vec3),
):
    """(coverage, cos and sin of twice the direction times coverage) of cell (row, column), row 0 where v is largest.

    ``low``: uv of the lower left corner; ``step``: of a cell, in uv; ``scale``: pattern units a unit of uv.
    ``samples`` footprints of a quarter of a cell, laid out by the R2 sequence, are averaged.
    """
    row, column = wp.tid()
    ax = wp.vec2(0.5 * float(step[0] * scale[0]), 0.0)
    ay = wp.vec2(0.0, 0.5 * float(step[1] * scale[1]))
    total = wp.vec3(0.0, 0.0, 0.0)
    for i in range(samples):
        fx = wp.frac(0.5 + 0.7548776662 * float(i + 1))
        fy = wp.frac(0.5 + 0.5698402909 * float(i + 1))
        u = low[0] + step[0] * (wp.float64(column) + wp.float64(fx))
        v = low[1] + step[1] * (wp.float64(rows - 1 - row) + wp.float64(fy))
        q = wp.vec2d(u * scale[0], v * scale[1])
        phase = wp.frac(0.381966 * float(i + 1) + 0.618034 * float(row * 131 + column))
        hit = LayerHit()
        if layer.kind == WORLEY:
            hit = worley(layer, q, scale, ax, ay, phase)
        elif layer.kind == LINEAR:
            hit = linear(layer, q, scale, ax, ay, phase)
        elif layer.kind == CONCENTRIC:
            hit = concentric(layer, q, scale, ax, ay, phase)
        elif layer.kind == SPIRAL:
            hit = spiral(layer, q, scale, ax, ay, phase)
        else:
            hit = full(layer, q, scale, ax, ay, phase)
        d = hit.direction
        total += wp.vec3(hit.alpha, hit.alpha * (d[0] * d[0] - d[1] * d[1]), 2.0 * hit.alpha * d[0] * d[1])
    out[row, column] = total / float(samples)
