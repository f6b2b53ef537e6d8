"""How a table depends on theta, the angle along the scratch: models that fill in between a few slices.

Fresnel's cosine along a path at theta is cos(theta) times the one in the plane, and at theta = pi/2 everything is a
mirror. So each cell is a smooth function of mu = cos(theta) with a known value at mu = 0. It bends most near there:
an exact reflectance has poles at mu of about -1/|index| (r_p of a facet met head-on is (n mu - 1) / (n mu + 1) or
so), and t = mu (1 + s) / (mu + s) moves them away, which leaves a function of t that low polynomials follow.

- "gamma": Raymond 2016, Eq. 2, a power of 2 |theta| / pi with an exponent of each cell, from theta = 0 and pi/3. It
  cannot show a dip, and exact metals have one: r <= 0 in most cells of iron.
- "quadratic": the parabola in t (s = 0.3) through theta = 0, 79.2 degrees and 90.
- "table": straight lines in t (s = 0.15) between 16 equal steps: two look-ups for each value.
- "full": the same between 32 steps.
- "exact": the polynomial in t (s = 0.2) through 13 Chebyshev-Lobatto nodes, below the sampling error.

Measured errors are in docs/profiles.md; ``choose_theta_model`` measures them for a profile and reflector.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

_SIXTY = 0.5


@dataclass(frozen=True)
class ThetaModel:
    """Slices kept and how they are joined: ``shift`` s of the coordinate t, ``places`` in t (0, the mirror,
    included), ``joined`` by one "polynomial" or by "lines"."""

    shift: float
    places: tuple[float, ...]
    joined: str

    def coordinate(self, mu: Any) -> np.ndarray:
        """t in [0, 1] of mu = cos(theta)."""
        mu = np.asarray(mu, np.float64)
        return mu * (1.0 + self.shift) / (mu + self.shift)

    @property
    def cosines(self) -> np.ndarray:
        """mu of the slices, the mirror (mu = 0) left out, descending from 1."""
        t = np.array([place for place in self.places if place > 0.0])[::-1]
        return self.shift * t / (1.0 + self.shift - t)

    def weights(self, mu: float) -> np.ndarray:
        """Weight of the mirror and then of each slice in the order of ``cosines``, for one mu: they sum to 1."""
        t, places = float(self.coordinate(mu)), np.array(self.places)
        if self.joined == "lines":
            steps = len(places) - 1
            low = min(int(t * steps), steps - 1)
            weights = np.zeros(len(places))
            weights[low + 1] = t * steps - low
            weights[low] = 1.0 - weights[low + 1]
        else:
            gaps = places[:, None] - places[None, :]
            np.fill_diagonal(gaps, 1.0)
            from_t = np.broadcast_to(t - places, gaps.shape).copy()
            np.fill_diagonal(from_t, 1.0)
            weights = np.prod(from_t / gaps, axis=1)
        return np.concatenate((weights[:1], weights[:0:-1]))


def _lobatto(steps: int) -> tuple[float, ...]:
    return tuple(0.5 - 0.5 * np.cos(np.pi * np.arange(steps + 1) / steps))


_MODELS = {
    "quadratic": ThetaModel(0.3, _lobatto(2), "polynomial"),
    "table": ThetaModel(0.15, tuple(np.arange(17) / 16.0), "lines"),
    "exact": ThetaModel(0.2, _lobatto(12), "polynomial"),
}
# from the cheapest to the dearest
THETA_MODELS = ("gamma", *_MODELS)
# "table" with twice the steps: a reference in renders, never chosen by itself
_MODELS["full"] = ThetaModel(0.15, tuple(np.arange(33) / 32.0), "lines")


def theta_model(name: str) -> ThetaModel | None:
    """The model of that name; None for "gamma", which is a formula of its own. ValueError on another name."""
    if name not in (*THETA_MODELS, "full"):
        raise ValueError(f"theta_model must be one of {(*THETA_MODELS, 'full')}, got {name!r}")
    return _MODELS.get(name)


def nodes(name: str) -> np.ndarray:
    """mu = cos(theta) of the slices that a table of this model keeps: theta = 0 and pi/3 (for Raymond's exponent),
    then the rest."""
    model = theta_model(name)
    extra = np.empty(0) if model is None else model.cosines
    return np.concatenate(([1.0, _SIXTY], extra[(extra < 1.0 - 1e-9) & (np.abs(extra - _SIXTY) > 1e-9)]))


def between_slices(
    name: str, mirror: np.ndarray, slices: np.ndarray, mu_slices: np.ndarray, theta: float
) -> np.ndarray:
    """rho at ``theta`` by a model other than "gamma", from ``slices`` at cos(theta) = ``mu_slices`` and the mirror;
    not below 0. ValueError where a slice that the model needs is not among them."""
    model = theta_model(name)
    assert model is not None
    weights = model.weights(float(np.cos(theta)))
    result = np.float32(weights[0]) * mirror * np.ones_like(slices[0])
    for mu, weight in zip(model.cosines, weights[1:], strict=True):
        nearest = int(np.argmin(np.abs(mu_slices - mu)))
        if abs(mu_slices[nearest] - mu) > 1e-6:
            raise ValueError(f"model {name!r} needs a table simulated with theta_model={name!r}")
        if weight != 0.0:
            result += np.float32(weight) * slices[nearest]
    return np.maximum(result, 0.0)


def power_law(mirror: np.ndarray, normal: np.ndarray, gamma: np.ndarray, theta: float) -> np.ndarray:
    """Raymond 2016, Eq. 2."""
    blend = (2.0 * abs(theta) / np.pi) ** gamma
    return blend * mirror + (1.0 - blend) * normal
