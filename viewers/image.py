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


def add(plotter: Any, pixels: np.ndarray) -> Sheet:
    """Fill the active renderer with the image, which can be repainted."""
    sheet = Sheet(plotter, pixels, 0.0, 0.0, 1.0, name="rendered")
    plotter.enable_parallel_projection()
    plotter.view_xy()
    plotter.camera.tight(padding=0.02, adjust_render_window=False)
    return sheet


def enlarged(pixels: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Pixels [h, w, 3] as a picture of ``size`` (width, height) by the nearest one."""
    rows = np.arange(size[1]) * pixels.shape[0] // size[1]
    columns = np.arange(size[0]) * pixels.shape[1] // size[0]
    return pixels[rows][:, columns]
