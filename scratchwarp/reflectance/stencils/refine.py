"""Bounded least squares over all numbers of a model (scipy, of the extra ``study``).

The residuals of 14,000 pairs and three channels reach scipy folded to as many as there are numbers and one more: at
every point J^T J = R^T R and R^T q = J^T r give the same cost, gradient and Gauss-Newton step as J and r.
"""

from typing import Any

import numpy as np

from .angles import Pairs
from .forward import COLOR, LOG_ALPHA, MODE, WIDTH, B, Q, count, model_and_slopes


def _least_squares() -> Any:
    try:
        from scipy.optimize import least_squares
    except ImportError:
        raise ImportError(
            "refining a fit needs scipy: pip install 'scratchwarp[study]', or fit with refine=False"
        ) from None
    return least_squares


def bounds(modes: int) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest of each number: what keeps the model physical and its masks of use."""
    low, high = np.full(count(modes), -np.inf), np.full(count(modes), np.inf)
    for k in range(modes):
        row = MODE * k
        for place, least, most in ((WIDTH, 0.0, 1.0), (B, -0.05, 1.0), (LOG_ALPHA, -2.0, 12.0), (Q, 0.0, 1e6)):
            low[row + place], high[row + place] = least, most
        low[row + COLOR : row + COLOR + 3] = 0.0
    crossings = slice(MODE * modes, MODE * modes + modes - 1)
    low[crossings], high[crossings] = 0.0, 1.0
    low[-3:], high[-3:] = (0.0, 0.0, -1.0), (np.inf, 1e3, 9.0)
    return low, high


class _Folded:
    """Residuals and slopes at the last point asked for, folded."""

    def __init__(self, modes: int, where: Pairs, values: np.ndarray) -> None:
        self.modes, self.where, self.values = modes, where, values.T
        self.root = np.sqrt(where.weight)
        self.at: np.ndarray | None = None

    def _fold(self, x: np.ndarray) -> None:
        if self.at is not None and np.array_equal(x, self.at):
            return
        values, slopes = model_and_slopes(x, self.modes, self.where)
        residual = (values - self.values) * self.root
        slopes *= self.root
        flat = slopes.reshape(len(x), -1)
        normal, right = flat @ flat.T, flat @ residual.ravel()
        scale = 1.0 / np.sqrt(np.maximum(np.diag(normal), 1e-300))
        scaled = normal * scale * scale[:, None]
        upper = np.linalg.cholesky(scaled + 1e-12 * np.eye(len(x))).T
        self.factor = upper / scale
        self.part = np.linalg.solve(upper.T, right * scale)
        self.rest = np.sqrt(max(float(np.sum(residual**2) - self.part @ self.part), 0.0))
        self.at = x.copy()

    def residual(self, x: np.ndarray) -> np.ndarray:
        self._fold(x)
        return np.append(self.part, self.rest)

    def slopes(self, x: np.ndarray) -> np.ndarray:
        self._fold(x)
        return np.vstack([self.factor, np.zeros(len(x))])


def refine(
    numbers: np.ndarray, modes: int, where: Pairs, values: np.ndarray, evaluations: int
) -> tuple[np.ndarray, float]:
    """(numbers, sum of squares) after at most ``evaluations`` of the model; ``values`` [n, 3]."""
    low, high = bounds(modes)
    inside = np.clip(numbers, low + 1e-9, high - 1e-9)
    folded = _Folded(modes, where, values)
    done = _least_squares()(
        folded.residual, inside, jac=folded.slopes, bounds=(low, high), x_scale="jac", max_nfev=evaluations,
        ftol=1e-7, xtol=1e-8, gtol=1e-12,
    )  # fmt: skip
    return done.x, 2.0 * float(done.cost)
