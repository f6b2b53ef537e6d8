"""The device functions of single terms over arrays."""

import warp as wp

from scratchwarp.reflectance.diffraction.faddeeva_device import damped_erf_between, faddeeva
from scratchwarp.reflectance.diffraction.lobe_device import lobe_integral, lobe_integral_paper, sinc

wp.set_module_options({"enable_backward": False})


@wp.kernel
def lobe_kernel(t: wp.array(dtype=wp.float64), out: wp.array(dtype=wp.vec4d)):
    """sinc, half turns and rest of M, M of Eq. 29."""
    i = wp.tid()
    m = lobe_integral(t[i])
    out[i] = wp.vec4d(sinc(t[i]), wp.float64(m.half), m.rest, lobe_integral_paper(t[i]))


@wp.kernel
def error_kernel(x: wp.array(dtype=wp.vec3d), out: wp.array(dtype=wp.vec4d)):
    """w(x + i y) of the first two, e^{-z^2} [erf(y + i z) - erf(x + i z)]."""
    i = wp.tid()
    w = faddeeva(wp.vec2d(x[i][0], x[i][1]))
    e = damped_erf_between(x[i][0], x[i][1], x[i][2])
    out[i] = wp.vec4d(w[0], w[1], e[0], e[1])
