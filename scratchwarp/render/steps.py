"""The steps by which an image refines: smaller ones at once, then more and more samples of the whole one."""

from dataclasses import dataclass, replace

from ..plan import EffectPlan
from .tiles import Tile, tiles

# Images this many times smaller, one sample a pixel, come before the first sample of the whole one.
SMALLER = (4, 2)
# The smallest edge in pixels that a smaller image may have.
LEAST = 8
# Samples that one step of the whole image adds at most.
MOST = 32


@dataclass(frozen=True, eq=False)
class Step:
    """Samples ``first`` to ``first + count - 1`` of each pixel of a plan's window; ``whole``: of the image asked for,
    not of a smaller one."""

    plan: EffectPlan
    whole: bool
    first: int
    count: int

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the window in pixels."""
        x0, x1, y0, y1 = self.plan.window
        return x1 - x0, y1 - y0

    def tiles(self) -> list[Tile]:
        """The window's tiles."""
        return tiles(*self.size, self.plan.settings.tile)


def steps(plan: EffectPlan) -> list[Step]:
    """All steps to a plan's image, in order: its samples doubled by each, up to ``MOST`` more."""
    found = [Step(shrunk(plan, n), False, 0, 1) for n in SMALLER if min(plan.size) >= LEAST * n]
    first, spp = 0, plan.settings.spp or 1
    while first < spp:
        count = min(max(first, 1), MOST, spp - first)
        found.append(Step(plan, True, first, count))
        first += count
    return found


def shrunk(plan: EffectPlan, factor: int) -> EffectPlan:
    """The plan of the same image ``factor`` times smaller with one sample a pixel; everything simulated stays."""
    width, height = (-(-edge // factor) for edge in plan.size)
    x0, x1, y0, y1 = plan.window
    window = (x0 // factor, -(-x1 // factor), y0 // factor, -(-y1 // factor))
    return replace(
        plan, size=(width, height), window=window, settings=replace(plan.settings, width=width, height=height, spp=1)
    )
