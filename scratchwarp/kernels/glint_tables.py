"""Tables of colours of scratches that diffract."""

import numpy as np

from ..reflectance.diffraction.color import spectral_samples
from ..scene import Wave

DEPTH_STEP = 0.006
"""Of ``wide_table`` [um]: a fringe of |D|^2 is at least 0.19 um deep; linear between, error 0.5 % of one."""
REACH_STEP = 0.04
"""Of ``wide_table`` [um]: a fringe of M is at least 0.38 um wide; cubic between them."""
MOST_NODES = 2_000_000
"""Of one table, 48 MB. Scratches that need more show no colours that a table would get right more cheaply."""


def wavelengths_of(wave: Wave) -> tuple[np.ndarray, np.ndarray]:
    """Wavelengths [um], the longest last, and linear Rec.709 of each; they add up to (1, 1, 1)."""
    if wave.sampling == "rgb":
        at, weights = spectral_samples("rgb")
    else:
        first, last = wave.wavelength_range
        n = max(wave.samples, 1)
        at = 1.0 / (1.0 / first - (np.arange(n) + 0.5) * ((1.0 / first - 1.0 / last) / n))
        _, weights = spectral_samples(at) if n > 1 else spectral_samples(1)
        if (first, last) == (380.0, 780.0):
            at, weights = spectral_samples(n)
    order = np.argsort(at)
    return at[order] * 1e-3, weights[order]


def wide_table(wave: Wave, deepest: float, reach: float, spread: float) -> np.ndarray | None:
    """T(X, D) and its slope in X, shape [depths, reaches, 2, 3], see ``glint_arrays_device.wide_integral``; depths from
    0 to ``deepest``, reaches from 0 to ``reach`` [um]; ``spread``: of the depths. None where that is too large."""
    depths, reaches = int(np.ceil(deepest / DEPTH_STEP)) + 2, int(np.ceil(reach / REACH_STEP)) + 2
    if depths * reaches > MOST_NODES:
        return None
    at, weights = spectral_samples(64)
    at = at * 1e-3
    k = 4.0 * np.pi / at
    rough, vary = np.exp(-0.5 * (k * wave.roughness) ** 2), np.exp(-0.5 * (k * spread) ** 2)
    fringes = np.cos(np.linspace(0.0, deepest, depths)[:, None] * k)
    half_d2 = 0.5 * (1.0 + rough**2 - 2.0 * rough * vary * fringes)
    x = np.linspace(0.0, reach, reaches)[:, None] * (2.0 * np.pi / at)
    # M by Simpson's rule on a fine grid: the integrand is 1 / 2 at 0 and smooth
    step = 0.02
    fine = np.arange(0.0, 2.0 * (np.ceil(x.max() / (2.0 * step)) + 2.0)) * step
    density = 0.5 * np.sinc(fine / (2.0 * np.pi)) ** 2
    sums = np.concatenate([[0.0], np.cumsum((density[0:-2:2] + 4.0 * density[1:-1:2] + density[2::2]) * step / 3.0)])
    m = np.interp(x, fine[::2], sums)
    slope = 0.5 * np.sinc(x / (2.0 * np.pi)) ** 2 * (2.0 * np.pi / at)
    both = np.stack([m, slope], axis=1)  # [reaches, 2, wavelengths]
    return np.einsum("dk,rsk,kc->drsc", half_d2, both, weights, optimize=True).astype(np.float32)
