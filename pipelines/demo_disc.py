"""The compact disc: one spiral of 1.6 um pitch, a reflection grating that bends, under a small sphere.

The track lies between the radii of 25 and 58 mm; its pits are taken as one groove 0.6 um wide, a quarter of a red
wavelength deep. Its orders stand where sin(theta_i) + sin(theta_o) = m lambda / pitch across the track. Lengths in
centimetres, +Y up, micro-structure in micrometres.
"""

from pathlib import Path

import numpy as np

from . import demo_shapes as shapes
from . import demo_usd as usd
from .demo_ball import metal

PITCH = 1.6
RADII = (0.75, 2.5, 5.8, 6.0)  # of the hole, the track's beginning and end, and the rim [cm]


def disc(path: Path | str, detail: float = 1.0) -> Path:
    """Write the stage; ``detail`` scales the number of faces."""
    stage = usd.new_stage()
    around = max(24, int(180 * detail))
    mirror = metal(stage, "mirror", "aluminium", 0.006)
    usd.wave(mirror, summation="coherent")
    pit = usd.profile(mirror, "pit", shape="rectangle")
    usd.layer(mirror, "track", pit, model="diffraction", distribution="spiral", width=0.6, depth=0.13, pitch=PITCH)
    usd.mesh(stage, "track", ring(RADII[1], RADII[2], around, max(2, int(12 * detail))), mirror)
    plain = metal(stage, "plain", "aluminium", 0.006)
    usd.mesh(stage, "hub", ring(RADII[0], RADII[1], around, max(2, int(4 * detail))), plain)
    usd.mesh(stage, "rim", ring(RADII[2], RADII[3], around, 1), plain)
    slate = usd.material(stage, "slate", diffuseColor=(0.02, 0.02, 0.022), roughness=0.8, ior=1.45)
    usd.mesh(stage, "table", shapes.lathe([[(60.0, 0.0), (0.0, 0.0)]], 48), slate, (0.0, -0.12, 0.0))
    usd.sphere_light(stage, "bulb", (3.0, 28.0, -16.0), 1.4, 3.2)
    usd.dome_light(stage, "sky", 0.12)
    usd.camera(stage, (0.0, 28.0, 17.0), (0.0, 0.0, 0.3))
    usd.settings(stage)
    return usd.save(stage, path, "A compact disc: a spiral of 1.6 um pitch.")


def ring(inner: float, outer: float, around: int, rows: int, whole: float = RADII[-1]) -> shapes.Shape:
    """A flat ring in the plane y = 0 about the origin, u along +x and v along -z, true to scale, the middle of the uv
    square at the origin and its side ``2 whole``."""
    turn = np.linspace(0.0, 2.0 * np.pi, around + 1)
    radius = np.linspace(inner, outer, rows + 1)[:, None]
    x, z = radius * np.cos(turn), radius * np.sin(turn)
    x[:, -1], z[:, -1] = x[:, 0], z[:, 0]
    points = np.stack([x, np.zeros_like(x), z], axis=-1)
    normals = np.broadcast_to((0.0, 1.0, 0.0), points.shape)
    # rows run outwards and columns from +x to +z, so that faces look up
    return shapes.grid(points, normals, 0.5 + np.stack([x, -z], axis=-1) / (2.0 * whole))
