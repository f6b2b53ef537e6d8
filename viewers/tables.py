"""Each layer's simulated table: rows phi_o, columns phi_i, brightness by the square root."""

from typing import Any

import numpy as np

from scratchwarp.plan.profiles import cross_section
from scratchwarp.profiles import simulate

from .colors import TEXT, Shown
from .display import pyvista


def picture(item: Shown, resolution: int = 64, rays: int = 256) -> np.ndarray:
    """The mirror table of a layer as an image [resolution, resolution, 3] in [0, 1], phi_o upwards, phi_i to the right.

    White is what the 99.5th percentile reaches.
    """
    pv = pyvista()
    table = simulate(cross_section(item.layer.profile, item.layer), resolution=resolution, rays=rays)
    density = np.sqrt(np.maximum(np.asarray(table.mirror, np.float64), 0.0))
    high = float(np.percentile(density, 99.5)) or 1.0
    shade = np.clip(density / high, 0.0, 1.0)[..., None]
    tint = np.array(pv.Color(item.color).float_rgb)
    shown = np.where(shade < 0.5, 2 * shade * tint, tint + (2 * shade - 1) * (1 - tint))
    return shown[::-1]


def add(plotter: Any, items: list[Shown]) -> None:
    """Fill the active renderer with one table for each layer, side by side."""
    columns = max(1, int(np.ceil(np.sqrt(len(items)))))
    titles, places = [], []
    for i, item in enumerate(items):
        x, y = 1.15 * (i % columns), -1.3 * (i // columns)
        plotter.add_mesh(plane(picture(item), x, y, 1.0), scalars="rgb", rgb=True, lighting=False)
        titles.append(item.title)
        places.append((x + 0.5, y + 1.1, 0.0))
    if titles:
        plotter.add_point_labels(
            np.array(places), titles, show_points=False, shape=None, font_size=10, text_color=TEXT,
            justification_horizontal="center", justification_vertical="center", always_visible=True,
        )  # fmt: skip
    plotter.enable_parallel_projection()
    plotter.view_xy()
    plotter.camera.tight(padding=0.04, adjust_render_window=False)
    plotter.camera.parallel_scale *= 1.15  # room for the titles
    plotter.camera.focal_point = np.add(plotter.camera.focal_point, (0.0, 0.12, 0.0))
    plotter.camera.position = np.add(plotter.camera.position, (0.0, 0.12, 0.0))


def plane(pixels: np.ndarray, x: float, y: float, width: float) -> Any:
    """A picture [h, w, 3] in [0, 1], row 0 at the top, as flat pyvista cells with its lower left corner at (x, y)."""
    pv = pyvista()
    rows, columns = pixels.shape[:2]
    step = width / columns
    data = pv.ImageData(dimensions=(columns + 1, rows + 1, 1), spacing=(step, step, 1.0), origin=(x, y, 0.0))
    data.cell_data["rgb"] = (255 * np.clip(pixels[::-1], 0, 1)).astype(np.uint8).reshape(-1, 3)
    return data
