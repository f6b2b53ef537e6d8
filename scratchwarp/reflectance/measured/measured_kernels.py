"""The kernel behind ``Brdf.evaluate``, one for each format, compiled when a file of it is evaluated."""

from functools import cache
from typing import Any

import warp as wp

wp.set_module_options({"enable_backward": False})


@cache
def evaluation_kernel(struct: Any, function: Any) -> Any:
    """A kernel over pairs of directions for a format's ``struct`` and its ``function(brdf, wi, wo)``."""

    @wp.kernel(module="unique", module_options={"enable_backward": False})
    def evaluate(
        brdf: struct,
        wi: wp.array(dtype=wp.vec3),
        wo: wp.array(dtype=wp.vec3),
        reciprocal: int,
        out: wp.array(dtype=wp.vec3),
    ):
        i = wp.tid()
        f = wp.vec3(0.0, 0.0, 0.0)
        if wi[i][2] > 0.0 and wo[i][2] > 0.0:
            f = function(brdf, wi[i], wo[i])
            if reciprocal == 1:
                f = 0.5 * (f + function(brdf, wo[i], wi[i]))
        out[i] = f

    return evaluate
