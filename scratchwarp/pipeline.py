"""The way from a file to a Scene: the stage reader with the image room's decoder in its hands."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .scene import Scene

if TYPE_CHECKING:
    from .stage import LiveStage


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

    options = _bounded(max_memory) | options
    return stage.read(path, frame=frame, camera=camera, purposes=tuple(purposes), **options)


def read_live(path: str | Path, *, max_memory: float | None = None, **options: Any) -> "LiveStage":
    """Read a stage that is edited while it is looked at; arguments and errors as ``read`` has them."""
    from .stage import LiveStage

    return LiveStage(path, **(_bounded(max_memory) | options))


def _bounded(max_memory: float | None) -> dict[str, Any]:
    """Options of a reading that takes at most ``max_memory`` bytes."""
    from .image import read_texture
    from .scene import Budget

    budget = Budget(max_memory)

    def load_texture(file: str, space: str) -> Any:
        return read_texture(file, space, budget)

    return {"load_texture": load_texture, "budget": budget}
