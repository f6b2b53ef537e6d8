"""The integrated lobe over arrays."""

import numpy as np
import warp as wp

from .arrays import device_array, launch
from .lobe_device import lobe_integral
from .real_device import HALF, PI, real

wp.set_module_options({"enable_backward": False})


@wp.kernel
def lobe_integral_kernel(t: wp.array(dtype=real), out: wp.array(dtype=real)):
    """M(2 pi t)."""
    i = wp.tid()
    m = lobe_integral(t[i])
    out[i] = HALF * PI * real(m.half) + m.rest


def lobe_integrals(t: np.ndarray) -> np.ndarray:
    """M(2 pi t) of any shape: the integral of (1 - cos x) / x^2 from 0 to 2 pi t."""
    return launch(lobe_integral_kernel, t.shape, device_array(t.reshape(-1)))
