"""A simulated cross-section as a table over (phi_o, phi_i), with everything a renderer or a person asks of it."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from scratchwarp.profiles import theta as theta_models

_HALF_PI = 0.5 * np.pi


def bin_angles(bins: int) -> np.ndarray:
    """Centres of ``bins`` equal bins over [-pi/2, pi/2] [rad]."""
    return (np.arange(bins) + 0.5) * (np.pi / bins) - _HALF_PI


def bin_weights(bins: int) -> np.ndarray:
    """Integral of the cosine over each bin, 2 sin(D/2) cos(centre)."""
    return 2.0 * np.sin(0.5 * np.pi / bins) * np.cos(bin_angles(bins))


@dataclass(frozen=True, eq=False)
class Table:
    """Reflection of a scratch along its cone: rho [1/rad] over M bins of phi_o (first index) and M bins of phi_i.

    ``mirror`` ``[M, M]``: with reflectance 1; each column times ``weights`` sums to 1 less what is lost.
    ``by_bounce`` ``[3, M, M]``: its parts after 1, 2, 3 and more reflections. ``normal``: rho_s at theta = 0, ``[M,
    M]``, or ``[M, M, 3]`` for a coloured reflector, and ``gamma``, the exponent of Raymond 2016 Eq. 2, alike; None
    without a reflector. ``slices`` ``[T, M, M(, 3)]``: rho_s at cos(theta) = ``slice_cosines`` ``[T]``. ``angles``,
    ``weights`` ``[M]``: bin centres [rad] and cosine weights. ``lost`` ``[M]``: share of each phi_i bin's paths cut
    off. ``cdf`` ``[M, M + 1]``: for each phi_o bin, cumulative over phi_i bins of mirror * weight, from 0 to 1
    (uniform where there is no energy). ``gamma_flagged``: share of occupied cells where no power of theta fits.
    ``rays``: rays traced in all.
    """

    mirror: np.ndarray
    by_bounce: np.ndarray
    normal: np.ndarray | None
    gamma: np.ndarray | None
    angles: np.ndarray
    weights: np.ndarray
    lost: np.ndarray
    cdf: np.ndarray
    slices: np.ndarray | None = None
    slice_cosines: np.ndarray | None = None
    theta_model: str = "gamma"
    gamma_flagged: float = 0.0
    rays: int = 0
    metadata: dict[str, Any] = field(default_factory=dict)

    @property
    def resolution(self) -> int:
        """Bins each way, M."""
        return len(self.angles)

    def slice(self, theta: float, model: str | None = None) -> np.ndarray:
        """rho_s at ``theta`` [rad], ``[M, M]`` or ``[M, M, 3]``, by the table's theta model or another that its
        slices allow ("gamma": Raymond 2016 Eq. 2; see ``theta``). The mirror table without a reflector. ValueError
        outside [-pi/2, pi/2] or for a model that needs slices the table does not hold."""
        if not (np.isfinite(theta) and abs(theta) <= _HALF_PI + 1e-9):
            raise ValueError(f"theta must lie in [-pi/2, pi/2], got {theta}")
        if self.normal is None or self.gamma is None or self.slices is None or self.slice_cosines is None:
            return np.array(self.mirror)
        model = self.theta_model if model is None else model
        mirror = self.mirror if self.normal.ndim == 2 else self.mirror[..., None]
        if model == "gamma":
            return theta_models.power_law(mirror, self.normal, self.gamma, theta)
        return theta_models.between_slices(model, mirror, self.slices, self.slice_cosines, theta)

    def sample(self, phi_o: Any, u: Any) -> tuple[np.ndarray, np.ndarray]:
        """``(phi_i, pdf)``: directions of incidence [rad] drawn for ``phi_o`` [rad] by the inverse CDF at ``u`` in
        [0, 1), and their densities [1/rad]. Broadcasts; float32. ValueError on angles or ``u`` out of range."""
        from scratchwarp.profiles.table_kernels import sample_table

        phi_o, u = _together("u", _angle("phi_o", phi_o), np.asarray(u, np.float64))
        if not np.all((u >= 0.0) & (u < 1.0)):
            raise ValueError(f"u must lie in [0, 1), got {u[~((u >= 0.0) & (u < 1.0))].flat[0]}")
        below_one = np.minimum(u.astype(np.float32), np.float32(1.0 - 2.0**-24))
        phi_i, pdf = self._over_arrays(sample_table, phi_o, below_one, 2)
        return phi_i, pdf

    def pdf(self, phi_o: Any, phi_i: Any) -> np.ndarray:
        """Density of ``sample`` [1/rad] at ``phi_i`` [rad] given ``phi_o``: proportional to mirror * cos(phi_i).
        Broadcasts; float32."""
        from scratchwarp.profiles.table_kernels import pdf_table

        phi_o, phi_i = _together("phi_i", _angle("phi_o", phi_o), _angle("phi_i", phi_i))
        return self._over_arrays(pdf_table, phi_o, phi_i, 1)[0]

    def _over_arrays(self, kernel: Any, first: np.ndarray, second: np.ndarray, outputs: int) -> list[np.ndarray]:
        import warp as wp

        def device(values: np.ndarray) -> Any:
            return wp.array(np.ascontiguousarray(values, np.float32), dtype=float, device="cpu")

        results = [wp.empty(first.size, dtype=float, device="cpu") for _ in range(outputs)]
        inputs = [device(self.cdf), device(first.ravel()), device(second.ravel())]
        wp.launch(kernel, dim=first.size, inputs=inputs, outputs=results, device="cpu")
        return [result.numpy().reshape(first.shape) for result in results]


def _angle(name: str, value: Any) -> np.ndarray:
    angles = np.asarray(value, np.float64)
    inside = np.abs(angles) <= _HALF_PI + 1e-6
    if not np.all(inside):
        raise ValueError(f"{name} must lie in [-pi/2, pi/2] rad, got {angles[~inside].flat[0]}")
    return np.clip(angles, -_HALF_PI, _HALF_PI)


def _together(name: str, phi_o: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Both, broadcast; ValueError naming them where their shapes do not fit."""
    try:
        first, second = np.broadcast_arrays(phi_o, other)
    except ValueError:
        shapes = f"{phi_o.shape} and {other.shape}"
        raise ValueError(f"phi_o and {name} must broadcast, got shapes {shapes}") from None
    return first, second


