"""How the width, depth and profile of single scratches change along them, as ``variation_device`` has it."""

import math
from typing import Any

import numpy as np

from ..scene import Layer

STEPS = 16  # straight stretches in a wavelength
MOST_POINTS = 4_000_000

Array = np.ndarray[Any, Any]


def along_path(layer: Layer, points: Array, wavelength: float, rng: np.random.Generator) -> tuple[Array, Array]:
    """(points [k, 2], scales [k, 2] of width and depth) of a path whose size changes every ``wavelength``.

    Each path draws its own phases. A size follows a triangle wave with a wobble in its speed, so that over many paths
    it is spread evenly within 1 -+ the layer's variation everywhere. Raises ValueError where a path would have more
    than ``MOST_POINTS``.
    """
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    parts = np.maximum(np.ceil(step * (STEPS / wavelength)).astype(np.int64), 1)
    if parts.sum() > MOST_POINTS:
        raise ValueError(
            f"{layer.label}: variationLength {layer.variation_length:g} cuts a groove into {parts.sum()} stretches, "
            f"more than {MOST_POINTS}; make it longer"
        )
    at = np.concatenate([np.linspace(0.0, 1.0, n, endpoint=False) + k for k, n in enumerate(parts)] + [[len(step)]])
    places = np.arange(len(points))
    fine = np.stack([np.interp(at, places, points[:, axis]) for axis in range(2)], 1)
    length = np.interp(at, places, np.concatenate([[0.0], np.cumsum(step)])) / wavelength
    scales = []
    for variation in (layer.width_variation, layer.depth_variation):
        phase, wobble = rng.random(), 2.0 * math.pi * rng.random()
        turn = phase + length + 0.06 * (np.sin(4.0 * math.pi * length + wobble) - math.sin(wobble))
        wave = 1.0 - np.abs(2.0 * (turn % 1.0) - 1.0)
        scales.append(1.0 + variation * (2.0 * wave - 1.0))
    return fine, np.stack(scales, 1)
