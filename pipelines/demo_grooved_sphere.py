"""A grooved sphere of metal and one of glass: circles of latitude, crossed by meridians that end before the poles.

After Bosch, Pueyo, Merillou and Ghazanfarpour 2008, figure 11. Lengths in centimetres, +Y up, micro-structure in
micrometres.
"""

from pathlib import Path

import numpy as np
from pxr import Sdf, Usd

from . import demo_shapes as shapes
from . import demo_usd as usd
from .demo_ball import metal

RADIUS = 5.0
GROOVE = 2200.0  # width [um]
LATITUDES = np.radians(np.arange(-60.0, 61.0, 12.0))
MERIDIANS = 24


def grooved_sphere(path: Path | str, detail: float = 1.0) -> Path:
    """Write the stage; ``detail`` scales the number of faces."""
    stage = usd.new_stage()
    lines = paths(stage)
    glass = usd.material(stage, "glass", diffuseColor=(0.0, 0.0, 0.0), roughness=0.02, ior=1.5, opacity=0.0)
    for name, owner, x in (("metal", metal(stage, "copper", "copper", 0.12), -5.9), ("glass", glass, 5.9)):
        cut = usd.round_in_facets(owner, "cut")
        usd.layer(
            owner, "grooves", cut, lines, model="groove", distribution="curves", width=GROOVE, depth=0.3 * GROOVE
        )
        usd.mesh(stage, name, sphere(detail), owner, (x, RADIUS, 0.0))
    light, dark = (
        usd.material(stage, name, diffuseColor=color, roughness=0.8)
        for name, color in (("light", (0.55, 0.5, 0.42)), ("dark", (0.16, 0.07, 0.05)))
    )
    n = max(6, int(24 * detail))
    bend = np.linspace(0, np.pi / 2, n)
    curve = np.stack([-24 - 14 * np.sin(bend), 14 - 14 * np.cos(bend)], axis=-1)
    outline = np.concatenate([[(60.0, 0.0), (10.0, 0.0), (-20.0, 0.0)], curve, [(-38.0, 60.0)]])
    for i in range(-10, 11):
        strip = shapes.extruded(outline, 6.0)
        usd.mesh(stage, f"strip{i + 10}", strip, dark if i % 2 else light, (6.0 * i, 0.0, 0.0))
    usd.rect_light(stage, "key", (-26.0, 40.0, 24.0), (0.0, 4.0, 0.0), (20.0, 20.0), 11.0, (1.0, 0.95, 0.88))
    usd.rect_light(stage, "side", (40.0, 16.0, 12.0), (0.0, 4.0, 0.0), (8.0, 30.0), 7.0, (0.86, 0.93, 1.0))
    usd.distant_light(stage, "sun", (-0.3, -0.7, -0.6), 0.0, 1.5, (1.0, 0.97, 0.92))
    usd.dome_light(stage, "ambient", 0.5, (0.86, 0.92, 1.0))
    usd.camera(stage, (0.0, 15.0, 46.0), (0.0, 4.6, 0.0), lens=42.0)
    usd.settings(stage, integrator="path", maxDepth=6)
    return usd.save(stage, path, "A grooved sphere of metal and one of glass.")


def sphere(detail: float) -> shapes.Shape:
    """A sphere with u around its axis and v along its meridians, true to scale at the equator."""
    rise = np.linspace(-0.5 * np.pi, 0.5 * np.pi, max(8, int(64 * detail)) + 1)
    outline = RADIUS * np.stack([np.cos(rise), np.sin(rise)], axis=-1)
    outline[[0, -1], 0] = 0.0
    return shapes.lathe([outline], max(12, int(128 * detail)))


def paths(stage: Usd.Stage) -> Sdf.Path:
    """The grooves in uv; those around the axis go on beyond the seam at the back."""
    rows = 0.25 + LATITUDES / (2.0 * np.pi)
    around = [np.array([(-0.1, v, 0.0), (1.1, v, 0.0)]) for v in rows]
    upright = [np.array([(u, rows[1], 0.0), (u, rows[-2], 0.0)]) for u in (np.arange(MERIDIANS) + 0.5) / MERIDIANS]
    return usd.curves(stage, "grooves", around + upright, width=GROOVE, depth=0.3 * GROOVE, space="uv")
