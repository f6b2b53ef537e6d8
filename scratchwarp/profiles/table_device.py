"""Sampling data of a profile table on the device: the density over phi_i for a given phi_o, and its inverse.

Within a bin of phi_i the density is proportional to cos(phi_i), so that sin(phi_i) is uniform there; phi_o takes the
row of its bin.
"""

import warp as wp

wp.set_module_options({"enable_backward": False})

_PI = wp.constant(3.14159265358979)
_HAIR = wp.constant(1.0e-6)
_HALF_PI = wp.constant(1.5707963267948966)


@wp.func
def table_bin(phi: float, bins: int) -> int:
    """Bin of an angle in [-pi/2, pi/2]."""
    return wp.clamp(int(wp.floor((phi + _HALF_PI) / _PI * float(bins))), 0, bins - 1)


@wp.func
def table_edge(k: int, bins: int) -> float:
    """Sine of the k-th bin edge."""
    return wp.sin(_PI * (float(k) / float(bins) - 0.5))


@wp.func
def table_pdf(cdf: wp.array(dtype=float, ndim=2), phi_o: float, phi_i: float) -> float:
    """Density of phi_i [1/rad], 0 outside [-pi/2, pi/2]."""
    bins = cdf.shape[0]
    density = float(0.0)
    if wp.abs(phi_i) <= _HALF_PI:
        row = table_bin(phi_o, bins)
        k = table_bin(phi_i, bins)
        share = cdf[row, k + 1] - cdf[row, k]
        density = share * wp.max(wp.cos(phi_i), 0.0) / (table_edge(k + 1, bins) - table_edge(k, bins))
    return density


@wp.func
def table_sample(cdf: wp.array(dtype=float, ndim=2), phi_o: float, u: float):
    """(phi_i, density) for u in [0, 1)."""
    bins = cdf.shape[0]
    row = table_bin(phi_o, bins)
    low = int(0)
    high = bins
    # the last edge at or below u: bins without energy have equal edges and are stepped over
    while high - low > 1:
        middle = (low + high) // 2
        if cdf[row, middle] <= u:
            low = middle
        else:
            high = middle
    # u may reach the last edge by rounding; go back to the last bin that holds energy
    while low > 0 and cdf[row, low + 1] <= cdf[row, low]:
        low -= 1
    share = wp.max(cdf[row, low + 1] - cdf[row, low], 1.0e-30)
    between = wp.clamp((u - cdf[row, low]) / share, 0.0, 1.0)
    first = table_edge(low, bins)
    last = table_edge(low + 1, bins)
    sine = wp.clamp(first + between * (last - first), -1.0, 1.0)
    # a hair inside the bin, so that rounding never moves a sample to a neighbour with another density
    left = _PI * (float(low) / float(bins) - 0.5)
    phi_i = wp.clamp(wp.asin(sine), left + _HAIR, left + _PI / float(bins) - _HAIR)
    return phi_i, share * wp.cos(phi_i) / (last - first)
