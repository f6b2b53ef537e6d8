"""Explicit scratches of the uv square on texels: what they cover, and which way they run."""

from typing import Any

import numpy as np

Array = np.ndarray

STEP = 0.5
"""Texels between the points that a curve is drawn by."""
MOST = 1 << 24


def drawn(
    curves: Any, window: tuple[float, ...], size: tuple[int, int], scale: tuple[float, float]
) -> tuple[Array, Array]:
    """(coverage [h, w] in [0, 1], direction [h, w, 2]) of ``scene.Curves`` of space uv, row 0 where v is largest.

    ``window``: (u0, v0, u1, v1) that the texels fill; ``scale``: micrometres a unit of u and of v, v negative where the
    mapping is mirrored. Directions are (cos, sin) of twice the angle from dP/du. Raises ValueError where the curves
    have more points than can be drawn.
    """
    width, height = size
    texel = abs(scale[0]) * (window[2] - window[0]) / width, abs(scale[1]) * (window[3] - window[1]) / height
    unit = np.sqrt(abs(scale[0] * scale[1])) if curves.width_unit == "uv" else 1.0
    last = np.cumsum(curves.counts) - 1
    first = np.setdiff1d(np.arange(len(curves.points)), last)
    starts, ends = curves.points[first, :2], curves.points[first + 1, :2]
    wide = 0.5 * unit * (curves.widths[first] + curves.widths[first + 1])
    along = (ends - starts) * scale
    length = np.linalg.norm(along, axis=1)
    fine = STEP * min(texel)
    steps, lanes = (np.maximum(np.ceil(x / fine), 1).astype(np.int64) for x in (length, wide))
    if int((steps * lanes).sum()) > MOST:
        raise ValueError(f"{curves.path}: its curves are too long for so fine texels")
    run = np.repeat(np.arange(len(first)), steps * lanes)
    nth = np.arange(len(run)) - np.repeat(np.cumsum(steps * lanes) - steps * lanes, steps * lanes)
    t = (nth // lanes[run] + 0.5) / steps[run]
    aside = ((nth % lanes[run] + 0.5) / lanes[run] - 0.5) * wide[run]
    turn = np.arctan2(along[:, 1], along[:, 0])
    at = starts[run] + t[:, None] * (ends - starts)[run]
    at = at + aside[:, None] * np.stack([-np.sin(turn[run]), np.cos(turn[run])], 1) / scale
    x = (at[:, 0] - window[0]) / (window[2] - window[0]) * width - 0.5
    y = (window[3] - at[:, 1]) / (window[3] - window[1]) * height - 0.5
    area = (length * wide / (steps * lanes))[run] / (texel[0] * texel[1])
    twice = np.stack([np.ones_like(turn), np.cos(2 * turn), np.sin(2 * turn)], 1)[run] * area[:, None]
    made = np.zeros((height * width, 3))
    i, j = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    for dj in (0, 1):
        for di in (0, 1):
            weight = np.abs(1 - di - (x - i)) * np.abs(1 - dj - (y - j))
            inside = (i + di >= 0) & (i + di < width) & (j + dj >= 0) & (j + dj < height)
            cell = ((j + dj) * width + i + di)[inside]
            for channel in range(3):
                made[:, channel] += np.bincount(cell, (weight * twice[:, channel])[inside], height * width)
    found = made.reshape(height, width, 3)
    two = found[..., 1:] / np.maximum(np.linalg.norm(found[..., 1:], axis=-1, keepdims=True), 1e-20)
    two[found[..., 0] <= 0.0] = (1.0, 0.0)
    return np.clip(found[..., 0], 0.0, 1.0).astype(np.float32), two.astype(np.float32)
