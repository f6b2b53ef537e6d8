"""Kernels behind ``evaluation``: one thread a pair of directions."""

import warp as wp

from .sample_device import stencil_pdf, stencil_sample
from .stencil_device import Stencil, stencil_eval

wp.set_module_options({"enable_backward": False})


@wp.kernel
def evaluate(
    stencil: Stencil,
    wi: wp.array(dtype=wp.vec3),
    wo: wp.array(dtype=wp.vec3),
    value: wp.array(dtype=wp.vec3),
    pdf: wp.array(dtype=float),
):
    """f_r and, where ``pdf`` is given, the density of each pair."""
    i = wp.tid()
    value[i] = stencil_eval(stencil, wo[i], wi[i])
    if pdf.shape[0] > 0:
        pdf[i] = stencil_pdf(stencil, wo[i], wi[i])


@wp.kernel
def sample(
    stencil: Stencil,
    wo: wp.array(dtype=wp.vec3),
    u: wp.array(dtype=wp.vec3),
    wi: wp.array(dtype=wp.vec3),
    weight: wp.array(dtype=wp.vec3),
    pdf: wp.array(dtype=float),
):
    """A direction for each view."""
    i = wp.tid()
    s = stencil_sample(stencil, wo[i], wp.vec2(u[i][0], u[i][1]), u[i][2])
    wi[i] = s.wi
    weight[i] = s.weight
    pdf[i] = s.pdf