def assembled(by_bounce: np.ndarray, lost: np.ndarray, slices: np.ndarray | None, **fields: Any) -> Table:
    """A table from what was simulated: the total, bins and sampling data follow from ``by_bounce``, ``normal`` is the
    first slice."""
    bins = by_bounce.shape[-1]
    mirror, weights = by_bounce.sum(axis=0), bin_weights(bins)
    return Table(
        mirror=mirror,
        by_bounce=by_bounce,
        normal=None if slices is None else slices[0],
        angles=bin_angles(bins),
        weights=weights,
        lost=lost,
        cdf=cumulative(mirror, weights),
        slices=slices,
        **fields,
    )


def cumulative(mirror: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """For each row (phi_o bin) of ``mirror`` the cumulative share of mirror * weight, float64 ``[M, M + 1]``; uniform
    in a row of none."""
    bins = len(weights)
    share = mirror * weights[None, :].astype(np.float64)
    total = share.sum(axis=1, keepdims=True)
    empty = total[:, 0] <= 0.0
    share = np.divide(share, total, out=share, where=~empty[:, None])
    if np.any(empty):
        share[empty] = weights / weights.sum()
    cdf = np.zeros((bins, bins + 1))
    np.cumsum(share, axis=1, out=cdf[:, 1:])
    cdf[:, 1:] /= cdf[:, -1:].copy()
    return cdf
