"""The way from a file to a Scene: the stage reader with the image room's decoder in its hands."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from .scene import Scene


def read(
    path: str | Path,
    frame: float | None = None,
    camera: str | None = None,
    purposes: Iterable[str] = ("default", "render"),
    **options: Any,
) -> Scene:
    """Read a USD stage.

    Args:
        path: .usd, .usda, .usdc or .usdz file.
        frame: time code; None reads every attribute at its earliest sample, or its default where it has none.
        camera: prim path or name; None takes the render settings' camera, then the stage's.
        purposes: included purposes.
        options: default_time, session_layer, mask, render_settings and warn of ``stage.read``.

    Raises StageError (a ValueError) or OSError naming the file, the prim and the value that is at fault.
    """
    from . import stage
    from .image import read_texture

    return stage.read(path, frame=frame, camera=camera, purposes=tuple(purposes), load_texture=read_texture, **options)
