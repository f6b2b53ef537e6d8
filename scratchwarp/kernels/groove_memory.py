"""What laying grooves out takes, told without a kernel."""

from collections.abc import Mapping
from typing import Any

from ..plan import EffectPlan
from ..plan.knobs import value
from ..scene import Scene
from . import geometry, grooves
from .assemble import kernel_key


def taken(scene: Scene, plan: EffectPlan) -> dict[str, int]:
    """The numbers of ``grooves.PackedGrooves`` for a plan; empty where nothing is laid out."""
    if not plan.on("grooves"):
        return {}
    key = kernel_key(scene, plan)
    return grooves.pack(scene, plan, key, geometry.pack(scene, key.directed, key.display_colors, {})).numbers


def described(numbers: Mapping[str, int], plan: EffectPlan) -> str:
    """``taken`` in words."""
    kilo: dict[str, Any] = {n: numbers[f"groove_{n}bytes"] / 1024 for n in ("", "path_", "section_", "grid_")}
    rule = value(plan.settings.knobs, "grooves.cells")
    return (
        f"grooves: {numbers['groove_pieces']} pieces of {numbers['groove_paths']} paths, {numbers['groove_cells']} "
        f"cells ({rule}); {kilo['']:.1f} kB: paths {kilo['path_']:.1f}, cross-sections {kilo['section_']:.1f}, grid "
        f"{kilo['grid_']:.1f}"
    )
