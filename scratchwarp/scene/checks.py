"""How records check and freeze what they hold: every message names the owner and the offending value."""

from collections.abc import Iterable
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike


def freeze(
    owner: str, name: str, values: ArrayLike, shape: tuple[int | None, ...], dtype: Any = np.float64
) -> np.ndarray:
    """Return a read-only array of ``shape`` (None: any length); ValueError on a wrong shape or a NaN."""
    array = np.array(values, dtype=dtype)
    fits = array.ndim == len(shape) and all(want in (None, got) for want, got in zip(shape, array.shape, strict=True))
    if not fits:
        wanted = "[" + ", ".join("n" if s is None else str(s) for s in shape) + "]"
        raise ValueError(f"{owner}: {name} has shape {list(array.shape)}, expected {wanted}")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        bad = np.argwhere(~np.isfinite(array))[0]
        raise ValueError(f"{owner}: {name}{[int(i) for i in bad]} is {array[tuple(bad)]}; every value must be finite")
    array.setflags(write=False)
    return array


def constant(values: Any) -> Any:
    """Default of an array field: a tuple, which ``freeze`` turns into the array when the record is made."""
    return values


def in_range(owner: str, name: str, value: float, low: float = -np.inf, high: float = np.inf) -> None:
    """ValueError unless ``low <= value <= high`` (a NaN never is)."""
    if not low <= value <= high:
        raise ValueError(f"{owner}: {name} is {value}, expected a value in [{low:g}, {high:g}]")


def all_finite(owner: str, record: Any, endless: Iterable[str] = ()) -> None:
    """ValueError where a number of a record, alone or in a tuple, is NaN or infinite; ``endless`` may be infinite."""
    for name in (f.name for f in fields(record)):
        value = getattr(record, name)
        for number in value if isinstance(value, tuple) else (value,):
            if not isinstance(number, float | np.floating) or np.isfinite(number):
                continue
            if name not in endless or np.isnan(number):
                raise ValueError(f"{owner}: {name} is {value}; every number must be finite")


def one_of(owner: str, name: str, value: str, allowed: tuple[str, ...]) -> None:
    """ValueError unless ``value`` is one of ``allowed``."""
    if value not in allowed:
        raise ValueError(f"{owner}: {name} is {value!r}, expected one of {', '.join(allowed)}")


def put(record: Any, **values: Any) -> None:
    """Set fields of a frozen record while it constructs itself."""
    for name, value in values.items():
        object.__setattr__(record, name, value)
