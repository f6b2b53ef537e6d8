"""Files of UTIA measurements for the renderer."""

from collections.abc import Sequence
from typing import Any

from .response_device import UtiaData
from .tabulated import MeasuredFile, packed


def pack(values: Sequence[MeasuredFile], arrays: Any, device: str, textures: Sequence[Any] = ()) -> Any:
    """Put the files into ``arrays.utia``; returns what must outlive them."""
    arrays.utia, alive = packed(values, UtiaData, device)
    return alive
