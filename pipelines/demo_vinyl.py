"""The record: a spiral of V grooves, far wider than light waves, whose fine orders merge into streaks of colour.

A groove is 56 um wide and 28 um deep with walls of 45 degrees; the pitch is 110 um. Lengths in centimetres, +Y up,
micro-structure in micrometres.
"""

from pathlib import Path
from typing import Any

from . import demo_shapes as shapes
from . import demo_usd as usd
from .demo_disc import ring

RADII = (0.36, 5.2, 6.0, 14.6, 15.0)  # of the hole, the label, the grooves' end and beginning, and the rim [cm]


def vinyl(path: Path | str, detail: float = 1.0) -> Path:
    """Write the stage; ``detail`` scales the number of faces."""
    stage = usd.new_stage()
    around = max(24, int(180 * detail))
    lacquer: dict[str, Any] = {"diffuseColor": (0.004, 0.004, 0.004), "roughness": 0.15, "ior": 1.54}
    pressed = usd.material(stage, "pressed", **lacquer)
    usd.wave(pressed, summation="coherent")
    groove = usd.profile(pressed, "groove", shape="vGroove")
    usd.layer(
        pressed, "track", groove, model="diffraction", distribution="spiral", width=56.0, depth=28.0, pitch=110.0
    )
    usd.mesh(stage, "track", ring(RADII[2], RADII[3], around, max(2, int(16 * detail)), RADII[-1]), pressed)
    flat = usd.material(stage, "flat", **lacquer)
    for name, inner, outer in (("dead", RADII[1], RADII[2]), ("rim", RADII[3], RADII[4])):
        usd.mesh(stage, name, ring(inner, outer, around, 1, RADII[-1]), flat)
    paper = usd.material(stage, "paper", diffuseColor=(0.5, 0.06, 0.04), roughness=0.7)
    usd.mesh(stage, "label", ring(RADII[0], RADII[1], around, 1, RADII[-1]), paper)
    slate = usd.material(stage, "slate", diffuseColor=(0.1, 0.09, 0.08), roughness=0.8)
    usd.mesh(stage, "table", shapes.lathe([[(90.0, 0.0), (0.0, 0.0)]], 48), slate, (0.0, -0.2, 0.0))
    usd.sphere_light(stage, "bulb", (10.0, 70.0, -65.0), 1.0, 30000.0)
    usd.rect_light(stage, "window", (-120.0, 110.0, -80.0), (0.0, 0.0, 0.0), (60.0, 80.0), 3.0, (0.86, 0.93, 1.0))
    usd.camera(stage, (0.0, 50.0, 48.0), (0.0, 0.0, 0.0))
    usd.settings(stage)
    return usd.save(stage, path, "A record: a spiral of V grooves.")
