"""Our lights in Mitsuba's words."""

from pathlib import Path
from typing import Any

import numpy as np

from scratchwarp.scene import (
    CylinderLight,
    DiskLight,
    DistantLight,
    DomeLight,
    Light,
    MeshLight,
    RectLight,
    Scene,
    SphereLight,
)

Array = np.ndarray
Node = tuple[str, dict[str, Any]]  # tag and plugin, and what is in it


def emitters(scene: Scene, folder: Path, notes: list[str]) -> list[Node]:
    """Every light of a scene but those that are meshes; ``notes``: what of them is lost."""
    made = []
    for number, light in enumerate(scene.lights):
        if isinstance(light, MeshLight):
            continue
        made.append(_emitter(scene, light, number, folder, notes))
        lost = {
            "shaping": light.shaping is not None,
            "diffuse and specular multipliers": (light.diffuse, light.specular) != (1.0, 1.0),
            "switched-off shadows": not light.shadow,
            "light links": light.linked is not None or light.shadow_linked is not None,
            "shadow colour and distance": max(light.shadow_color) > 0.0 or np.isfinite(light.shadow_distance),
        }
        notes += [
            f"{light.path}: {name} cannot be said in a Mitsuba scene and is left out" for name in lost if lost[name]
        ]
    return made


def _emitter(scene: Scene, light: Light, number: int, folder: Path, notes: list[str]) -> Node:
    exposure = scene.camera.exposure
    radiance = light.radiance * exposure
    if isinstance(light, DomeLight):
        place = np.eye(4)
        place[:3, :3] = light.rotation
        pixels = np.ones((2, 4, 3)) if light.texture < 0 else scene.textures[light.texture].pixels[..., :3]
        if light.texture < 0:
            return "emitter constant", {"radiance": radiance}
        name = _write(folder, f"light{number}", on_poles(pixels) * radiance)
        return "emitter envmap", {"filename": name, "to_world": place}
    if isinstance(light, DistantLight):
        if light.angle <= 0.0:
            return "emitter directional", {"direction": Vector(light.direction), "irradiance": radiance}
        low, high = scene.bounds()
        far = 1e3 * max(float(np.linalg.norm(high - low)), 1e-3)
        return _area("disk", _placed(
            0.5 * (low + high) - far * light.direction, far * np.tan(0.5 * light.angle), light.direction
        ), radiance)  # fmt: skip
    if isinstance(light, SphereLight):
        if light.point or light.radius <= 0.0:
            return "emitter point", {"position": Vector(light.center), "intensity": radiance}
        node, inside = _area("sphere", None, radiance)
        return node, {"center": Vector(light.center), "radius": light.radius, **inside}
    if isinstance(light, CylinderLight):
        ends = {"p0": Vector(light.center - light.axis), "p1": Vector(light.center + light.axis)}
        node, inside = _area("cylinder", None, radiance)
        return node, {**ends, "radius": light.radius, **inside}
    assert isinstance(light, RectLight | DiskLight)
    place = np.eye(4)
    # seen along the normal: x runs to the left, so that the frame is right-handed
    place[:3] = np.stack([-light.ex, light.ey, light.normal, light.center], 1)
    if np.linalg.det(place[:3, :3]) < 0.0:
        place[:3, 0] *= -1.0
    if isinstance(light, RectLight) and light.texture >= 0:
        pixels = scene.textures[light.texture].pixels[..., :3] * radiance
        file = ("texture bitmap", {"filename": _write(folder, f"light{number}", pixels), "raw": True})
        return "shape rectangle", {"to_world": place, "emitter": ("emitter area", {"radiance": file})}
    return _area("disk" if isinstance(light, DiskLight) else "rectangle", place, radiance)


def _area(shape: str, place: Array | None, radiance: Any) -> Node:
    own = {} if place is None else {"to_world": place}
    return f"shape {shape}", {**own, "emitter": ("emitter area", {"radiance": radiance})}


def _placed(center: Array, radius: float, normal: Array) -> Array:
    n = normal / np.linalg.norm(normal)
    x = np.cross(n, np.eye(3)[int(np.argmin(np.abs(n)))])
    x /= np.linalg.norm(x)
    place = np.eye(4)
    place[:3] = np.stack([radius * x, radius * np.cross(n, x), n, center], 1)
    return place


class Vector(str):
    """Three numbers as Mitsuba's scene files write points and vectors."""

    def __new__(cls, values: Any) -> "Vector":
        """From a sequence of numbers."""
        return super().__new__(cls, ", ".join(repr(float(x)) for x in values))


def on_poles(pixels: Array) -> Array:
    """An image all around, whose rows lie half a row from the poles, with rows on the poles, as Mitsuba wants them."""
    high = len(pixels)
    at = np.arange(high) / max(high - 1, 1) * high - 0.5
    low = np.clip(np.floor(at).astype(int), 0, high - 1)
    part = np.clip(at - low, 0.0, 1.0)[:, None, None]
    up = np.clip(low + 1, 0, high - 1)
    return (1 - part) * pixels[low] + part * pixels[up]


def _write(folder: Path, name: str, pixels: Array) -> str:
    from scratchwarp import image

    file = f"textures/{name}.exr"
    image.write_layers({"color": np.asarray(pixels, np.float32)}, folder / file)
    return file
