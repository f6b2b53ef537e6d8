"""What people look at while they work: pyvista, one file per thing looked at.

Files:
    meshes         the scene's meshes
    directions     which way each layer's scratches run on them, and how long they are
    curves         explicit scratches, as lines on the surfaces
    camera         the camera's frustum and the lights
    profiles       each layer's cross-section
    tables         each layer's simulated table
    image          the rendered image
    colors         one colour for each layer
    display        pyvista, and whether windows can be drawn here
    window         all of it together, and the keys of the window

``view`` opens the window; importing this package imports neither pyvista nor pxr nor Warp.
"""

from pathlib import Path
from typing import Any

__all__ = ["KEYS", "view"]

# key -> what it does in the window, as --help prints it.
KEYS = {
    "d": "scratch directions on or off",
    "c": "explicit scratches on or off",
    "l": "camera and lights on or off",
    "t": "triangle edges on or off",
    "n": "the next layers in the plots",
    "i": "render again, seen from where the window looks",
    "o": "look through the stage's camera again",
    "q": "close the window",
}


def view(stage_path: Path | str, screenshot: Path | str | None = None, **options: Any) -> None:
    """Show a stage: meshes with the directions of their scratches, each layer's profile and table, the image.

    Opens a window with the keys of ``KEYS``, or writes a picture to ``screenshot`` without a display. ``options`` are
    those of ``scratchwarp.viewers.window.view``: frame, camera, width, spp, size, page.

    Raises:
        ImportError: pyvista is missing.
        OSError: nothing can be drawn here (no display, no off-screen OpenGL), or the picture cannot be written.
        ValueError: the stage is at fault.
    """
    from .display import pyvista

    pyvista()  # says what to install when it is missing
    from .window import view as show

    show(stage_path, screenshot, **options)
