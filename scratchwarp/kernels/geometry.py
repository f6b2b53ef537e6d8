"""Scene -> world triangles with a bounding volume hierarchy."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from ..scene import Instance, Material, Mesh, Scene, TextureInput
from .geometry_device import Geometry

Array = np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class PackedGeometry:
    """Device geometry and the Warp mesh that has to stay alive with it."""

    arrays: Geometry
    mesh: wp.Mesh | None
    triangles: int


def uv_set(material: Material) -> str:
    """The uv set that a material's textures read (its scratches follow it, too)."""
    for value in vars(material.surface).values():
        if isinstance(value, TextureInput):
            return value.uv_set
    return "st"


def _fallback_uv(points: Array, triangles: Array, scale: float) -> Array:
    """Box projection in object space, metres: u, v are the two axes that the facet's normal is least along."""
    corners = points[triangles]
    normal = np.abs(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    first = np.array([1, 2, 0])[normal.argmax(1)]
    rows = np.arange(len(triangles))[:, None]
    cols = np.arange(3)[None]
    second = (first + 1) % 3
    return scale * np.stack([corners[rows, cols, first[:, None]], corners[rows, cols, second[:, None]]], -1)


def _gradients(world: Array, uv: Array) -> tuple[Array, Array]:
    """dP/du and dP/dv of each triangle, shape [m, 3]; zeros where the mapping is degenerate."""
    e1, e2 = world[:, 1] - world[:, 0], world[:, 2] - world[:, 0]
    d1, d2 = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    det = d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]
    size = np.abs(d1).max(1) * np.abs(d2).max(1)
    good = np.abs(det) > 1e-12 * size
    inverse = np.where(good, 1.0 / np.where(good, det, 1.0), 0.0)[:, None]
    return (e1 * d2[:, 1:] - e2 * d1[:, 1:]) * inverse, (e2 * d1[:, :1] - e1 * d2[:, :1]) * inverse


def _smooth_tangents(triangles: Array, uv: Array, dpdu: Array, area: Array) -> Array:
    """Corner tangents: dP/du averaged over the triangles that share the corner's point and its uv, by area."""
    # one 64-bit mix of point and rounded uv a corner: sorting numbers is ten times faster than sorting rows
    u, v = np.clip((uv.reshape(-1, 2) * 1e7).round(), -9e18, 9e18).astype(np.int64).view(np.uint64).T
    keys = triangles.ravel().astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    keys = (keys ^ u * np.uint64(0xC2B2AE3D27D4EB4F)) + v * np.uint64(0x165667B19E3779F9)
    _, group = np.unique(keys, return_inverse=True)
    group = group.ravel()
    length = np.linalg.norm(dpdu, axis=1, keepdims=True)
    unit = np.divide(dpdu, length, out=np.zeros_like(dpdu), where=length > 0) * area[:, None]
    spread = np.repeat(unit, 3, axis=0)
    sums = np.stack([np.bincount(group, spread[:, k]) for k in range(3)], 1)
    return sums[group].reshape(-1, 3, 3)


def instance_arrays(
    mesh: Mesh, instance: Instance, materials: tuple[Material, ...], directed: bool
) -> dict[str, Array]:
    """World triangles of one instance: world, normals [m, 3, 3], uv [m, 3, 2], dpdu, dpdv [m, 3], material [m], scale
    [2] (micrometres a unit of u and of v), and tangents, where ``directed``, and colors, where the mesh has them."""
    matrix = instance.transform
    linear = matrix[:3, :3]
    points = mesh.points @ linear.T + matrix[:3, 3]
    flip = np.linalg.det(linear) < 0
    order = [0, 2, 1] if flip else [0, 1, 2]
    triangles = mesh.triangles[:, order]
    world = points[triangles]
    cross = np.cross(world[:, 1] - world[:, 0], world[:, 2] - world[:, 0])
    norm = np.linalg.norm(cross, axis=1)
    facet = np.divide(cross, norm[:, None], out=np.zeros_like(cross), where=norm[:, None] > 0)

    if mesh.normals is None:
        normals = np.repeat(facet[:, None], 3, axis=1)
    else:
        cofactor = np.cross(linear[[1, 2, 0]], linear[[2, 0, 1]]) * (-1 if flip else 1)
        normals = mesh.normals[:, order].astype(np.float64) @ cofactor.T
        length = np.linalg.norm(normals, axis=-1, keepdims=True)
        normals = np.where(length > 0, normals / np.where(length > 0, length, 1.0), facet[:, None])

    scale = abs(np.linalg.det(linear)) ** (1 / 3)
    chosen = [mesh.uvs.get(uv_set(materials[m]), mesh.uvs.get("st")) for m in instance.materials]
    first = chosen[0]
    if first is not None and all(c is first for c in chosen):
        uv = np.array(first[:, order])
    else:
        uv = _fallback_uv(mesh.points, mesh.triangles, scale)[:, order]
        for slot, coordinates in enumerate(chosen):
            if coordinates is not None:
                mask = mesh.slots == slot
                uv[mask] = coordinates[:, order][mask]
    dpdu, dpdv = _gradients(world, uv)
    bad = ~(np.abs(dpdu).max(1) > 0) | ~(np.abs(dpdv).max(1) > 0)
    if bad.any():  # a point or a line in uv: use the stable fallback there
        uv[bad] = _fallback_uv(mesh.points, mesh.triangles[bad], scale)[:, order]
        dpdu[bad], dpdv[bad] = _gradients(world[bad], uv[bad])

    assert mesh.slots is not None  # a Mesh fills them in
    area = 0.5 * norm
    total = max(float(area.sum()), 1e-300)
    mean = [1e6 * np.sqrt(float((area * (d * d).sum(1)).sum()) / total) for d in (dpdu, dpdv)]
    arrays = {
        "world": world,
        "normals": normals,
        "uv": uv,
        "dpdu": dpdu,
        "dpdv": dpdv,
        "material": np.array(instance.materials, np.int32)[mesh.slots],
        "scale": np.array(mean),
    }
    if directed:
        if mesh.tangents is not None:
            arrays["tangents"] = mesh.tangents[:, order].astype(np.float64) @ linear.T
        else:
            arrays["tangents"] = _smooth_tangents(triangles, uv, dpdu, area)
    if mesh.colors is not None:
        arrays["colors"] = mesh.colors[:, order]
    return arrays


