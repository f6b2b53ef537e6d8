"""Mesh light: the triangles of an instance."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scratchwarp.lights import mesh_device as device
from scratchwarp.lights.model import LightModel, Packer, unit
from scratchwarp.scene.light import MeshLight


def world_triangles(light: MeshLight, packer: Packer) -> np.ndarray:
    """Corners of the instance's triangles [m], shape [m, 3, 3], counter-clockwise seen from outside."""
    if not 0 <= light.instance < len(packer.instances):
        raise ValueError(f"{light.path}: instance {light.instance} is not one of the {len(packer.instances)} instances")
    instance = packer.instances[light.instance]
    mesh = packer.meshes[instance.mesh]
    corners = mesh.points[mesh.triangles] @ instance.transform[:3, :3].T + instance.transform[:3, 3]
    if np.linalg.det(instance.transform[:3, :3]) < 0.0:
        corners = corners[:, ::-1]
    return corners


def _pack(light: MeshLight, packer: Packer) -> Mapping[str, Any]:
    corners = world_triangles(light, packer)
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=-1)
    total = float(areas.sum())
    if not total > 0.0:
        return {"size": 0.0}
    low, high = corners.min((0, 1)), corners.max((0, 1))
    center = (low + high) / 2.0
    axis = packer.instances[light.instance].transform[:3, :3] @ np.array([0.0, 0.0, -1.0])
    return {
        "first": packer.put_triangles(corners),
        "count": len(corners),
        "cdf": packer.put_cdf(np.concatenate([[0.0], np.cumsum(areas) / total])),
        "size": total,
        "center": center,
        # float32 corners may lie this much outside of the ball of the float64 ones
        "radius": np.linalg.norm(corners - center, axis=-1).max() * (1.0 + 1e-6) + 1e-7 * np.abs(corners).max(),
        "ez": unit(axis),
    }


MESH = LightModel("mesh", MeshLight, _pack, device.sample_mesh, device.hit_mesh, device.span_mesh, geometry=True)
