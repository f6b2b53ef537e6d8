"""Tables of colours of scratches that diffract."""

from typing import Any

import numpy as np
import warp as wp

from ..reflectance.diffraction.color import spectral_samples
from ..scene import Wave
from .glint_energy_device import BINS
from .glint_lobes_device import PER_CYCLE, tabulate

DEPTH_STEP = 0.006
"""Of ``wide_table`` [um]: a fringe of |D|^2 is at least 0.19 um deep; linear between, error 0.5 % of one."""
REACH_STEP = 0.03
"""Of ``wide_table`` [um]: a fringe of M is at least 0.38 um wide; cubic between them."""
SHARES = 1024
"""Depths at which the mean |D|^2 of a layer is tabulated."""
MOST_TERMS = 100_000_000
"""Of one table of a cross-section: a second or two."""
MOST_NODES = 2_000_000
"""Of one table, 48 MB. Scratches that need more show no colours that a table would get right more cheaply."""

MOST_LOBES = 1 << 24
"""Facets at places of one table of a lobe: a second or two."""


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


def bin_width(wave: Wave) -> float:
    """What one wavelength stands for in 1 / wavelength [1/um]."""
    first, last = wave.wavelength_range
    count = 3 if wave.sampling == "rgb" else max(wave.samples, 1)
    return 1e3 * (1.0 / first - 1.0 / last) / count


def depth_shares(deepest: float, roughness: float, outline: np.ndarray | None) -> np.ndarray:
    """Mean |D|^2 of depths from 0 to ``deepest`` [um], float32 [SHARES, COLUMNS]: of each part of the spectrum, even
    in 1 / wavelength, and linear Rec.709 of all of it. ``outline``: as in ``wide_table``."""
    at, weights = spectral_samples(16 * BINS)
    k = 2.0 * np.pi * 2.0 / at * 1e3
    depth = np.linspace(0.0, deepest, SHARES)[:, None]
    if outline is None:
        rough = np.exp(-0.5 * (k * roughness) ** 2)
        power = 1.0 + rough**2 - 2.0 * rough * np.cos(k * depth)
    else:
        power = np.zeros((SHARES, len(k)))
        for _, height, width, rise in outline:
            # the mean of |1 - e^{i k h}|^2 over a straight facet
            power += width * (2.0 - 2.0 * np.cos(k * depth * height) * np.sinc(k * depth * rise / (2.0 * np.pi)))
    means = np.maximum(power.reshape(SHARES, BINS, 16).mean(-1), 0.0)
    return np.concatenate([means, power @ weights], axis=1).astype(np.float32)


def lobe_table(outline: np.ndarray, reach: float, deep: float, device: str = "cpu") -> tuple[np.ndarray, float] | None:
    """``lobe_at``'s table, shape [depths, reaches] float32, and where its rows begin: 0 less a step where the lobe is
    even. ``reach``, ``deep``: greatest arguments, in wavelengths; None where it would be too large."""
    even = mirrored(outline)
    rows = np.ceil(deep * float(PER_CYCLE)) + 5.0
    reaches = np.ceil((1.0 if even else 2.0) * reach * float(PER_CYCLE)) + 6.0
    if not rows * reaches * len(outline) <= MOST_LOBES:
        return None
    first = -(1.0 if even else np.ceil(reach * float(PER_CYCLE)) + 2.0) / float(PER_CYCLE)
    facets: Any = wp.array(outline, dtype=wp.vec4d, device=device)
    made: Any = wp.empty(int(rows * reaches), dtype=float, device=device)
    wp.launch(tabulate, len(made), inputs=[facets, float(first), int(reaches)], outputs=[made], device=device)
    return made.numpy().reshape(int(rows), int(reaches)), float(first)


def mirrored(outline: np.ndarray) -> bool:
    """Whether facets look the same from both sides, so that their lobe is even in xi_2."""
    return bool(np.allclose(outline[::-1] * [-1, 1, 1, -1], outline, atol=1e-9))


def wide_table(
    wave: Wave, depths: tuple[float, float], reach: float, spread: float, outline: np.ndarray | None = None
) -> np.ndarray | None:
    """T(X, D) and its slope in X, shape [depths, reaches, 2, 3], see ``glint_arrays_device.wide_integral``.

    ``depths``: least and greatest; reaches from 0 to ``reach`` [um]; ``spread``: of the depths; ``outline``: facets of
    a cross-section that is no rectangle. None where that is too large, or where the lobe is not even in xi_2.
    """
    rows, reaches = int(np.ceil((depths[1] - depths[0]) / DEPTH_STEP)) + 2, int(np.ceil(reach / REACH_STEP)) + 2
    if rows * reaches > MOST_NODES:
        return None
    at, weights = spectral_samples(64)
    at = at * 1e-3
    depth = np.linspace(depths[0], depths[1], rows)[:, None]
    if outline is not None:
        return _outline_table(depth, reaches, reach, at, weights, outline)
    k = 4.0 * np.pi / at
    rough, vary = np.exp(-0.5 * (k * wave.roughness) ** 2), np.exp(-0.5 * (k * spread) ** 2)
    half_d2 = 0.5 * (1.0 + rough**2 - 2.0 * rough * vary * np.cos(depth * k))
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


def _outline_table(
    depth: np.ndarray, reaches: int, reach: float, at: np.ndarray, weights: np.ndarray, outline: np.ndarray
) -> np.ndarray | None:
    """The same of facets: (pi / 2) integral of |p|^2 dX / lambda, p the transform over a width of 1."""
    fine = 4 * (reaches - 1) + 1
    if not mirrored(outline) or len(depth) * fine * len(at) * len(outline) > MOST_TERMS:
        return None
    x = np.linspace(0.0, reach, fine)[:, None] / at
    table = np.empty((len(depth), reaches, 2, 3), np.float32)
    step = reach / (fine - 1)
    for row, d in enumerate(depth / at):
        p = np.zeros(x.shape, complex)
        for v, height, width, rise in outline:
            bounced = np.exp(-4j * np.pi * d * height) * np.sinc(x * width + 2.0 * d * rise)
            p += width * np.exp(-2j * np.pi * x * v) * (np.sinc(x * width) - bounced)
        density = (0.5 * np.pi * np.abs(p) ** 2 / at) @ weights
        sums = np.concatenate([np.zeros((1, 3)), np.cumsum(0.5 * (density[1:] + density[:-1]) * step, axis=0)])
        table[row, :, 0], table[row, :, 1] = sums[::4], density[::4]
    return table
