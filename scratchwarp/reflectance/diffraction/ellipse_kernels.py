"""Footprints over arrays."""

import warp as wp

from .ellipse_device import ellipse_coverage, ellipse_footprint, make_ellipse
from .quadrature_device import Rules
from .real_device import real

wp.set_module_options({"enable_backward": False})


@wp.struct
class Footprints:
    """Half-axes [um], angle from the scratch to a1 [rad], distance of the scratch [um], coherence radius [um]."""

    a1: wp.array(dtype=real)
    a2: wp.array(dtype=real)
    angle: wp.array(dtype=real)
    offset: wp.array(dtype=real)
    sigma: wp.array(dtype=real)


@wp.kernel
def footprint_kernel(f: Footprints, method: int, rules: Rules, out: wp.array(dtype=real)):
    """Mean of |eta_s|^2."""
    i = wp.tid()
    e = make_ellipse(f.a1[i], f.a2[i], f.angle[i])
    out[i] = ellipse_footprint(e, f.offset[i], f.sigma[i], method, rules)


@wp.kernel
def coverage_kernel(f: Footprints, width: wp.array(dtype=real), method: int, rules: Rules, out: wp.array(dtype=real)):
    """Area density of a scratch."""
    i = wp.tid()
    e = make_ellipse(f.a1[i], f.a2[i], f.angle[i])
    out[i] = ellipse_coverage(e, f.offset[i], width[i], f.sigma[i], method, rules)
