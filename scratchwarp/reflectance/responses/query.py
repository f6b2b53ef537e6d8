"""Responses from NumPy, by the device functions that the renderer calls; float32, directions broadcast."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..vectors import directions, uniforms
from . import RESPONSES
from .pack import pack
from .query_kernels import kernels_of, spot_at


@dataclass(frozen=True)
class Queried:
    """A response to ask: a key of ``RESPONSES``, what its ``pack`` takes, and a reflector of ``optics`` or None."""

    name: str
    values: Any
    fresnel: Any = None

    def __post_init__(self) -> None:
        if self.name not in RESPONSES:
            raise ValueError(f"name must be one of {', '.join(RESPONSES)}, got {self.name!r}")


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
    value, density = kernels_of(response.name).evaluate(
        pack([response], textures=textures).arrays, spot_at(uv, footprint), wi.reshape(-1, 3), wo.reshape(-1, 3)
    )
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
    found = kernels_of(response.name).sample(
        pack([response], textures=textures).arrays, spot_at(uv, footprint), wo.reshape(-1, 3), square.reshape(-1, 3)
    )
    return found[0].reshape(*lead, 3), found[1].reshape(*lead, 3), found[2].reshape(lead)
