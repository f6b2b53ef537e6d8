"""From spectra to linear Rec.709: CIE 1931 2-degree observer, illuminants, chromatic adaptation, blackbodies.

Wavelengths in nanometres. Integrals are sums over the 5 nm grid ``WAVELENGTHS``; spectra given elsewhere are
interpolated linearly onto it and held constant beyond their ends. Nothing is clamped unless said: saturated colours
come out with negative components. Sources: CIE 015:2018; ITU-R BT.709; Planck's law; the Bradford transform (Lam 1985).
"""

from typing import Any

import numpy as np

from scratchwarp.optics.cie_tables import CIE_1931_D65

_TABLE = np.array(CIE_1931_D65, np.float64)
WAVELENGTHS = _TABLE[:, 0]
"""Grid of the integrals [nm], 360 to 830 by 5."""
CMF = _TABLE[:, 1:4]
"""Colour matching functions x, y, z on the grid, [95, 3]."""
ILLUMINANTS = {"D65": _TABLE[:, 4], "E": np.full(len(_TABLE), 100.0)}
"""Relative spectral power on the grid, by name."""
LUMINANCE = np.array([0.2126390058715104, 0.7151686787677559, 0.0721923153607337])
"""Luminance Y of the three primaries, white being 1."""

_PRIMARIES_XY = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))
_WHITE_XY = (0.3127, 0.3290)
_BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
_HC_OVER_K = 1.438776877e7  # second radiation constant [nm K], exact in the SI of 2019


def _xyz(xy: tuple[float, float]) -> np.ndarray:
    return np.array([xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]])


def _rgb_to_xyz_matrix() -> np.ndarray:
    primaries = np.stack([_xyz(xy) for xy in _PRIMARIES_XY], axis=1)
    return primaries * np.linalg.solve(primaries, _xyz(_WHITE_XY))


RGB_TO_XYZ = _rgb_to_xyz_matrix()
"""Linear Rec.709 to XYZ, white (1, 1, 1) to the D65 white point with Y = 1; ``xyz = RGB_TO_XYZ @ rgb``."""
XYZ_TO_RGB = np.linalg.inv(RGB_TO_XYZ)
"""The inverse of ``RGB_TO_XYZ``."""


def xyz_to_rgb(xyz: Any) -> np.ndarray:
    """XYZ ``[..., 3]`` to linear Rec.709 ``[..., 3]``, not clamped."""
    return np.asarray(xyz, np.float64) @ XYZ_TO_RGB.T


def rgb_to_xyz(rgb: Any) -> np.ndarray:
    """Linear Rec.709 ``[..., 3]`` to XYZ ``[..., 3]``."""
    return np.asarray(rgb, np.float64) @ RGB_TO_XYZ.T


def adapt(xyz: Any, source_white: Any, target_white: Any) -> np.ndarray:
    """Bradford adaptation of XYZ ``[..., 3]`` from one white point to another (both XYZ ``[3]``)."""
    gain = (_BRADFORD @ np.asarray(target_white)) / (_BRADFORD @ np.asarray(source_white))
    return np.asarray(xyz, np.float64) @ (np.linalg.solve(_BRADFORD, gain[:, None] * _BRADFORD)).T


def cmf(wavelengths: Any) -> np.ndarray:
    """Colour matching functions ``[..., 3]`` at any wavelengths [nm], cubic between the nodes, 0 outside 360 to 830."""
    at = np.asarray(wavelengths, np.float64)
    step = WAVELENGTHS[1] - WAVELENGTHS[0]
    position = np.clip((at - WAVELENGTHS[0]) / step, 0.0, len(WAVELENGTHS) - 1.0)
    node = np.clip(position.astype(int), 1, len(WAVELENGTHS) - 3)
    t = (position - node)[..., None]
    # Lagrange's cubic through four neighbouring nodes: exact at the nodes
    before, here, after, beyond = (CMF[node + i] for i in (-1, 0, 1, 2))
    value = -t * (t - 1) * (t - 2) / 6 * before + (t + 1) * (t - 1) * (t - 2) / 2 * here
    value += -(t + 1) * t * (t - 2) / 2 * after + (t + 1) * t * (t - 1) / 6 * beyond
    outside = (at < WAVELENGTHS[0]) | (at > WAVELENGTHS[-1])
    return np.where(outside[..., None], 0.0, np.maximum(value, 0.0))


