"""Instances: meshes in metres about the scene's origin, with their materials."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from pxr import Usd

from scratchwarp.scene import Instance, StageError

from .binding import bound_materials, lost_binding, slot_prims
from .geometry import Geometry
from .material import Materials
from .reading import Reading
from .traverse import Placed
from .vectors import lengths


def to_metres(reading: Reading, world: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """A matrix to world space in scene units, made one to metres relative to ``origin`` [m]; float64 [4, 4]."""
    metric = np.array(world, np.float64)
    metric[:3] *= reading.metres
    metric[:3, 3] -= origin
    return metric


def check_finite(reading: Reading, placed: Placed) -> None:
    """StageError unless the prim's transform is finite."""
    if not np.isfinite(placed.world).all():
        raise StageError(f"{reading.path}: {placed.path} has a transform that is not finite; repair its xformOps")


def place_instances(
    reading: Reading, geometry: Geometry, origin: np.ndarray, materials: Materials, purposes: Sequence[str]
) -> list[Instance]:
    """One Instance for each placement; StageError on a transform that is not finite."""
    for placed, _ in geometry.placements:
        check_finite(reading, placed)
    prims = {str(p.prim.GetPath()): p.prim for p, _ in geometry.placements}
    slots = {path: slot_prims(prim) for path, prim in prims.items()}
    every: list[Usd.Prim] = [prim for found in slots.values() for prim in found]
    materials_found = bound_materials(every, purposes)
    for prim, material in zip(every, materials_found, strict=True):
        lost = None if material else lost_binding(prim)
        if lost:
            reading.warn(prim.GetPath(), f"is bound to {lost}, which is no Material")
    bound = iter(materials_found)
    indices = {path: tuple(materials.index(next(bound)) for _ in found) for path, found in slots.items()}
    transforms = np.array([to_metres(reading, placed.world, origin) for placed, _ in geometry.placements])
    ranks = _ranks(transforms.reshape(-1, 4, 4)[:, :3, :3])
    instances = []
    for (placed, mesh), transform, rank in zip(geometry.placements, transforms, ranks, strict=True):
        if rank < 2:
            reading.warn(placed.path, "its transform has a scale of 0; it is left out")
            continue
        if rank == 2:
            transform, mesh = _baked(geometry, mesh, transform)
        instances.append(Instance(placed.path, mesh, transform, indices[str(placed.prim.GetPath())]))
    return instances


def _ranks(linear: np.ndarray) -> np.ndarray:
    """Dimension of what matrices [n, 3, 3] map space to."""
    ranks = np.full(len(linear), 3)
    doubtful = np.abs(np.linalg.det(linear)) <= 1e-9 * lengths(linear.transpose(0, 2, 1)).prod(1)
    scales = np.linalg.svd(linear[doubtful], compute_uv=False)
    ranks[doubtful] = (scales > 1e-9 * scales[:, :1]).sum(1)
    return ranks


def _baked(geometry: Geometry, index: int, transform: np.ndarray) -> tuple[np.ndarray, int]:
    """(translation, index of a mesh with the rest of the transform in its points), for a matrix without inverse."""
    mesh = geometry.meshes[index]
    geometry.meshes.append(replace(mesh, points=mesh.points @ transform[:3, :3].T, normals=None, tangents=None))
    translation = np.eye(4)
    translation[:3, 3] = transform[:3, 3]
    return translation, len(geometry.meshes) - 1
