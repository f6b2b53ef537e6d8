"""Which way each layer's scratches run: short lines on the surfaces, along the layer's angle from dP/du."""

from typing import Any

import numpy as np

from scratchwarp.scene import Layer, Scene

from .colors import Shown, shown
from .display import pyvista
from .meshes import world_corners

STATISTICAL = ("worley", "random")


def tangents(corners: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit dP/du, the direction a quarter turn counter-clockwise of it, and the normal of each triangle, [m, 3] each.

    ``corners``: [m, 3, 3], ``uv``: [m, 3, 2]. Where uv give no direction, the first edge serves.
    """
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    a, b = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    along = (first * b[:, 1:] - second * a[:, 1:]) * np.sign(area)[:, None]
    along = np.where(np.linalg.norm(along, axis=1, keepdims=True) > 0, along, first)
    normal = np.cross(first, second)
    along, normal = _unit(along), _unit(normal)
    return along, np.cross(normal, along), normal


def angles(layer: Layer, uv: np.ndarray, scale: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Direction [n], radians from dP/du, of a scratch at each ``uv`` [n, 2]; ``scale`` [2]: metres for one u, one v."""
    turn = np.full(len(uv), layer.angle)
    if layer.distribution in ("concentric", "spiral"):
        away = (uv - np.asarray(layer.center)) * scale
        turn = np.arctan2(away[:, 1], away[:, 0]) + np.pi / 2
    elif layer.distribution == "crosshatch":
        turn = turn + layer.cross_angle * rng.integers(0, 2, len(uv))
    elif layer.distribution in STATISTICAL:
        turn = turn + layer.angle_spread * (rng.random(len(uv)) - 0.5)
    return turn


def segments(scene: Scene, item: Shown, count: int, seed: int = 0) -> np.ndarray:
    """Start and end of scratches of a layer, world metres, shape [n, 2, 3], spread evenly by area.

    There are ``count`` of them, or as many as the layer has on its surfaces where that is less. A line is as long as
    the layer's scratches, within 1 and 8 percent of the size of the surfaces it lies on; the lines of regular patterns
    are all 3 percent. Layers of distribution curves have none: their lines are explicit.
    """
    if item.layer.distribution == "curves":
        return np.zeros((0, 2, 3))
    rng = np.random.default_rng(seed)
    parts = []
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        corners, uv = world_corners(mesh, instance), mesh.uvs.get("st")
        mine = np.asarray(instance.materials)[mesh.slots] == item.material
        if uv is not None and mine.any():
            flipped = np.linalg.det(instance.transform[:3, :3]) < 0
            parts.append((corners[mine], (uv[:, ::-1] if flipped else uv)[mine]))
    if not parts:
        return np.zeros((0, 2, 3))
    corners, uv = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    if not area.sum() > 0:
        return np.zeros((0, 2, 3))
    count = min(count, number(item.layer, float(area.sum())))
    chosen = rng.choice(len(area), count, p=area / area.sum())
    weights = rng.dirichlet((1.0, 1.0, 1.0), count)[:, :, None]
    at, st = (corners[chosen] * weights).sum(1), (uv[chosen] * weights).sum(1)
    along, across, normal = tangents(corners[chosen], uv[chosen])
    turn = angles(item.layer, st, _scale(corners, uv, area), rng)[:, None]
    size = float(np.linalg.norm(np.ptp(corners.reshape(-1, 3), axis=0)))
    length = 0.03 * size
    if item.layer.distribution in STATISTICAL and item.layer.space == "surface":
        length = float(np.clip(item.layer.length * 1e-6, 0.01 * size, 0.08 * size))
    half = 0.5 * length * (np.cos(turn) * along + np.sin(turn) * across)
    lifted = at + 0.002 * size * normal
    return np.stack([lifted - half, lifted + half], axis=1)


def number(layer: Layer, area: float) -> int:
    """How many scratches a statistical layer has on ``area`` square metres; for others, more than can be drawn."""
    if layer.distribution not in STATISTICAL or layer.space != "surface":
        return 1 << 30
    density = layer.density * 1e6
    if density <= 0:
        each = max(layer.width * layer.length, 1e-3) * 1e-12
        density = -np.log1p(-min(layer.coverage, 0.999)) / each
    return int(min(np.ceil(density * area), 1 << 30))


def add(plotter: Any, scene: Scene, count: int = 1500) -> list[Any]:
    """Draw ``count`` lines for each layer in its colour; returns the actors."""
    pv = pyvista()
    actors = []
    for i, item in enumerate(shown(scene)):
        lines = segments(scene, item, count, seed=i)
        if len(lines):
            data = pv.line_segments_from_points(lines.reshape(-1, 3))
            actors.append(plotter.add_mesh(data, color=item.color, line_width=1.5, lighting=False))
    return actors


def _scale(corners: np.ndarray, uv: np.ndarray, area: np.ndarray) -> np.ndarray:
    """Root mean square of |dP/du| and |dP/dv| over the triangles, by area."""
    edges = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=1)
    steps = np.stack([uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]], axis=1)
    good = np.abs(np.linalg.det(steps)) > 1e-12
    if not good.any():
        return np.ones(2)
    slopes = np.linalg.solve(steps[good], edges[good])
    return np.sqrt(np.average((slopes**2).sum(-1), axis=0, weights=area[good]))


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)
