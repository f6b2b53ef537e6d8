"""The kernel behind ``stored``."""

import warp as wp

from .solid_device import GrooveSet, Piece
from .stored_device import path_with, piece_made

wp.set_module_options({"enable_backward": False})


@wp.kernel
def pieces(grooves: GrooveSet, out: wp.array(dtype=Piece)):
    """Piece number t of the paths that do not repeat."""
    t = wp.tid()
    path = grooves.paths[path_with(grooves, t)]
    out[t] = piece_made(grooves, path, t - path.first)
