"""Each layer's cross-section; how wide and deep it is stands below.

Heights are drawn by their square root, so that shallow ones are seen, and one as deep as it is wide fills its cell.
"""

from typing import Any

import numpy as np

from scratchwarp.plan.profiles import cross_section
from scratchwarp.scene import Layer

from .colors import Shown
from .marks import Line, look_at, word

HEIGHT = 0.55  # of a cell, whose width is 1
PITCH = (1.15, 0.95)


def micrometres(layer: Layer) -> np.ndarray:
    """The outline [n, 2] of a layer: x from the middle, z from the surface, both in micrometres (space uv: in uv)."""
    line = cross_section(layer.profile, layer).polyline(4)
    return (line - (0.5 * (line[0, 0] + line[-1, 0]), 0.0)) * layer.width


class Plot:
    """One layer's outline and its size, with the lower left corner at (x, y)."""

    def __init__(self, plotter: Any, item: Shown, x: float, y: float) -> None:
        self.x, self.y = x, y
        word(plotter, item.title, x + 0.5, y + HEIGHT + 0.13)
        self.size = word(plotter, "", x + 0.5, y - 0.1, 10)
        self.line = Line(plotter, item.color)
        self.draw(item.layer)

    def draw(self, layer: Layer) -> None:
        """Show the layer as it is now, with the ground beside it."""
        line = micrometres(layer)
        ground = 0.15 * np.ptp(line[:, 0])
        line = np.concatenate([[[line[0, 0] - ground, 0.0]], line, [[line[-1, 0] + ground, 0.0]]])
        low, high = line.min(axis=0), line.max(axis=0)
        wide, tall = np.maximum(high - low, 1e-9)
        stretched = (1.0 / wide, HEIGHT / tall * min(1.0, np.sqrt(tall / wide)))
        self.line.draw((self.x, self.y + HEIGHT) + (line - (low[0], high[1])) * stretched)
        unit = "um" if layer.space == "surface" else "of the uv square"
        self.size.input = f"{layer.width:.3g} wide, {layer.depth:.3g} deep, {unit}"


def add(plotter: Any, items: list[Shown]) -> list[Plot]:
    """Fill the active renderer, but for a strip below, with one plot for each layer; returns the plots."""
    columns = max(1, int(np.ceil(np.sqrt(len(items)))))
    rows = max(1, -(-len(items) // columns))
    plots = [Plot(plotter, item, PITCH[0] * (i % columns), -PITCH[1] * (i // columns)) for i, item in enumerate(items)]
    bottom = -PITCH[1] * (rows - 1) - 0.2
    high = 0.95 - bottom
    look_at(plotter, -0.1, PITCH[0] * columns, bottom - 0.2 * high, 0.95)
    return plots
