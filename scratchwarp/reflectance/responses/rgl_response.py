"""Files of RGL measurements for the renderer."""

from collections.abc import Sequence
from typing import Any

from .response_device import RglData
from .tabulated import MeasuredFile, packed


def pack(values: Sequence[MeasuredFile], arrays: Any, device: str, textures: Sequence[Any] = ()) -> Any:
    """Put the files into ``arrays.rgl``; returns what must outlive them."""
    arrays.rgl, alive = packed(values, RglData, device)
    return alive
