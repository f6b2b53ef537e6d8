"""A stencil model as a base, in the axes of the uv set."""

import warp as wp

from ..base_device import BaseSample, BaseTerms
from ..stencils.sample_device import stencil_pdf, stencil_sample
from ..stencils.stencil_device import stencil_eval
from .response_device import ResponseArrays, ResponseAt, Spot, from_axes, to_axes

wp.set_module_options({"enable_backward": False})


@wp.func
def stencil_response_place(arrays: ResponseArrays, at: ResponseAt, spot: Spot) -> ResponseAt:
    """Azimuths count from the direction of u."""
    r = at
    r.x_axis = spot.u_axis
    r.y_axis = spot.v_axis
    return r


@wp.func
def stencil_response_eval(arrays: ResponseArrays, at: ResponseAt, wo: wp.vec3, wi: wp.vec3) -> BaseTerms:
    """f_r cos(theta_i) and density."""
    t = BaseTerms()
    if wo[2] > 0.0 and wi[2] > 0.0:
        own_o = to_axes(at, wo)
        own_i = to_axes(at, wi)
        t.value = wi[2] * stencil_eval(arrays.stencils[at.index], own_o, own_i)
        t.pdf = stencil_pdf(arrays.stencils[at.index], own_o, own_i)
    return t


@wp.func
def stencil_response_sample(arrays: ResponseArrays, at: ResponseAt, wo: wp.vec3, u: wp.vec2, v: float) -> BaseSample:
    """A direction; pdf 0: none."""
    drawn = stencil_sample(arrays.stencils[at.index], to_axes(at, wo), u, v)
    s = BaseSample()
    s.wi = from_axes(at, drawn.wi)
    s.pdf = drawn.pdf
    s.weight = drawn.weight
    return s
