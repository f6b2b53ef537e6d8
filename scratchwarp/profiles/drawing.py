"""A table as a picture like Raymond 2016, Figure 5: the cross-section above, the reflection by number of bounces
below."""

import numpy as np

from scratchwarp.profiles.profile import Profile
from scratchwarp.profiles.table import Table

_MARGIN = 0.04
_STRIP = 0.3
_LINE = 0.006
_GREY = 0.18


def picture(table: Table, profile: Profile | None = None, size: int = 512) -> np.ndarray:
    """Linear RGB in [0, 1], float32 ``[height, width, 3]``: one bounce in red, two in green, more in blue; phi_i runs
    to the right and phi_o upwards, from -90 to 90 degrees, marked every 30 degrees at the edges. ``profile`` is drawn
    above at its true aspect. ``size``: pixels across, at least 32 (ValueError). Brightness is rho to the power 0.35,
    1 at its 99.8th percentile among occupied cells: faint paths stay visible.
    """
    if size < 32:
        raise ValueError(f"size must be at least 32 pixels, got {size}")
    margin = max(4, int(_MARGIN * size))
    inner = size - 2 * margin
    index = np.minimum((np.arange(inner) + 0.5) * table.resolution / inner, table.resolution - 1).astype(int)
    occupied = table.mirror[table.mirror > 0.0]
    brightest = float(np.percentile(occupied, 99.8)) if occupied.size else 1.0
    cells = np.clip(table.by_bounce / max(brightest, 1e-30), 0.0, 1.0) ** 0.35
    square = np.full((inner + 2 * margin, size, 3), _GREY, np.float32)
    square[margin:-margin, margin:-margin] = cells.transpose(1, 2, 0)[index[::-1]][:, index]
    for tick in (np.arange(7) / 6.0 * (inner - 1)).astype(int):
        square[margin + tick, [margin // 2, size - 1 - margin // 2]] = 1.0
        square[[margin // 2, -1 - margin // 2], margin + tick] = 1.0
    if profile is None:
        return square
    return np.concatenate((_drawing(profile, size, margin), square))


def _drawing(profile: Profile, size: int, margin: int) -> np.ndarray:
    """The outline as a white line on grey, metal below it a little lighter."""
    points = (profile.polyline(8) - (profile.points[0, 0], profile.top)) / profile.period
    lowest = min(float(points[:, 1].min()), -0.02)
    inner = size - 2 * margin
    height = max(int(min(-lowest, 1.2) * inner), int(_STRIP * size * 0.1)) + 2 * margin
    scale = min((height - 2 * margin) / -lowest, inner)
    x = (np.arange(size) + 0.5 - size / 2) / scale + 0.5
    z = -(np.arange(height) + 0.5 - margin) / scale
    flat_left, flat_right = [x[0] - 1.0, points[0, 1]], [x[-1] + 1.0, points[-1, 1]]
    outline = np.concatenate(([flat_left], points, [flat_right]))
    start, edge = outline[:-1], np.diff(outline, axis=0)
    nearest = np.full((height, size), np.inf)
    crossings = np.zeros((height, size), int)
    for (x0, z0), (dx, dz) in zip(start, edge, strict=True):
        along = ((x[None, :] - x0) * dx + (z[:, None] - z0) * dz) / max(dx * dx + dz * dz, 1e-30)
        along = np.clip(along, 0.0, 1.0)
        distance = np.hypot(x[None, :] - x0 - along * dx, z[:, None] - z0 - along * dz)
        nearest = np.minimum(nearest, distance)
        if dx != 0.0:
            t = (x - x0) / dx
            hit = (t >= 0.0) & (t < 1.0)
            crossings += hit[None, :] & (z0 + t * dz > z[:, None])
    body = np.where(crossings % 2 == 1, 2.0 * _GREY, _GREY)
    line = np.clip(1.5 - nearest * scale / max(1.0, _LINE * size / 2), 0.0, 1.0)
    shade = body + (1.0 - body) * line
    return np.repeat(shade[..., None], 3, axis=2).astype(np.float32)
