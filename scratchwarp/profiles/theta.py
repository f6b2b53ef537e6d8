"""How the table depends on theta, the angle along the scratch: three models of one set of slices.

Fresnel's cosine along a path at theta is cos(theta) times the one in the plane, and at theta = pi/2 everything is a
mirror. So each cell is a smooth function of mu = cos(theta) with a known value at mu = 0, which the models fill in
from slices at a few nodes:

- "gamma": Raymond 2016, Eq. 2, a power of 2 |theta| / pi with an exponent of each cell, from theta = 0, pi/3 (and
  pi/2). It cannot show a dip, and exact metals have one: r <= 0 in most cells of iron.
- "quadratic": the parabola in mu through the same three slices; no further storage, dips included.
- "exact": the polynomial in mu through nine Chebyshev-Lobatto nodes; as near the full simulation as the sampling error.
"""

import numpy as np

THETA_MODELS = ("gamma", "quadratic", "exact")
_EXACT_NODES = 9
_LARGEST_GAMMA = 64.0


def nodes(model: str) -> np.ndarray:
    """mu = cos(theta) of the slices a model keeps, descending from 1; mu = 0 is the mirror table and not among them."""
    if model not in THETA_MODELS:
        raise ValueError(f"theta_model must be one of {THETA_MODELS}, got {model!r}")
    if model == "exact":
        return 0.5 + 0.5 * np.cos(np.pi * np.arange(_EXACT_NODES - 1) / (_EXACT_NODES - 1))
    return np.array([1.0, 0.5])


def exponent(mirror: np.ndarray, normal: np.ndarray, sixty: np.ndarray) -> tuple[np.ndarray, float]:
    """``(gamma, flagged)``: Raymond's exponent for each cell, finite and in [0, 64], and the share of cells with
    energy whose curve a power cannot represent (r = (rho60 - rho0) / (rho90 - rho0) outside (0, 1]). Flat and empty
    cells get 1, where any value serves."""
    span = mirror - normal
    occupied = np.broadcast_to(mirror > 0.0, span.shape)
    curved = span > 1e-6 * np.maximum(mirror, 1e-30)
    r = np.where(curved, (sixty - normal) / np.where(curved, span, 1.0), 2.0 / 3.0)
    wrong = occupied & curved & ((r <= 0.0) | (r > 1.0))
    lowest = (2.0 / 3.0) ** _LARGEST_GAMMA
    gamma = np.log(np.clip(r, lowest, 1.0)) / np.log(2.0 / 3.0)
    return gamma.astype(np.float32), float(wrong.sum() / max(int(occupied.sum()), 1))


def between_slices(mirror: np.ndarray, slices: np.ndarray, mu_nodes: np.ndarray, theta: float) -> np.ndarray:
    """The polynomial in mu = cos(theta) through ``slices`` at ``mu_nodes`` and ``mirror`` at 0 (Lagrange), not below
    0."""
    mu = float(np.cos(theta))
    places = np.append(mu_nodes, 0.0)
    result = np.zeros_like(slices[0])
    for k, place in enumerate(places):
        others = np.delete(places, k)
        weight = np.float32(np.prod((mu - others) / (place - others)))
        result += weight * (slices[k] if k < len(slices) else mirror)
    return np.maximum(result, 0.0)


def power_law(mirror: np.ndarray, normal: np.ndarray, gamma: np.ndarray, theta: float) -> np.ndarray:
    """Raymond 2016, Eq. 2."""
    blend = (2.0 * abs(theta) / np.pi) ** gamma
    return blend * mirror + (1.0 - blend) * normal
