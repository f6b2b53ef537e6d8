"""The rendered image, as the renderer itself makes it."""

from dataclasses import replace
from typing import Any

import numpy as np

from scratchwarp.scene import Camera, Scene, Settings

from .sheet import Sheet


def picture(scene: Scene, width: int = 320, spp: int = 4, camera: Camera | None = None) -> np.ndarray:
    """The stage rendered small, [h, w, 3] in [0, 1] through the sRGB view; ``camera``: instead of the stage's."""
    from scratchwarp.image import SRGB
    from scratchwarp.plan import make_plan
    from scratchwarp.render import render

    if camera is not None:
        scene = replace(scene, camera=camera)
    film = render(scene, make_plan(scene, Settings(width=width, spp=spp)))
    return np.clip(SRGB.apply(np.asarray(film["color"], np.float32)), 0.0, 1.0)


def add(plotter: Any, pixels: np.ndarray) -> None:
    """Fill the active renderer with the image."""
    Sheet(plotter, pixels, 0.0, 0.0, 1.0, name="rendered")
    plotter.enable_parallel_projection()
    plotter.view_xy()
    plotter.camera.tight(padding=0.02, adjust_render_window=False)
