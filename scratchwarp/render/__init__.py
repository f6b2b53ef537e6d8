"""From a plan to a film: tiles, threads, progress, checkpoints.

Files:
    renderer    render(scene, plan) -> Film
    tiles       tiles over threads
    film        Film and its AOVs
    develop     sums -> AOVs and header
    checkpoint  finished tiles on disk
    progress    the progress bar

``scratchwarp.render`` is both this room and the function that renders, so the room can be called.
"""

import sys
import types
from typing import Any

from .film import AOVS, Film
from .progress import bar

__all__ = ["AOVS", "Film", "bar", "render"]


def render(scene: Any, plan: Any, **options: Any) -> Film:
    """Render a planned scene; see ``renderer.render`` for the options."""
    from .renderer import render as run

    return run(scene, plan, **options)


class _Room(types.ModuleType):
    """A module that renders when it is called."""

    def __call__(self, scene: Any, plan: Any, **options: Any) -> Film:
        return render(scene, plan, **options)


sys.modules[__name__].__class__ = _Room
