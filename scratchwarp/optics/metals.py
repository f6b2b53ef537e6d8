"""Measured metals: n and k against wavelength, their colour, and three-channel n, k with the same colour.

Source of the figures: ``metal_tables``.
"""

from functools import lru_cache
from typing import Any

import numpy as np

from scratchwarp.optics import spectra
from scratchwarp.optics.fresnel import Conductor, amplitudes
from scratchwarp.optics.metal_tables import METALS, TABLE

_TABLE = np.array(TABLE, np.float64)
_HIGHEST = 0.999  # silver and gold leave Rec.709 at the red end: above this no eta, k exist and energy would grow
_COSINES = np.linspace(0.05, 1.0, 20)

NAMES = METALS
"""The metals there are figures for."""


def _column(name: str) -> int:
    if name not in METALS:
        raise ValueError(f"name must be one of {METALS}, got {name!r}")
    return 1 + 2 * METALS.index(name)


def index(name: str, wavelengths: Any) -> tuple[np.ndarray, np.ndarray]:
    """``(n, k)`` of a metal at the wavelengths [nm], any shape; held constant outside 360 to 830 nm."""
    column, at = _column(name), np.asarray(wavelengths, np.float64)
    return np.interp(at, _TABLE[:, 0], _TABLE[:, column]), np.interp(at, _TABLE[:, 0], _TABLE[:, column + 1])


def reflectance_spectrum(name: str, wavelengths: Any, cos_theta: float = 1.0) -> np.ndarray:
    """Unpolarised reflectance of a metal at the wavelengths [nm], exact Fresnel."""
    r_s, r_p = amplitudes(cos_theta, *index(name, wavelengths))
    return 0.5 * (np.abs(r_s) ** 2 + np.abs(r_p) ** 2)


def reflectance_rgb(name: str, cos_theta: float = 1.0) -> np.ndarray:
    """Colour of the metal under D65: linear Rec.709 ``[3]`` of the whole spectrum, not clamped (gold: red above 1)."""
    return spectra.spectrum_to_rgb(spectra.WAVELENGTHS, reflectance_spectrum(name, spectra.WAVELENGTHS, cos_theta))


def rgb(name: str) -> tuple[np.ndarray, np.ndarray]:
    """``(eta [3], k [3])``: one index a linear Rec.709 channel that shows the colour of the whole spectrum.

    For each channel, the pair whose reflectance at normal incidence is that of ``reflectance_rgb`` (at most 0.999)
    exactly, and at the other angles the nearest, by least squares weighted with the cosine (projected solid angle). k
    follows from eta and the reflectance in closed form; eta is searched. This keeps the colour an artist sees face on
    and the darkening before grazing.
    """
    eta, k = _fitted(name)
    return np.array(eta), np.array(k)


def conductor(name: str, model: str = "exact") -> Conductor:
    """The metal as a three-channel ``Conductor`` with the indices of ``rgb``."""
    return Conductor(*_fitted(name), model)


@lru_cache(maxsize=len(METALS))
def _fitted(name: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    target = np.minimum([reflectance_rgb(name, c) for c in _COSINES], 1.0)
    normal = np.clip(reflectance_rgb(name), 0.0, _HIGHEST)
    fitted = [_fit_channel(normal[i], target[:, i]) for i in range(3)]
    return tuple(e for e, _ in fitted), tuple(k for _, k in fitted)


def _fit_channel(normal: float, target: np.ndarray) -> tuple[float, float]:
    root = np.sqrt(normal)
    low, high = np.log((1.0 - root) / (1.0 + root)), np.log((1.0 + root) / (1.0 - root))  # where k^2 >= 0

    def k_of(eta: np.ndarray) -> np.ndarray:
        return np.sqrt(np.maximum((normal * (eta + 1.0) ** 2 - (eta - 1.0) ** 2) / (1.0 - normal), 0.0))

    for _ in range(4):
        grid = np.linspace(low, high, 201)
        eta = np.exp(grid)
        r_s, r_p = amplitudes(_COSINES[:, None], eta, k_of(eta))
        error = 0.5 * (np.abs(r_s) ** 2 + np.abs(r_p) ** 2) - target[:, None]
        best = int(np.argmin(_COSINES @ error**2))
        low, high = grid[max(best - 2, 0)], grid[min(best + 2, 200)]
    return float(eta[best]), float(k_of(eta[best]))
