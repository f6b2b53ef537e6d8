"""Image pyramids for ``pyramid_device``, and maps of directions as images that may be averaged."""

from collections.abc import Sequence

import numpy as np
import warp as wp

from .pyramid_device import Pyramids
from .texture import pack_textures

ENCODINGS = ("angle", "vector")


def halved(image: np.ndarray, axis: int) -> np.ndarray:
    """An image half as large (rounded up) along ``axis``, each texel the mean of what it covers: odd sizes share the
    texels at the borders, so the mean of the image stays."""
    size = image.shape[axis]
    if size == 1:
        return image
    count = (size + 1) // 2
    edges = np.linspace(0.0, size, count + 1)
    at = np.arange(size)
    weights = np.clip(np.minimum(edges[1:, None], at + 1) - np.maximum(edges[:-1, None], at), 0.0, 1.0)
    weights /= weights.sum(axis=1, keepdims=True)
    return np.moveaxis(np.tensordot(weights, image, (1, axis)), 0, axis)


def pyramid(image: np.ndarray) -> list[np.ndarray]:
    """The image [h, w, 4] and ever smaller ones down to one texel, float32."""
    levels = [np.asarray(image, np.float32)]
    while max(levels[-1].shape[:2]) > 1:
        levels.append(halved(halved(levels[-1], 0), 1).astype(np.float32))
    return levels


def doubled(image: np.ndarray, encoding: str) -> np.ndarray:
    """Directions of scratches [h, w, 4] as unit vectors of twice their angle, in the first two channels.

    Lines have no sign: only at twice the angle are 179 and 1 degrees neighbours, so only there may directions be
    averaged.
    ``encoding`` angle: the first channel, 0 to 1 for 0 to 180 degrees; vector: the first two are (x, y) / 2 + 1/2,
    and vectors shorter than 1/50, which 8 bits cannot tell from none, have no direction (zeros). ValueError on
    another encoding.
    """
    if encoding not in ENCODINGS:
        raise ValueError(f"encoding must be one of {ENCODINGS}, got {encoding!r}")
    if encoding == "angle":
        turn = 2.0 * np.pi * image[..., 0].astype(np.float64)
        two = np.stack([np.cos(turn), np.sin(turn)], -1)
    else:
        two = doubled_vectors(2.0 * image[..., :2].astype(np.float64) - 1.0, 0.02)
    result = np.zeros((*image.shape[:2], 4), np.float32)
    result[..., :2] = two
    return result


def doubled_vectors(vectors: np.ndarray, least: float = 1e-12) -> np.ndarray:
    """Unit vectors [..., 2] of twice the angle of ``vectors`` [..., 2]; zeros for those shorter than ``least``."""
    x, y = vectors[..., 0], vectors[..., 1]
    square = x * x + y * y
    two = np.stack([x * x - y * y, 2.0 * x * y], -1)
    return np.divide(two, square[..., None], out=np.zeros_like(two), where=square[..., None] > least * least)


def pack_pyramids(images: Sequence[np.ndarray], device: str = "cpu") -> Pyramids:
    """Device pyramids of images [h, w, 4], in order; they take 4/3 of the images' texels, 16 bytes each."""
    made = [pyramid(image) for image in images]
    packed = Pyramids()
    packed.atlas = pack_textures([level for levels in made for level in levels], device)
    counts = np.array([len(levels) for levels in made] or [0], np.int32)
    packed.first = wp.array((np.cumsum(counts) - counts).astype(np.int32), dtype=int, device=device)
    packed.levels = wp.array(counts, dtype=int, device=device)
    return packed
