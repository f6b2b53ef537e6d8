"""Energy between a base and the scratches on it, from Python."""

from typing import Any

import numpy as np
import warp as wp

from .arrays import DEVICE, device_array
from .inputs import numbers
from .real_device import vec2


def balance(visible: Any, dense: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """(weight of the base, factor of the scratches), float64 like ``visible`` = sum of area share times |D|^2 >= 0.

    base + factor * visible is at most 1, wavelength for wavelength, so that no density or depth of scratches makes
    light; scratches that are invisible (D = n lambda / 2) take nothing from the base. ``dense`` False: exactly 1 -
    visible while that lasts. Raises ValueError on negative or non-finite values.
    """
    from .energy_kernels import balance_kernel

    values = numbers("visible", visible, least=0.0)
    out = wp.zeros(values.size, dtype=vec2, device=DEVICE)
    if values.size:
        inputs = [device_array(values.reshape(-1)), int(dense)]
        wp.launch(balance_kernel, values.size, inputs=inputs, outputs=[out], device=DEVICE)
    result = out.numpy().reshape(*values.shape, 2)
    return result[..., 0], result[..., 1]
