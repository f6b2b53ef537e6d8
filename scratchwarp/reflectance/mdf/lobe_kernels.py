"""Kernels behind ``lobe``: one thread a pair of directions."""

import warp as wp

from .lobe_device import Lobe, lobe_eval, lobe_pdf, lobe_sample

wp.set_module_options({"enable_backward": False})


@wp.kernel
def evaluate(
    lobe: Lobe,
    wi: wp.array(dtype=wp.vec3),
    wo: wp.array(dtype=wp.vec3),
    delta: wp.array(dtype=wp.vec2),
    value: wp.array(dtype=float),
    pdf: wp.array(dtype=float),
):
    """f_r and density of each pair."""
    i = wp.tid()
    value[i] = lobe_eval(lobe, delta[i], wo[i], wi[i])
    pdf[i] = lobe_pdf(lobe, delta[i], wo[i], wi[i])


@wp.kernel
def sample(
    lobe: Lobe,
    wo: wp.array(dtype=wp.vec3),
    u: wp.array(dtype=wp.vec3),
    delta: wp.array(dtype=wp.vec2),
    wi: wp.array(dtype=wp.vec3),
    weight: wp.array(dtype=float),
    pdf: wp.array(dtype=float),
):
    """A direction for each view."""
    i = wp.tid()
    s = lobe_sample(lobe, delta[i], wo[i], wp.vec2(u[i][0], u[i][1]), u[i][2])
    wi[i] = s.wi
    weight[i] = s.weight
    pdf[i] = s.pdf
