"""From a plan to a film: tiles, threads, progress, checkpoints.

Files:
    renderer    render(scene, plan) -> Film
    tiles       tiles over threads
    trace       jobs (samples of a tile), and the threads that do them; farm: workers of Dask that do; farm_worker,
                farm_data; beside: images that a farm renders at a time
    shoot       one job into sums of its own; launch: one kernel over tiles of one film
    tables      the plan's tables, simulated or found
    canvas      the image while it is rendered
    interrupt   signals: stops and snapshots
    session     Session: a scene that is changed while its image refines; steps are the ways it gets better
    inspect     what made a pixel
    film        Film and its AOVs
    develop     sums -> AOVs and header
    target      error estimated from samples, and passes until it is small enough
    checkpoint  finished tiles on disk; described: what decides an image, by name
    baked       tables simulated beforehand, beside the stage
    progress    the progress bar

The room can be called like its function: ``scratchwarp.render(scene, plan)``.
"""

import sys
import types
from typing import Any

from ..plan import EffectPlan
from ..scene import Scene
from .beside import side_by_side
from .farm import Farm
from .film import AOVS, Film
from .interrupt import Control, signals
from .progress import bar, bars
from .renderer import render
from .session import Redone, Session

__all__ = ["AOVS", "Control", "Farm", "Film", "Redone", "Session", "bar", "bars", "render", "side_by_side", "signals"]


class _Room(types.ModuleType):
    """A module that renders when it is called."""

    def __call__(self, scene: Scene, plan: EffectPlan, **options: Any) -> Film:
        return render(scene, plan, **options)


sys.modules[__name__].__class__ = _Room
