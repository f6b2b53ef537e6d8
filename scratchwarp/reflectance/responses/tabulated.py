"""Files of measured BRDFs for the renderer: their tables, how to draw from them, what bounds their energy."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import warp as wp

from ..measured import Brdf, load
from .half_device import HalfTable

_ROWS, _COLUMNS = 64, 32  # of the table of half vectors
_VIEWS = 16  # that it is the mean of
_LIMIT_ROWS, _LIMIT_COLUMNS = 12, 12
_SAMPLES = 400  # of each albedo
_LEAST_COSINE = 1e-3


@dataclass(frozen=True)
class MeasuredFile:
    """A file, and its size and time of change, so that one written anew counts as another."""

    path: str
    size: int
    changed: int


@dataclass(frozen=True, eq=False)
class Tabulated:
    """A file's BRDF, cumulative tables of its half vectors, factors that bound its albedo, and its mean albedo."""

    brdf: Brdf
    rows: np.ndarray
    columns: np.ndarray
    limit: np.ndarray
    albedo: tuple[float, float, float]


def measured_file(path: str, format: str = "auto") -> tuple[str, MeasuredFile]:
    """(format, file). Raises OSError when it cannot be read, ValueError when it is foreign or not of ``format``."""
    status = Path(path).stat()
    file = MeasuredFile(str(path), status.st_size, status.st_mtime_ns)
    found = tabulated(file).brdf.format
    if format not in ("auto", found):
        raise ValueError(f"{path}: scratch:measured:format is {format!r}, but the file is of {found!r}")
    return found, file


@lru_cache(maxsize=8)
def tabulated(file: MeasuredFile) -> Tabulated:
    """The tables of a file."""
    brdf = load(file.path)
    t = np.arange(_ROWS + 1) / _ROWS
    cosines = np.cos(0.5 * np.pi * t * t)
    middle = np.arccos(np.clip(0.5 * (cosines[1:] + cosines[:-1]), -1.0, 1.0))
    phi = (np.arange(_COLUMNS) + 0.5) / _COLUMNS * 2.0 * np.pi
    h = _directions(middle[:, None], phi).reshape(-1, 1, 3)
    k = np.arange(_VIEWS)
    views = _directions(np.radians(5.0 + 70.0 * (k + 0.5) / _VIEWS), k * 2.399963)
    facing = (h * views).sum(-1, keepdims=True)
    wi = 2.0 * facing * h - views
    value = np.where(
        (facing > 0.0) & (wi[..., 2:] > 0.0), _both_ways(brdf, wi, views) * np.maximum(wi[..., 2:], 0.0) * facing, 0.0
    )
    # each view counts alike: its own light divided by its total
    lightness = value.mean(-1).reshape(_ROWS, _COLUMNS, _VIEWS)
    area = -np.diff(cosines)[:, None, None]
    energy = lightness * area / np.maximum((lightness * area).sum((0, 1)), 1e-30)
    density = energy.mean(-1) + 1e-4 / (_ROWS * _COLUMNS)
    rows = np.concatenate([[0.0], np.cumsum(density.sum(1))])
    columns = np.concatenate([np.zeros((_ROWS, 1)), np.cumsum(density, axis=1)], axis=1)
    rows, columns = rows / rows[-1], columns / columns[:, -1:]
    limit, albedo = _limits(brdf, rows, columns)
    return Tabulated(brdf, rows, columns, limit, albedo)


def _directions(theta: Any, phi: Any) -> np.ndarray:
    parts = np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta))
    return np.stack(parts, axis=-1)


