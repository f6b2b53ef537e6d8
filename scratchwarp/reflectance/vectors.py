"""Checks of what NumPy entry points are given, and the way of broadcast arrays to the device and back."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

UNIT_TOLERANCE = 1e-3  # how far from 1 the length of a direction may be


def numbers(name: str, values: ArrayLike, low: float = -np.inf, high: float = np.inf) -> np.ndarray:
    """``values`` as float64; ValueError naming ``name`` and the first that is not a number in [low, high]."""
    try:
        array = np.asarray(values, np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be numbers, got {values!r}") from None
    good = np.isfinite(array) & (array >= low) & (array <= high)
    if not good.all():
        raise ValueError(f"{name} must lie in [{low:g}, {high:g}], got {array[~good].flat[0]}")
    return array


def vectors(name: str, values: ArrayLike, size: int, longest: float = np.inf) -> np.ndarray:
    """``values`` as float64 [..., size], none longer than ``longest``; ValueError naming ``name`` and the value."""
    array = numbers(name, values)
    if array.ndim < 1 or array.shape[-1] != size:
        raise ValueError(f"{name} must have shape [..., {size}], got {list(array.shape)}")
    length = np.linalg.norm(array, axis=-1)
    if np.any(length > longest):
        worst = np.unravel_index(np.argmax(length), length.shape)
        raise ValueError(f"{name} must be no longer than {longest:.3g}, got {array[worst]} of length {length[worst]:g}")
    return array


def directions(name: str, values: ArrayLike) -> np.ndarray:
    """Unit vectors [..., 3] in float64; ValueError naming ``name`` when a length is off by more than 1e-3."""
    array = vectors(name, values, 3)
    length = np.linalg.norm(array, axis=-1)
    if np.any(np.abs(length - 1.0) > UNIT_TOLERANCE):
        worst = length.flat[np.argmax(np.abs(length - 1.0))]
        raise ValueError(f"{name} must be unit within {UNIT_TOLERANCE}, got length {worst:g}")
    return array / length[..., None]


def uniforms(name: str, values: ArrayLike, size: int) -> np.ndarray:
    """Numbers [..., size] in [0, 1), none so near to 1 that float32 would round it there."""
    array = vectors(name, values, size)
    if np.any((array < 0.0) | (array >= 1.0)):
        raise ValueError(f"{name} must lie in [0, 1), got {array[(array < 0.0) | (array >= 1.0)].flat[0]}")
    return np.minimum(array, 1.0 - 2.0**-24)


def to_device(
    arrays: Sequence[np.ndarray], dtypes: Sequence[Any], device: Any = "cpu"
) -> tuple[tuple[int, ...], list[Any]]:
    """(leading shape, flat device arrays) of arrays that broadcast; a dtype of vectors keeps the last axis."""
    tails = [() if d in (float, int, wp.float64) else (d._length_,) for d in dtypes]
    leads = [a.shape[: a.ndim - len(t)] for a, t in zip(arrays, tails, strict=True)]
    try:
        lead = np.broadcast_shapes(*leads)
    except ValueError:
        raise ValueError(f"leading shapes {', '.join(str(list(s)) for s in leads)} do not broadcast") from None
    given = zip(arrays, dtypes, tails, strict=True)
    full = [(np.ascontiguousarray(np.broadcast_to(a, lead + t)).reshape(-1, *t), d) for a, d, t in given]
    return lead, [wp.array(a, dtype=d, device=device) for a, d in full]
