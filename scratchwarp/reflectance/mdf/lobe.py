"""Reflection by deformed facets from NumPy: value, samples and density; float32, inputs broadcast."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ..vectors import directions, to_device, uniforms
from . import lobe_device, lobe_kernels
from .density import DISTRIBUTIONS, KINDS, parameters, perturbations, position


@dataclass(frozen=True)
class Lobe:
    """A distribution by name, its two exponents ("ashikhmin-shirley") or widths, and the kind of deformation.

    Raises ValueError naming the field.
    """

    distribution: str = "ashikhmin-shirley"
    x: float = 100.0
    y: float = 100.0
    kind: str = "linear"

    def __post_init__(self) -> None:
        position("distribution", self.distribution, DISTRIBUTIONS)
        position("kind", self.kind, KINDS)
        parameters(self.distribution, ("x", "y"), self.x, self.y)

    def to_device(self) -> Any:
        """The device struct ``lobe_device.Lobe``."""
        lobe = lobe_device.Lobe()
        lobe.distribution = DISTRIBUTIONS.index(self.distribution)
        lobe.kind = KINDS.index(self.kind)
        lobe.x, lobe.y = float(self.x), float(self.y)
        return lobe


class LobeSamples(NamedTuple):
    """Directions [..., 3], f_r cos(theta_i) / pdf [...], density [1/sr] [...]; weight and pdf 0: nothing."""

    omega_i: np.ndarray
    weight: np.ndarray
    pdf: np.ndarray


def _terms(lobe: Lobe, omega_i: ArrayLike, omega_o: ArrayLike, delta: ArrayLike) -> list[np.ndarray]:
    arrays = [directions("omega_i", omega_i), directions("omega_o", omega_o), perturbations(delta)]
    lead, inputs = to_device(arrays, [wp.vec3, wp.vec3, wp.vec2])
    outputs = [wp.zeros(len(inputs[0]), dtype=float, device="cpu") for _ in range(2)]
    wp.launch(lobe_kernels.evaluate, len(inputs[0]), inputs=[lobe.to_device(), *inputs], outputs=outputs, device="cpu")
    return [a.numpy().reshape(lead) for a in outputs]


def evaluate(lobe: Lobe, omega_i: ArrayLike, omega_o: ArrayLike, delta: ArrayLike = (0.0, 0.0)) -> np.ndarray:
    """f_r [1/sr] without Fresnel factor, ``[...]``, for directions ``[..., 3]`` and normals ``delta [..., 2]``.

    Reciprocal; the albedo of no view exceeds 1 (kind "linear"). The formula stands in ``lobe_device``. Raises
    ValueError on directions that are not unit and on |delta| > 1.
    """
    return _terms(lobe, omega_i, omega_o, delta)[0]


def pdf(lobe: Lobe, omega_i: ArrayLike, omega_o: ArrayLike, delta: ArrayLike = (0.0, 0.0)) -> np.ndarray:
    """Density [1/sr] with which ``sample`` finds ``omega_i`` when seen from ``omega_o``, ``[...]``."""
    return _terms(lobe, omega_i, omega_o, delta)[1]


def sample(lobe: Lobe, omega_o: ArrayLike, u: ArrayLike, delta: ArrayLike = (0.0, 0.0)) -> LobeSamples:
    """Directions in proportion to the lobe; ``u [..., 3]`` uniform in [0, 1), the third chooses the strategy."""
    arrays = [directions("omega_o", omega_o), uniforms("u", u, 3), perturbations(delta)]
    lead, inputs = to_device(arrays, [wp.vec3, wp.vec3, wp.vec2])
    count = len(inputs[0])
    outputs: list[Any] = [wp.zeros(count, dtype=d, device="cpu") for d in (wp.vec3, float, float)]
    wp.launch(lobe_kernels.sample, count, inputs=[lobe.to_device(), *inputs], outputs=outputs, device="cpu")
    wi, weight, density = (a.numpy() for a in outputs)
    return LobeSamples(wi.reshape(*lead, 3), weight.reshape(lead), density.reshape(lead))
