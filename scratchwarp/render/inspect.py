"""What made a pixel: the layers and effects behind it, the footprint, and each layer's lobe there."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..kernels import Assembled, Parts, assemble, camera_data
from ..plan import EffectPlan
from ..scene import Scene
from . import develop
from .launch import SAMPLES_A_LAUNCH, SUMS, film_arrays, launcher
from .tiles import Tile

# Samples by which the shares of layers are estimated.
SAMPLES = 256

Color = tuple[float, float, float]


@dataclass(frozen=True)
class LayerShare:
    """A layer at a pixel.

    Attributes:
        name: of the layer. radiance: what the pixel has more with it than without it.
        theta, phi: the viewer in the frame of its mean direction [rad]; its mirror cone is theta_i = -theta.
        angles: phi_i [rad], and lobe: rho [1/rad] there, the mean of the channels, of light on that cone; empty for a
            Lambert scratch.
    """

    name: str
    radiance: Color
    theta: float
    phi: float
    angles: tuple[float, ...] = ()
    lobe: tuple[float, ...] = ()


@dataclass(frozen=True)
class PixelReport:
    """What made a pixel.

    Attributes:
        pixel: column and row. prim, material: paths, "" where nothing was met. position: world [m]; normal: world.
        distance: from the eye [m]. footprint: full axes of the pixel's footprint on the surface [um].
        radiance, base, scratches, emission: of the pixel, and its parts. noise: standard error of its luminance.
        layers: each layer of the material, in cutting order. effects: (name, why) of those that are on and concern it.
    """

    pixel: tuple[int, int]
    prim: str
    material: str
    position: Color
    normal: Color
    distance: float
    footprint: tuple[float, float]
    radiance: Color
    base: Color
    scratches: Color
    emission: Color
    noise: float
    layers: tuple[LayerShare, ...]
    effects: tuple[tuple[str, str], ...]


def inspect(
    scene: Scene, plan: EffectPlan, built: Assembled, kernel: Any, tables: list[Any], parts: Parts, device: str,
    pixel: tuple[int, int],
) -> PixelReport:  # fmt: skip
    """What made ``pixel`` (column, row) of a planned and assembled scene; ``Session.inspect`` calls this.

    ValueError for a pixel outside the image.
    """
    x, y = pixel
    if not (0 <= x < plan.size[0] and 0 <= y < plan.size[1]):
        raise ValueError(f"pixel {pixel} lies outside the image of {plan.size[0]} x {plan.size[1]}")
    alone = replace(plan, window=(x, x + 1, y, y + 1))

    def shot(layers: tuple[Any, ...]) -> dict[str, np.ndarray]:
        changed = built
        if layers != plan.layers:
            changed = assemble(scene, replace(alone, layers=layers), tables, device, parts.copy())
        inputs = (camera_data(scene, alone), *changed.inputs[1:])
        film = film_arrays(1, 1, device)
        launch = launcher(kernel, replace(changed, inputs=inputs), alone, film, device)
        for first in range(0, SAMPLES, SAMPLES_A_LAUNCH):
            launch(Tile(0, 0, 1, 1), first, SAMPLES_A_LAUNCH)
        return develop.aovs({name: getattr(film, name).numpy() for name in SUMS}, scene, SAMPLES)

    seen = {name: image[0, 0] for name, image in shot(plan.layers).items()}
    number = int(seen["primId"])
    hit = number >= 0
    position = seen["P"].astype(np.float64) - scene.origin
    index, tangent = _surface(built, number, position) if hit else (-1, np.zeros(3))
    material = scene.materials[index] if hit else None
    eye = scene.camera.transform[:3, 3]
    toward = scene.camera.transform[:3, 2] if scene.camera.projection == "orthographic" else eye - position
    shares = []
    for layer in material.layers if material else ():
        without = tuple(
            tuple(p for p in own if m != index or p.sublayer.layer.name != layer.name)
            for m, own in enumerate(plan.layers)
        )
        left = shot(without)["color"][0, 0]
        frame = _frame(seen["normal"].astype(np.float64), tangent, layer.angle)
        used = [p.table for p in plan.layers[index] if p.sublayer.layer.name == layer.name and p.table >= 0]
        shares.append(_share(layer.name, seen["color"] - left, frame, toward, tables[used[0]] if used else None))
    distance = float(np.linalg.norm(eye - position)) if hit else math.inf
    return PixelReport(
        pixel=pixel,
        prim=scene.instances[number].path if hit else "",
        material=material.path if material else "",
        position=_three(seen["P"]),
        normal=_three(seen["normal"]),
        distance=distance,
        footprint=_footprint(scene, plan, seen["normal"], toward, distance) if hit else (0.0, 0.0),
        radiance=_three(seen["color"]),
        base=_three(seen["base"]),
        scratches=_three(seen["scratches"]),
        emission=_three(seen["emission"]),
        noise=float(math.sqrt(max(float(seen["variance"]), 0.0))),
        layers=tuple(shares),
        effects=_effects(plan, material.path if material else ""),
    )


def _surface(built: Assembled, instance: int, position: np.ndarray) -> tuple[int, np.ndarray]:
    """(material, dP/du) of the instance's triangle nearest to a position."""
    g = built.inputs[1]
    mine = np.flatnonzero(g.instance.numpy() == instance)
    corners = g.points.numpy().reshape(-1, 3, 3)[mine].astype(np.float64)
    a, e1, e2 = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    n = np.cross(e1, e2)
    area = np.maximum((n * n).sum(1), 1e-300)
    d = position - a
    v, w = (np.cross(d, e2) * n).sum(1) / area, (np.cross(e1, d) * n).sum(1) / area
    off = np.abs((d * n).sum(1)) / np.sqrt(area)
    outside = np.maximum(np.maximum(-v, -w), np.maximum(v + w - 1.0, 0.0))
    best = mine[int(np.argmin(off + outside * np.sqrt(np.sqrt(area))))]
    return int(g.material.numpy()[best]), g.dpdu.numpy()[best].astype(np.float64)


