"""The renderer's device functions in float32 over arrays."""

import warp as wp

from scratchwarp.reflectance.diffraction.interval_device import cut_cap
from scratchwarp.reflectance.diffraction.response_device import (
    across_integral,
    across_integral_paper,
    depth_response,
    sinc2,
)

wp.set_module_options({"enable_backward": False})


@wp.kernel
def response_kernel(x: wp.array(dtype=wp.vec4), out: wp.array(dtype=wp.vec4)):
    """sinc^2(x), the integral over [y, z] at ratio x, the same with Eq. 29, |D|^2 of depth y at wavelength z, g = 2."""
    i = wp.tid()
    a = x[i]
    out[i] = wp.vec4(
        sinc2(a[0]),
        across_integral(a[0], a[1], a[2]),
        across_integral_paper(a[0], a[1], a[2]),
        depth_response(a[1], a[2], 2.0, 0.0, 0.0),
    )


@wp.kernel
def cap_kernel(
    axis: wp.array(dtype=wp.vec3), angle: wp.array(dtype=float), u: wp.array(dtype=float), out: wp.array(dtype=wp.vec4)
):
    """Intervals of psi of a cap."""
    i = wp.tid()
    out[i] = cut_cap(axis[i], angle[i], u[i])
