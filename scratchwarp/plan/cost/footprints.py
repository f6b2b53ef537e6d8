"""How wide a sample's footprint is on each material: the mean over what of its surfaces faces the camera."""

import math
from dataclasses import dataclass

import numpy as np

from ...scene import Scene, Settings
from ...scratches.knobs import FOOTPRINTS

MOST = 20_000
"""Triangles of an instance that are looked at; of more, every second, third and so on."""
LEVEL = 0.05
"""Least cosine of a view: footprints of flatter ones are not told apart."""


@dataclass(frozen=True)
class Print:
    """``edge``: of the square [um] that a sample stands for, seen head-on; ``stretch``: how much longer it is along the
    view; ``area``: of the material's surfaces [um^2]."""

    edge: float
    stretch: float
    area: float

    @property
    def across(self) -> float:
        """Mean width [um] over all directions of the ellipse of that area."""
        return 1.128 * self.edge * (1.0 + self.stretch) / 2.0


def parts_of_pixel(settings: Settings) -> float:
    """How many of what a sample stands for make a pixel: its samples, unless a coverage filter says otherwise."""
    edge = FOOTPRINTS.get(str(settings.knobs.get("scratches.coverageFilter")), 0.0)
    return 1.0 / edge**2 if edge > 0.0 else float(settings.spp or 1)


def footprints(scene: Scene, size: tuple[int, int], spp: float) -> list[Print]:
    """Of each material; ``size``: of the image in pixels. What hides what is not looked at."""
    camera = scene.camera
    left, right, bottom, top = camera.window(*size, scene.options.conform, scene.options.pixel_aspect)
    pixel = (right - left) / size[0] / math.sqrt(max(spp, 1))
    sums = np.zeros((max(len(scene.materials), 1), 4))  # weight, edge, stretch, area
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        if not len(mesh.triangles) or not instance.materials:
            continue
        step = max(1, len(mesh.triangles) // MOST)
        points = mesh.points @ instance.transform[:3, :3].T + instance.transform[:3, 3]
        corners = points[mesh.triangles[::step]]
        slots = mesh.slots[::step] if mesh.slots is not None else np.zeros(len(corners), int)
        owners = np.asarray(instance.materials)[slots]
        normal = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(normal, axis=1)
        middle = corners.mean(axis=1)
        if len(corners) < 200:  # the middle of a large triangle may lie far off the image
            middle = _seen_middle(scene, corners, middle, (left, right, bottom, top))
        to_eye = camera.transform[:3, 3] - middle
        away = np.linalg.norm(to_eye, axis=1)
        axis = camera.transform[:3, 2]
        if camera.projection == "orthographic":
            away, to_eye = np.ones_like(away), np.broadcast_to(axis, to_eye.shape)
        cosine = np.abs((normal * to_eye).sum(1)) / np.maximum(area * np.linalg.norm(to_eye, axis=1), 1e-300)
        local = (middle - camera.transform[:3, 3]) @ camera.transform[:3, :3]
        deep = np.maximum(-local[:, 2], 1e-12) if camera.projection == "perspective" else np.ones(len(local))
        at = local[:, :2] / deep[:, None]
        inside = (at[:, 0] > left) & (at[:, 0] < right) & (at[:, 1] > bottom) & (at[:, 1] < top) & (local[:, 2] < 0.0)
        weight = area * cosine / np.maximum(away, 1e-12) ** 2 * np.where(inside, 1.0, 1e-6)
        for column, value in enumerate((weight, weight * away, weight / np.maximum(cosine, LEVEL))):
            np.add.at(sums[:, column], owners, value)
        np.add.at(sums[:, 3], owners, step * area)
    made = []
    for weight, edge, stretch, area in sums:
        mean, long = (edge / weight, stretch / weight) if weight > 0.0 else (0.0, 1.0)
        made.append(Print(1e6 * pixel * mean, long, 1e12 * area))
    return made


def _seen_middle(
    scene: Scene, corners: np.ndarray, middle: np.ndarray, window: tuple[float, float, float, float]
) -> np.ndarray:
    """Of a grid of points over each triangle the mean of those on the image; its middle where none is."""
    camera, (left, right, bottom, top) = scene.camera, window
    steps = [(i, j) for i in range(13) for j in range(13 - i)]
    weights = np.array([(i / 12.0, j / 12.0, 1.0 - (i + j) / 12.0) for i, j in steps])
    points = np.einsum("kc,ncx->nkx", weights, corners)
    local = (points - camera.transform[:3, 3]) @ camera.transform[:3, :3]
    deep = np.where(local[..., 2] < 0.0, -local[..., 2], np.nan) if camera.projection == "perspective" else 1.0
    x, y = local[..., 0] / deep, local[..., 1] / deep
    on = (x > left) & (x < right) & (y > bottom) & (y < top)
    weight = np.where(on, 1.0 / np.where(on, np.abs(local[..., 2]), 1.0) ** 2, 0.0)
    total = weight.sum(axis=1)
    mean = (weight[..., None] * points).sum(axis=1) / np.maximum(total, 1e-300)[:, None]
    return np.where((total > 0.0)[:, None], mean, middle)
