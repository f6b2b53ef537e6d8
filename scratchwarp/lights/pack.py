"""Light records to device arrays."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from scratchwarp.lights.light_device import Light, LightArrays
from scratchwarp.lights.model import LightModel, Packer
from scratchwarp.lights.registry import MODELS
from scratchwarp.reflectance.texture import pack_textures
from scratchwarp.scene.geometry import Instance, Mesh
from scratchwarp.scene.light import Light as LightRecord
from scratchwarp.scene.light import Shaping
from scratchwarp.scene.texture import Texture
from scratchwarp.scene.world import Scene

_FAR = 1.0e10


@dataclass(frozen=True, eq=False)
class PackedLights:
    """Lights on the device.

    Attributes:
        kinds: names of the kinds that occur, in order of first occurrence.
        models: the kinds themselves, in the same order.
        lights: kind name -> ``wp.array(dtype=Light)``, in scene order.
        slots: for each light of the scene its index within its kind's array, shape [n], int32.
        arrays: what they share.
        warnings: what cannot be honoured, one sentence each, naming the prim.
    """

    kinds: tuple[str, ...]
    models: tuple[LightModel, ...]
    lights: Mapping[str, wp.array]
    slots: np.ndarray
    arrays: LightArrays
    warnings: tuple[str, ...] = ()


def _shaping(shaping: Shaping | None) -> dict[str, Any]:
    if shaping is None:
        return {}
    softness = min(max(shaping.cone_softness, 0.0), 1.0)
    return {
        "shaped": 1,
        "focus": max(shaping.focus, 0.0),
        "focus_tint": shaping.focus_tint,
        "cone_angle": shaping.cone_angle,
        "cone_start": shaping.cone_angle * (1.0 - softness),
    }


def _common(light: LightRecord, index: int) -> dict[str, Any]:
    return {
        "radiance": light.radiance,
        "texture": -1,
        "diffuse": light.diffuse,
        "specular": light.specular,
        "shadow": int(light.shadow),
        "shadow_color": light.shadow_color,
        "shadow_distance": min(light.shadow_distance, _FAR),
        "link": -1 if light.linked is None else index,
        "shadow_link": -1 if light.shadow_linked is None else index,
        "index": index,
        "camera_visible": 1,
        **_shaping(light.shaping),
    }


def _struct(fields: Mapping[str, Any]) -> Any:
    struct = Light()
    for name, value in fields.items():
        setattr(struct, name, value)
    return struct


def pack_lights(
    lights: Sequence[LightRecord],
    textures: Sequence[Texture] = (),
    instances: Sequence[Instance] = (),
    meshes: Sequence[Mesh] = (),
    device: str = "cpu",
    filtered: bool = False,
) -> PackedLights:
    """Put light records on ``device``; ``filtered``: images of domes with smaller copies, for ``lit_device``.

    ``textures``, ``instances``, ``meshes``: what the records' indices refer to. Raises ValueError on a record of an
    unknown class or an index that refers to nothing.
    """
    packer = Packer(textures, instances, meshes, filtered=filtered)
    models: dict[str, LightModel] = {}
    rows: dict[str, list[dict[str, Any]]] = {}
    slots = np.zeros(len(lights), np.int32)
    warnings = []
    for index, record in enumerate(lights):
        model = MODELS.get(type(record))
        if model is None:
            known = ", ".join(m.__name__ for m in MODELS)
            raise ValueError(f"{record.path}: no light model for {type(record).__name__}; known are {known}")
        texture = getattr(record, "texture", -1)
        if texture >= len(textures):
            raise ValueError(f"{record.path}: texture {texture} is not one of the {len(textures)} textures")
        models[model.name] = model
        packed = rows.setdefault(model.name, [])
        slots[index] = len(packed)
        packed.append({**_common(record, index), **model.pack(record, packer)})
        if packed[-1].get("size", 1.0) == 0.0 and not packed[-1].get("delta", 0):
            warnings.append(f"{record.path}: the light has no area and sheds no light")
    arrays = LightArrays()
    arrays.atlas = pack_textures(packer.images, device)
    arrays.cdf = wp.array(np.concatenate(packer.cdf or [np.zeros(1, np.float32)]), dtype=float, device=device)
    corners = np.concatenate(packer.triangles or [np.zeros((1, 3, 3), np.float32)]).reshape(-1, 3)
    arrays.triangles = wp.array(corners, dtype=wp.vec3, device=device)
    on_device: dict[str, Any] = {
        name: wp.array([_struct(f) for f in fields], dtype=Light, device=device) for name, fields in rows.items()
    }
    return PackedLights(tuple(models), tuple(models.values()), on_device, slots, arrays, tuple(warnings))


def pack(scene: Scene, device: str = "cpu", filtered: bool = False) -> PackedLights:
    """Put all lights of a scene on ``device``; see ``pack_lights``."""
    return pack_lights(scene.lights, scene.textures, scene.instances, scene.meshes, device, filtered)
