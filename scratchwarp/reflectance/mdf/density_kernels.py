"""Kernels behind ``density``: one thread a point, in float64."""

import warp as wp

from .deform_device import deform_point, inverse_deform_point
from .distributions_device import facet_density, facet_z2

wp.set_module_options({"enable_backward": False})


@wp.kernel
def density(
    distribution: int,
    kind: int,
    h: wp.array(dtype=wp.vec3d),
    delta: wp.array(dtype=wp.vec2d),
    x: wp.array(dtype=wp.float64),
    y: wp.array(dtype=wp.float64),
    out: wp.array(dtype=wp.float64),
):
    """D of ``h``, deformed by ``delta``."""
    i = wp.tid()
    out[i] = wp.float64(0.0)
    if h[i][2] > wp.float64(0.0):
        p = wp.vec2d(h[i][0], h[i][1])
        z2 = facet_z2(h[i])
        if wp.dot(delta[i], delta[i]) > wp.float64(0.0):
            p = inverse_deform_point(kind, p, delta[i])
            z2 = wp.float64(1.0) - wp.dot(p, p)
        if z2 > wp.float64(0.0):
            out[i] = facet_density(distribution, p, z2, x[i], y[i])


@wp.kernel
def moved(
    kind: int,
    inverse: int,
    p: wp.array(dtype=wp.vec2d),
    delta: wp.array(dtype=wp.vec2d),
    out: wp.array(dtype=wp.vec2d),
):
    """T of ``p``, or its inverse."""
    i = wp.tid()
    if inverse == 1:
        out[i] = inverse_deform_point(kind, p[i], delta[i])
    else:
        out[i] = deform_point(kind, p[i], delta[i])
