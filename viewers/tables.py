"""Each layer's simulated table: rows phi_o, columns phi_i, brightness by the square root."""

from typing import Any

import numpy as np

from scratchwarp import profiles
from scratchwarp.plan.profiles import cross_section

from .colors import Shown
from .display import pyvista
from .marks import look_at, word
from .sheet import Sheet

SIDE = 138  # pixels across ``bounces``: 128 bins, and the margin with its ticks


def picture(item: Shown, resolution: int = 128, rays: int = 512) -> np.ndarray:
    """The mirror table of a layer as an image [resolution, resolution, 3] in [0, 1], phi_o upwards, phi_i to the right.

    White is what the 99.5th percentile reaches.
    """
    pv = pyvista()
    table = profiles.simulate(cross_section(item.layer.profile, item.layer), resolution=resolution, rays=rays)
    density = np.sqrt(np.maximum(np.asarray(table.mirror, np.float64), 0.0))
    high = float(np.percentile(density, 99.5)) or 1.0
    shade = np.clip(density / high, 0.0, 1.0)[..., None]
    tint = np.array(pv.Color(item.color).float_rgb)
    shown = np.where(shade < 0.5, 2 * shade * tint, tint + (2 * shade - 1) * (1 - tint))
    return shown[::-1]


def bounces(table: profiles.Table) -> np.ndarray:
    """The table as ``profiles.picture`` draws it, by number of bounces, [SIDE, SIDE, 3] in [0, 1] through the sRGB
    curve."""
    linear = profiles.picture(table, size=SIDE)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055)


def add(plotter: Any, items: list[Shown]) -> list[Sheet]:
    """Fill the active renderer with one table for each layer, side by side; returns the pictures, to be repainted."""
    columns = max(1, int(np.ceil(np.sqrt(len(items)))))
    sheets = []
    for i, item in enumerate(items):
        x, y = 1.15 * (i % columns), -1.3 * (i // columns)
        sheets.append(Sheet(plotter, picture(item), x, y, 1.0))
        word(plotter, item.title, x + 0.5, y + 1.1)
    look_at(plotter, -0.1, 1.15 * columns, -1.3 * (max(1, -(-len(items) // columns)) - 1) - 0.1, 1.45)
    return sheets
