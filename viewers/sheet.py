"""A picture lying in the window that is repainted in place: one rectangle with a texture."""

from typing import Any

import numpy as np

from .display import pyvista


class Sheet:
    """Pixels [h, w, 3] in [0, 1], row 0 at the top, with the lower left corner at (x, y) and square pixels."""

    def __init__(self, plotter: Any, pixels: np.ndarray, x: float, y: float, width: float, name: str = "") -> None:
        pv = pyvista()
        rows, columns = pixels.shape[:2]
        height = width * rows / columns
        self.image = pv.ImageData(dimensions=(columns, rows, 1))
        self.image.point_data["rgb"] = np.zeros((rows * columns, 3), np.uint8)
        self.image.set_active_scalars("rgb")
        texture = pv.Texture(self.image)
        texture.interpolate = False
        quad = pv.Plane(
            center=(x + 0.5 * width, y + 0.5 * height, 0.0), i_size=width, j_size=height, i_resolution=1, j_resolution=1
        )
        self.actor = plotter.add_mesh(quad, texture=texture, lighting=False, name=name or None)
        self.paint(pixels)

    @property
    def pixels(self) -> np.ndarray:
        """What is painted, uint8 [h, w, 3], row 0 at the top."""
        columns, rows = self.image.dimensions[:2]
        return np.array(self.image.point_data["rgb"]).reshape(rows, columns, 3)[::-1]

    def paint(self, pixels: np.ndarray) -> None:
        """Show other pixels of the same shape in [0, 1]; no actor is made, nothing is drawn yet."""
        scalars = self.image.point_data["rgb"]
        scalars[...] = (255.0 * np.clip(pixels[::-1], 0.0, 1.0) + 0.5).astype(np.uint8).reshape(-1, 3)
        self.image.GetPointData().GetScalars().Modified()
        self.image.Modified()
