"""The plain stage: no scratches anywhere, so that every scratch effect must be off.

Lengths in centimetres, +Y up.
"""

from pathlib import Path

from . import demo_shapes as shapes
from . import demo_usd as usd
from .demo_ball import metal
from .demo_kettle import studio


def plain(path: Path | str, detail: float = 1.0) -> Path:
    """Write the stage; ``detail`` scales the number of faces."""
    stage = usd.new_stage()
    rings = max(8, int(48 * detail))
    surfaces = [
        ("steel", metal(stage, "steel", "iron", 0.15), -13.0, 5.5),
        ("plastic", usd.material(stage, "plastic", diffuseColor=(0.05, 0.16, 0.32), roughness=0.2, ior=1.5), 0.0, 7.5),
        ("clay", usd.material(stage, "clay", diffuseColor=(0.55, 0.3, 0.18), roughness=1.0), 14.0, 5.5),
    ]
    for name, owner, x, radius in surfaces:
        usd.mesh(stage, name, shapes.sphere(radius, (0.0, 0.4, 1.0), rings, 2 * rings), owner, (x, radius, 0.0))
    studio(stage, detail)
    usd.camera(stage, (7.0, 28.0, 84.0), (0.5, 5.2, 0.0))
    usd.settings(stage)
    return usd.save(stage, path, "A plain stage without scratches.")
