"""The material ball: a scratched ball on seven metal tiles, one for each way in which scratches lie.

Lengths in centimetres, +Y up, micro-structure in micrometres.
"""

from pathlib import Path
from typing import Any

import numpy as np
from pxr import Sdf, Usd, UsdShade

from . import demo_shapes as shapes
from . import demo_usd as usd

REACH = 3.2  # from the middle of a tile to its corners
GAP = 0.12
RADIUS = 2.35

# The colours with which UsdPreviewSurface shows each metal to other programs.
COLORS = {
    "aluminium": (0.91, 0.92, 0.92),
    "copper": (0.93, 0.62, 0.5),
    "brass": (0.89, 0.75, 0.42),
    "gold": (1.0, 0.76, 0.33),
    "silver": (0.96, 0.94, 0.91),
    "iron": (0.56, 0.55, 0.53),
}


def ball(path: Path | str, detail: float = 1.0) -> Path:
    """Write the stage; ``detail`` scales the number of faces and curve points."""
    stage = usd.new_stage()
    rings = max(8, int(64 * detail))
    tiles(stage, detail)
    steel = metal(stage, "ball", "silver", 0.09)
    usd.layer(
        steel, "hairlines", usd.profile(steel, "soft", shape="round", rim=0.2), order=1, distribution="worley",
        patterns=16, width=24.0, depth=4.0, length=6000.0, coverage=0.12, angleSpread=360.0, curvature=40.0, seed=3,
    )
    usd.layer(
        steel, "marks", usd.profile(steel, "sharp", shape="vGroove", rim=0.3), order=2, distribution="random",
        width=55.0, depth=14.0, length=9000.0, coverage=0.012, angleSpread=360.0, curvature=30.0, seed=8,
        widthVariation=0.4,
    )
    body = shapes.sphere(RADIUS, (0.0, 0.45, 1.0), rings, 2 * rings)
    usd.mesh(stage, "ball", body, steel, (0.0, RADIUS + 0.38, 0.0))
    foot = metal(stage, "foot", "iron", 0.16)
    usd.layer(
        foot, "turned", usd.profile(foot, "tool", shape="round", periodic=True), distribution="linear",
        width=110.0, depth=9.0, pitch=110.0,
    )
    usd.mesh(stage, "foot", pedestal(detail), foot)
    surroundings(stage, detail)
    usd.camera(stage, (0.0, 21.5, 31.0), (0.0, 0.5, 0.45))
    usd.settings(stage)
    return usd.save(stage, path, "A scratched ball on tiles with every distribution of scratches.")


def metal(stage: Usd.Stage, name: str, kind: str, roughness: float) -> UsdShade.Material:
    """A measured metal of GGX alpha ``roughness``, and its likeness for programs that know none."""
    measured = {"base": "conductor", "metal": kind, "roughness": roughness}
    look = {"diffuseColor": COLORS[kind], "metallic": 1.0, "roughness": float(np.sqrt(roughness))}
    return usd.material(stage, name, measured, **look)


