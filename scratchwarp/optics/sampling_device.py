"""Sampling on the device: the front door to hashes, Sobol points and pixel filters, and the warps of the unit square.

Every warp takes ``u`` in [0, 1)^2 and has its density in the docstring; directions are unit, around +z.
"""

import warp as wp

from scratchwarp.optics.filters_device import (
    filter_offset_blackman_harris,
    filter_offset_box,
    filter_offset_gaussian,
)
from scratchwarp.optics.hash_device import hash_combine, pcg_hash, pixel_seed, unit_float
from scratchwarp.optics.sobol_device import sobol_1d, sobol_2d

__all__ = [
    "cone_one_minus_cos",
    "filter_offset_blackman_harris",
    "filter_offset_box",
    "filter_offset_gaussian",
    "hash_combine",
    "pcg_hash",
    "pixel_seed",
    "sample_concentric_disk",
    "sample_cone",
    "sample_cosine_hemisphere",
    "sample_uniform_sphere",
    "sobol_1d",
    "sobol_2d",
    "unit_float",
]

_PI = wp.constant(3.141592653589793)


@wp.func
def sample_concentric_disk(u: wp.vec2) -> wp.vec2:
    """Uniform over the unit disk, density 1 / pi, by Shirley and Chiu's map (squares to rings, area kept)."""
    a = 2.0 * u[0] - 1.0
    b = 2.0 * u[1] - 1.0
    horizontal = wp.abs(a) > wp.abs(b)
    radius = wp.where(horizontal, a, b)
    other = wp.where(horizontal, b, a)
    angle = 0.25 * _PI * other / wp.where(radius == 0.0, 1.0, radius)
    c = radius * wp.cos(angle)
    s = radius * wp.sin(angle)
    return wp.where(horizontal, wp.vec2(c, s), wp.vec2(s, c))


@wp.func
def sample_cosine_hemisphere(u: wp.vec2) -> wp.vec3:
    """Direction above the plane with density z / pi."""
    d = sample_concentric_disk(u)
    return wp.vec3(d[0], d[1], wp.sqrt(wp.max(1.0 - d[0] * d[0] - d[1] * d[1], 0.0)))


@wp.func
def cone_one_minus_cos(half_angle: float) -> float:
    """1 - cos(half_angle) without cancellation."""
    s = wp.sin(0.5 * half_angle)
    return 2.0 * s * s


@wp.func
def sample_cone(u: wp.vec2, one_minus_cos: float) -> wp.vec3:
    """Uniform in the cap of directions whose cosine to +z is at least 1 - ``one_minus_cos``.

    Density 1 / (2 pi one_minus_cos); ``one_minus_cos`` from 0 (the direction +z itself) to 2 (the sphere).
    """
    drop = u[0] * one_minus_cos
    radius = wp.sqrt(wp.max(drop * (2.0 - drop), 0.0))
    angle = 2.0 * _PI * u[1]
    return wp.vec3(radius * wp.cos(angle), radius * wp.sin(angle), 1.0 - drop)


@wp.func
def sample_uniform_sphere(u: wp.vec2) -> wp.vec3:
    """Uniform over the sphere, density 1 / (4 pi)."""
    return sample_cone(u, 2.0)
