"""Pack simulated profile tables for the device."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from .profile_table_device import TableArrays


def rows_to_unit_energy(mirror: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Scale each phi_o row of a mirror table so that sum_i mirror[j, i] w_i = 1.

    The simulation conserves energy over phi_o; reciprocity carries that to rows up to its sampling error (below 1e-3 at
    the default rays), which this removes so that a furnace stays white. Rows without energy become Lambertian.
    """
    energy = mirror @ weights
    empty = energy <= 1e-6
    scaled = mirror / np.where(empty, 1.0, energy)[:, None]
    scaled[empty] = 0.5
    return scaled


def pack(tables: Sequence[Any], device: str = "cpu") -> TableArrays:
    """Device arrays of ``profiles`` tables, all of one resolution.

    Each table offers ``mirror [M, M]``, ``weights [M]``, and ``normal``, ``gamma`` ([M, M] or [M, M, 3], or None for
    a mirror).
    """
    packed = TableArrays()
    bins = len(tables[0].weights) if tables else 1
    packed.bins = bins
    count = max(len(tables), 1)
    mirror = np.zeros((count, bins, bins), np.float32)
    normal = np.zeros((count, bins, bins, 3), np.float32)
    gamma = np.ones((count, bins, bins, 3), np.float32)
    cdf = np.zeros((count, bins, bins + 1), np.float32)
    fresnel = np.zeros(count, np.int32)
    for k, table in enumerate(tables):
        raw = np.asarray(table.mirror, np.float64)
        weights = np.asarray(table.weights, np.float64)
        unit = rows_to_unit_energy(raw, weights)
        mirror[k] = unit
        sums = np.cumsum(unit * weights, axis=1)
        cdf[k, :, 1:] = sums / sums[:, -1:]
        if table.normal is not None:
            fresnel[k] = 1
            # a cell's albedo is normal / mirror: keep that ratio under the row scaling
            scale = np.divide(unit, raw, out=np.ones_like(raw), where=raw > 0)[..., None]
            as_rgb = np.asarray(table.normal, np.float64)
            normal[k] = (as_rgb if as_rgb.ndim == 3 else as_rgb[..., None]) * scale
            exponent = np.asarray(table.gamma, np.float64)
            gamma[k] = exponent if exponent.ndim == 3 else exponent[..., None]
    packed.mirror = wp.array(mirror, dtype=float, device=device)
    packed.normal = wp.array(normal, dtype=wp.vec3, device=device)
    packed.gamma = wp.array(gamma, dtype=wp.vec3, device=device)
    packed.cdf = wp.array(cdf, dtype=float, device=device)
    packed.fresnel = wp.array(fresnel, dtype=int, device=device)
    return packed
