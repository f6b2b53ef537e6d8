"""The panel: a painted car door with wash marks in its clear coat and deep scratches down to the metal.

Lengths in metres, +Z up, micro-structure in micrometres.
"""

from pathlib import Path
from typing import Any

import numpy as np
from pxr import Sdf, Usd

from . import demo_shapes as shapes
from . import demo_usd as usd

UP = (0.0, 0.0, 1.0)
WIDTH, HEIGHT = 0.24, 0.18


def panel(path: Path | str, detail: float = 1.0) -> Path:
    """Write the stage; ``detail`` scales the number of faces and scratches."""
    stage = usd.new_stage(meters_per_unit=1.0, up="Z")
    coat: dict[str, Any] = {"clearcoat": 1.0, "clearcoatRoughness": 0.03, "ior": 1.5}
    paint = usd.material(stage, "paint", diffuseColor=(0.26, 0.004, 0.008), roughness=0.38, **coat)
    shallow = usd.profile(paint, "shallow", shape="round")
    torn = usd.profile(paint, "torn", shape="trapezoid", floorWidth=0.3, rim=0.25)
    usd.layer(
        paint, "wash", shallow, order=1, distribution="worley", width=36.0, depth=4.0, length=7000.0, coverage=0.08,
        patterns=12, angleSpread=360.0, curvature=40.0, seed=11,
    )
    usd.layer(
        paint, "twigs", shallow, order=2, distribution="random", width=90.0, depth=9.0, length=40000.0, coverage=0.012,
        angle=8.0, angleSpread=30.0, curvature=10.0, widthVariation=0.5, seed=4,
    )
    usd.layer(
        paint, "gravel", torn, order=3, distribution="random", width=260.0, depth=70.0, length=4000.0, coverage=0.004,
        angle=160.0, angleSpread=50.0, widthVariation=0.5, material="conductor", metal="aluminium", seed=6,
    )
    usd.layer(
        paint, "key", torn, key(stage, detail), order=4, distribution="curves", width=550.0, depth=130.0,
        material="conductor", metal="aluminium",
    )
    columns, rows = max(8, int(120 * detail)), max(6, int(90 * detail))
    usd.mesh(stage, "door", shapes.sheet(door, columns, rows), paint)
    concrete = usd.material(stage, "concrete", diffuseColor=(0.12, 0.12, 0.125), roughness=0.8)
    bend = np.linspace(0, np.pi / 2, max(6, int(24 * detail)))
    rise = np.stack([-0.5 - 0.3 * np.sin(bend), 0.3 - 0.3 * np.cos(bend)], axis=-1)
    wall = shapes.extruded(np.concatenate([[(1.5, 0.0), (0.0, 0.0)], rise, [(-0.8, 0.8), (-0.8, 1.2)]]), 4.0)
    usd.mesh(stage, "garage", wall.z_up(), concrete)
    usd.rect_light(stage, "tube", (-0.3, -0.5, 0.75), (0, 0, 0.1), (0.9, 0.12), 7.0, (1.0, 0.97, 0.92), UP)
    usd.rect_light(stage, "side", (0.8, -0.3, 0.3), (0, 0, 0.1), (0.2, 0.5), 5.0, (0.85, 0.92, 1.0), UP)
    usd.sphere_light(stage, "lamp", (0.12, -0.7, 0.34), 0.008, 4000.0)
    usd.sphere_light(stage, "spark", (-0.28, -0.7, 0.2), 0.006, 4000.0, (1.0, 0.88, 0.75))
    usd.distant_light(stage, "sun", (0.3, 1.0, -0.9), 0.53, 0.3, up=UP)
    usd.dome_light(stage, "sky", 0.16, (0.7, 0.82, 1.0))
    usd.camera(stage, (0.09, -0.6, 0.2), (0.0, 0.0, 0.088), UP)
    usd.settings(stage)
    return usd.save(stage, path, "A scratched painted panel: marks in the clear coat, and bare metal.")


def door(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Positions on the door, seen from -Y: bulged, with a crease along it and its edges bent back."""
    x, y = 2 * u - 1, 2 * v - 1
    bulge = 0.015 * (1 - x**2) + 0.02 * (1 - (y + 0.1) ** 2)
    crease = 0.005 * np.tanh((v - 0.68 - 0.06 * u) * 45)
    bent = 1.4 * (np.clip(np.abs(x) - 0.93, 0, 1) ** 2 + np.clip(np.abs(y) - 0.93, 0, 1) ** 2)
    return np.stack([WIDTH / 2 * x, bent - bulge + crease + 0.02 * v, HEIGHT * v + 0.004], axis=-1)


def key(stage: Usd.Stage, detail: float) -> Sdf.Path:
    """What somebody did with a key, in uv."""
    n = max(12, int(90 * detail))
    rng = np.random.default_rng(7)
    wave = shapes.smooth([(0.1, 0.52), (0.28, 0.45), (0.5, 0.5), (0.7, 0.42), (0.9, 0.47)], n)
    loop = np.linspace(0, 2.2 * np.pi, n)[:, None]
    curl = np.array([0.33, 0.26]) + (0.05 - 0.004 * loop) * np.concatenate([np.cos(loop), 1.2 * np.sin(loop)], axis=1)
    strokes = [wave, wave[: n // 2] + (0.02, -0.03), curl]
    strokes = [stroke + 0.0006 * rng.standard_normal(stroke.shape) for stroke in strokes]
    lines = [np.concatenate([stroke, np.zeros((len(stroke), 1))], axis=1) for stroke in strokes]
    return usd.curves(stage, "key", lines, width=550.0, depth=130.0, space="uv")