def illuminant(name: str, wavelengths: Any = WAVELENGTHS) -> np.ndarray:
    """Relative power of "D65" or "E" at the wavelengths [nm], 100 at 560 nm, held beyond 360 to 830 nm."""
    if name not in ILLUMINANTS:
        raise ValueError(f"illuminant must be one of {tuple(ILLUMINANTS)}, got {name!r}")
    return np.interp(np.asarray(wavelengths, np.float64), WAVELENGTHS, ILLUMINANTS[name])


def _on_grid(wavelengths: Any, values: Any) -> np.ndarray:
    at, spectrum = np.asarray(wavelengths, np.float64), np.asarray(values, np.float64)
    if at.ndim != 1 or len(at) < 1 or not np.all(np.isfinite(at)) or np.any(np.diff(at) <= 0.0):
        raise ValueError(f"wavelengths must be one ascending list [nm], got {wavelengths}")
    if spectrum.shape[-1:] != at.shape or not np.all(np.isfinite(spectrum)):
        raise ValueError(f"values must be finite, with {len(at)} wavelengths last, got shape {spectrum.shape}")
    flat = spectrum.reshape(-1, len(at))
    resampled = np.array([np.interp(WAVELENGTHS, at, row) for row in flat])
    return resampled.reshape(*spectrum.shape[:-1], len(WAVELENGTHS))


def spectrum_to_rgb(wavelengths: Any, values: Any, illuminant: str = "D65") -> np.ndarray:
    """Colour of a reflectance spectrum ``values [..., n]`` lit by an illuminant: linear Rec.709 ``[..., 3]``.

    XYZ under the illuminant, Y = 1 for a perfect reflector, adapted (Bradford) from its white to that of Rec.709, so
    that reflectance 1 is exactly (1, 1, 1) under any of them. Raises ValueError on descending or mismatched
    wavelengths.
    """
    if illuminant not in ILLUMINANTS:
        raise ValueError(f"illuminant must be one of {tuple(ILLUMINANTS)}, got {illuminant!r}")
    weights = CMF * ILLUMINANTS[illuminant][:, None]
    weights = weights / weights[:, 1].sum()
    xyz = _on_grid(wavelengths, values) @ weights
    return xyz_to_rgb(adapt(xyz, weights.sum(axis=0), _xyz(_WHITE_XY)))


def emission_to_rgb(wavelengths: Any, values: Any) -> np.ndarray:
    """Colour of an emitted spectrum ``values [..., n]`` (power a nanometre): linear Rec.709 with no adaptation.

    Y is the integral of values times the y function, in the unit of ``values`` times nanometres (multiply by 683 lm/W
    for photometric units).
    """
    return xyz_to_rgb(_on_grid(wavelengths, values) @ CMF * (WAVELENGTHS[1] - WAVELENGTHS[0]))


def blackbody_rgb(kelvin: Any) -> np.ndarray:
    """Colour of a blackbody at ``kelvin``, shape ``[..., 3]``, normalised to luminance 1.

    Components outside Rec.709 (blue below about 1900 K) are set to 0 before the normalisation. Raises ValueError
    unless finite and at least 500 K, below which nothing is left in the visible range.
    """
    temperature = np.asarray(kelvin, np.float64)
    if not np.all(np.isfinite(temperature)) or np.any(temperature < 500.0):
        raise ValueError(f"kelvin must be finite and at least 500, got {kelvin}")
    exponent = _HC_OVER_K / (WAVELENGTHS * temperature[..., None])
    # Planck's law without the common factor exp(-c2 / (830 nm T)): low temperatures do not underflow
    smallest = exponent[..., -1:]
    power = np.exp(smallest - exponent) / (WAVELENGTHS / 560.0) ** 5 / -np.expm1(-exponent)
    rgb = np.maximum(emission_to_rgb(WAVELENGTHS, power), 0.0)
    return rgb / (rgb @ LUMINANCE)[..., None]
