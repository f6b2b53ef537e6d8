"""Facets of Ashikhmin and Shirley's distribution: long along the scratch, as wide across as the profile's slopes."""

import warp as wp

from ...optics.microfacets_device import half_vector
from ..base_device import BaseSample, BaseTerms
from ..mdf.lobe_device import lobe_eval, lobe_pdf, lobe_sample
from .response_device import ResponseArrays, ResponseAt, facet_reflectance

wp.set_module_options({"enable_backward": False})


@wp.func
def facets_eval(arrays: ResponseArrays, at: ResponseAt, wo: wp.vec3, wi: wp.vec3) -> BaseTerms:
    """f_r cos(theta_i) and density."""
    t = BaseTerms()
    if wo[2] > 0.0 and wi[2] > 0.0:
        none = wp.vec2(0.0, 0.0)
        f = lobe_eval(arrays.facets[at.index], none, wo, wi) * wi[2]
        t.value = f * facet_reflectance(arrays, at.reflectance, wp.dot(wo, half_vector(wo, wi)))
        t.pdf = lobe_pdf(arrays.facets[at.index], none, wo, wi)
    return t


@wp.func
def facets_sample(arrays: ResponseArrays, at: ResponseAt, wo: wp.vec3, u: wp.vec2, v: float) -> BaseSample:
    """A direction; pdf 0: none."""
    drawn = lobe_sample(arrays.facets[at.index], wp.vec2(0.0, 0.0), wo, u, v)
    s = BaseSample()
    s.wi = drawn.wi
    s.pdf = drawn.pdf
    if drawn.pdf > 0.0:
        f = facet_reflectance(arrays, at.reflectance, wp.dot(wo, half_vector(wo, drawn.wi)))
        s.weight = drawn.weight * f
    return s
