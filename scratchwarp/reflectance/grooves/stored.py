"""The pieces of a pattern as a table, for the grid and for NumPy."""

from typing import Any

import numpy as np
import warp as wp

from . import stored_kernels as kernels
from .solid_device import Piece


def make_pieces(grooves: Any, count: int) -> np.ndarray:
    """The first ``count`` pieces as a NumPy table."""
    record: Any = Piece
    if not count:
        return np.zeros(0, dtype=record.numpy_dtype())
    out: Any = wp.zeros(count, dtype=Piece, device="cpu")
    wp.launch(kernels.pieces, count, inputs=[grooves], outputs=[out], device="cpu")
    return np.array(out.numpy())
