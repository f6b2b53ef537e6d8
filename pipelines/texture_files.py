"""Baked maps as 8-bit PNG files, or as constants where they do not vary."""

from pathlib import Path

import numpy as np

Array = np.ndarray

_STEP = 1.0 / 255.0


def varies(values: Array) -> bool:
    """Whether a map [h, w] or [h, w, n] shows differences in 8 bits."""
    return values.size > 0 and bool((np.ptp(values.reshape(-1, *values.shape[2:]), axis=0) > _STEP).any())


def mean(values: Array) -> Array:
    """The mean texel."""
    return values.reshape(-1, *values.shape[2:]).mean(0)


def write(path: Path, values: Array, color: bool = False) -> Path:
    """Write a map in [0, 1]: [h, w] as grey, [h, w, 2] as red and green, [h, w, 3]; ``color``: linear, stored as sRGB.

    OSError where it cannot be written.
    """
    from scratchwarp.image import quick
    from scratchwarp.whole import whole

    pixels = values[..., None].repeat(3, -1) if values.ndim == 2 else values
    if pixels.shape[-1] == 2:
        pixels = np.concatenate([pixels, np.zeros_like(pixels[..., :1])], -1)
    data = quick.eight_bit(pixels) if color else np.rint(255.0 * np.clip(pixels, 0.0, 1.0)).astype(np.uint8)
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole(path) as draft:
        draft.write_bytes(quick.png(np.ascontiguousarray(data)))
    return path


def normals(slope: Array) -> Array:
    """Tangent-space normals [h, w, 3] in [0, 1] of slopes dz/dx, dz/dy [h, w, 2]."""
    n = np.concatenate([-slope, np.ones_like(slope[..., :1])], -1)
    return 0.5 + 0.5 * n / np.linalg.norm(n, axis=-1, keepdims=True)