def tiles(stage: Usd.Stage, detail: float) -> None:
    """The middle tile under the ball and six around it, from the right counter-clockwise seen from above."""
    side = np.arange(6) * np.pi / 3 + np.pi / 6
    slab = shapes.tile(REACH * np.stack([np.cos(side), -np.sin(side)], axis=-1), 0.6, 0.1)
    layers: list[tuple[str, str, float, dict[str, Any]]] = [
        ("worley", "iron", 0.12, {"width": 30.0, "depth": 5.0, "length": 8000.0, "coverage": 0.2, "patterns": 8}),
        ("spiral", "brass", 0.06, {"width": 220.0, "depth": 34.0, "pitch": 640.0}),
        ("linear", "aluminium", 0.06, {"width": 240.0, "depth": 40.0, "pitch": 700.0, "angle": 30.0}),
        ("crosshatch", "iron", 0.1, {"width": 240.0, "depth": 40.0, "pitch": 1100.0, "angle": -22.0}),
        ("random", "aluminium", 0.08, {"width": 60.0, "depth": 14.0, "length": 14000.0, "coverage": 0.1}),
        ("concentric", "copper", 0.06, {"width": 160.0, "depth": 24.0, "pitch": 420.0}),
        ("curves", "gold", 0.06, {"width": 60.0, "depth": 16.0}),
    ]
    directions = {
        "worley": {"angleSpread": 360.0},
        "crosshatch": {"crossAngle": 63.0},
        "random": {"angleSpread": 70.0, "curvature": 15.0},
    }
    for i, (distribution, kind, roughness, values) in enumerate(layers):
        turn, step = (i - 1) * np.pi / 3, (i > 0) * (REACH * np.sqrt(3) + GAP)
        at = np.round((step * np.cos(turn), 0.0, -step * np.sin(turn)), 5).tolist()
        owner = metal(stage, f"{distribution}Tile", kind, roughness)
        shape = "vGroove" if distribution == "random" else "round"
        cut = usd.profile(owner, "cut", shape=shape, rim=0.15)
        engraved = rosette(stage, at, detail) if distribution == "curves" else None
        values = values | directions.get(distribution, {})
        usd.layer(owner, distribution, cut, engraved, distribution=distribution, seed=i, **values)
        usd.mesh(stage, f"{distribution}Tile", slab, owner, at)


def rosette(stage: Usd.Stage, at: list[float], detail: float) -> Sdf.Path:
    """The engraving of the tile at ``at``."""
    lines = shapes.rosette(max(4, int(24 * detail)), max(24, int(360 * detail)))
    engraved = [2.6 * np.stack([line[:, 0], np.zeros(len(line)), -line[:, 1]], axis=-1) for line in lines]
    return usd.curves(stage, "rosette", engraved, width=60.0, depth=16.0, space="object", move=at)


def pedestal(detail: float) -> shapes.Shape:
    """A turned foot with a hollow for the ball."""
    n = max(3, int(12 * detail))
    flank = shapes.smooth([(1.75, 0.0), (1.72, 0.12), (1.45, 0.34), (1.28, 0.62)], n)
    lip = shapes.smooth([(1.28, 0.62), (1.22, 0.68), (1.14, 0.66)], n)
    seat = shapes.smooth([(1.14, 0.66), (0.6, 0.46), (0.0, 0.4)], n)
    return shapes.lathe([flank, lip, seat], max(12, int(96 * detail)))


def surroundings(stage: Usd.Stage, detail: float) -> None:
    """A dark floor, the lights and what they shine on."""
    slate = usd.material(stage, "slate", diffuseColor=(0.035, 0.037, 0.042), roughness=0.45, ior=1.5)
    segments = max(12, int(64 * detail))
    usd.mesh(stage, "floor", shapes.lathe([[(60.0, 0.0), (30.0, 0.0), (0.0, 0.0)]], segments), slate, (0.0, -0.6, 0.0))
    usd.rect_light(stage, "key", (-24.0, 22.0, 10.0), (0.0, 0.0, 0.0), (12.0, 12.0), 9.0, (1.0, 0.96, 0.9))
    usd.rect_light(stage, "side", (30.0, 12.0, 2.0), (0.0, 0.0, 0.0), (8.0, 16.0), 6.0, (0.85, 0.92, 1.0))
    usd.sphere_light(stage, "bulb", (5.0, 26.0, 12.0), 0.35, 1500.0)
    usd.sphere_light(stage, "spark", (-16.0, 18.0, -7.0), 0.3, 1500.0, (1.0, 0.85, 0.7))
    usd.sphere_light(stage, "glint", (21.4, 23.0, -1.9), 0.3, 1500.0)
    usd.distant_light(stage, "sky", (0.6, -1.0, -0.1), 3.0, 0.4)
    usd.dome_light(stage, "ambient", 0.38, (0.92, 0.96, 1.0))