def _frame(normal: np.ndarray, tangent: np.ndarray, angle: float) -> np.ndarray:
    """Rows u, v, n of a layer's mean direction."""
    n = normal / max(float(np.linalg.norm(normal)), 1e-30)
    t = tangent - (tangent @ n) * n
    if np.linalg.norm(t) < 1e-12:
        t = np.cross(n, np.eye(3)[int(np.argmin(np.abs(n)))])
    t /= np.linalg.norm(t)
    b = np.cross(n, t)
    return np.stack([math.cos(angle) * t + math.sin(angle) * b, math.cos(angle) * b - math.sin(angle) * t, n])


def _share(name: str, radiance: np.ndarray, frame: np.ndarray, toward: np.ndarray, table: Any) -> LayerShare:
    u, v, n = frame @ (toward / np.linalg.norm(toward))
    theta, phi = math.asin(min(max(u, -1.0), 1.0)), math.atan2(v, n)
    if table is None:
        return LayerShare(name, _three(radiance), theta, phi)
    row = int(np.argmin(np.abs(table.angles - phi)))
    rho = np.asarray(table.mirror if table.normal is None else table.slice(abs(theta)))[row]
    rho = rho.mean(-1) if rho.ndim == 2 else rho
    return LayerShare(
        name, _three(radiance), theta, phi, tuple(map(float, table.angles)), tuple(map(float, rho))
    )  # fmt: skip


def _footprint(
    scene: Scene, plan: EffectPlan, normal: np.ndarray, toward: np.ndarray, distance: float
) -> tuple[float, float]:
    """Full axes [um] of a pixel's cone on the surface."""
    camera = scene.camera
    left, right, bottom, top = camera.window(*plan.size, scene.options.conform, scene.options.pixel_aspect)
    across = max((right - left) / plan.size[0], (top - bottom) / plan.size[1])
    width = across * (1.0 if camera.projection == "orthographic" else distance) * 1e6
    cosine = abs(float(toward @ normal)) / max(float(np.linalg.norm(toward) * np.linalg.norm(normal)), 1e-30)
    return width / max(cosine, 1e-3), width


def _effects(plan: EffectPlan, material: str) -> tuple[tuple[str, str], ...]:
    """Those that are on for this material, or for the whole scene."""
    found = []
    for name, choice in plan.effects.items():
        mine = any(prim == material or prim.startswith(f"{material} layer") for prim in choice.prims) if material else 0
        if choice.enabled and (mine or not name.startswith(("base.", "scratches", "diffraction", "grooves"))):
            found.append((name, choice.reason))
    return tuple(found)


def _three(values: np.ndarray) -> Color:
    r, g, b = (float(v) for v in values)
    return r, g, b
