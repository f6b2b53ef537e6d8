"""Kernels that turn stored paths into tables: reflectance along each path, and energy into bins of the exit angle."""

import warp as wp

from scratchwarp.profiles.path_device import Cosines
from scratchwarp.profiles.trace_kernels import Lines, broken

wp.set_module_options({"enable_backward": False})

_HALF_PI = wp.constant(1.5707963267948966)
# Widths of deposits never fall below this share of a bin: a ray exactly on a bin edge is then shared by both sides.
_NARROWEST = wp.constant(2.0e-3)


@wp.struct
class Deposit:
    """Bins that the energy of each column goes to."""

    half: wp.array(dtype=float)  # [lines] half the range of incidence [rad] that a line stands for
    offset: wp.array(dtype=float)  # [lines] from the line's incidence to the middle of that range
    product: wp.array(dtype=float, ndim=3)  # [lines, rays, layers] reflectance along each path
    energy: wp.array(dtype=float, ndim=3)  # [columns, 3 + layers, bins]: by 1, 2, 3 and more bounces, then the layers
    lost: wp.array(dtype=float)  # [columns]
    lines_each: int  # lines a column


@wp.kernel
def reflect_along(
    start: int,
    lines: Lines,
    cosines: Cosines,
    table: wp.array(dtype=float, ndim=2),
    product: wp.array(dtype=float, ndim=3),
):
    """Product of the reflectances at a path's bounces, for every ray of a line and every row of ``table`` [layers,
    nodes] (over the cosine in the plane, from 0 to 1)."""
    line = start + wp.tid()
    layers = table.shape[0]
    nodes = table.shape[1]
    for ray in range(lines.counts[line, 0]):
        for layer in range(layers):
            product[line, ray, layer] = 1.0
        base = line * cosines.capacity + lines.first[line, ray]
        for bounce in range(lines.bounces[line, ray]):
            place = wp.abs(cosines.value[base + bounce]) * float(nodes - 1)
            node = wp.min(int(place), nodes - 2)
            between = place - float(node)
            for layer in range(layers):
                lower = table[layer, node]
                upper = table[layer, node + 1]
                factor = lower + between * (upper - lower)
                product[line, ray, layer] = factor * product[line, ray, layer]


@wp.func
def ramp(u: float) -> float:
    """Integral of the positive part."""
    positive = wp.max(u, 0.0)
    return 0.5 * positive * positive


@wp.func
def share_below(edge: float, low: float, high: float, smear: float) -> float:
    """Part of a uniform spread over [low, high], blurred by a box of half-width smear, that lies below edge."""
    if smear <= 0.0:
        return wp.clamp((edge - low) / (high - low), 0.0, 1.0)
    total = ramp(edge - low + smear) - ramp(edge - high + smear) - ramp(edge - low - smear) + ramp(edge - high - smear)
    return wp.clamp(total / (2.0 * smear * (high - low)), 0.0, 1.0)


@wp.func
def centre(lines: Lines, deposit: Deposit, line: int, ray: int) -> float:
    """Exit angle for the middle of the range of incidence."""
    return lines.phi_o[line, ray] + wp.clamp(lines.rate_phi[line, ray] * deposit.offset[line], -0.5, 0.5)


@wp.func
def spread(
    deposit: Deposit,
    lines: Lines,
    column: int,
    line: int,
    left: int,
    right: int,
    energy: float,
):
    """Put the energy of a strip whose rays agree (or of one ray: left == right) over the exit angles it reaches."""
    bins = deposit.energy.shape[2]
    layers = deposit.product.shape[2]
    bounces = lines.bounces[line, left]
    if bounces < 0:
        deposit.lost[column] += energy
    else:
        a = (centre(lines, deposit, line, left) + _HALF_PI) / lines.bin
        b = (centre(lines, deposit, line, right) + _HALF_PI) / lines.bin
        low = wp.min(a, b)
        high = wp.max(a, b)
        rate = 0.5 * (wp.abs(lines.rate_phi[line, left]) + wp.abs(lines.rate_phi[line, right]))
        smear = wp.min(rate * deposit.half[line], 0.5) / lines.bin
        middle = 0.5 * (low + high)
        if high - low < 0.03 * smear:
            # a single direction of exit, blurred by the range of incidence alone
            low = middle - smear
            high = middle + smear
            smear = 0.0
        if high - low < _NARROWEST:
            low = middle - 0.5 * _NARROWEST
            high = middle + 0.5 * _NARROWEST
        order = wp.min(bounces, 3) - 1
        first = wp.clamp(int(wp.floor(low - smear)), 0, bins - 1)
        last = wp.clamp(int(wp.floor(high + smear)), first, bins - 1)
        below = float(0.0)
        for j in range(first, last + 1):
            upto = float(1.0)
            if j < last:
                # measured from the strip's middle, where float32 is finest
                upto = share_below(float(j + 1 - first), low - float(first), high - float(first), smear)
            part = energy * (upto - below)
            below = upto
            deposit.energy[column, order, j] += part
            for layer in range(layers):
                product = 0.5 * (deposit.product[line, left, layer] + deposit.product[line, right, layer])
                deposit.energy[column, 3 + layer, j] += part * product


@wp.kernel
def deposit_strips(start: int, lines: Lines, deposit: Deposit):
    """Each strip over the angles between its two rays; half to each ray where they still disagree."""
    column = start + wp.tid()
    for k in range(deposit.lines_each):
        line = column * deposit.lines_each + k
        for strip in range(lines.counts[line, 1]):
            left = lines.left[line, strip]
            right = lines.right[line, strip]
            width = lines.width[line, strip]
            energy = width / float(deposit.lines_each)
            if broken(lines, line, left, right, width):
                spread(deposit, lines, column, line, left, left, 0.5 * energy)
                spread(deposit, lines, column, line, right, right, 0.5 * energy)
            else:
                spread(deposit, lines, column, line, left, right, energy)


@wp.kernel
def deposit_samples(start: int, lines: Lines, deposit: Deposit):
    """Each ray counts 1, which float32 adds without error up to 16 million; the host divides."""
    column = start + wp.tid()
    bins = deposit.energy.shape[2]
    layers = deposit.product.shape[2]
    count = lines.counts[column, 0]
    for ray in range(count):
        bounces = lines.bounces[column, ray]
        if bounces < 0:
            deposit.lost[column] += 1.0
        else:
            place = (lines.phi_o[column, ray] + _HALF_PI) / lines.bin
            j = wp.clamp(int(wp.floor(place)), 0, bins - 1)
            deposit.energy[column, wp.min(bounces, 3) - 1, j] += 1.0
            for layer in range(layers):
                deposit.energy[column, 3 + layer, j] += deposit.product[column, ray, layer]
