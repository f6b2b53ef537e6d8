"""Energy over arrays."""

import warp as wp

from .energy_device import balanced_weights
from .real_device import real, vec2

wp.set_module_options({"enable_backward": False})


@wp.kernel
def balance_kernel(visible: wp.array(dtype=real), dense: int, out: wp.array(dtype=vec2)):
    """Weights of base and scratches."""
    i = wp.tid()
    out[i] = balanced_weights(visible[i], dense)
