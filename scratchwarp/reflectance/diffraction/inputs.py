"""Arguments from Python: checked, as float64, ready to broadcast. Messages name the argument and the value."""

from typing import Any

import numpy as np

_UNIT = 1e-3  # how far from 1 the length of a direction may be


def numbers(name: str, value: Any, least: float = -np.inf, above: float = -np.inf) -> np.ndarray:
    """Finite numbers, at least ``least`` and greater than ``above``."""
    try:
        array = np.asarray(value, np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be numbers, got {value!r}") from None
    wrong = ~(np.isfinite(array) & (array >= least) & ((array > above) | (above == -np.inf)))
    if np.any(wrong):
        bound = f" greater than {above:g}" if above > -np.inf else f" at least {least:g}" if least > -np.inf else ""
        raise ValueError(f"{name} must be finite and{bound or ' real'}, got {array[wrong].flat[0]}")
    return array


def vectors(name: str, value: Any) -> np.ndarray:
    """Finite vectors ``[..., 3]``."""
    array = numbers(name, value)
    if array.ndim < 1 or array.shape[-1] != 3:
        raise ValueError(f"{name} must have shape [..., 3], got {list(array.shape)}")
    return array


def directions(name: str, value: Any) -> np.ndarray:
    """Unit vectors ``[..., 3]``; lengths within 1e-3 of 1 are made 1."""
    array = vectors(name, value)
    length = np.linalg.norm(array, axis=-1)
    wrong = np.abs(length - 1.0) > _UNIT
    if np.any(wrong):
        raise ValueError(f"{name} must be unit within {_UNIT}, got a vector of length {length[wrong].flat[0]}")
    return array / length[..., None]


def option(name: str, value: Any, allowed: tuple[str, ...]) -> str:
    """One of the allowed words."""
    if value not in allowed:
        raise ValueError(f"{name} must be one of {allowed}, got {value!r}")
    return value


def common_shape(**shapes: tuple[int, ...]) -> tuple[int, ...]:
    """What the leading shapes of the named arguments broadcast to."""
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        said = ", ".join(f"{name} {list(shape)}" for name, shape in shapes.items())
        raise ValueError(f"leading shapes do not broadcast: {said}") from None
