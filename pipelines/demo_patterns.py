"""Brushed and scattered scratches, each shallow and steep: four balls (Raymond 2016, Figure 14).

Left to right: brushed shallow, brushed steep, scattered shallow, scattered steep. Lengths in centimetres, +Y up, sizes
of scratches as fractions of the uv square (Table 1).
"""

from pathlib import Path
from typing import Any

import numpy as np

from . import demo_shapes as shapes
from . import demo_usd as usd
from .demo_ball import metal

BRUSHED = {"patterns": 4, "angleSpread": 7.0, "length": 0.02, "width": 7e-4, "coverage": 0.75}
SCATTERED = {"patterns": 16, "angleSpread": 360.0, "length": 0.02, "width": 1e-4, "coverage": 0.35}
SHALLOW, STEEP = 0.06, 0.55  # depth over width


def patterns(path: Path | str, detail: float = 1.0) -> Path:
    """Write the stage; ``detail`` scales the number of faces."""
    stage = usd.new_stage()
    rings = max(8, int(56 * detail))
    sorts: list[tuple[str, dict[str, Any], float]] = [
        ("brushedShallow", BRUSHED, SHALLOW),
        ("brushedSteep", BRUSHED, STEEP),
        ("scatteredShallow", SCATTERED, SHALLOW),
        ("scatteredSteep", SCATTERED, STEEP),
    ]
    for i, (name, pattern, aspect) in enumerate(sorts):
        owner = metal(stage, name, "iron", 0.03)
        cut = usd.profile(owner, "cut", shape="quartic")
        depth = aspect * pattern["width"]
        usd.layer(owner, "scratches", cut, distribution="worley", space="uv", seed=4, depth=depth, **pattern)
        body = shapes.sphere(4.0, (0.2, 0.5, 0.85), rings, 2 * rings)
        usd.mesh(stage, name, body, owner, (8.8 * (i - 1.5), 4.0, 0.0))
    table = usd.material(stage, "table", diffuseColor=(0.16, 0.16, 0.165), roughness=0.6, ior=1.5)
    bend = np.linspace(0, np.pi / 2, max(6, int(24 * detail)))
    curve = np.stack([-30 - 20 * np.sin(bend), 20 - 20 * np.cos(bend)], axis=-1)
    outline = np.concatenate([[(60.0, 0.0), (20.0, 0.0), (-20.0, 0.0)], curve, [(-50.0, 60.0)]])
    usd.mesh(stage, "backdrop", shapes.extruded(outline, 260.0), table)
    usd.rect_light(stage, "key", (-30.0, 38.0, 26.0), (0.0, 4.0, 0.0), (26.0, 26.0), 8.0, (1.0, 0.96, 0.9))
    usd.rect_light(stage, "side", (46.0, 20.0, 14.0), (0.0, 4.0, 0.0), (8.0, 30.0), 6.0, (0.86, 0.93, 1.0))
    usd.sphere_light(stage, "bulb", (8.0, 40.0, 40.0), 0.6, 1800.0, (1.0, 0.55, 0.5))
    usd.dome_light(stage, "ambient", 0.8, (0.85, 0.91, 1.0))
    usd.camera(stage, (0.0, 14.0, 62.0), (0.0, 4.0, 0.0), lens=76.0)
    usd.settings(stage, 960, 360)
    return usd.save(stage, path, "Brushed and scattered scratches, shallow and steep.")
