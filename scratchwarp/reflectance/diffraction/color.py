"""Colours of single scratches from Python: exact, or by sampled wavelengths."""

import functools
from typing import Any

import numpy as np
import warp as wp

from scratchwarp.optics import spectra

from .arrays import DEVICE, device_array, rules
from .color_device import FringeTable
from .inputs import common_shape, numbers
from .real_device import real, vec3
from .reflection import brdf
from .scratch import Scratch

RGB_WAVELENGTHS = (612.0, 549.0, 465.0)
"""Wavelengths [nm] taken for red, green and blue where three must do."""

_LONGEST, _STEP = 40.0, 1.0 / 64.0  # offsets of the table [um]
_GRID = 0.05  # wavelengths of its integrals [nm]


def rgb(width: Any, depth: Any, xi2: Any, wavelengths: Any = None) -> np.ndarray:
    """Colour of one scratch under a distant white light at xi_1 = 0, s_b = 0: linear Rec.709 ``[..., 3]`` of its BRDF
    [1/sr], not clamped; illuminant E adapted to D65, so that a BRDF of 1 at all wavelengths is (1, 1, 1).

    ``width``, ``depth`` [um] >= 0 and ``xi2`` in [-2, 2] broadcast. ``wavelengths``: None, exact, by one look-up table
    and no sampling of wavelengths; an integer, so many uniform in 1 / lambda over 380 to 780 nm; a list [nm],
    ascending, summed by the trapezoidal rule; "rgb", the values at 612, 549 and 465 nm taken for red, green and blue.
    Raises ValueError naming the argument.
    """
    w, d = numbers("width", width, least=0.0), numbers("depth", depth, least=0.0)
    xi = numbers("xi2", xi2, least=-2.0)
    if np.any(xi > 2.0):
        raise ValueError(f"xi2 must lie in [-2, 2], got {xi[xi > 2.0].flat[0]}")
    shape = common_shape(width=w.shape, depth=d.shape, xi2=xi.shape)
    w, d, xi = (np.broadcast_to(value, shape).reshape(-1) for value in (w, d, xi))
    if wavelengths is None:
        return _exact(w, d, xi).reshape(*shape, 3)
    at, weights = spectral_samples(wavelengths)
    # directions with this sum across the scratch and none along it
    half = 0.5 * xi[:, None]
    direction = np.stack(np.broadcast_arrays(0.0, half, np.sqrt(np.maximum(1.0 - half * half, 1e-12))), axis=-1)
    direction = direction / np.linalg.norm(direction, axis=-1, keepdims=True)
    values = brdf(direction, direction, Scratch(width=w[:, None], depth=d[:, None]), at)
    return (values @ weights).reshape(*shape, 3)


def spectral_samples(wavelengths: Any) -> tuple[np.ndarray, np.ndarray]:
    """Wavelengths [nm] ``[n]`` and weights ``[n, 3]`` to linear Rec.709 of a reflectance sampled there, each column's
    sum 1: illuminant E adapted to D65. ``wavelengths`` as in ``rgb``, not None."""
    if isinstance(wavelengths, str):
        if wavelengths != "rgb":
            raise ValueError(f"wavelengths must be None, an integer, a list [nm] or 'rgb', got {wavelengths!r}")
        return np.array(RGB_WAVELENGTHS), np.eye(3)
    if isinstance(wavelengths, int | np.integer) and not isinstance(wavelengths, bool):
        if wavelengths < 1:
            raise ValueError(f"wavelengths must be at least 1, got {wavelengths}")
        n = int(wavelengths)
        low, high = 1.0 / 780.0, 1.0 / 380.0
        at = 1.0 / (high - (np.arange(n) + 0.5) * ((high - low) / n))
        xyz = spectra.cmf(at) * at[:, None] ** 2
    else:
        at = numbers("wavelengths", wavelengths, above=0.0)
        if at.ndim != 1 or len(at) < 1 or np.any(np.diff(at) <= 0.0):
            raise ValueError(f"wavelengths must be one ascending list [nm], got {wavelengths}")
        gaps = np.concatenate(([0.0], np.diff(at), [0.0]))
        xyz = spectra.cmf(at) * (0.5 * (gaps[1:] + gaps[:-1]) if len(at) > 1 else np.ones(1))[:, None]
    total = xyz.sum(axis=0)
    if not np.all(total > 0.0):
        raise ValueError(f"wavelengths must reach into the visible range, got {wavelengths}")
    return at, to_rgb(xyz / total)


def to_rgb(equal_energy: np.ndarray) -> np.ndarray:
    """Linear Rec.709 of XYZ ``[..., 3]`` whose white is (1, 1, 1): sums over wavelengths of each column are 1 before
    and after."""
    return spectra.xyz_to_rgb(spectra.adapt(equal_energy, np.ones(3), spectra.rgb_to_xyz(np.ones(3))))


def _exact(w: np.ndarray, d: np.ndarray, xi: np.ndarray) -> np.ndarray:
    from .color_kernels import color_kernel

    out = wp.zeros(len(w), dtype=vec3, device=DEVICE)
    inputs = [fringe_table(), rules((8,)), *(device_array(value, real) for value in (w, d, xi))]
    if len(w):
        wp.launch(color_kernel, len(w), inputs=inputs, outputs=[out], device=DEVICE)
    return out.numpy()


@functools.cache
def fringe_table() -> FringeTable:
    """The look-up table of ``color_device`` for the CIE 1931 observer, made once: 2561 rows, 0.25 MB."""
    wave = np.arange(spectra.WAVELENGTHS[0] + 0.5 * _GRID, spectra.WAVELENGTHS[-1], _GRID)
    density = spectra.cmf(wave)
    density = to_rgb(density / density.sum(axis=0))
    k = 2.0 * np.pi / (wave * 1e-3)
    offsets = np.arange(0.0, _LONGEST + 0.5 * _STEP, _STEP)
    rows = np.empty((len(offsets), 4, 3))
    for part in np.array_split(np.arange(len(offsets)), 16):
        phase = offsets[part, None] * k
        cosine, sine = np.cos(phase), np.sin(phase)
        rows[part, 0] = cosine @ density
        rows[part, 1] = -(sine * k) @ density
        rows[part, 2] = -(cosine * k**2) @ density
        rows[part, 3] = (sine * k**3) @ density
    table: Any = FringeTable()
    table.step = _STEP
    table.rows = device_array(rows, vec3)
    return table
