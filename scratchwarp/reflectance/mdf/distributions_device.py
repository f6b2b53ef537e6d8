"""Densities of facet normals, written for the point ``p`` where a normal lies over the unit disk, and z2 = normal_z^2.

All are generic in the scalar type: the renderer calls them in float32, the NumPy entry points in float64. The z of a
normal near the pole is 1 to rounding, whatever its exponent; ``p`` is not, so powers of z are taken from 1 - |p|^2.

Sources: Ashikhmin and Shirley 2000 (Eq. 1 of Kang and Cho, a density a solid angle); Ward 1992 (the exponential alone,
peak 1 / (pi ax ay)); Beckmann and GGX, whose integrals times the cosine are 1.
"""

from typing import Any

import warp as wp

ASHIKHMIN_SHIRLEY = wp.constant(0)
WARD = wp.constant(1)
BECKMANN = wp.constant(2)
GGX = wp.constant(3)


@wp.func
def facet_z2(h: Any):
    """h_z^2 without cancellation: from z itself near the horizon, from x and y near the pole."""
    r2 = h[0] * h[0] + h[1] * h[1]
    return wp.where(h[2] * h[2] < h.dtype(0.5), h[2] * h[2], h.dtype(1.0) - r2)


@wp.func
def ashikhmin_shirley_d(p: Any, z2: Any, ex: Any, ey: Any):
    """sqrt((ex + 1)(ey + 1)) / (2 pi) z^(ex cos^2 phi + ey sin^2 phi) [1/sr]; the pole needs no azimuth."""
    one = p.dtype(1.0)
    u = wp.max(z2, p.dtype(1.0e-30))
    # log(z2) / |p|^2, whose limit at the pole is -1; 1 - u is exact, so that rounding of u cancels
    slope = wp.where(u < one, wp.log(u) / wp.max(one - u, p.dtype(1.0e-30)), -one)
    power = p.dtype(0.5) * (ex * p[0] * p[0] + ey * p[1] * p[1]) * slope
    return wp.sqrt((ex + one) * (ey + one)) / p.dtype(6.283185307179586) * wp.exp(power)


@wp.func
def ward_d(p: Any, z2: Any, ax: Any, ay: Any):
    """exp(-tan^2 theta (cos^2 phi / ax^2 + sin^2 phi / ay^2)) / (pi ax ay)."""
    x = p[0] / ax
    y = p[1] / ay
    return wp.exp(-(x * x + y * y) / wp.max(z2, p.dtype(1.0e-30))) / (p.dtype(3.141592653589793) * ax * ay)


@wp.func
def beckmann_d(p: Any, z2: Any, ax: Any, ay: Any):
    """Ward's exponential over cos^4 theta."""
    z = wp.max(z2, p.dtype(1.0e-15))
    return ward_d(p, z2, ax, ay) / (z * z)


@wp.func
def ggx_disk_d(p: Any, z2: Any, ax: Any, ay: Any):
    """1 / (pi ax ay (x^2 / ax^2 + y^2 / ay^2 + z^2)^2)."""
    x = p[0] / ax
    y = p[1] / ay
    e = wp.max(x * x + y * y + z2, p.dtype(1.0e-15))
    return p.dtype(1.0) / (p.dtype(3.141592653589793) * ax * ay * e * e)


@wp.func
def facet_density(distribution: int, p: Any, z2: Any, x: Any, y: Any):
    """D of the distribution named; ``x`` and ``y`` are its exponents or widths."""
    d = p.dtype(0.0)
    if distribution == ASHIKHMIN_SHIRLEY:
        d = ashikhmin_shirley_d(p, z2, x, y)
    elif distribution == WARD:
        d = ward_d(p, z2, x, y)
    elif distribution == BECKMANN:
        d = beckmann_d(p, z2, x, y)
    else:
        d = ggx_disk_d(p, z2, x, y)
    return d
