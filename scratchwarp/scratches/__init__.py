"""Where scratches lie: how much of a footprint they cover, and which way they run.

Files (device):
    layer_device       LayerData and LayerHit, what every distribution takes and returns
    worley_device      stretched cellular noise, Raymond 2016 Eq. 7
    lines_device       linear, concentric and spiral patterns of regular pitch
    curves_device      explicit curves found in a bounding volume hierarchy
    grid_device        a uniform grid over strips in the plane, for footprint lookups
    variation_device   how wide and deep one scratch is, and its table
Files (host):
    worley             threshold for a coverage, mean coverage for a threshold
    expand             a Layer as the author wrote it -> the sublayers that the kernel runs through
    curves             polylines -> segments and their hierarchy
    grid               strips -> the grid that holds them, its cell size and memory
    variation          how the scratches of a layer differ, and the tables that stand for them

A distribution is one device function with the signature of ``worley_device.worley`` and one line in ``KINDS``; explicit
curves alone look at the surface itself instead of the pattern plane.
"""

import importlib

# distribution -> (module, device function); the position is the number that LayerData.kind holds.
KINDS = {
    "worley": ("scratchwarp.scratches.worley_device", "worley"),
    "linear": ("scratchwarp.scratches.lines_device", "linear"),
    "concentric": ("scratchwarp.scratches.lines_device", "concentric"),
    "spiral": ("scratchwarp.scratches.lines_device", "spiral"),
    "full": ("scratchwarp.scratches.lines_device", "full"),
    "curves": ("scratchwarp.scratches.curves_device", "curves"),
}

# Patterns that can be laid along a map of directions; circles, spirals and curves go their own way.
ORIENTED = ("worley", "linear", "full")


def kind_number(distribution: str) -> int:
    """The number that ``LayerData.kind`` holds for a distribution of ``KINDS``."""
    return list(KINDS).index(distribution)


def device_function(distribution: str, varied: bool = False):
    """The Warp function that finds the coverage of a distribution of ``KINDS`` (imports Warp); ``varied``: the one that
    also says which scratch is there."""
    module, name = KINDS[distribution]
    return getattr(importlib.import_module(module), f"{name}_varied" if varied else name)
