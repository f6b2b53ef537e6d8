"""Explicit scratches, as lines on the surfaces of the materials whose layers draw them."""

from typing import Any

import numpy as np

from scratchwarp.scene import Curves, Instance, Scene

from .colors import shown
from .display import pyvista
from .meshes import world_corners


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


def add(plotter: Any, scene: Scene) -> list[Any]:
    """Draw every explicit scratch in its layer's colour; returns the actors."""
    pv = pyvista()
    actors = []
    for item in shown(scene):
        for index in item.layer.curves:
            lines = [line for line in polylines(scene, scene.curves[index], item.material) if len(line) > 1]
            if not lines:
                continue
            starts = np.cumsum([0] + [len(line) for line in lines[:-1]])
            ranges = [start + np.arange(len(line)) for line, start in zip(lines, starts, strict=True)]
            cells = [np.concatenate([[len(points)], points]) for points in ranges]
            data = pv.PolyData(np.concatenate(lines), lines=np.concatenate(cells))
            actor = plotter.add_mesh(data, color=item.color, line_width=2.0, lighting=False)
            actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0, -4)
            actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
            actors.append(actor)
    return actors
