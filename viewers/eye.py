"""Where a window's eye is: at a camera of the scene."""

from typing import Any

import numpy as np

from scratchwarp.scene import Scene


def look_through(plotter: Any, scene: Scene, size: tuple[int, int]) -> None:
    """Put the eye of the active renderer where the scene's camera is; ``size``: of its image in pixels."""
    seen, matrix = plotter.camera, scene.camera.transform
    low, high = scene.bounds()
    eye = matrix[:3, 3]
    reach = float(np.dot(0.5 * (low + high) - eye, -matrix[:3, 2])) or 1.0
    seen.position = eye
    seen.focal_point = eye - matrix[:3, 2] * abs(reach)
    seen.up = matrix[:3, 1]
    left, right, bottom, top = scene.camera.window(*size)
    seen.parallel_projection = scene.camera.projection == "orthographic"
    if seen.parallel_projection:
        seen.parallel_scale = 0.5 * (top - bottom)
    else:
        seen.view_angle = float(np.degrees(np.arctan(top) - np.arctan(bottom)))
    plotter.renderer.reset_camera_clipping_range()
