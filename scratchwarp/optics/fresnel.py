"""What a smooth facet reflects: four frozen reflectors and their float64 reference formulas.

``Mirror()``, ``Conductor(eta, k, model)``, ``Dielectric(ior, model)`` and ``Schlick(f0)`` are hashable records. Each
has

- ``channels``: 1, or 3 where the parameters are linear Rec.709 triples;
- ``reflectance(cos_theta)``: unpolarised power reflectance, float64 ``[..., channels]``, for ``cos_theta`` in [0, 1];
- ``token``: a text that tells two reflectors apart, for cache keys and file names.

The device counterparts are in ``fresnel_device``. Sources: Fresnel's equations with a complex index eta + i k (Born
and Wolf, Principles of Optics, ch. 1 and 14); Schlick 1994; Lazanyi and Szirmay-Kalos 2005, "Fresnel Term
Approximations for Metals".
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

CONDUCTOR_MODELS = ("exact", "lazanyi", "lazanyi-error", "schlick")
DIELECTRIC_MODELS = ("exact", "schlick")
_COS_TOLERANCE = 1e-6


def amplitudes(cos_theta: Any, eta: Any, k: Any = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Complex amplitude coefficients ``(r_s, r_p)`` of a half-space of index eta + i k, seen from a medium of index 1.

    All arguments broadcast; ``cos_theta`` in [0, 1], ``eta`` and ``k`` relative to the medium of incidence. Phases
    follow exp(-i omega t); r_p has the sign in which r_p = -r_s at normal incidence. Beyond the critical angle |r| = 1.
    """
    cosine = np.asarray(cos_theta, np.float64)
    index = np.asarray(eta, np.float64) + 1j * np.asarray(k, np.float64)
    # the index times the refracted cosine; index^2 - sin^2 without cancellation
    axial = np.sqrt((index - 1.0) * (index + 1.0) + cosine * cosine + 0j)
    axial = np.where(axial.imag < 0.0, -axial, axial)
    with np.errstate(invalid="ignore", divide="ignore"):
        r_s = (cosine - axial) / (cosine + axial)
        r_p = (index * index * cosine - axial) / (index * index * cosine + axial)
    grazing = np.broadcast_to(cosine <= 0.0, r_s.shape)
    return np.where(grazing, -1.0 + 0j, r_s), np.where(grazing, -1.0 + 0j, r_p)


def _cosines(cos_theta: Any) -> np.ndarray:
    cosine = np.asarray(cos_theta, np.float64)
    if not np.all((cosine >= -_COS_TOLERANCE) & (cosine <= 1.0 + _COS_TOLERANCE)):
        bad = cosine[~((cosine >= -_COS_TOLERANCE) & (cosine <= 1.0 + _COS_TOLERANCE))].flat[0]
        raise ValueError(f"cos_theta must lie in [0, 1], got {bad}; pass the cosine to the facet normal")
    return np.clip(cosine, 0.0, 1.0)[..., None]


def _channel_values(name: str, value: Any, low: float, high: float = np.inf) -> tuple[float, ...]:
    values = np.asarray(value, np.float64)
    if values.shape not in ((), (1,), (3,)):
        raise ValueError(f"{name} must be a number or three (linear Rec.709), got shape {values.shape}")
    if not (np.all(np.isfinite(values)) and np.all(values >= low) and np.all(values <= high)):
        raise ValueError(f"{name} must be finite and lie in [{low:g}, {high:g}], got {value}")
    return tuple(float(v) for v in np.atleast_1d(values))


def _schlick(cosine: np.ndarray, f0: np.ndarray) -> np.ndarray:
    return f0 + (1.0 - f0) * (1.0 - cosine) ** 5


def _numbers(values: Sequence[float]) -> str:
    return ",".join(repr(v) for v in values)