def _both_ways(brdf: Brdf, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    up = wi[..., 2] > 1e-6
    light = np.where(up[..., None], wi, (0.0, 0.0, 1.0))
    light = light / np.linalg.norm(light, axis=-1, keepdims=True)
    return np.where(up[..., None], brdf.evaluate(light, wo, reciprocal=True).astype(np.float64), 0.0)


def _limits(brdf: Brdf, rows: np.ndarray, columns: np.ndarray) -> tuple[np.ndarray, tuple[float, float, float]]:
    """(1 / max(1, albedo) of views over half a turn, albedo at 45 degrees)."""
    cosines = np.maximum((1.0 - np.arange(_LIMIT_ROWS) / (_LIMIT_ROWS - 1)) ** 2, _LEAST_COSINE)
    views = _directions(np.arccos(cosines)[:, None], np.arange(2 * _LIMIT_COLUMNS) / _LIMIT_COLUMNS * np.pi)
    # the same half vectors for all: strata of the table's rows and columns
    n = np.arange(_SAMPLES) + 0.5
    u, v = n / _SAMPLES, (n * 0.6180339887498949) % 1.0
    row = np.clip(np.searchsorted(rows, u, side="right") - 1, 0, _ROWS - 1)
    column = np.array([np.searchsorted(columns[r], x, side="right") - 1 for r, x in zip(row, v, strict=True)])
    column = np.clip(column, 0, _COLUMNS - 1)
    inside = (n * 0.7548776662466927) % 1.0, (n * 0.5698402909980532) % 1.0
    edge = np.cos(0.5 * np.pi * (np.arange(_ROWS + 1) / _ROWS) ** 2)
    z = edge[row] + inside[0] * (edge[row + 1] - edge[row])
    h = _directions(np.arccos(np.clip(z, -1.0, 1.0)), (column + inside[1]) / _COLUMNS * 2.0 * np.pi)
    flat = views.reshape(-1, 1, 3)
    facing = (h * flat).sum(-1)
    by_half = 2.0 * facing[..., None] * h - flat
    spread = _directions(np.arccos(np.sqrt(u)), 2.0 * np.pi * v)
    albedo = np.zeros((len(flat), 3))
    for wi, ok in ((by_half, facing > 0.0), (np.broadcast_to(spread, by_half.shape), np.ones_like(facing, bool))):
        half = wi + flat
        half /= np.maximum(np.linalg.norm(half, axis=-1, keepdims=True), 1e-20)
        cell = _density(half, rows, columns)
        pdf = 0.5 * cell / (4.0 * np.maximum((half * flat).sum(-1), 1e-6)) + 0.5 * np.maximum(wi[..., 2], 0.0) / np.pi
        weight = _both_ways(brdf, wi, np.broadcast_to(flat, wi.shape)) * (np.maximum(wi[..., 2], 0.0) / pdf)[..., None]
        albedo += 0.5 * np.where((ok & (wi[..., 2] > 0.0))[..., None], weight, 0.0).mean(1)
    table = albedo.max(-1).reshape(_LIMIT_ROWS, 2, _LIMIT_COLUMNS).max(1)
    near = np.maximum(table, np.vstack([table[1:], table[-1:]]))
    wide = np.maximum(near, np.maximum(np.roll(near, 1, axis=1), np.roll(near, -1, axis=1)))
    middle = albedo.reshape(_LIMIT_ROWS, -1, 3)[int(np.argmin(np.abs(cosines - np.sqrt(0.5))))].mean(0)
    r, g, b = np.clip(middle, 0.0, 1.0)
    return 1.0 / np.maximum(1.02 * wide, 1.0), (float(r), float(g), float(b))


def _density(h: np.ndarray, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Density of half vectors [1/sr] by the tables, as on the device."""
    t = np.sqrt(np.arccos(np.clip(h[..., 2], -1.0, 1.0)) / (0.5 * np.pi))
    row = np.clip((t * _ROWS).astype(int), 0, _ROWS - 1)
    turn = np.arctan2(h[..., 1], h[..., 0]) / (2.0 * np.pi) % 1.0
    column = np.clip((turn * _COLUMNS).astype(int), 0, _COLUMNS - 1)
    edge = np.cos(0.5 * np.pi * (np.arange(_ROWS + 1) / _ROWS) ** 2)
    share = np.diff(rows)[row] * np.diff(columns, axis=1)[row, column]
    return share / ((edge[row] - edge[row + 1]) * 2.0 * np.pi / _COLUMNS)


def packed(values: Sequence[MeasuredFile], struct: Any, device: str) -> tuple[Any, Any]:
    """(device array of ``struct`` with the files' tables, what must outlive it)."""
    records = []
    for value in values:
        made = tabulated(value)
        half: Any = HalfTable()
        half.rows = wp.array(made.rows.astype(np.float32), dtype=float, device=device)
        half.columns = wp.array(made.columns.astype(np.float32), dtype=float, device=device)
        half.limit = wp.array(made.limit.astype(np.float32), dtype=float, device=device)
        record = struct()
        record.brdf, record.half = made.brdf.device_record(), half
        records.append(record)
    return wp.array(records, dtype=struct, device=device), records
