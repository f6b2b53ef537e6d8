"""Lobes of reflectance in 3D: how bright the surface is from one side, as distance from the middle."""

from collections.abc import Callable
from typing import Any

import numpy as np

from .display import pyvista

_THETAS, _PHIS = 32, 73
_STEEPEST = 75.0  # degrees, where measurements end
_THETA, _PHI = np.meshgrid(np.linspace(0.0, np.radians(_STEEPEST), _THETAS), np.linspace(0.0, 2.0 * np.pi, _PHIS))
DIRECTIONS = np.stack([np.sin(_THETA) * np.cos(_PHI), np.sin(_THETA) * np.sin(_PHI), np.cos(_THETA)], axis=-1)


def lobe_points(evaluate: Callable[[np.ndarray, np.ndarray], np.ndarray], omega_i: np.ndarray) -> np.ndarray:
    """Points [n, 3] at the cube root of the luminance of f_r cos(theta_o) along every direction, light from
    ``omega_i``.

    The cube root keeps the dim parts of a lobe visible beside a bright ridge.
    """
    value = evaluate(np.broadcast_to(omega_i, DIRECTIONS.shape), DIRECTIONS).astype(float) @ (0.2126, 0.7152, 0.0722)
    return (np.cbrt(np.maximum(value * DIRECTIONS[..., 2], 0.0))[..., None] * DIRECTIONS).reshape(-1, 3)


class LobeSurface:
    """One lobe in the active renderer, changed in place."""

    def __init__(self, plotter: Any, color: str, **look: Any) -> None:
        grid = pyvista().StructuredGrid(*(DIRECTIONS[..., k] for k in range(3)))
        self.surface = grid
        # StructuredGrid wants its points in Fortran order of the arrays it was made of
        self._order = np.arange(DIRECTIONS[..., 0].size).reshape(DIRECTIONS.shape[:2]).ravel(order="F")
        self.actor = plotter.add_mesh(grid, color=color, reset_camera=False, **look)

    @property
    def points(self) -> np.ndarray:
        """Where it is, [n, 3]."""
        return np.array(self.surface.points)

    def draw(self, points: np.ndarray) -> None:
        """Show other ``lobe_points``."""
        self.surface.points = points[self._order]
