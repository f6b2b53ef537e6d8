"""Each layer's cross-section, to scale in micrometres."""

from typing import Any

import numpy as np

from scratchwarp.plan.profiles import cross_section
from scratchwarp.scene import Layer

from .colors import TEXT, Shown
from .display import pyvista


def micrometres(layer: Layer) -> np.ndarray:
    """The outline [n, 2] of a layer: x from the middle, z from the surface, both in micrometres (space uv: in uv)."""
    line = cross_section(layer.profile, layer).polyline()
    return (line - (0.5 * (line[0, 0] + line[-1, 0]), 0.0)) * layer.width


def add(plotter: Any, items: list[Shown]) -> list[Any]:
    """Fill the active renderer with one plot for each layer; returns the charts."""
    pv = pyvista()
    charts = []
    for item, (x, y, width, height) in zip(items, cells(len(items)), strict=True):
        y, height = 0.93 * y, 0.93 * height  # room for the title of all
        chart = pv.Chart2D(size=(0.98 * width, 0.97 * height), loc=(x + 0.01 * width, y + 0.015 * height))
        line = micrometres(item.layer)
        ground = 0.15 * np.ptp(line[:, 0])
        x_values = np.concatenate([[line[0, 0] - ground], line[:, 0], [line[-1, 0] + ground]])
        z_values = np.concatenate([[0.0], line[:, 1], [0.0]])
        chart.background_color = (0, 0, 0, 0)
        chart.border_color = (0, 0, 0, 0)
        chart.line(x_values, z_values, color=item.color, width=2.5)
        depth = max(float(np.ptp(z_values)), 1e-9)
        chart.x_range = [float(x_values[0]), float(x_values[-1])]
        chart.y_range = [float(z_values.min()) - 0.15 * depth, float(z_values.max()) + 0.25 * depth]
        chart.title = item.title
        for axis, label in ((chart.x_axis, "um"), (chart.y_axis, "")):
            axis.label = label if item.layer.space == "surface" else ""
            axis.grid = False
            axis.tick_count = 3
            axis.label_size = axis.tick_label_size = 10
            for part in (axis.GetTitleProperties(), axis.GetLabelProperties(), chart.GetTitleProperties()):
                part.SetColor(*pv.Color(TEXT).float_rgb)
            axis.pen.color = TEXT
            axis.SetNotation(2)  # fixed point
            axis.SetPrecision(1)
        chart.GetTitleProperties().SetFontSize(12)
        plotter.add_chart(chart)
        charts.append(chart)
    return charts


def cells(count: int) -> list[tuple[float, float, float, float]]:
    """(x, y, width, height) in [0, 1] of ``count`` equal cells, first at the top left, as square as it goes."""
    columns = max(1, int(np.ceil(np.sqrt(count))))
    rows = max(1, int(np.ceil(count / columns)))
    return [((i % columns) / columns, 1 - (i // columns + 1) / rows, 1 / columns, 1 / rows) for i in range(count)]
