"""Lines and words in a flat plot: each made once and changed in place."""

from typing import Any

import numpy as np

from .colors import TEXT
from .display import pyvista


class Line:
    """A line through points [n, 2] in the plane z = 0 of the active renderer."""

    def __init__(self, plotter: Any, color: str, width: float = 2.5) -> None:
        self.data = pyvista().PolyData(np.zeros((2, 3)), lines=[2, 0, 1])
        self.actor = plotter.add_mesh(self.data, color=color, line_width=width, lighting=False, reset_camera=False)

    @property
    def points(self) -> np.ndarray:
        """Where it runs, [n, 2]."""
        return np.array(self.data.points[:, :2])

    def draw(self, points: np.ndarray) -> None:
        """Let it run elsewhere."""
        raised = np.pad(points, ((0, 0), (0, 1)))
        if len(points) == self.data.n_points:
            self.data.points = raised
        else:
            self.data.copy_from(pyvista().PolyData(raised, lines=[len(points), *range(len(points))]))


def word(plotter: Any, text: str, x: float, y: float, size: int = 11) -> Any:
    """A text centred on (x, y, 0); its ``input`` can be changed."""
    made = pyvista().Text(text)
    made.prop.color, made.prop.font_size = TEXT, size
    made.prop.justification_horizontal = made.prop.justification_vertical = "center"
    made.GetPositionCoordinate().SetCoordinateSystemToWorld()
    made.GetPositionCoordinate().SetValue(x, y, 0.0)
    plotter.renderer.add_actor(made, reset_camera=False, pickable=False, render=False)
    return made


def look_at(plotter: Any, left: float, right: float, bottom: float, top: float) -> None:
    """Look straight down on this rectangle of the plane, as large as it fits."""
    plotter.enable_parallel_projection()
    plotter.view_xy()
    wide, high = plotter.renderer.GetSize()
    middle = 0.5 * (left + right), 0.5 * (bottom + top)
    plotter.camera.focal_point, plotter.camera.position = (*middle, 0.0), (*middle, 3.0)
    plotter.camera.parallel_scale = 0.5 * max(top - bottom, (right - left) * high / max(wide, 1))
    plotter.renderer.reset_camera_clipping_range()
