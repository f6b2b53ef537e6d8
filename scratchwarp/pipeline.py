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
    max_memory: float | None = None,
    **options: Any,
) -> Scene:
    """Read a USD stage.

    Args:
        path: .usd, .usda, .usdc or .usdz file.
        frame: time code; None reads every attribute at its earliest sample, or its default where it has none.
        camera: prim path or name; None takes the render settings' camera, then the stage's.
        purposes: included purposes.
        max_memory: bytes that meshes, curves, instances and textures may take together; None: three quarters of this
            machine's. What would take more is an error before it is allocated.
        options: default_time, session_layer, mask, render_settings and warn of ``stage.read``.

    Raises StageError (a ValueError) or OSError naming the file, the prim and the value that is at fault.
    """
    from . import stage
    from .image import read_texture
    from .scene import Budget

    budget = Budget(max_memory)

    def load_texture(file: str, space: str) -> Any:
        return read_texture(file, space, budget)

    options = {"load_texture": load_texture, "budget": budget, **options}
    return stage.read(path, frame=frame, camera=camera, purposes=tuple(purposes), **options)
