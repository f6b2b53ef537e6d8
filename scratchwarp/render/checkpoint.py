"""Finished tiles on disk, so that an interrupted render goes on where it stopped, to the same bits."""

import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..whole import whole


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
