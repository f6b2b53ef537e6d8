"""Pieces of scratches dealt into groups, so that a footprint over very many can look at some of them."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..plan import EffectPlan
from ..plan.crowds import crowded, crowds, groups, lit
from ..plan.wave_effects import footprint_and_triangle
from ..scene import Scene

Array = np.ndarray[Any, Any]


class Crowds:
    """The groups of each material. ``owners``: the material of each layer number."""

    def __init__(self, scene: Scene, plan: EffectPlan, owners: Sequence[int]) -> None:
        edges = footprint_and_triangle(scene, plan.settings, plan.waves)
        self.counts = crowds(scene, plan.waves, *edges)
        self.settings = plan.settings
        self.owners = np.asarray(owners, np.int64)
        self.made: dict[int, tuple[int, int]] = {}

    def deal(self, layers: Array) -> Array:
        """The group of each piece by the number of its layer; those of a material are as many in each, at random."""
        dealt = np.zeros(len(layers), np.int32)
        owner, first = self.owners[layers], 0
        rng = np.random.default_rng(0)
        for material in np.unique(owner).tolist():
            own = np.flatnonzero(owner == material)
            number = groups(self.counts[material], self.settings, len(own))
            dealt[own] = first + rng.permutation(len(own)).astype(np.int32) % number
            self.made[material] = first, number
            first += number
        return dealt

    def of(self, material: int) -> tuple[int, int, int]:
        """(first group, groups, strands that are lit at most: 0 for all) of a material; no groups where it has no
        piece."""
        first, number = self.made.get(material, (0, 0))
        most = lit(self.settings.knobs) if crowded(self.counts[material], self.settings) else 0
        return first, number, most
