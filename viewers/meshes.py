"""The scene's meshes, in the metres of the scene."""

from typing import Any

import numpy as np

from scratchwarp.scene import Instance, Material, Mesh, Scene

from .colors import shown
from .display import pyvista


def world_corners(mesh: Mesh, instance: Instance) -> np.ndarray:
    """World positions of each triangle's corners [m, 3, 3], counter-clockwise seen from outside."""
    matrix = instance.transform
    corners = (mesh.points @ matrix[:3, :3].T + matrix[:3, 3])[mesh.triangles]
    return corners[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else corners


def base_color(material: Material) -> np.ndarray:
    """A colour [3] in [0, 1] to show the material by, before its scratches."""
    surface = material.surface
    color = getattr(surface, "diffuse_color", getattr(surface, "color", None))
    if not isinstance(color, tuple) or max(color) <= 0.0:
        color = (0.45, 0.45, 0.45)
    return np.clip(np.asarray(color), 0.0, 1.0) ** (1 / 2.2)


def add(plotter: Any, scene: Scene) -> list[Any]:
    """Draw every instance; returns the actors. Scratched materials are shown lighter, so that lines stand out."""
    pv = pyvista()
    scratched = {s.material for s in shown(scene)}
    actors = []
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        if not len(mesh.triangles):
            continue
        matrix = instance.transform
        points = mesh.points @ matrix[:3, :3].T + matrix[:3, 3]
        faces = np.column_stack([np.full(len(mesh.triangles), 3), mesh.triangles])
        colors = np.array([base_color(scene.materials[i]) for i in instance.materials])
        plain = np.array([i not in scratched for i in instance.materials])
        colors[plain] *= 0.6
        data = pv.PolyData(points, faces.ravel())
        data.cell_data["color"] = (255 * colors[mesh.slots]).astype(np.uint8)
        actors.append(plotter.add_mesh(data, scalars="color", rgb=True, ambient=0.25, show_edges=False))
    return actors
