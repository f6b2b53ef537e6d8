"""Packing images for ``texture_device``."""

from collections.abc import Sequence

import numpy as np
import warp as wp

from scratchwarp.reflectance.texture_device import TextureAtlas

_MOST_TEXELS = 2**31 - 1  # array indices on the device are 32 bits


def pack_textures(images: Sequence[np.ndarray], device: str = "cpu") -> TextureAtlas:
    """Put images, each float32 of shape [h, w, 4] with row 0 at the top, into one atlas; image i keeps its index.

    Raises ValueError on an image of another shape or without texels, or when all together exceed 2^31 - 1 texels.
    """
    for i, pixels in enumerate(images):
        if pixels.ndim != 3 or pixels.shape[2] != 4 or pixels.size == 0:
            raise ValueError(f"images[{i}] has shape {list(pixels.shape)}, expected [h, w, 4] with at least one texel")
    sizes = np.array([p.shape[0] * p.shape[1] for p in images], np.int64)
    if sizes.sum() > _MOST_TEXELS:
        raise ValueError(f"images hold {sizes.sum()} texels together, at most {_MOST_TEXELS} fit; use smaller images")
    atlas = TextureAtlas()
    flat = [np.asarray(p, np.float32).reshape(-1, 4) for p in images] or [np.zeros((1, 4), np.float32)]
    atlas.texels = wp.array(flat[0] if len(flat) == 1 else np.concatenate(flat), dtype=wp.vec4, device=device)
    starts = np.concatenate([[0], np.cumsum(sizes)])[: max(len(sizes), 1)]
    for name, values in (
        ("offset", starts),
        ("width", [p.shape[1] for p in images] or [1]),
        ("height", [p.shape[0] for p in images] or [1]),
    ):
        setattr(atlas, name, wp.array(np.asarray(values, np.int32), dtype=int, device=device))
    return atlas
