"""The kernels behind ``query``, one pair for each kind of response, compiled when it is asked for."""

from functools import cache
from typing import Any

import warp as wp

from . import RESPONSES
from .response_device import ResponseArrays, ResponseAt, Spot

wp.set_module_options({"enable_backward": False})


@wp.func
def recorded(arrays: ResponseArrays) -> ResponseAt:
    """The first response as its record says."""
    record = arrays.records[0]
    at = ResponseAt()
    at.kind = record.kind
    at.index = record.index
    at.reflectance = record.reflectance
    at.x_axis = wp.vec2(1.0, 0.0)
    at.y_axis = wp.vec2(0.0, 1.0)
    return at


@cache
def kernels_of(name: str) -> tuple[Any, Any]:
    """(evaluation, sampling) of a key of ``RESPONSES``."""
    evaluated, drawn, placed = RESPONSES[name].functions()

    @wp.kernel(module="unique", module_options={"enable_backward": False})
    def evaluate(
        arrays: ResponseArrays,
        spot: Spot,
        wi: wp.array(dtype=wp.vec3),
        wo: wp.array(dtype=wp.vec3),
        value: wp.array(dtype=wp.vec3),
        pdf: wp.array(dtype=float),
    ):
        i = wp.tid()
        at = recorded(arrays)
        if wp.static(placed is not None):
            at = wp.static(placed)(arrays, at, spot)
        t = wp.static(evaluated)(arrays, at, wo[i], wi[i])
        value[i] = t.value
        pdf[i] = t.pdf

    @wp.kernel(module="unique", module_options={"enable_backward": False})
    def sample(
        arrays: ResponseArrays,
        spot: Spot,
        wo: wp.array(dtype=wp.vec3),
        u: wp.array(dtype=wp.vec3),
        wi: wp.array(dtype=wp.vec3),
        weight: wp.array(dtype=wp.vec3),
        pdf: wp.array(dtype=float),
    ):
        i = wp.tid()
        at = recorded(arrays)
        if wp.static(placed is not None):
            at = wp.static(placed)(arrays, at, spot)
        s = wp.static(drawn)(arrays, at, wo[i], wp.vec2(u[i][0], u[i][1]), u[i][2])
        wi[i] = s.wi
        weight[i] = s.weight
        pdf[i] = s.pdf

    return evaluate, sample
