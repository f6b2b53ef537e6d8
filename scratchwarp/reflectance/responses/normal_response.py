"""Scratch normal maps for the renderer: pyramids of the normals' first and second moments."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from ...scene import NormalMap, Texture
from ..mdf.density import KINDS
from .response_device import Moments, NormalMapData

# scene's names of distributions -> position in ``mdf.DISTRIBUTIONS``
_FACETS = {"ashikhminShirley": 0, "ward": 1, "beckmann": 2, "ggx": 3}
_LONGEST = 0.99


def moments(pixels: np.ndarray, strength: float = 1.0) -> np.ndarray:
    """Means of x, y, x^2, y^2, x y of the normals of an image ``[h, w, 3 or 4]`` (n * 0.5 + 0.5), float32 [h, w, 5]."""
    n = 2.0 * np.asarray(pixels[..., :3], np.float64) - 1.0
    length = np.linalg.norm(n, axis=-1, keepdims=True)
    n = np.divide(n, length, out=np.broadcast_to((0.0, 0.0, 1.0), n.shape).copy(), where=length > 0.0)
    p = strength * n[..., :2]
    p *= np.minimum(_LONGEST / np.maximum(np.linalg.norm(p, axis=-1, keepdims=True), 1e-20), 1.0)
    x, y = p[..., 0], p[..., 1]
    return np.stack([x, y, x * x, y * y, x * y], axis=-1).astype(np.float32)


def pyramid(finest: np.ndarray) -> list[np.ndarray]:
    """``finest [h, w, c]`` and its means over twice, four times, ... as wide squares, down to one texel."""
    levels = [np.ascontiguousarray(finest)]
    while max(levels[-1].shape[:2]) > 1:
        levels.append(np.ascontiguousarray(_halved(_halved(levels[-1], 0), 1)))
    return levels


def _halved(values: np.ndarray, axis: int) -> np.ndarray:
    """Half as many rows (or columns), each the mean of what it covers; an odd one is dealt out by overlap."""
    size = values.shape[axis]
    if size == 1:
        return values
    rows = np.moveaxis(values, axis, 0)
    if size % 2 == 0:
        return np.moveaxis(0.5 * (rows[0::2] + rows[1::2]), 0, axis)
    count = size // 2
    edges = np.arange(count + 1) * (size / count)
    whole = np.concatenate([np.zeros((1, *rows.shape[1:])), np.cumsum(rows, axis=0, dtype=np.float64)])
    low = np.minimum(edges.astype(int), size - 1)
    part = (edges - low).reshape(-1, *[1] * (rows.ndim - 1))
    until = whole[low] + part * rows[low]
    return np.moveaxis((np.diff(until, axis=0) * (count / size)).astype(np.float32), 0, axis)


def pack(values: Sequence[NormalMap], arrays: Any, device: str, textures: Sequence[Texture] = ()) -> None:
    """Put the maps into ``arrays``; those that read one texture at one strength share a pyramid."""
    firsts: dict[tuple[int, float], tuple[int, int]] = {}
    shapes: list[tuple[int, int, int]] = []
    texels: list[np.ndarray] = []
    records = []
    for value in values:
        key = (value.texture, value.strength)
        if key not in firsts:
            made = pyramid(moments(textures[value.texture].pixels, value.strength))
            firsts[key] = (len(shapes), len(made))
            for level in made:
                shapes.append((sum(len(t) for t in texels), level.shape[1], level.shape[0]))
                texels.append(level.reshape(-1, 5))
        m: Any = NormalMapData()
        m.first_level, m.levels = firsts[key]
        m.repeats = wp.vec2(*value.repeats)
        m.distribution = _FACETS[value.facets]
        m.deformation = KINDS.index(value.deformation) if value.deformation in KINDS else -1
        m.x, m.y = value.roughness
        records.append(m)
    arrays.maps = wp.array(records, dtype=NormalMapData, device=device)
    arrays.levels = wp.array(np.array(shapes, np.int32), dtype=wp.vec3i, device=device)
    arrays.moments = wp.array(np.concatenate(texels), dtype=Moments, device=device)
