"""Finished tiles on disk, so that an interrupted render goes on where it stopped, to the same bits."""

import hashlib
import os
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np


def digest(*parts: Any) -> str:
    """A short hash of everything that decides the image."""
    sha = hashlib.sha256()
    for part in parts:
        sha.update(part.tobytes() if isinstance(part, np.ndarray) else repr(part).encode())
    return sha.hexdigest()[:16]


def save(path: str | Path, key: str, finished: np.ndarray, sums: Mapping[str, np.ndarray]) -> None:
    """Write the finished tiles [n] and the sums whole: beside the file first, then renamed onto it."""
    target = Path(path)
    arrays: dict[str, Any] = {f"sum_{name}": values for name, values in sums.items()}
    handle, draft = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    try:
        with os.fdopen(handle, "wb") as file:
            np.savez(file, key=np.array(key), finished=finished, **arrays)
        os.replace(draft, target)
    except BaseException:
        Path(draft).unlink(missing_ok=True)
        raise


def load(path: str | Path, key: str, sums: Mapping[str, np.ndarray]) -> np.ndarray | None:
    """Fill ``sums`` from a checkpoint and return its finished tiles; None when there is no file.

    Raises ValueError when the file belongs to another render or is no checkpoint.
    """
    if not Path(path).exists():
        return None
    try:
        with np.load(path, allow_pickle=False) as stored:
            if str(stored["key"]) != key:
                raise ValueError(
                    f"{path}: the checkpoint is of another stage, settings or version; delete it or leave out --resume"
                )
            for name, array in sums.items():
                array[...] = stored[f"sum_{name}"]
            return np.array(stored["finished"])
    except (OSError, KeyError, zipfile.BadZipFile) as error:
        raise ValueError(f"{path}: not a checkpoint of scratchwarp ({error})") from None
