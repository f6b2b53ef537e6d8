"""Pack simulated profile tables for the device."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from ..profiles.theta import theta_model
from .profile_table_device import TableArrays

MODEL = "table"  # theta model of the tables that the device reads


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


def _steps(table: Any, scale: np.ndarray) -> np.ndarray:
    """rho_s at the steps of the theta model, [phi_o, steps + 1, phi_i, 3], times ``scale`` [phi_o, phi_i]."""
    model = theta_model(MODEL)
    assert model is not None
    # the model's cosines descend from 1, its steps ascend from the mirror
    rows = [int(np.abs(table.slice_cosines - mu).argmin()) for mu in model.cosines[::-1]]
    if np.abs(table.slice_cosines[rows] - model.cosines[::-1]).max() > 1e-6:
        raise ValueError(f"a table was simulated with theta_model {table.theta_model!r}, expected {MODEL!r}")
    mirror, slices = table.mirror, table.slices
    if slices.ndim == 3:
        slices = slices[..., None]
    made = np.empty((len(mirror), len(rows) + 1, len(mirror), 3), np.float32)
    made[:, 0] = (mirror * scale)[..., None]
    for step, row in enumerate(rows, start=1):
        made[:, step] = slices[row] * scale[..., None]
    return made


def pack(tables: Sequence[Any], device: str = "cpu") -> TableArrays:
    """Device arrays of ``profiles`` tables, all of one resolution.

    Tables of a reflector have the slices of theta model ``MODEL``, else ValueError.
    """
    model = theta_model(MODEL)
    assert model is not None
    packed = TableArrays()
    bins = len(tables[0].weights) if tables else 1
    packed.bins = bins
    count = max(len(tables), 1)
    mirror = np.zeros((count, bins, bins), np.float32)
    cdf = np.zeros((count, bins, bins + 1), np.float32)
    reflector = np.full(count, -1, np.int32)
    steps: list[np.ndarray] = []
    for k, table in enumerate(tables):
        raw = np.asarray(table.mirror, np.float64)
        weights = np.asarray(table.weights, np.float64)
        unit = rows_to_unit_energy(raw, weights)
        mirror[k] = unit
        sums = np.cumsum(unit * weights, axis=1)
        cdf[k, :, 1:] = sums / sums[:, -1:]
        if table.slices is not None:
            # a cell's albedo is its slice over its mirror: keep that ratio under the row scaling
            scale = np.divide(unit, raw, out=np.ones_like(raw), where=raw > 0).astype(np.float32)
            reflector[k] = len(steps)
            steps.append(_steps(table, scale))
    packed.steps = len(model.cosines)
    packed.slices = wp.array(np.stack(steps) if steps else np.zeros((1, 1, 1, 1, 3)), dtype=wp.vec3, device=device)
    packed.mirror = wp.array(mirror, dtype=float, device=device)
    packed.cdf = wp.array(cdf, dtype=float, device=device)
    packed.reflector = wp.array(reflector, dtype=int, device=device)
    return packed
