"""Finished tiles on disk, so that an interrupted render goes on where it stopped, to the same bits."""

import hashlib
import zipfile
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..whole import whole


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


def save(path: str | Path, key: str, finished: np.ndarray, sums: Mapping[str, np.ndarray]) -> None:
    """Write the finished tiles [n] and the sums, whole or not at all."""
    arrays: dict[str, Any] = {f"sum_{name}": values for name, values in sums.items()}
    with whole(Path(path)) as draft, draft.open("wb") as file:
        np.savez(file, key=np.array(key), finished=finished, **arrays)


def load(path: str | Path, key: str, sums: Mapping[str, np.ndarray]) -> np.ndarray | None:
    """Fill ``sums`` from a checkpoint and return its finished tiles; None when there is no file.

    Raises ValueError when the file belongs to another render or is no checkpoint.
    """
    if not Path(path).exists():
        return None
    try:
        with np.load(path, allow_pickle=False) as stored:
            arrays = {name: stored[name] for name in stored.files}
        found, finished = str(arrays["key"]), arrays["finished"]
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise ValueError(f"{path}: not a checkpoint of scratchwarp ({error})") from None
    if found != key:
        raise ValueError(
            f"{path}: the checkpoint is of another stage, settings or version; delete it or leave out --resume"
        )
    for name, array in sums.items():
        array[...] = arrays[f"sum_{name}"]
    return finished
