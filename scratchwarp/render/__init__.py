"""From a plan to a film: tiles, threads, progress, checkpoints.

Files:
    renderer    render(scene, plan) -> Film
    tiles       tiles over threads
    film        Film and its AOVs
    develop     sums -> AOVs and header
    checkpoint  finished tiles on disk
    progress    the progress bar

``scratchwarp.render`` is the function; ``from scratchwarp.render import Film`` finds this room all the same.
"""

from .film import AOVS, Film
from .progress import bar
from .renderer import render

__all__ = ["AOVS", "Film", "bar", "render"]
