"""Each layer's cross-section, to scale in micrometres."""

from typing import Any

import numpy as np

from scratchwarp.profiles import Profile, shape
from scratchwarp.scene import Layer

from .colors import TEXT, Shown
from .display import pyvista

# Parameter of the schema -> keyword of ``profiles.shape``, for the shapes that have it.
PARAMETERS = {
    "vGroove": {"apex": "apex"},
    "trapezoid": {"apex": "apex", "floorWidth": "floor"},
    "gaussian": {"sigma": "sigma"},
}


def outline(layer: Layer) -> Profile:
    """The profile of a layer with width 1 and the depth of the layer in widths.

    Raises:
        ValueError: the authored points cannot be a profile.
    """
    authored = layer.profile
    aspect = layer.depth / layer.width if layer.width > 0 else 0.0
    isolated = not authored.periodic
    if authored.points is not None and authored.shape == "points":
        return Profile(np.asarray(authored.points) * (1.0, aspect), isolated)
    names = PARAMETERS.get(authored.shape, {})
    known = {names[key]: value for key, value in authored.parameters if key in names}
    return shape(
        authored.shape, aspect, rim=authored.rim, rim_width=authored.rim_width, isolated=isolated, **known
    )


def micrometres(layer: Layer) -> np.ndarray:
    """The outline [n, 2] of a layer: x from the middle, z from the surface, both in micrometres (space uv: in uv)."""
    line = outline(layer).polyline()
    return (line - (0.5 * (line[0, 0] + line[-1, 0]), 0.0)) * layer.width


def add(plotter: Any, items: list[Shown]) -> list[Any]:
    """Fill the active renderer with one plot for each layer; returns the charts."""
    pv = pyvista()
    charts = []
    for item, (x, y, width, height) in zip(items, cells(len(items)), strict=True):
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
        chart.GetTitleProperties().SetFontSize(12)
        plotter.add_chart(chart)
        charts.append(chart)
    return charts


def cells(count: int) -> list[tuple[float, float, float, float]]:
    """(x, y, width, height) in [0, 1] of ``count`` equal cells, first at the top left, as square as it goes."""
    columns = max(1, int(np.ceil(np.sqrt(count))))
    rows = max(1, int(np.ceil(count / columns)))
    return [((i % columns) / columns, 1 - (i // columns + 1) / rows, 1 / columns, 1 / rows) for i in range(count)]
