"""What the lobe of a sample reflects over solid angle: the base's own lobes, or a registered response."""

import warp as wp

from ..reflectance.base_device import BaseSample, BaseTerms, base_eval_pdf, base_sample
from ..reflectance.responses import RESPONSES, kind_number
from ..reflectance.responses.response_device import ResponseArrays, ResponseAt, Spot
from .key import KernelKey
from .lobe_device import Lobe


def make_lobe_terms(key: KernelKey):
    """(terms, drawn): value and density of a lobe, and a direction drawn from it, compiled for ``key``."""
    numbers = [kind_number(name) for name in key.responses]
    functions = [RESPONSES[name].functions() for name in key.responses]

    @wp.func
    def terms(responses: ResponseArrays, lobe: Lobe, wi: wp.vec3, w_diffuse: float, w_specular: float) -> BaseTerms:
        result = BaseTerms()
        if wp.static(len(functions) == 0):
            result = base_eval_pdf(lobe.base, lobe.wo, wi, w_diffuse, w_specular)
        else:
            if lobe.response.kind == 0:
                result = base_eval_pdf(lobe.base, lobe.wo, wi, w_diffuse, w_specular)
            for j in range(wp.static(len(functions))):
                if lobe.response.kind == wp.static(numbers[j]):
                    result = wp.static(functions[j][0])(responses, lobe.response, lobe.wo, wi)
                    result.value = w_specular * result.value
        return result

    @wp.func
    def drawn(responses: ResponseArrays, lobe: Lobe, u: wp.vec2, v: float) -> BaseSample:
        result = BaseSample()
        if wp.static(len(functions) == 0):
            result = base_sample(lobe.base, lobe.wo, u, v, lobe.w_diffuse, lobe.w_specular)
        else:
            if lobe.response.kind == 0:
                result = base_sample(lobe.base, lobe.wo, u, v, lobe.w_diffuse, lobe.w_specular)
            for j in range(wp.static(len(functions))):
                if lobe.response.kind == wp.static(numbers[j]):
                    result = wp.static(functions[j][1])(responses, lobe.response, lobe.wo, u, v)
                    result.weight = lobe.w_specular * result.weight
        return result

    return terms, drawn


def make_place(key: KernelKey):
    """Device function: a response at a point, from its record and where the point lies."""
    placed = [name for name in key.responses if RESPONSES[name].placed]
    numbers = [kind_number(name) for name in placed]
    functions = [RESPONSES[name].functions()[2] for name in placed]

    @wp.func
    def place(responses: ResponseArrays, number: int, spot: Spot) -> ResponseAt:
        record = responses.records[number]
        at = ResponseAt()
        at.kind = record.kind
        at.index = record.index
        at.reflectance = record.reflectance
        at.x_axis = wp.vec2(1.0, 0.0)
        at.y_axis = wp.vec2(0.0, 1.0)
        for j in range(wp.static(len(functions))):
            if at.kind == wp.static(numbers[j]):
                at = wp.static(functions[j])(responses, at, spot)
        return at

    return place
