"""Masks and directions of layers that diffract -> the device."""

from collections.abc import Callable
from typing import Any

import numpy as np
import warp as wp

from ..plan import EffectPlan
from ..reflectance.pyramid import doubled
from ..scene import Layer, Scene
from ..scratches.expand import Sublayer
from ..scratches.locate_kernels import locate
from . import maps
from .maps_device import MapSet

Array = np.ndarray[Any, Any]


class GlintMaps:
    """Maps as they are asked for, numbered; ``packed`` puts all of them on the device."""

    def __init__(self, masks: bool, oriented: bool) -> None:
        self.masks, self.oriented = masks, oriented
        self._every: list[Sublayer] = []

    def number(self, layer: Layer, angle: float | None = None) -> int:
        """Of a layer's maps, -1 where it has none; ``angle``: of straight lines, which directions turn further."""
        masked = self.masks and (layer.mask_texture >= 0 or layer.mask_primvar)
        turned = self.oriented and angle is not None and (layer.orientation_texture >= 0 or layer.orientation_primvar)
        if not masked and not turned:
            return -1
        kind = "linear" if angle is not None else "curves"
        self._every.append(Sublayer(layer, kind, angle or 0.0, 0.0))
        return len(self._every) - 1

    def packed(self, scene: Scene, shape: Any, device: str) -> MapSet:
        """All of them."""
        return maps.pack_sublayers(scene, self._every, shape, self.masks, self.oriented, device)


def directions(scene: Scene, plan: EffectPlan, layer: Layer, shape: Any, own: Array) -> Callable[[Array], Array] | None:
    """Directions that a layer's map gives: uv ``[n, 2]`` -> unit vectors of twice the angle in the pattern plane,
    zeros where it gives none; None without a map. ``own``: the triangles of one instance that the layer lies on,
    bool."""
    if not plan.on("diffraction.orientation") or not (layer.orientation_primvar or layer.orientation_texture >= 0):
        return None
    du, dv = (x.numpy()[own].astype(np.float64) for x in (shape.dpdu, shape.dpdv))
    corners = shape.points.numpy().reshape(-1, 3, 3)[own].astype(np.float64)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    handed = -1.0 if (np.cross(du, dv) * normal).sum() < 0.0 else 1.0
    if layer.orientation_primvar:
        normal = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
        every = shape.dpdu.numpy().astype(np.float64), maps.normals_of(shape.points.numpy())
        row = maps.direction_row(scene, layer.orientation_primvar, *every).reshape(-1, 3, 2)[own]
        uvs = shape.uvs.numpy().reshape(-1, 3, 2)[own]

        located = locator(uvs)

        def by_primvar(uv: Array) -> Array:
            face, bary = located(uv)
            found = (bary[..., None] * row[np.maximum(face, 0)]).sum(1) * (face >= 0)[:, None]
            return found * (1.0, handed)

        return by_primvar
    image = doubled(scene.textures[layer.orientation_texture].pixels, layer.orientation_encoding)[..., :2]
    h, w = image.shape[:2]

    def by_texture(uv: Array) -> Array:
        x, y = uv[:, 0] * w - 0.5, (1.0 - uv[:, 1]) * h - 0.5
        i, j = np.floor(x).astype(int), np.floor(y).astype(int)
        s, t = (x - i)[:, None], (y - j)[:, None]

        def texel(a: Array, b: Array) -> Array:
            return image[b % h, a % w]

        low = (1.0 - s) * texel(i, j) + s * texel(i + 1, j)
        high = (1.0 - s) * texel(i, j + 1) + s * texel(i + 1, j + 1)
        return ((1.0 - t) * low + t * high) * (1.0, handed)

    return by_texture


def locator(uvs: Array) -> Callable[[Array], tuple[Array, Array]]:
    """Points in uv ``[n, 2]`` -> (triangle or -1 [n], barycentric coordinates [n, 3]) among triangles ``[m, 3, 2]``."""
    flat = np.concatenate([uvs, np.zeros((len(uvs), 3, 1), np.float32)], -1)
    boxes: list[Any] = [wp.array(x, dtype=wp.vec3, device="cpu") for x in (flat.min(1), flat.max(1))]
    over = wp.Bvh(boxes[0], boxes[1])
    corners: Any = wp.array(np.ascontiguousarray(uvs.reshape(-1, 2), np.float32), dtype=wp.vec2, device="cpu")

    def located(points: Array) -> tuple[Array, Array]:
        at: Any = wp.array(np.ascontiguousarray(points, np.float32), dtype=wp.vec2, device="cpu")
        face: Any = wp.empty(len(points), dtype=int, device="cpu")
        bary: Any = wp.empty(len(points), dtype=wp.vec3, device="cpu")
        wp.launch(locate, len(points), inputs=[over.id, corners, at], outputs=[face, bary], device="cpu")
        return face.numpy(), bary.numpy()

    return located
