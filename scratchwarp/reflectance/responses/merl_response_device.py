"""A file of MERL's as a base, in the axes of the uv set: the mean of both ways of the light, energy bounded."""

import warp as wp

from ..base_device import BaseSample, BaseTerms
from ..measured.merl_device import merl_eval
from ..stencils.stencil_device import limit_at
from .half_device import half_pdf, half_sample
from .response_device import ResponseArrays, ResponseAt, Spot, from_axes, to_axes

wp.set_module_options({"enable_backward": False})


@wp.func
def merl_response_place(arrays: ResponseArrays, at: ResponseAt, spot: Spot) -> ResponseAt:
    """Azimuths count from the direction of u."""
    r = at
    r.x_axis = spot.u_axis
    r.y_axis = spot.v_axis
    return r


@wp.func
def merl_response_eval(arrays: ResponseArrays, at: ResponseAt, wo: wp.vec3, wi: wp.vec3) -> BaseTerms:
    """f_r cos(theta_i) and density."""
    t = BaseTerms()
    if wo[2] > 0.0 and wi[2] > 0.0:
        o = to_axes(at, wo)
        i = to_axes(at, wi)
        data = arrays.merl[at.index]
        bound = wp.min(limit_at(data.half.limit, o), limit_at(data.half.limit, i))
        t.value = (0.5 * bound * wi[2]) * (merl_eval(data.brdf, i, o) + merl_eval(data.brdf, o, i))
        t.pdf = half_pdf(data.half, o, i)
    return t


@wp.func
def merl_response_sample(arrays: ResponseArrays, at: ResponseAt, wo: wp.vec3, u: wp.vec2, v: float) -> BaseSample:
    """A direction; pdf 0: none."""
    s = BaseSample()
    s.wi = from_axes(at, half_sample(arrays.merl[at.index].half, to_axes(at, wo), u, v))
    t = merl_response_eval(arrays, at, wo, s.wi)
    if t.pdf > 0.0:
        s.pdf = t.pdf
        s.weight = t.value / t.pdf
    return s
