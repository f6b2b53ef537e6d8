"""Masks and orientations of scratch layers -> the device: pyramids of textures, corner values of primvars."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from ..plan.choice import LayerPlan
from ..reflectance.pyramid import doubled, doubled_vectors, pack_pyramids
from ..scene import Layer, Mesh, Scene
from ..scratches import ORIENTED
from ..scratches.expand import Sublayer
from .maps_device import LayerMaps, MapSet

Array = np.ndarray[Any, Any]


def _corners(scene: Scene, name: str) -> list[tuple[Mesh, Array, Array | None]]:
    """(mesh, its instance's linear part, the primvar's corner values in the order of the device's triangles or None)
    of each instance with triangles."""
    found = []
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        if len(mesh.triangles):
            linear = instance.transform[:3, :3]
            values = mesh.primvars.get(name)
            if values is not None and np.linalg.det(linear) < 0:
                values = values[:, [0, 2, 1]]
            found.append((mesh, linear, values))
    return found


def mask_row(scene: Scene, name: str) -> Array:
    """A float primvar at all corners, float32 [3 m]; 1 on meshes without it."""
    parts = [
        np.ones(3 * len(mesh.triangles)) if values is None else np.asarray(values[..., 0], np.float64).ravel()
        for mesh, _, values in _corners(scene, name)
    ]
    return np.concatenate([*parts, np.zeros(0)]).astype(np.float32)


def direction_row(scene: Scene, name: str, dpdu: Array, normals: Array) -> Array:
    """A primvar of directions at all corners as double-angle vectors from dP/du, float32 [3 m, 2].

    Three components: a vector in object space, projected onto the triangle. Two: in the tangent frame. One: degrees.
    ``dpdu``, ``normals`` [m, 3]: of the world triangles. On meshes without the primvar scratches follow dP/du.
    """
    parts, first = [], 0
    for mesh, linear, values in _corners(scene, name):
        m = len(mesh.triangles)
        if values is None:
            two = np.tile([1.0, 0.0], (3 * m, 1))
        elif values.shape[-1] == 1:
            turn = 2.0 * np.radians(np.asarray(values, np.float64)[..., 0])
            two = np.stack([np.cos(turn), np.sin(turn)], -1)
        elif values.shape[-1] == 2:
            two = doubled_vectors(np.asarray(values, np.float64))
        else:
            world = np.asarray(values, np.float64) @ linear.T
            x = dpdu[first : first + m] / np.maximum(np.linalg.norm(dpdu[first : first + m], axis=1), 1e-30)[:, None]
            y = np.cross(normals[first : first + m], x)
            flat = np.stack([(world * x[:, None]).sum(-1), (world * y[:, None]).sum(-1)], -1)
            two = doubled_vectors(flat, 1e-30)
        parts.append(two.reshape(-1, 2))
        first += m
    return np.concatenate([*parts, np.zeros((0, 2))]).astype(np.float32)


def normals_of(points: Array) -> Array:
    """Unit normals [m, 3] of triangles given by their corners [3 m, 3]."""
    corners = points.reshape(-1, 3, 3).astype(np.float64)
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return cross / np.maximum(np.linalg.norm(cross, axis=1), 1e-30)[:, None]


def has_maps(layer: Layer) -> bool:
    """Whether a layer names any mask or orientation."""
    return max(layer.mask_texture, layer.orientation_texture) >= 0 or bool(
        layer.mask_primvar or layer.orientation_primvar
    )


def mapped(layers: Sequence[Sequence[LayerPlan]]) -> list[Sublayer]:
    """The sublayers with maps, in the order in which their records are packed."""
    return [p.sublayer for own in layers for p in own if has_maps(p.sublayer.layer)]


def sources(
    scene: Scene, layers: Sequence[Sequence[LayerPlan]], placed: Any, masks: bool, oriented: bool
) -> tuple[Any, ...]:
    """Everything that ``pack_maps`` looks at; ``placed`` stands for the instances."""
    own: list[Any] = []
    for sub in mapped(layers) if masks or oriented else []:
        x = sub.layer
        textures, names = (x.mask_texture, x.orientation_texture), (x.mask_primvar, x.orientation_primvar)
        own.append((textures, names, x.orientation_encoding, sub.distribution, sub.angle))
    return (tuple(own), scene.textures, scene.meshes, placed, masks, oriented) if own else ()


def pack_maps(
    scene: Scene, layers: Sequence[Sequence[LayerPlan]], shape: Any, masks: bool, oriented: bool, device: str = "cpu"
) -> MapSet:
    """Maps of ``mapped(layers)``. ``shape``: the scene's packed ``Geometry``; ``masks``,
    ``oriented``: which of the maps are on."""
    return pack_sublayers(scene, mapped(layers) if masks or oriented else [], shape, masks, oriented, device)


def pack_sublayers(
    scene: Scene, every: Sequence[Sublayer], shape: Any, masks: bool, oriented: bool, device: str = "cpu"
) -> MapSet:
    """The same of any sublayers, in their order."""
    images: dict[tuple[int, str], int] = {}
    rows: dict[str, list[str]] = {"mask": [], "orientation": []}

    def image(texture: int, kind: str) -> int:
        return images.setdefault((texture, kind), len(images)) if texture >= 0 else -1

    def row(kind: str, name: str) -> int:
        if name and name not in rows[kind]:
            rows[kind].append(name)
        return rows[kind].index(name) if name else -1

    records = []
    for sub in every:
        layer: Layer = sub.layer
        d: Any = LayerMaps()
        d.mask = d.mask_primvar = d.orientation = d.orientation_primvar = -1
        if masks:
            d.mask, d.mask_primvar = image(layer.mask_texture, ""), row("mask", layer.mask_primvar)
        if oriented and sub.distribution in ORIENTED:
            d.orientation_primvar = row("orientation", layer.orientation_primvar)
            if not layer.orientation_primvar:
                d.orientation = image(layer.orientation_texture, layer.orientation_encoding)
        d.cos_a, d.sin_a = math.cos(sub.angle), math.sin(sub.angle)
        records.append(d)
    pixels = []
    for texture, encoding in images:
        own = scene.textures[texture].pixels
        pixels.append(doubled(own, encoding) if encoding else own)
    packed = MapSet()
    layers_type: Any = LayerMaps
    packed.layers = wp.array(records or [LayerMaps()], dtype=layers_type, device=device)
    packed.pyramids = pack_pyramids(pixels, device)
    values = [mask_row(scene, name) for name in rows["mask"]] or [np.zeros(1, np.float32)]
    packed.masks = wp.array(np.stack(values), dtype=float, device=device)
    directions = [np.zeros((1, 2), np.float32)]
    if rows["orientation"]:
        dpdu, normals = shape.dpdu.numpy().astype(np.float64), normals_of(shape.points.numpy())
        directions = [direction_row(scene, name, dpdu, normals) for name in rows["orientation"]]
    packed.directions = wp.array(np.stack(directions), dtype=wp.vec2, device=device)
    return packed