def pack(
    scene: Scene, directed: bool, colored: bool, emitters: Mapping[int, int], device: str = "cpu"
) -> PackedGeometry:
    """Flatten every instance into world triangles.

    ``directed``: some material has a direction, so build tangents; ``colored``: some material shows display colours;
    ``emitters``: instance -> the mesh light that it is, as the kernel numbers lights.
    """
    parts: list[dict[str, Array]] = []
    for number, instance in enumerate(scene.instances):
        mesh = scene.meshes[instance.mesh]
        if len(mesh.triangles):
            part = instance_arrays(mesh, instance, scene.materials, directed)
            m = len(mesh.triangles)
            part["instance"] = np.full(m, number, np.int32)
            part["light"] = np.full(m, emitters.get(number, -1), np.int32)
            if colored and "colors" not in part:
                part["colors"] = np.full((m, 3, 3), 0.18, np.float32)
            parts.append(part)

    g = Geometry()
    count = sum(len(p["world"]) for p in parts)
    g.empty = 1 if count == 0 else 0

    def joined(name: str, shape: tuple[int, ...]) -> Array:
        return np.concatenate([p[name] for p in parts]) if parts else np.zeros((1, *shape))

    def floats(values: Array, width: int) -> Array:
        return np.ascontiguousarray(values.reshape(-1, width), dtype=np.float32)

    points = floats(joined("world", (3, 3)), 3)
    g.points = wp.array(points, dtype=wp.vec3, device=device)
    g.normals = wp.array(floats(joined("normals", (3, 3)), 3), dtype=wp.vec3, device=device)
    g.uvs = wp.array(floats(joined("uv", (3, 2)), 2), dtype=wp.vec2, device=device)
    g.dpdu = wp.array(floats(joined("dpdu", (3,)), 3), dtype=wp.vec3, device=device)
    g.dpdv = wp.array(floats(joined("dpdv", (3,)), 3), dtype=wp.vec3, device=device)
    g.tangents = wp.array(
        floats(joined("tangents", (3, 3)), 3) if directed else np.zeros((1, 3), np.float32),
        dtype=wp.vec3,
        device=device,
    )
    g.colors = wp.array(
        floats(joined("colors", (3, 3)), 3) if colored else np.zeros((1, 3), np.float32), dtype=wp.vec3, device=device
    )
    for name in ("material", "instance", "light"):
        setattr(g, name, wp.array(joined(name, ()).astype(np.int32), dtype=int, device=device))
    scales = np.ones((max(len(scene.instances), 1), 2))
    for p in parts:
        scales[p["instance"][0]] = p["scale"]
    g.pattern_scale = wp.array(scales, dtype=wp.vec2d, device=device)
    accelerated: wp.Mesh | None = None
    if count:
        indices: Any = wp.array(np.arange(3 * count, dtype=np.int32), dtype=int, device=device)
        accelerated = wp.Mesh(points=g.points, indices=indices, bvh_constructor="sah", bvh_leaf_size=2)
        g.mesh = accelerated.id
    return PackedGeometry(g, accelerated, count)
