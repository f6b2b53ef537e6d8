"""Analytical models fitted to a measurement, for comparison with a stencil model of the same data."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..stencils.angles import SIZE, collapse, grid_directions, pairs
from ..stencils.axes import peaks, ridge_curve
from ..vectors import directions
from .rival_shapes import SHAPES, Angles, angles

RIVALS = tuple(SHAPES)
LOBES = {"kurt": 2, "ward": 1, "ashikhmin-shirley": 1, "ggx": 1}
_SAMPLES = 1500
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def lobes_for(model: str, parameters: int) -> int:
    """How many lobes, 1 to 4, a rival needs to have at least ``parameters`` numbers; ValueError on an unknown model."""
    if model not in SHAPES:
        raise ValueError(f"model must be one of {', '.join(RIVALS)}, got {model!r}")
    return int(np.clip(np.ceil((parameters - 3) / (len(SHAPES[model].low) + 3)), 1, 4))


@dataclass(frozen=True, eq=False)
class Rival:
    """kd + sum of ks times a lobe, for each channel: ``model`` one of ``RIVALS``, ``lobes`` [count, numbers] of
    ``rival_shapes``, ``kd`` [3] [1/sr], ``ks`` [count, 3]."""

    model: str
    lobes: np.ndarray
    kd: np.ndarray
    ks: np.ndarray

    @property
    def parameters(self) -> int:
        """How many numbers were fitted."""
        return self.lobes.size + self.kd.size + self.ks.size

    def evaluate(self, omega_i: ArrayLike, omega_o: ArrayLike) -> np.ndarray:
        """f_r [1/sr], float64 ``[..., 3]``, for unit directions that broadcast; 0 below the horizon."""
        wi, wo = np.broadcast_arrays(directions("omega_i", omega_i), directions("omega_o", omega_o))
        at = angles(wi.reshape(-1, 3), wo.reshape(-1, 3))
        value = self.kd + np.stack([SHAPES[self.model].function(p, at) for p in self.lobes], axis=-1) @ self.ks
        above = (wi[..., 2] > 0.0) & (wo[..., 2] > 0.0)
        return np.where(above[..., None], value.reshape(wi.shape), 0.0)

    def unfolded(self) -> np.ndarray:
        """The model on the grid of a UTIA measurement, [288, 288, 3]."""
        w = grid_directions()
        return self.evaluate(w[:, None], w[None])


def fit_rival(brdf: Any, model: str = "kurt", lobes: int | None = None) -> Rival:
    """Least squares of an analytical model to a ``Brdf`` or values [288, 288, 3]; needs scipy (extra ``study``).

    ``model``: "kurt" (two lobes unless told), "ward", "ashikhmin-shirley" or "ggx" (one). Lobes are fitted to
    luminance, kd and ks to each channel, as Filip et al. 2015 fit Kurt's; lobes start along the brightest ridges of the
    data and across them. Raises ValueError naming the argument.
    """
    if model not in SHAPES:
        raise ValueError(f"model must be one of {', '.join(RIVALS)}, got {model!r}")
    count = LOBES[model] if lobes is None else lobes
    if int(count) != count or not 1 <= count <= 4:
        raise ValueError(f"lobes must be a whole number in [1, 4], got {lobes}")
    values = np.asarray(brdf, np.float64)
    if values.shape != (SIZE, SIZE, 3) or not np.all(np.isfinite(values)):
        raise ValueError(f"brdf must be finite values [288, 288, 3], got shape {list(values.shape)}")
    means = collapse(np.maximum(values, 0.0), pairs())
    top = float(means.max())
    if top <= 0.0:
        return Rival(model, np.zeros((count, len(SHAPES[model].low))), np.zeros(3), np.zeros((count, 3)))
    seen = means / top
    kept, weight = _chosen(seen)
    at, root = _pair_angles(kept), np.sqrt(weight)
    axes = (peaks(*ridge_curve(seen @ _LUMINANCE, pairs())) or [0.0])[:2]
    best, error = None, np.inf
    for turn in (0.0, 0.5 * np.pi):
        done = _searched(
            model, [axes[k % len(axes)] + turn for k in range(count)], at, seen[kept] @ _LUMINANCE[:, None], root
        )
        if done.cost < error:
            best, error = done.x, done.cost
    assert best is not None
    shapes = best.reshape(count, -1)
    everywhere = _pair_angles(np.arange(len(means)))
    linear = _linear(_design(model, shapes, everywhere), seen, np.sqrt(pairs().weight)) * top
    return Rival(model, shapes, linear[0], linear[1:])


def _chosen(seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs to search with, bright ones more often, and their weights."""
    weight = pairs().weight
    luminance = seen @ _LUMINANCE
    importance = weight * (luminance.mean() + luminance)
    chance = np.minimum(importance * (_SAMPLES / importance.sum()), 1.0)
    kept = np.nonzero(np.random.default_rng(0).random(len(chance)) < chance)[0]
    return kept, weight[kept] / chance[kept]


def _pair_angles(kept: np.ndarray) -> Angles:
    _, first = np.unique(pairs().member, return_index=True)
    w = grid_directions()
    return angles(w[first[kept] // SIZE], w[first[kept] % SIZE])


def _design(model: str, shapes: np.ndarray, at: Angles) -> np.ndarray:
    columns = [SHAPES[model].function(p, at) for p in shapes]
    return np.stack([np.ones_like(at.cos_i), *columns], axis=-1)


def _linear(design: np.ndarray, seen: np.ndarray, root: np.ndarray) -> np.ndarray:
    """Non-negative least squares for kd and ks, [1 + lobes, channels]."""
    nnls = _scipy().nnls
    scale = np.maximum(np.linalg.norm(design * root[:, None], axis=0), 1e-150)
    scaled = design * (root[:, None] / scale)
    # of the square root of the normal equations: as many rows as unknowns
    upper = np.linalg.cholesky(scaled.T @ scaled + 1e-12 * np.eye(design.shape[1])).T
    right = np.linalg.solve(upper.T, scaled.T @ (seen * root[:, None]))
    return np.stack([nnls(upper, right[:, c])[0] for c in range(seen.shape[1])], axis=-1) / scale[:, None]


def _searched(model: str, azimuths: list[float], at: Angles, seen: np.ndarray, root: np.ndarray) -> Any:
    shape = SHAPES[model]
    start = np.array([value for azimuth in azimuths for value in (azimuth, *shape.start)])
    count = len(azimuths)

    def residual(x: np.ndarray) -> np.ndarray:
        design = _design(model, x.reshape(count, -1), at)
        return ((design @ _linear(design, seen, root) - seen) * root[:, None]).ravel()

    return _scipy().least_squares(
        residual, start, bounds=(np.tile(shape.low, count), np.tile(shape.high, count)), x_scale=1.0, max_nfev=40
    )


def _scipy() -> Any:
    try:
        from scipy import optimize
    except ImportError:
        raise ImportError("fitting a rival model needs scipy: pip install 'scratchwarp[study]'") from None
    return optimize
