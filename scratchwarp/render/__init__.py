"""From a plan to a film: tiles, threads, progress, checkpoints.

Files:
    renderer    render(scene, plan) -> Film
    tiles       tiles over threads
    launch      one kernel over tiles of one film
    session     Session: a scene that is changed while its image refines; steps are the ways it gets better
    inspect     what made a pixel
    film        Film and its AOVs
    develop     sums -> AOVs and header
    target      error estimated from samples, and passes until it is small enough
    checkpoint  finished tiles on disk
    baked       tables simulated beforehand, beside the stage
    progress    the progress bar

The room can be called like its function: ``scratchwarp.render(scene, plan)``.
"""

import sys
import types
from typing import Any

from ..plan import EffectPlan
from ..scene import Scene
from .film import AOVS, Film
from .progress import bar
from .renderer import render
from .session import Redone, Session

__all__ = ["AOVS", "Film", "Redone", "Session", "bar", "render"]


class _Room(types.ModuleType):
    """A module that renders when it is called."""

    def __call__(self, scene: Scene, plan: EffectPlan, **options: Any) -> Film:
        return render(scene, plan, **options)


sys.modules[__name__].__class__ = _Room
