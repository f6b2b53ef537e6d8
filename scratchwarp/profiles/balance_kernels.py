"""Kernels that join the columns traced into whole tables: symmetry, reciprocity, normalisation, Raymond's exponent."""

import warp as wp

wp.set_module_options({"enable_backward": False})

_LOG_TWO_THIRDS = wp.constant(-0.4054651081081644)
_LARGEST_EXPONENT = wp.constant(64.0)


@wp.struct
class Columns:
    """Energy of the columns traced, ``[columns, layers, bins]``: all of them, or the left half of a symmetric
    profile's."""

    energy: wp.array(dtype=float, ndim=3)
    weight: wp.array(dtype=float)  # [bins] cosine weight of a bin
    reciprocal: int


@wp.func
def column_share(columns: Columns, i: int, layer: int, j: int) -> float:
    """Share of the light of phi_i bin i that leaves into phi_o bin j; columns not traced are their mirror images."""
    bins = columns.energy.shape[2]
    mirrored = i >= columns.energy.shape[0]
    return columns.energy[wp.where(mirrored, bins - 1 - i, i), layer, wp.where(mirrored, bins - 1 - j, j)]


@wp.func
def flow_between(columns: Columns, i: int, layer: int, j: int) -> float:
    """Flow from phi_i bin i to phi_o bin j, averaged with the flow back where the profile is reciprocal."""
    flow = column_share(columns, i, layer, j) * columns.weight[i]
    if columns.reciprocal != 0:
        flow = 0.5 * (flow + column_share(columns, j, layer, i) * columns.weight[j])
    return flow


@wp.kernel
def mirror_flow(start: int, columns: Columns, flow: wp.array(dtype=float, ndim=2)):
    """Flow of a mirror, all orders of reflection, ``[phi_o, phi_i]``; one thread a row."""
    j = start + wp.tid()
    for i in range(flow.shape[1]):
        total = float(0.0)
        for layer in range(3):
            total += flow_between(columns, i, layer, j)
        flow[j, i] = total


@wp.kernel
def scaled_tables(
    start: int,
    columns: Columns,
    row_scale: wp.array(dtype=float),
    column_scale: wp.array(dtype=float),
    table: wp.array(dtype=float, ndim=3),
):
    """rho ``[layers, phi_o, phi_i]``: flow times both scales; one thread a row of all layers."""
    j = start + wp.tid()
    for layer in range(table.shape[0]):
        for i in range(table.shape[2]):
            table[layer, j, i] = flow_between(columns, i, layer, j) * row_scale[j] * column_scale[i]


@wp.kernel
def fit_exponents(
    start: int,
    mirror: wp.array(dtype=float, ndim=2),
    normal: wp.array(dtype=float, ndim=3),
    sixty: wp.array(dtype=float, ndim=3),
    gamma: wp.array(dtype=float, ndim=3),
    flagged: wp.array(dtype=int, ndim=2),
):
    """Exponent of Raymond 2016 Eq. 2 for each channel, row and column; ``flagged`` [rows, 2]: cells misfit, and
    occupied."""
    j = start + wp.tid()
    misfit = int(0)
    occupied = int(0)
    for channel in range(gamma.shape[0]):
        for i in range(gamma.shape[2]):
            top = mirror[j, i]
            span = top - normal[channel, j, i]
            value = float(1.0)
            if top > 0.0:
                occupied += 1
                if span > 1.0e-6 * top:
                    r = (sixty[channel, j, i] - normal[channel, j, i]) / span
                    if r <= 0.0 or r > 1.0:
                        misfit += 1
                    value = _LARGEST_EXPONENT
                    if r > 0.0:
                        value = wp.clamp(wp.log(wp.min(r, 1.0)) / _LOG_TWO_THIRDS, 0.0, _LARGEST_EXPONENT)
            gamma[channel, j, i] = value
    flagged[j, 0] = misfit
    flagged[j, 1] = occupied
