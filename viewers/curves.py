"""Explicit scratches, as lines on the surfaces of the materials whose layers draw them.

Those that diffract, many and fine, are coloured by their direction in space: x red, y green, z blue; some of them stand
for all. The others take the colour of their layer.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from scratchwarp.scene import Curves, Instance, Scene

from .colors import shown
from .display import pyvista
from .meshes import world_corners

MOST = 1500  # scratches that are drawn of a layer that diffracts: more would hide the surface and each other
STEP = 0.004  # of the uv square, between the points of scratches that diffract


def on_surface(scene: Scene, instance: Instance, curves: Curves) -> tuple[np.ndarray, np.ndarray]:
    """World positions [n, 3] of uv curves on an instance, and which of them lie on its uv set [n]."""
    pv = pyvista()
    mesh = scene.meshes[instance.mesh]
    uv = mesh.uvs["st"]
    if np.linalg.det(instance.transform[:3, :3]) < 0:
        uv = uv[:, ::-1]
    count = len(mesh.triangles)
    flat = np.concatenate([uv.reshape(-1, 2), np.zeros((3 * count, 1))], axis=1)
    chart = pv.PolyData(flat, np.column_stack([np.full(count, 3), np.arange(3 * count).reshape(-1, 3)]).ravel())
    chart.point_data["world"] = world_corners(mesh, instance).reshape(-1, 3)
    found = pv.PolyData(curves.points).sample(chart, tolerance=1e-9)
    return np.asarray(found.point_data["world"]), np.asarray(found.point_data["vtkValidPointMask"]) > 0


def polylines(scene: Scene, curves: Curves, material: int) -> list[np.ndarray]:
    """The scratches of one Curves record as world polylines [k, 3], cut where they leave the surface."""
    cuts = np.cumsum(curves.counts)[:-1]
    if curves.space == "object":
        return np.split(curves.points, cuts)
    lines = []
    for instance in scene.instances:
        if material in instance.materials and "st" in scene.meshes[instance.mesh].uvs:
            points, inside = on_surface(scene, instance, curves)
            for line, good in zip(np.split(points, cuts), np.split(inside, cuts), strict=True):
                ends = np.flatnonzero(np.diff(good.astype(int))) + 1
                pieces = zip(np.split(line, ends), np.split(good, ends), strict=True)
                lines += [piece for piece, there in pieces if there[0] and len(piece) > 1]
    return lines


def refined(curves: Curves, step: float = STEP) -> Curves:
    """uv curves with points between, at most ``step`` apart, so that they follow the surface; others as they are."""
    if curves.space != "uv" or not len(curves.points):
        return curves
    last = np.zeros(len(curves.points), bool)
    last[np.cumsum(curves.counts) - 1] = True
    ahead = np.roll(curves.points, -1, axis=0) - curves.points
    parts = np.where(last, 1, np.maximum(np.ceil(np.linalg.norm(ahead, axis=1) / step), 1)).astype(int)
    at = np.repeat(np.arange(len(parts)), parts)
    share = (np.arange(len(at)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[at]
    curve = np.repeat(np.arange(len(curves.counts)), curves.counts)
    return replace(
        curves,
        points=curves.points[at] + share[:, None] * np.where(last[at, None], 0.0, ahead[at]),
        counts=np.bincount(curve, parts, len(curves.counts)).astype(int),
        widths=curves.widths[at],
        depths=curves.depths[at],
    )


def direction_colors(lines: list[np.ndarray]) -> np.ndarray:
    """A colour [sum of points, 3] in [0, 1] for every point: the magnitudes of the direction's x, y and z."""
    ahead = [np.gradient(line, axis=0) for line in lines]
    size = [np.linalg.norm(d, axis=1, keepdims=True) for d in ahead]
    return np.concatenate([np.abs(d) / np.maximum(n, 1e-30) for d, n in zip(ahead, size, strict=True)])


def add(plotter: Any, scene: Scene) -> list[Any]:
    """Draw every explicit scratch in its layer's colour, or by its direction where it diffracts; returns the actors."""
    pv = pyvista()
    actors = []
    for item in shown(scene):
        diffracts = scene.materials[item.material].wave is not None
        for index in item.layer.curves:
            drawn = refined(scene.curves[index]) if diffracts else scene.curves[index]
            lines = [line for line in polylines(scene, drawn, item.material) if len(line) > 1]
            if not lines:
                continue
            if diffracts:
                lines = lines[:: len(lines) // MOST + 1]
            starts = np.cumsum([0] + [len(line) for line in lines[:-1]])
            ranges = [start + np.arange(len(line)) for line, start in zip(lines, starts, strict=True)]
            cells = [np.concatenate([[len(points)], points]) for points in ranges]
            data = pv.PolyData(np.concatenate(lines), lines=np.concatenate(cells))
            look: dict[str, Any] = {"color": item.color, "line_width": 2.0}
            if diffracts:
                data.point_data["direction"] = (255.0 * direction_colors(lines) + 0.5).astype(np.uint8)
                look = {"scalars": "direction", "rgb": True, "line_width": 1.0}
            actor = plotter.add_mesh(data, lighting=False, **look)
            actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0, -4)
            actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
            actors.append(actor)
    return actors
