"""The camera's frustum and the lights, as far as they have a place."""

from typing import Any

import numpy as np

from scratchwarp.scene import (
    Camera,
    CylinderLight,
    DiskLight,
    DistantLight,
    Light,
    RectLight,
    Scene,
    SphereLight,
)

from .display import pyvista

COLOR = "#ffd75e"


def frustum(camera: Camera, aspect: float, reach: float) -> np.ndarray:
    """Line segments [8, 2, 3] of what the camera sees, ``reach`` metres deep; ``aspect``: width over height."""
    left, right, bottom, top = camera.window(1000, max(1, round(1000 / aspect)))
    window = np.array([[left, bottom, -1], [right, bottom, -1], [right, top, -1], [left, top, -1]], np.float64)
    near, far = np.zeros((4, 3)), window * (reach, reach, reach)
    if camera.projection == "orthographic":
        near, far = window * (1, 1, 0), window * (1, 1, reach)
    lines = np.concatenate([np.stack([near, far], axis=1), np.stack([far, np.roll(far, -1, axis=0)], axis=1)])
    return lines @ camera.transform[:3, :3].T + camera.transform[:3, 3]


def light_shape(light: Light, middle: np.ndarray, reach: float) -> Any:
    """A pyvista mesh for a light, None for one without a place (domes, meshes).

    ``middle`` [3] and ``reach``: the middle of the scene and the size to draw by [m]; a distant light is an arrow.
    """
    pv = pyvista()
    if isinstance(light, SphereLight):
        radius = max(light.radius, 0.004 * reach)
        return pv.Sphere(radius=radius, center=light.center, theta_resolution=16, phi_resolution=12)
    if isinstance(light, RectLight):
        corners = [light.center + i * light.ex + j * light.ey for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        return pv.PolyData(np.array(corners), [4, 0, 1, 2, 3])
    if isinstance(light, DiskLight):
        turn = np.linspace(0, 2 * np.pi, 32, endpoint=False)[:, None]
        return pv.PolyData(light.center + np.cos(turn) * light.ex + np.sin(turn) * light.ey, [32, *range(32)])
    if isinstance(light, CylinderLight):
        return pv.Tube(pointa=light.center - light.axis, pointb=light.center + light.axis, radius=light.radius)
    if isinstance(light, DistantLight):
        start = middle - reach * light.direction
        return pv.Arrow(start=start, direction=light.direction, scale=0.2 * reach, tip_radius=0.06, shaft_radius=0.02)
    return None


def add(plotter: Any, scene: Scene, aspect: float) -> list[Any]:
    """Draw the frustum and the lights; returns the actors."""
    pv = pyvista()
    segments = frustum(scene.camera, aspect, 0.35 * _reach(scene))
    lines = pv.line_segments_from_points(segments.reshape(-1, 3))
    return [plotter.add_mesh(lines, color=COLOR, line_width=1.5, lighting=False), *lights(plotter, scene)]


def lights(plotter: Any, scene: Scene) -> list[Any]:
    """Draw the lights that have a place; returns the actors."""
    middle = 0.5 * np.add(*scene.bounds())
    shapes = [light_shape(light, middle, _reach(scene)) for light in scene.lights]
    return [plotter.add_mesh(s, color=COLOR, style="wireframe", lighting=False) for s in shapes if s is not None]


def _reach(scene: Scene) -> float:
    """From the eye to the middle of the scene [m]."""
    return float(np.linalg.norm(0.5 * np.add(*scene.bounds()) - scene.camera.transform[:3, 3])) or 1.0
