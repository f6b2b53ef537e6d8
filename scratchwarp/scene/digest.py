"""A hash of records and arrays: equal where everything in them is equal, to the last bit."""

import hashlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np


def digest(*parts: Any) -> str:
    """A short hash of everything that decides the image: records with all their fields, arrays to the last bit."""
    sha = hashlib.sha256()
    _absorb(sha, parts)
    return sha.hexdigest()[:16]


def _absorb(sha: Any, part: Any) -> None:
    """Feed a value to the hash with its type and size, so that no two values look alike."""
    if isinstance(part, np.ndarray):
        sha.update(f"{part.dtype}{part.shape}".encode())
        sha.update(np.ascontiguousarray(part))
    elif is_dataclass(part) and not isinstance(part, type):
        _absorb(sha, (type(part).__name__, *(getattr(part, f.name) for f in fields(part))))
    elif isinstance(part, Mapping):
        _absorb(sha, tuple(sorted(part.items())))
    elif isinstance(part, frozenset):
        _absorb(sha, tuple(sorted(part)))
    elif isinstance(part, tuple | list):
        sha.update(f"({len(part)}".encode())
        for inner in part:
            _absorb(sha, inner)
    else:
        sha.update(f"{part!r},".encode())
