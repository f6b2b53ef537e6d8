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


def nodes(model: str) -> np.ndarray:
    """mu = cos(theta) of the slices a model keeps, descending from 1; mu = 0 is the mirror table and not among them."""
    if model not in THETA_MODELS:
        raise ValueError(f"theta_model must be one of {THETA_MODELS}, got {model!r}")
    if model == "exact":
        return 0.5 + 0.5 * np.cos(np.pi * np.arange(_EXACT_NODES - 1) / (_EXACT_NODES - 1))
    return np.array([1.0, 0.5])


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
