"""NumPy files from strangers: what their arrays claim to hold is checked by their headers before one is read."""

import os
import zipfile
from typing import Any, BinaryIO

import numpy as np

from .memory import Budget, TooLarge

_HEADERS = {1: np.lib.format.read_array_header_1_0, 2: np.lib.format.read_array_header_2_0}


def check_archive(source: Any, budget: Budget | None = None, name: object = None) -> None:
    """TooLarge (a ValueError) naming the file and the array where those of an ``.npz`` or ``.npy`` file claim more
    bytes than the file holds, or together more than ``budget`` leaves (None: most of this machine's memory).

    ``source``: a path, or a binary stream, which is left at its start; ``name``: what messages call it. What is no
    such file is left to whoever reads it, which says so.
    """
    named, budget = source if name is None else name, budget or Budget()
    if isinstance(source, str | os.PathLike):
        with open(source, "rb") as stream:
            check_archive(stream, budget, named)
        return
    try:
        if not zipfile.is_zipfile(source):
            source.seek(0, os.SEEK_END)
            size = source.tell()
            source.seek(0)
            _check_array(source, size, str(named), budget)
            return
        with zipfile.ZipFile(source) as archive:
            for entry in archive.infolist():
                with archive.open(entry) as member:
                    _check_array(member, entry.file_size, f"{named}: {entry.filename.removesuffix('.npy')}", budget)
    finally:
        source.seek(0)


def _check_array(stream: BinaryIO | Any, size: int, name: str, budget: Budget) -> None:
    try:
        version = np.lib.format.read_magic(stream)[0]
        shape, _, dtype = _HEADERS.get(version, _HEADERS[2])(stream)
        at = stream.tell()
    except (ValueError, EOFError, OSError, zipfile.BadZipFile, SyntaxError):
        return
    claimed = float(dtype.itemsize)
    for count in shape:
        claimed *= float(count)
    said = f"an array of {' x '.join(map(str, shape)) or 1} {dtype}"
    if claimed > size - at:
        raise TooLarge(f"{name}: claims to be {said}, {claimed:.3g} bytes, and holds {size - at}; it is damaged")
    budget.take(claimed, name, said, besides=claimed)
