"""The 3D preview without a window: meshes with the directions of their scratches, drawn in a thread of its own."""

import importlib.util
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from typing import Any

import numpy as np

from scratchwarp.scene import Scene
from scratchwarp.scene.digest import digest

from .colors import BACKGROUND
from .display import canvas
from .eye import look_through


def available() -> bool:
    """Whether pyvista is installed."""
    return importlib.util.find_spec("pyvista") is not None


class Preview:
    """Draws scenes by pyvista, all in one thread, for VTK wants its windows used where they were made."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="preview")
        self._open = ExitStack()
        self._plotter: Any = None
        self._shown: tuple[Any, ...] = ()
        self._lit = ""
        self._lights: list[Any] = []

    def picture(self, scene: Scene, size: tuple[int, int]) -> np.ndarray:
        """Meshes, scratches and lights from the scene's camera, uint8 [h, w, 3] of ``size`` (width, height).

        ImportError without pyvista, OSError where nothing can be drawn.
        """
        return self._thread.submit(self._draw, scene, size).result()

    def close(self) -> None:
        """Close what was opened."""
        self._thread.submit(self._open.close).result()
        self._thread.shutdown()

    def _draw(self, scene: Scene, size: tuple[int, int]) -> np.ndarray:
        if self._plotter is None:
            self._plotter = self._open.enter_context(canvas(True, size))
            self._plotter.set_background(BACKGROUND)
            self._plotter.disable_anti_aliasing()
        # records that were read again are others, though equal
        drawn = (scene.meshes, scene.curves, digest(scene.instances, scene.materials))
        if drawn != self._shown:
            self._fill(scene)
            self._shown, self._lit = drawn, ""
        if digest(scene.lights) != self._lit:
            self._light(scene)
            self._lit = digest(scene.lights)
        self._plotter.window_size = list(size)
        look_through(self._plotter, scene, size)
        self._plotter.render()  # a picture alone shows what was drawn last
        return np.array(self._plotter.screenshot(return_img=True))[..., :3]

    def _fill(self, scene: Scene) -> None:
        from . import curves, directions, meshes

        self._plotter.clear_actors()
        self._lights = []
        meshes.add(self._plotter, scene)
        directions.add(self._plotter, scene)
        curves.add(self._plotter, scene)

    def _light(self, scene: Scene) -> None:
        from . import camera

        for actor in self._lights:
            self._plotter.remove_actor(actor, render=False)
        self._lights = list(camera.lights(self._plotter, scene))
        for actor in self._lights:
            actor.prop.line_width = 1.0
