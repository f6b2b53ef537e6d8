"""A sublayer laid out over a part of the uv square: what it covers of each texel and which way it runs."""

from collections.abc import Mapping

import numpy as np
import warp as wp

from ..plan.choice import LayerPlan
from ..scratches.pattern_kernels import cells
from .material import pack_layer

Array = np.ndarray

SAMPLES = 16


def covered(
    plan: LayerPlan,
    window: tuple[float, float, float, float],
    size: tuple[int, int],
    scale: tuple[float, float],
    samples: int = SAMPLES,
) -> tuple[Array, Array]:
    """(coverage float32 [h, w] in [0, 1], direction float32 [h, w, 2]) of each texel, row 0 where v is largest.

    Args:
        plan: a sublayer of any distribution but explicit curves, else ValueError.
        window: (u0, v0, u1, v1) that the texels fill. size: (w, h). samples: footprints averaged in a texel.
        scale: micrometres a unit of u and of v over the surface; v negative where the mapping is mirrored.

    Directions are (cos, sin) of twice the angle from dP/du, averaged over what is covered.
    """
    if plan.sublayer.distribution == "curves":
        raise ValueError(f"{plan.sublayer.layer.label}: explicit curves are no pattern of the uv square")
    if not (window[2] > window[0] and window[3] > window[1]) or min(size) < 1 or samples < 1:
        raise ValueError(f"window {window}, size {size}, samples {samples}: there is nothing to lay out")
    width, height = size
    data = pack_layer(plan)
    unit = (1.0, float(np.sign(scale[1]) or 1.0)) if data.uv_space else scale
    out = wp.zeros((height, width), dtype=wp.vec3, device="cpu")
    step = ((window[2] - window[0]) / width, (window[3] - window[1]) / height)
    inputs = [data, wp.vec2d(window[0], window[1]), wp.vec2d(*step), wp.vec2d(*unit), height, samples, out]
    wp.launch(cells, (height, width), inputs=inputs, device="cpu")
    found = out.numpy()
    two = found[..., 1:] / np.maximum(np.linalg.norm(found[..., 1:], axis=-1, keepdims=True), 1e-20)
    empty = found[..., 0] <= 0.0
    two[empty] = (np.cos(2.0 * plan.sublayer.angle), np.sin(2.0 * plan.sublayer.angle))
    return np.clip(found[..., 0], 0.0, 1.0), two.astype(np.float32)


def mapping_scale(arrays: Mapping[str, Array]) -> tuple[float, float]:
    """Micrometres a unit of u and of v over an instance (``geometry.instance_arrays``); v negative where the mapping is
    mirrored on most of it."""
    world = arrays["world"]
    cross = np.cross(world[:, 1] - world[:, 0], world[:, 2] - world[:, 0])
    turned = np.cross(arrays["dpdu"], arrays["dpdv"])
    handed = float((np.sign((turned * cross).sum(1)) * np.linalg.norm(cross, axis=1)).sum())
    su, sv = (float(x) for x in arrays["scale"])
    return su, sv if handed >= 0.0 else -sv
