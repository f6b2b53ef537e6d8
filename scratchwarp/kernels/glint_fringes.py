"""The table of colours under lights without extent, for ``glint_fringes_device``."""

import functools

import numpy as np

from ..optics import spectra
from ..reflectance.diffraction.color import to_rgb

STEP = 1.0 / 64.0
"""Of offsets [um]."""
OFFSETS = 2561
"""To 40 um."""
FALLS, FALL_STEP = 25, 0.004
"""Gaussians e^{-g k^2} along the scratch: g from 0 every 0.004 um^2."""
CHANNELS = (0.612, 0.549, 0.465)
"""Middle wavelengths of R, G and B [um]."""
_GRID = 0.1  # nm


@functools.lru_cache(maxsize=1)
def fringes() -> np.ndarray:
    """Integrals of cmf(lambda) e^{-g (k^2 - k_c^2)} times cos(k o), its slope in o, and both for -k^2 cos(k o): linear
    Rec.709, float32 ``[FALLS, OFFSETS, 4, 3]``; 3 MB. k_c: that of the channel, so that neighbours in g are alike."""
    wave = np.arange(spectra.WAVELENGTHS[0] + 0.5 * _GRID, spectra.WAVELENGTHS[-1], _GRID)
    density = spectra.cmf(wave)
    density = to_rgb(density / density.sum(axis=0))
    k = 2.0 * np.pi / (wave * 1e-3)
    middle = 2.0 * np.pi / np.array(CHANNELS)
    fall = FALL_STEP * np.arange(FALLS)[:, None, None]
    falling = density * np.exp(-fall * (k[:, None] ** 2 - middle**2))  # [falls, waves, 3]
    flat = np.moveaxis(falling, 0, 1).reshape(len(k), -1).astype(np.float32)
    rows = np.empty((FALLS, OFFSETS, 4, 3), np.float32)
    squared, k32 = (k[:, None] ** 2 * flat).astype(np.float32), k[:, None].astype(np.float32)
    for part in np.array_split(np.arange(OFFSETS), 8):
        phase = STEP * part[:, None] * k
        cosine, sine = np.cos(phase).astype(np.float32), np.sin(phase).astype(np.float32)
        for column, (wave_of, weight) in enumerate(
            ((cosine, flat), (sine, -k32 * flat), (cosine, -squared), (sine, k32 * squared))
        ):
            rows[:, part, column] = np.moveaxis((wave_of @ weight).reshape(len(part), FALLS, 3), 1, 0)
    return rows
