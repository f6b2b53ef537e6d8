"""From energies of traced columns to tables: the host of ``balance_kernels``."""

from typing import Any

import numpy as np
import warp as wp

from scratchwarp.profiles import balance_kernels as kernels
from scratchwarp.profiles.launch import launch_tiles

_ROUNDS = 3


def balanced(energy: np.ndarray, weights: np.ndarray, lost: np.ndarray, reciprocal: bool, threads: int) -> np.ndarray:
    """rho ``[layers, phi_o, phi_i]`` [1/rad], float32, from the share of each column's light ``[columns, layers,
    phi_o]``.

    Fewer columns than bins are the left half of a symmetric profile's. Where ``reciprocal``, the energy weights[i] *
    share is averaged with its transpose; then rows and columns are scaled together (three rounds of symmetric
    Sinkhorn scaling, then once by column), so that each column accounts for all its light but ``lost``.
    """
    bins, layers = len(weights), energy.shape[1]
    columns = kernels.Columns()
    columns.energy = _device(energy)
    columns.weight = _device(weights)
    columns.reciprocal = int(reciprocal)
    scale = np.ones(bins)
    last = np.ones(bins)
    if reciprocal:
        flow = wp.empty((bins, bins), dtype=float, device="cpu")
        launch_tiles(kernels.mirror_flow, bins, [columns, flow], threads)
        mirror = flow.numpy()
        target = weights * (1.0 - lost)
        for _ in range(_ROUNDS):
            scale *= np.sqrt(_ratio(target, scale * (mirror @ scale.astype(np.float32))))
        last = _ratio(target, scale * (mirror @ scale.astype(np.float32)))
    table = wp.empty((layers, bins, bins), dtype=float, device="cpu")
    rows, cells = _device(scale / weights), _device(scale * last / weights)
    launch_tiles(kernels.scaled_tables, bins, [columns, rows, cells, table], threads)
    return table.numpy()


def exponents(mirror: np.ndarray, normal: np.ndarray, sixty: np.ndarray, threads: int) -> tuple[np.ndarray, float]:
    """``(gamma, flagged)``: Raymond's exponent ``[channels, M, M]``, finite and in [0, 64], from slices at theta = 0
    and pi/3 of that shape and the mirror table ``[M, M]``; and the share of cells with energy whose curve no power
    represents (r = (rho60 - rho0) / (rho90 - rho0) outside (0, 1]). Flat and empty cells get 1, where any value
    serves."""
    gamma = wp.empty(normal.shape, dtype=float, device="cpu")
    counts = wp.empty((len(mirror), 2), dtype=int, device="cpu")
    inputs = [_device(mirror), _device(normal), _device(sixty), gamma, counts]
    launch_tiles(kernels.fit_exponents, len(mirror), inputs, threads)
    misfit, occupied = counts.numpy().sum(axis=0)
    return gamma.numpy(), float(misfit) / max(int(occupied), 1)


def _ratio(target: np.ndarray, have: np.ndarray) -> np.ndarray:
    return np.divide(target, have, out=np.ones_like(have), where=have > 0.0)


def _device(values: np.ndarray) -> Any:
    return wp.array(np.ascontiguousarray(values, np.float32), dtype=float, device="cpu", copy=False)