@dataclass(frozen=True)
class Mirror:
    """Reflects everything, at every angle."""

    @property
    def channels(self) -> int:
        """1: the reflectance has no colour."""
        return 1

    @property
    def token(self) -> str:
        """Identity as text."""
        return "mirror"

    def reflectance(self, cos_theta: Any) -> np.ndarray:
        """Ones, ``[..., 1]``."""
        return np.ones_like(_cosines(cos_theta))


@dataclass(frozen=True)
class Conductor:
    """A metal of complex refractive index ``eta + i k``, relative to the medium above it.

    ``eta``, ``k``: a number or three; kept as tuples of ``channels`` floats. ``model``: "exact" (unpolarised Fresnel),
    "lazanyi" (Lazanyi and Szirmay-Kalos 2005, base formula), "lazanyi-error" (the same less its error term a c (1 -
    c)^alpha, see
    ``error_term``), "schlick" (with the exact reflectance at normal incidence).
    Raises ValueError on negative or non-finite values, eta = k = 0, or an unknown model.
    """

    eta: Any
    k: Any
    model: str = "exact"

    def __post_init__(self) -> None:
        eta, k = _channel_values("eta", self.eta, 0.0), _channel_values("k", self.k, 0.0)
        count = max(len(eta), len(k))
        eta, k = eta * (count // len(eta)), k * (count // len(k))
        if any(e == 0.0 and x == 0.0 for e, x in zip(eta, k, strict=True)):
            raise ValueError(f"eta and k must not both be 0, got eta={self.eta}, k={self.k}")
        if self.model not in CONDUCTOR_MODELS:
            raise ValueError(f"model must be one of {CONDUCTOR_MODELS}, got {self.model!r}")
        object.__setattr__(self, "eta", eta)
        object.__setattr__(self, "k", k)

    @property
    def channels(self) -> int:
        """1 or 3."""
        return len(self.eta)

    @property
    def token(self) -> str:
        """Identity as text."""
        return f"conductor:{self.model}:{_numbers(self.eta)}:{_numbers(self.k)}"

    @property
    def f0(self) -> tuple[float, ...]:
        """Reflectance at normal incidence, ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2), a channel."""
        return tuple(((e - 1) ** 2 + x * x) / ((e + 1) ** 2 + x * x) for e, x in zip(self.eta, self.k, strict=True))

    @property
    def error_term(self) -> tuple[tuple[float, float], ...]:
        """``(a, alpha)`` a channel of the Lazanyi error term, fitted by ``fit_lazanyi_error``."""
        return tuple(fit_lazanyi_error(e, x) for e, x in zip(self.eta, self.k, strict=True))

    def reflectance(self, cos_theta: Any) -> np.ndarray:
        """Unpolarised power reflectance ``[..., channels]`` of the chosen model."""
        cosine, eta, k = _cosines(cos_theta), np.asarray(self.eta), np.asarray(self.k)
        if self.model == "exact":
            r_s, r_p = amplitudes(cosine, eta, k)
            return 0.5 * (np.abs(r_s) ** 2 + np.abs(r_p) ** 2)
        if self.model == "schlick":
            return _schlick(cosine, np.asarray(self.f0))
        base = _lazanyi(cosine, eta, k)
        if self.model == "lazanyi":
            return base
        a, alpha = np.asarray(self.error_term).T
        return np.clip(base - a * cosine * (1.0 - cosine) ** alpha, 0.0, 1.0)


def _lazanyi(cosine: np.ndarray, eta: Any, k: Any) -> np.ndarray:
    return ((eta - 1.0) ** 2 + 4.0 * eta * (1.0 - cosine) ** 5 + k * k) / ((eta + 1.0) ** 2 + k * k)


@lru_cache(maxsize=1024)
def fit_lazanyi_error(eta: float, k: float) -> tuple[float, float]:
    """Constants ``(a, alpha)`` with which a c (1 - c)^alpha best stands for "Lazanyi base less exact Fresnel", c the
    cosine.

    Least squares over c uniform in [0, 1]: a follows in closed form for each alpha, alpha by golden-section search in
    [1, 40]. The paper gives the form and constants of a few metals, no rule for other ones.
    """
    cosine = np.linspace(0.0, 1.0, 513)
    r_s, r_p = amplitudes(cosine, eta, k)
    error = _lazanyi(cosine, eta, k) - 0.5 * (np.abs(r_s) ** 2 + np.abs(r_p) ** 2)

    def best(alpha: float) -> tuple[float, float]:
        shape = cosine * (1.0 - cosine) ** alpha
        a = float(shape @ error / (shape @ shape))
        return float(np.sum((error - a * shape) ** 2)), a

    low, high, ratio = 1.0, 40.0, (np.sqrt(5.0) - 1.0) / 2.0
    for _ in range(60):
        left, right = high - ratio * (high - low), low + ratio * (high - low)
        if best(left)[0] < best(right)[0]:
            high = right
        else:
            low = left
    alpha = 0.5 * (low + high)
    return best(alpha)[1], float(alpha)


@dataclass(frozen=True)
class Dielectric:
    """A transparent half-space of refractive index ``ior`` relative to the medium above it.

    ``ior`` may be below 1 (seen from inside): total internal reflection is included. ``model``: "exact" or "schlick"
    (below 1 the refracted cosine enters Schlick's formula). Raises ValueError on ior <= 0, non-finite, or an unknown
    model.
    """

    ior: float
    model: str = "exact"

    def __post_init__(self) -> None:
        if np.ndim(self.ior) != 0 or not (np.isfinite(self.ior) and self.ior > 0.0):
            raise ValueError(f"ior must be one finite number above 0, got {self.ior}")
        if self.model not in DIELECTRIC_MODELS:
            raise ValueError(f"model must be one of {DIELECTRIC_MODELS}, got {self.model!r}")
        object.__setattr__(self, "ior", float(self.ior))

    @property
    def channels(self) -> int:
        """1."""
        return 1

    @property
    def token(self) -> str:
        """Identity as text."""
        return f"dielectric:{self.model}:{self.ior!r}"

    @property
    def f0(self) -> tuple[float, ...]:
        """Reflectance at normal incidence, ((ior - 1) / (ior + 1))^2."""
        return (((self.ior - 1.0) / (self.ior + 1.0)) ** 2,)

    def reflectance(self, cos_theta: Any) -> np.ndarray:
        """Unpolarised power reflectance ``[..., 1]``."""
        cosine = _cosines(cos_theta)
        if self.model == "exact":
            r_s, r_p = amplitudes(cosine, self.ior)
            return 0.5 * (np.abs(r_s) ** 2 + np.abs(r_p) ** 2)
        if self.ior < 1.0:
            axial2 = (self.ior - 1.0) * (self.ior + 1.0) + cosine * cosine
            cosine = np.sqrt(np.maximum(axial2, 0.0)) / self.ior
        return _schlick(cosine, np.asarray(self.f0))


@dataclass(frozen=True)
class Schlick:
    """Schlick's formula f0 + (1 - f0) (1 - cos)^5 with a free reflectance at normal incidence.

    ``f0``: a number or three in [0, 1]; kept as a tuple. Raises ValueError outside that range.
    """

    f0: Any

    def __post_init__(self) -> None:
        object.__setattr__(self, "f0", _channel_values("f0", self.f0, 0.0, 1.0))

    @property
    def channels(self) -> int:
        """1 or 3."""
        return len(self.f0)

    @property
    def token(self) -> str:
        """Identity as text."""
        return f"schlick:{_numbers(self.f0)}"

    def reflectance(self, cos_theta: Any) -> np.ndarray:
        """Power reflectance ``[..., channels]``."""
        return _schlick(_cosines(cos_theta), np.asarray(self.f0))


Reflector = Mirror | Conductor | Dielectric | Schlick
