"""A picture over a view, as high as it and in its middle."""

from typing import Any

import numpy as np

from .display import pyvista


class Overlay:
    """Pixels laid over the active renderer; hidden until ``show``."""

    def __init__(self, plotter: Any) -> None:
        from vtkmodules.vtkRenderingCore import vtkPolyDataMapper2D, vtkTexture, vtkTexturedActor2D

        pv = pyvista()
        self._renderer = plotter.renderer
        self._quad = pv.PolyData(np.zeros((4, 3)), [4, 0, 1, 2, 3])
        self._quad.active_texture_coordinates = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
        self._texture = vtkTexture()
        mapper = vtkPolyDataMapper2D()
        mapper.SetInputData(self._quad)
        self.actor = vtkTexturedActor2D()
        self.actor.SetMapper(mapper)
        self.actor.SetTexture(self._texture)
        self.actor.SetVisibility(False)
        self._renderer.add_actor(self.actor, reset_camera=False, pickable=False, render=False)

    @property
    def visible(self) -> bool:
        """Whether it is seen."""
        return bool(self.actor.GetVisibility())

    def show(self, visible: bool) -> None:
        """Show or hide it."""
        self.actor.SetVisibility(visible)

    def paint(self, pixels: np.ndarray) -> None:
        """Show other pixels, uint8 [h, w, 3], row 0 at the top; nothing is drawn yet."""
        rows, columns = pixels.shape[:2]
        made = pyvista().ImageData(dimensions=(columns, rows, 1))
        made.point_data["rgb"] = np.ascontiguousarray(pixels[::-1]).reshape(-1, 3)
        made.set_active_scalars("rgb")
        self._texture.SetInputData(made)
        wide, high = self._renderer.GetSize()
        across = high * columns / rows
        left = 0.5 * (wide - across)
        self._quad.points = np.array(
            [[left, 0, 0], [left + across, 0, 0], [left + across, high, 0], [left, high, 0]], float
        )
