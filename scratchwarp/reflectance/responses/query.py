"""Responses from NumPy, by the device functions that the renderer calls; float32, directions broadcast."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ..vectors import directions, uniforms
from . import RESPONSES
from .pack import pack
from .query_kernels import kernels_of
from .response_device import Spot


@dataclass(frozen=True)
class Queried:
    """A response to ask: a key of ``RESPONSES``, what its ``pack`` takes, and a reflector of ``optics`` or None."""

    name: str
    values: Any
    fresnel: Any = None

    def __post_init__(self) -> None:
        if self.name not in RESPONSES:
            raise ValueError(f"name must be one of {', '.join(RESPONSES)}, got {self.name!r}")


def _run(
    response: Queried, kernel: int, uv: Any, footprint: Any, textures: Any, given: Sequence[Any], wanted: Sequence[Any]
) -> list[np.ndarray]:
    """What a kernel of the response makes of vectors [..., 3]."""
    packed = pack([response], textures=textures)
    spot: Any = Spot()
    spot.uv = wp.vec2d(*map(float, uv))
    edges = np.asarray(footprint, np.float32).reshape(2, 2)
    spot.jx, spot.jy = wp.vec2(*map(float, edges[0])), wp.vec2(*map(float, edges[1]))
    spot.u_axis, spot.v_axis = wp.vec2(1.0, 0.0), wp.vec2(0.0, 1.0)
    flat = [np.ascontiguousarray(np.reshape(a, (-1, 3)), np.float32) for a in given]
    inputs = [packed.arrays, spot, *(wp.array(a, dtype=wp.vec3, device="cpu") for a in flat)]
    made = [wp.zeros(len(flat[0]), dtype=d, device="cpu") for d in wanted]
    wp.launch(kernels_of(response.name)[kernel], len(flat[0]), inputs=inputs, outputs=made, device="cpu")
    return [m.numpy() for m in made]


def evaluate(
    response: Queried,
    omega_i: ArrayLike,
    omega_o: ArrayLike,
    uv: tuple[float, float] = (0.0, 0.0),
    footprint: ArrayLike = ((0.0, 0.0), (0.0, 0.0)),
    textures: tuple[Any, ...] = (),
) -> tuple[np.ndarray, np.ndarray]:
    """(f_r [..., 3], density [...]) [1/sr] for unit directions ``[..., 3]`` with n = +z; 0 below the horizon.

    ``uv``: where on the surface; ``footprint``: how (u, v) change along its two edges; ``textures``: of a scene, for
    responses that read any. The frame's x is the direction of u. Raises ValueError on directions that are not unit.
    """
    wi, wo = np.broadcast_arrays(directions("omega_i", omega_i), directions("omega_o", omega_o))
    lead = wi.shape[:-1]
    value, density = _run(response, 0, uv, footprint, textures, (wi, wo), (wp.vec3, float))
    cosine = wi.reshape(-1, 3)[:, 2:]
    f = np.divide(value, cosine, out=np.zeros_like(value), where=cosine > 0.0)
    return f.reshape(*lead, 3), density.reshape(lead)


def sample(
    response: Queried,
    omega_o: ArrayLike,
    u: ArrayLike,
    uv: tuple[float, float] = (0.0, 0.0),
    footprint: ArrayLike = ((0.0, 0.0), (0.0, 0.0)),
    textures: tuple[Any, ...] = (),
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(omega_i [..., 3], f_r cos(theta_i) / density [..., 3], density [...]) for ``u [..., 3]`` in [0, 1); density 0:
    nothing is reflected that way. Else as ``evaluate``."""
    wo, square = np.broadcast_arrays(directions("omega_o", omega_o), uniforms("u", u, 3))
    lead = wo.shape[:-1]
    found = _run(response, 1, uv, footprint, textures, (wo, square), (wp.vec3, wp.vec3, float))
    return found[0].reshape(*lead, 3), found[1].reshape(*lead, 3), found[2].reshape(lead)
