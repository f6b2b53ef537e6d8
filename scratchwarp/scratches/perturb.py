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
    amounts = (layer.width_variation, layer.depth_variation)
    return fine, np.stack([1.0 + a * (2.0 * _wave(length, rng) - 1.0) for a in amounts], 1)


def _wave(length: Array, rng: np.random.Generator) -> Array:
    """A number in [0, 1] along a path, ``length`` in wavelengths, with phases of its own."""
    phase, wobble = rng.random(), 2.0 * math.pi * rng.random()
    turn = phase + length + 0.06 * (np.sin(4.0 * math.pi * length + wobble) - math.sin(wobble))
    return 1.0 - np.abs(2.0 * (turn % 1.0) - 1.0)


def profile_runs(
    points: Array, scales: Array | None, wavelength: float, levels: int, rng: np.random.Generator
) -> list[tuple[Array, Array | None, float]]:
    """(points, scales, part) of the runs in which a path goes from one profile to the other and back: in ``levels``
    steps, part the middle of each, every ``wavelength``. Runs begin and end amid stretches, never at a corner."""
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    run = np.concatenate([[0.0], np.cumsum(step)])
    count = max(math.ceil(run[-1] / wavelength * 4 * levels), 1)
    if count > MOST_POINTS:
        raise ValueError(f"a path of {run[-1]:.3g} whose profile changes every {wavelength:.3g} has too many runs")
    middles = (np.arange(count) + 0.5) * (run[-1] / count)
    level = np.minimum((_wave(middles / wavelength, rng) * levels).astype(int), levels - 1)
    changes = np.flatnonzero(np.diff(level)) + 1
    edges = changes * (run[-1] / count)
    # off the corners, by a hundredth of the stretch
    place = np.clip(np.searchsorted(run, edges, side="right") - 1, 0, len(step) - 1)
    edges = np.clip(edges, run[place] + 0.01 * step[place], run[place + 1] - 0.01 * step[place])
    made = []
    for first, last, k in zip([0.0, *edges], [*edges, run[-1]], [level[0], *level[changes]], strict=True):
        at = np.concatenate([[first], run[(run > first) & (run < last)], [last]])
        own = np.stack([np.interp(at, run, column) for column in points.T], 1)
        sizes = None if scales is None else np.stack([np.interp(at, run, column) for column in scales.T], 1)
        made.append((own, sizes, (float(k) + 0.5) / levels))
    return made
