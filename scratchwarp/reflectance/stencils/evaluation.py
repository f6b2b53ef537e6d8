"""The stencil model from NumPy: value, samples and density, by the device functions; float32, inputs broadcast."""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..vectors import directions, uniforms
from .angles import grid_directions
from .energy import device_model, draw, limits, probabilities, run
from .model import Model


class StencilSamples(NamedTuple):
    """Directions [..., 3], f_r cos(theta_i) / pdf [..., 3], density [1/sr] [...]; weight and pdf 0: nothing."""

    omega_i: np.ndarray
    weight: np.ndarray
    pdf: np.ndarray


@lru_cache(maxsize=32)
def pack(model: Model, energy_conserving: bool = False) -> Any:
    """The device struct of ``model`` with everything that is computed once for it."""
    shares = probabilities(model)
    return device_model(model, shares, limits(model, shares) if energy_conserving else None, energy_conserving)


@lru_cache(maxsize=32)
def _plain(model: Model) -> Any:
    return device_model(model, np.zeros(2 + len(model.modes)))


def _model(model: Any) -> Model:
    if not isinstance(model, Model):
        raise ValueError(f"model must be a stencils.Model, got {type(model).__name__}")
    return model


def _pairs(omega_i: ArrayLike, omega_o: ArrayLike) -> tuple[tuple[int, ...], np.ndarray, np.ndarray]:
    wi, wo = directions("omega_i", omega_i), directions("omega_o", omega_o)
    try:
        wi, wo = np.broadcast_arrays(wi, wo)
    except ValueError:
        raise ValueError(f"omega_i and omega_o do not broadcast: {list(wi.shape)}, {list(wo.shape)}") from None
    return wi.shape[:-1], wi.reshape(-1, 3), wo.reshape(-1, 3)


def evaluate(model: Model, omega_i: ArrayLike, omega_o: ArrayLike, energy_conserving: bool = False) -> np.ndarray:
    """f_r [1/sr] of a model, ``[..., 3]``, for unit directions ``[..., 3]`` with n = +z; 0 below the horizon.

    Non-negative and reciprocal. ``energy_conserving`` ends the growth of highlights towards grazing at 75 degrees and
    scales each pair of directions by the smaller of the factors that bring either's albedo below 1, still reciprocal.
    Raises ValueError on directions that are not unit.
    """
    lead, wi, wo = _pairs(omega_i, omega_o)
    stencil = pack(_model(model), True) if energy_conserving else _plain(_model(model))
    return run(stencil, wi, wo)[0].reshape(*lead, 3)


def pdf(model: Model, omega_i: ArrayLike, omega_o: ArrayLike) -> np.ndarray:
    """Density [1/sr] with which ``sample`` finds ``omega_i`` when seen from ``omega_o``, ``[...]``."""
    lead, wi, wo = _pairs(omega_i, omega_o)
    return run(pack(_model(model)), wi, wo, density=True)[1].reshape(lead)


def sample(model: Model, omega_o: ArrayLike, u: ArrayLike, energy_conserving: bool = False) -> StencilSamples:
    """Directions in proportion to the parts of the model; ``u [..., 3]`` in [0, 1), the third chooses the part.

    The mean of ``weight`` times the incident radiance is the reflected radiance; without ``energy_conserving`` it has
    no finite variance when b is above 0, for the model itself is unbounded at grazing.
    """
    wo, square = np.broadcast_arrays(directions("omega_o", omega_o), uniforms("u", u, 3))
    lead = wo.shape[:-1]
    stencil = pack(_model(model), energy_conserving)
    wi, weight, density = draw(stencil, wo.reshape(-1, 3), square.reshape(-1, 3))
    return StencilSamples(wi.reshape(*lead, 3), weight.reshape(*lead, 3), density.reshape(lead))


def unfolded(model: Model, energy_conserving: bool = False) -> np.ndarray:
    """The model on the grid of a UTIA measurement, float64 [288, 288, 3] (illumination, view, rgb)."""
    w = grid_directions()
    return evaluate(model, w[:, None], w[None], energy_conserving).astype(np.float64)
