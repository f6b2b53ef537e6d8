"""Seamless normal maps of scratches: engraved hemispheres, stretched at random or along a direction.

Source: Kang and Cho, section 2.4 and figure 10.
"""

import numpy as np

from ..vectors import numbers


def _positive(name: str, value: float, low: float, high: float) -> float:
    return float(numbers(name, np.asarray(value).reshape(()), low, high))


def scratch_map(
    resolution: int | tuple[int, int] = 512,
    density: float = 200.0,
    length: float = 0.2,
    width: float = 0.004,
    depth: float = 0.3,
    direction: float | None = None,
    spread: float = 0.0,
    variation: float = 0.5,
    seed: int = 0,
) -> np.ndarray:
    """Tangent-space normals ``[h, w, 3]`` float32, unit, z > 0, row 0 at the top; the map tiles without a seam.

    Each pit is a cap of a sphere scaled to an ellipse ``length`` by ``width`` (fractions of the tile; equal: a
    hemisphere unstretched). ``density`` pits a tile; ``depth`` in widths; ``direction`` [rad] from +x,
    counter-clockwise with v upwards, or None for any; ``spread`` [rad] half the range about ``direction``;
    ``variation`` in [0, 1] of length and depth from pit to pit. Where pits cross, the deeper is seen. Raises ValueError
    naming the argument.
    """
    shape = tuple(resolution) if isinstance(resolution, tuple | list) else (resolution, resolution)
    if len(shape) != 2 or any(int(n) != n or not 1 <= n <= 16384 for n in shape):
        raise ValueError(f"resolution must be one or two whole numbers in [1, 16384], got {resolution}")
    h, w = (int(n) for n in shape)
    _positive("density", density, 0.0, 1e6)
    for name, value, high in (("length", length, 1.0), ("width", width, 1.0), ("depth", depth, 10.0)):
        _positive(name, value, 0.0 if name == "depth" else 1e-6, high)
    _positive("variation", variation, 0.0, 1.0)
    _positive("spread", spread, 0.0, np.pi)
    middle = 0.0 if direction is None else _positive("direction", direction, -1e4, 1e4)
    half_range = np.pi if direction is None else spread

    rng = np.random.default_rng(seed)
    count = int(density) + int(rng.random() < density - int(density))
    center = rng.random((count, 2))
    angle = middle + half_range * (2.0 * rng.random(count) - 1.0)
    scale = 1.0 - variation * rng.random((count, 2))
    height = np.zeros((h, w))
    slope = np.zeros((h, w, 2))
    for k in range(count):
        _engrave(height, slope, center[k], angle[k], length * scale[k, 0], width, depth * width * scale[k, 1])
    normals = np.concatenate([-slope, np.ones((h, w, 1))], axis=-1)
    return (normals / np.linalg.norm(normals, axis=-1, keepdims=True)).astype(np.float32)


def _engrave(
    height: np.ndarray, slope: np.ndarray, center: np.ndarray, angle: float, length: float, width: float, depth: float
) -> None:
    """Cut one pit into ``height`` (fractions of the tile, negative) and its gradient, wrapped around the edges."""
    h, w = height.shape
    a, b = 0.5 * length, 0.5 * width
    c, s = np.cos(angle), np.sin(angle)
    reach_x, reach_y = np.hypot(a * c, b * s), np.hypot(a * s, b * c)
    columns = np.arange(int(np.floor((center[0] - reach_x) * w)), int(np.ceil((center[0] + reach_x) * w)) + 1)
    rows = np.arange(int(np.floor((center[1] - reach_y) * h)), int(np.ceil((center[1] + reach_y) * h)) + 1)
    x = (columns[None, :] + 0.5) / w - center[0]
    y = (rows[:, None] + 0.5) / h - center[1]
    along, across = (x * c + y * s) / a, (y * c - x * s) / b
    q = along * along + across * across
    inside = q < 1.0
    # a cap of the sphere of radius R in units of half the width: sag d = R - sqrt(R^2 - 1); a hemisphere when d >= 1
    sag = min(depth / b, 1.0)
    if sag <= 0.0:
        return
    radius = (1.0 + sag * sag) / (2.0 * sag)
    root = np.sqrt(np.maximum(radius * radius - q, 1e-4))
    scale = depth / sag  # deeper than a hemisphere: stretched downwards
    z = -scale * (root - (radius - sag))
    gain = scale / root
    dx = gain * (along * c / a - across * s / b)
    dy = gain * (along * s / a + across * c / b)
    # row 0 is the top: v runs against the rows
    at = np.ix_((-1 - rows) % h, columns % w)
    deeper = inside & (z < height[at])
    height[at] = np.where(deeper, z, height[at])
    slope[at] = np.where(deeper[..., None], np.stack([dx, dy], axis=-1), slope[at])
