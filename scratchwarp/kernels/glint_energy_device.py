"""What scratches take from the base, wavelength for wavelength, and what it then leaves to them.

A scratch of area share a takes a |D|^2: what it diffracts, and what interferes with the base. Lines that lie at random
take 1 - product (1 - a_m |D_m|^2) together, many of them 1 - e^{-sum}: they stand in each other's place. Pieces of one
line take what it would: each its part of the logarithm.
"""

import warp as wp

from .glint_arrays_device import GlintArrays, Strand, WaveLayer
from .lobe_device import luminance

BINS = 16
"""Parts of the spectrum, even in 1 / wavelength; |D|^2 is averaged over each."""
COLUMNS = BINS + 3
"""The same, and linear Rec.709 of |D|^2 over the whole spectrum."""


@wp.struct
class Balance:
    """Linear Rec.709 factors of the base, ``left``, and of the sum of all scratches, ``shared``."""

    left: wp.vec3
    shared: wp.vec3


@wp.func
def take_share(
    a: GlintArrays,
    layer: WaveLayer,
    strand: Strand,
    area: float,
    covered: wp.array(dtype=float),
    taken: wp.array(dtype=float),
):
    """Add a strand of area share ``area`` to the sums of a |D|^2 and of -log(1 - a |D|^2)."""
    last = layer.share_count - 1
    at = wp.clamp(strand.depth / layer.share_step, 0.0, float(last))
    cell = wp.min(int(at), last - 1)
    t = at - float(cell)
    row = layer.share + cell
    line = area / wp.max(strand.part, 1.0e-6)
    for k in range(BINS):
        share = line * ((1.0 - t) * a.shares[row, k] + t * a.shares[row + 1, k])
        covered[k] = covered[k] + strand.part * share
        s = wp.min(share, 0.9999)
        whole = s * (1.0 + s * (0.5 + s * (0.33333333 + s * (0.25 + 0.2 * s))))
        if s > 0.25:
            whole = -wp.log(1.0 - s)
        taken[k] = taken[k] + strand.part * whole
    for c in range(3):
        value = (1.0 - t) * a.shares[row, BINS + c] + t * a.shares[row + 1, BINS + c]
        covered[BINS + c] = covered[BINS + c] + area * value


@wp.func
def take_all(covered: wp.array(dtype=float), taken: wp.array(dtype=float)):
    """Scratches that interfere take what they would each: where they stand the fields say."""
    for k in range(BINS):
        taken[k] = -wp.log(wp.max(1.0 - covered[k], 1.0e-6))


@wp.func
def balance_of(a: GlintArrays, covered: wp.array(dtype=float), taken: wp.array(dtype=float)) -> Balance:
    """Base and scratches return 1 together in every channel, as they do at every wavelength."""
    r = Balance()
    # of the spectrum's parts; they say how crowded it is, and the whole spectrum what that is a part of
    sum = wp.vec3(0.0, 0.0, 0.0)
    gone = wp.vec3(0.0, 0.0, 0.0)
    for k in range(BINS):
        # the base never keeps more than scratches that are bright enough leave
        part = wp.min(1.0 - wp.exp(-taken[k]), covered[k])
        sum += covered[k] * a.share_colors[k]
        gone += part * a.share_colors[k]
    exact = wp.vec3(covered[BINS], covered[BINS + 1], covered[BINS + 2])
    y = wp.min(luminance(gone) / wp.max(luminance(sum), 1.0e-12), 1.0)
    for c in range(3):
        # colours so pure that a channel has nothing take the factor of the luminance
        factor = y
        if sum[c] > 1.0e-3 * luminance(sum) and sum[c] > 0.0:
            factor = wp.clamp(gone[c] / sum[c], 0.0, 1.0)
        lost = wp.clamp(factor * exact[c], 0.0, 1.0)
        r.left[c] = 1.0 - lost
        r.shared[c] = factor
        if factor * exact[c] > 1.0:
            r.shared[c] = 1.0 / exact[c]
    return r
