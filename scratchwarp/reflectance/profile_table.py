"""Pack simulated profile tables for the device."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from ..profiles.theta import theta_model
from .profile_table_device import TableArrays

RENDERED = ("gamma", "quadratic", "table")  # theta models that the device reads, from the cheapest


def rows_to_unit_energy(mirror: np.ndarray, weights: np.ndarray, lost: np.ndarray | float = 0.0) -> np.ndarray:
    """Scale each phi_o row of a mirror table so that sum_i mirror[j, i] w_i = 1, or 1 - lost[j].

    The simulation conserves energy over phi_o; reciprocity carries that to rows up to its sampling error (below 1e-3 at
    the default rays), which this removes so that a furnace stays white. Rows without energy become Lambertian.
    """
    energy = mirror @ weights
    empty = energy <= 1e-6
    scaled = mirror / np.where(empty, 1.0, energy)[:, None]
    scaled[empty] = 0.5
    return scaled * np.broadcast_to(1.0 - np.asarray(lost), empty.shape)[:, None]


def _rows(table: Any, scale: np.ndarray) -> tuple[np.ndarray, int, float]:
    """(rows [phi_o, n, phi_i, 3] of a reflector's table, its steps, its shift); see ``TableArrays``."""
    model = theta_model(table.theta_model)
    mirror = np.repeat((table.mirror * scale)[..., None], 3, axis=-1)

    def colored(values: np.ndarray) -> np.ndarray:
        return np.broadcast_to(values if values.ndim == 3 else values[..., None], mirror.shape)

    if model is None:
        made = [mirror, colored(table.normal) * scale[..., None], colored(table.gamma)]
        return np.stack(made, axis=1), 0, 0.0
    steps = len(model.cosines)
    if not np.allclose(model.places, np.arange(steps + 1) / steps):
        raise ValueError(f"theta_model {table.theta_model!r} has no equal steps; the renderer reads {RENDERED}")
    # the model's cosines descend from 1, its steps ascend from the mirror
    at = [int(np.abs(table.slice_cosines - mu).argmin()) for mu in model.cosines[::-1]]
    slices = [colored(table.slices[k]) * scale[..., None] for k in at]
    return np.stack([mirror, *slices], axis=1), steps, model.shift


def pack(tables: Sequence[Any], device: str = "cpu") -> TableArrays:
    """Device arrays of ``profiles`` tables, all of one resolution, each of a theta model in ``RENDERED``."""
    packed = TableArrays()
    bins = len(tables[0].weights) if tables else 1
    packed.bins = bins
    count = max(len(tables), 1)
    mirror = np.zeros((count, bins, bins), np.float32)
    cdf = np.zeros((count, bins, bins + 1), np.float32)
    first, steps, shift = np.full(count, -1, np.int32), np.zeros(count, np.int32), np.zeros(count, np.float32)
    rows: list[np.ndarray] = []
    for k, table in enumerate(tables):
        raw = np.asarray(table.mirror, np.float64)
        weights = np.asarray(table.weights, np.float64)
        unit = rows_to_unit_energy(raw, weights)
        sums = np.cumsum(unit * weights, axis=1)
        cdf[k, :, 1:] = sums / sums[:, -1:]
        unit = rows_to_unit_energy(raw, weights, np.asarray(table.lost, np.float64))
        mirror[k] = unit
        if table.normal is not None:
            # a cell's albedo is its slice over its mirror: keep that ratio under the row scaling
            scale = np.divide(unit, raw, out=np.ones_like(raw), where=raw > 0).astype(np.float32)
            made, steps[k], shift[k] = _rows(table, scale)
            first[k] = sum(r.shape[1] for r in rows)
            rows.append(made.astype(np.float32))
    every = np.concatenate(rows, axis=1) if rows else np.zeros((1, 1, 1, 3), np.float32)
    packed.slices = wp.array(every, dtype=wp.vec3, device=device)
    packed.mirror = wp.array(mirror, dtype=float, device=device)
    packed.cdf = wp.array(cdf, dtype=float, device=device)
    packed.first = wp.array(first, dtype=int, device=device)
    packed.steps = wp.array(steps, dtype=int, device=device)
    packed.shift = wp.array(shift, dtype=float, device=device)
    return packed
