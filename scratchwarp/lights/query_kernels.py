"""Kernels over arrays of points that call one light's device functions."""

import functools
from typing import Any

import warp as wp

from scratchwarp.lights.light_device import Light, LightArrays, LightHit, LightSample, Span
from scratchwarp.lights.model import LightModel
from scratchwarp.optics.sampling_device import sobol_2d

wp.set_module_options({"enable_backward": False})

_OPTIONS = {"enable_backward": False}


@functools.cache
def sample_kernel(model: LightModel) -> Any:
    """Kernel: a sample for each (x, u)."""
    sample = model.sample

    @wp.kernel(module="unique", module_options=_OPTIONS)
    def sample_light(
        lights: wp.array[Light],
        arrays: LightArrays,
        x: wp.array[wp.vec3],
        u: wp.array[wp.vec2],
        out: wp.array[LightSample],
    ):
        i = wp.tid()
        out[i] = sample(arrays, lights[0], x[i], u[i])

    return sample_light


@functools.cache
def hit_kernel(model: LightModel) -> Any:
    """Kernel: a hit for each (x, w)."""
    hit = model.hit

    @wp.kernel(module="unique", module_options=_OPTIONS)
    def hit_light(
        lights: wp.array[Light],
        arrays: LightArrays,
        x: wp.array[wp.vec3],
        w: wp.array[wp.vec3],
        out: wp.array[LightHit],
    ):
        i = wp.tid()
        out[i] = hit(arrays, lights[0], x[i], w[i])

    return hit_light


@functools.cache
def span_kernel(model: LightModel) -> Any:
    """Kernel: an interval for each (x, u, n, sin_theta), v = n x u."""
    span = model.span

    @wp.kernel(module="unique", module_options=_OPTIONS)
    def span_light(
        lights: wp.array[Light],
        arrays: LightArrays,
        x: wp.array[wp.vec3],
        u: wp.array[wp.vec3],
        n: wp.array[wp.vec3],
        sin_theta: wp.array[float],
        out: wp.array[Span],
    ):
        i = wp.tid()
        out[i] = span(arrays, lights[0], x[i], u[i], wp.cross(n[i], u[i]), n[i], sin_theta[i])

    return span_light


@functools.cache
def irradiance_kernel(model: LightModel) -> Any:
    """Kernel: unoccluded irradiance for each (x, n), by ``samples`` Sobol points."""
    sample = model.sample

    @wp.kernel(module="unique", module_options=_OPTIONS)
    def irradiance_light(
        lights: wp.array[Light],
        arrays: LightArrays,
        x: wp.array[wp.vec3],
        n: wp.array[wp.vec3],
        samples: int,
        seed: wp.uint32,
        out: wp.array[wp.vec3],
    ):
        i = wp.tid()
        light = lights[0]
        total = wp.vec3(0.0, 0.0, 0.0)
        for k in range(samples):
            s = sample(arrays, light, x[i], sobol_2d(wp.uint32(k), i, seed))
            cosine = wp.max(wp.dot(s.wi, n[i]), 0.0)
            if s.pdf > 0.0:
                total += s.radiance * (cosine / s.pdf)
            elif s.pdf < 0.0:
                total += s.radiance * cosine
        out[i] = total / float(samples)

    return irradiance_light
