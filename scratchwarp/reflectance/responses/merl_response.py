"""Files of MERL measurements for the renderer."""

from collections.abc import Sequence
from typing import Any

from .response_device import MerlData
from .tabulated import MeasuredFile, packed


def pack(values: Sequence[MeasuredFile], arrays: Any, device: str, textures: Sequence[Any] = ()) -> Any:
    """Put the files into ``arrays.merl``; returns what must outlive them."""
    arrays.merl, alive = packed(values, MerlData, device)
    return alive
