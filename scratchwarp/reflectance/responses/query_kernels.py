"""The kernels behind ``query``, one pair for each kind of response."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
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


@dataclass(frozen=True, eq=False)
class Kernels:
    """Evaluation and sampling of a kind."""

    evaluating: Any
    sampling: Any

    def evaluate(self, arrays: Any, spot: Any, wi: np.ndarray, wo: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """f_r cos(theta_i) [n, 3] and densities [n]."""
        value, pdf = wp.zeros(len(wi), dtype=wp.vec3, device="cpu"), wp.zeros(len(wi), dtype=float, device="cpu")
        wp.launch(self.evaluating, len(wi), [arrays, spot, _vectors(wi), _vectors(wo)], [value, pdf], device="cpu")
        return value.numpy(), pdf.numpy()

    def sample(self, arrays: Any, spot: Any, wo: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, ...]:
        """Directions [n, 3], weights [n, 3], densities [n]."""
        made = [wp.zeros(len(wo), dtype=d, device="cpu") for d in (wp.vec3, wp.vec3, float)]
        wp.launch(self.sampling, len(wo), [arrays, spot, _vectors(wo), _vectors(u)], made, device="cpu")
        return tuple(m.numpy() for m in made)


def _vectors(values: np.ndarray) -> Any:
    return wp.array(np.ascontiguousarray(values, np.float32), dtype=wp.vec3, device="cpu")


def spot_at(uv: tuple[float, float], footprint: Any) -> Any:
    """The spot of a surface whose frame lies along u and v."""
    spot: Any = Spot()
    spot.uv = wp.vec2d(*map(float, uv))
    edges = np.asarray(footprint, np.float32).reshape(2, 2)
    spot.jx, spot.jy = wp.vec2(*map(float, edges[0])), wp.vec2(*map(float, edges[1]))
    spot.u_axis, spot.v_axis = wp.vec2(1.0, 0.0), wp.vec2(0.0, 1.0)
    return spot


@cache
def kernels_of(name: str) -> Kernels:
    """The kernels of a key of ``RESPONSES``."""
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

    return Kernels(evaluate, sample)
