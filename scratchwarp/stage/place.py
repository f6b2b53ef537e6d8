"""Instances: meshes in metres about the scene's origin, with their materials."""

from collections.abc import Sequence

import numpy as np
from pxr import Usd

from scratchwarp.scene import Instance, StageError

from .binding import bound_materials, slot_prims
from .geometry import Geometry
from .material import Materials
from .reading import Reading


def to_metres(reading: Reading, world: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """A matrix to world space in scene units, made one to metres relative to ``origin`` [m]; float64 [4, 4]."""
    metric = np.array(world, np.float64)
    metric[:3] *= reading.metres
    metric[:3, 3] -= origin
    return metric


def place_instances(
    reading: Reading, geometry: Geometry, origin: np.ndarray, materials: Materials, purposes: Sequence[str]
) -> list[Instance]:
    """One Instance for each placement; StageError on a transform that is not finite."""
    prims = {str(p.prim.GetPath()): p.prim for p, _ in geometry.placements}
    slots = {path: slot_prims(prim) for path, prim in prims.items()}
    every: list[Usd.Prim] = [prim for found in slots.values() for prim in found]
    bound = iter(bound_materials(every, purposes))
    indices = {path: tuple(materials.index(next(bound)) for _ in found) for path, found in slots.items()}
    instances = []
    for placed, mesh in geometry.placements:
        transform = to_metres(reading, placed.world, origin)
        if not np.isfinite(transform).all():
            raise StageError(f"{reading.path}: {placed.path} has a transform that is not finite; repair its xformOps")
        instances.append(Instance(placed.path, mesh, transform, indices[str(placed.prim.GetPath())]))
    return instances
