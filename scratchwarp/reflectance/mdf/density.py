"""Distributions of facet normals from NumPy, plain and deformed by a perturbed normal; float64, inputs broadcast."""

from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ..vectors import directions, numbers, to_device, vectors
from . import density_kernels as kernels

DISTRIBUTIONS = ("ashikhmin-shirley", "ward", "beckmann", "ggx")
KINDS = ("linear", "sqrt")

_LONGEST = 1.0 + 1e-6  # a unit vector's share of the disk, rounded


def position(name: str, value: Any, allowed: tuple[str, ...]) -> int:
    """Where ``value`` stands among ``allowed``; ValueError naming ``name`` when it does not."""
    if value not in allowed:
        raise ValueError(f"{name} must be one of {', '.join(allowed)}, got {value!r}")
    return allowed.index(value)


def perturbations(delta: ArrayLike) -> np.ndarray:
    """``delta`` checked: [..., 2] in the unit disk."""
    return vectors("delta", delta, 2, _LONGEST)


def parameters(distribution: str, names: tuple[str, str], x: ArrayLike, y: ArrayLike) -> list[np.ndarray]:
    """Exponents (0 and more) or widths (above 0) checked, under the names that the caller knows."""
    low = 0.0 if distribution == "ashikhmin-shirley" else 1e-6
    return [numbers(name, value, low, 1e9) for name, value in zip(names, (x, y), strict=True)]


def _density(
    distribution: str, names: tuple[str, str], h: ArrayLike, x: ArrayLike, y: ArrayLike,
    delta: ArrayLike = (0.0, 0.0), kind: str = "linear",
) -> np.ndarray:  # fmt: skip
    chosen = position("distribution", distribution, DISTRIBUTIONS)
    map_kind = position("kind", kind, KINDS)
    arrays = [directions("h", h), perturbations(delta), *parameters(distribution, names, x, y)]
    lead, inputs = to_device(arrays, [wp.vec3d, wp.vec2d, wp.float64, wp.float64])
    out = wp.zeros(len(inputs[0]), dtype=wp.float64, device="cpu")
    wp.launch(kernels.density, len(out), inputs=[chosen, map_kind, *inputs], outputs=[out], device="cpu")
    return out.numpy().reshape(lead)


def ashikhmin_shirley(h: ArrayLike, ex: ArrayLike, ey: ArrayLike) -> np.ndarray:
    """Kang and Cho's Eq. 1 [1/sr] at unit normals ``h [..., 3]``: the integral over the hemisphere is 1.

    ``ex``, ``ey`` >= 0 are the exponents along x and y. 0 at and below the horizon. Raises ValueError naming what is
    wrong.
    """
    return _density("ashikhmin-shirley", ("ex", "ey"), h, ex, ey)


def ward(h: ArrayLike, ax: ArrayLike, ay: ArrayLike) -> np.ndarray:
    """exp(-tan^2 theta (cos^2 phi / ax^2 + sin^2 phi / ay^2)) / (pi ax ay) at unit normals ``h [..., 3]``.

    ``ax``, ``ay`` > 0 are widths (root mean square slopes times sqrt 2). The integral times the cosine is below 1; that
    of ``beckmann`` is 1.
    """
    return _density("ward", ("ax", "ay"), h, ax, ay)


def beckmann(h: ArrayLike, ax: ArrayLike, ay: ArrayLike) -> np.ndarray:
    """``ward`` over cos^4 theta: the integral times the cosine is 1."""
    return _density("beckmann", ("ax", "ay"), h, ax, ay)


def ggx(h: ArrayLike, ax: ArrayLike, ay: ArrayLike) -> np.ndarray:
    """Anisotropic GGX: the integral times the cosine is 1."""
    return _density("ggx", ("ax", "ay"), h, ax, ay)


def deformed(
    h: ArrayLike, delta: ArrayLike, ex: ArrayLike, ey: ArrayLike, kind: str = "linear",
    distribution: str = "ashikhmin-shirley",
) -> np.ndarray:  # fmt: skip
    """D'(h) = D(T^-1(h)) (Eq. 6): the distribution pulled along by a normal whose x and y are ``delta [..., 2]``.

    ``ex``, ``ey`` are exponents for Ashikhmin-Shirley, widths for "ward", "beckmann" and "ggx". 0 where T^-1 leaves the
    disk (kind "sqrt" alone) and below the horizon. Raises ValueError on |delta| > 1.
    """
    return _density(distribution, ("ex", "ey"), h, ex, ey, delta, kind)


def _move(name: str, p: ArrayLike, delta: ArrayLike, kind: str, inverse: bool) -> np.ndarray:
    map_kind = position("kind", kind, KINDS)
    lead, inputs = to_device([vectors(name, p, 2, _LONGEST), perturbations(delta)], [wp.vec2d, wp.vec2d])
    out = wp.zeros(len(inputs[0]), dtype=wp.vec2d, device="cpu")
    wp.launch(kernels.moved, len(out), inputs=[map_kind, int(inverse), *inputs], outputs=[out], device="cpu")
    return out.numpy().reshape(*lead, 2)


def inverse_deform(p: ArrayLike, delta: ArrayLike, kind: str = "linear") -> np.ndarray:
    """T^-1 of points ``p [..., 2]`` of the unit disk, ``[..., 2]``: "linear" inverts Eq. 3, "sqrt" is Eq. 5.

    The square root may lead out of the disk. Raises ValueError on |p| > 1 and |delta| > 1.
    """
    return _move("p", p, delta, kind, True)


def deform(p: ArrayLike, delta: ArrayLike, kind: str = "linear") -> np.ndarray:
    """T of points ``p [..., 2]`` of the unit disk (Eq. 3 "linear", Eq. 4 "sqrt", which may leave the disk)."""
    return _move("p", p, delta, kind, False)
