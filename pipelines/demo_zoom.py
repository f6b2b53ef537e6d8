"""A flight from ten metres to a millimetre over a scratched sheet: the same material from haze to single scratches.

The camera looks along a fixed direction, and its distance shrinks by the same factor from frame to frame: frames 1 to
41 are four decades. The pixels' footprints run from hundreds of scratches to a hundredth of one. The sheet is lit by a
distant light and a dome, so that directions to light and viewer stay the same at the picture's middle. +Y up, metres.
"""

from pathlib import Path

import numpy as np
from pxr import Gf, UsdGeom

from . import demo_shapes as shapes
from . import demo_usd as usd
from .demo_ball import metal

FRAMES = 41
FARTHEST, NEAREST = 10.0, 1e-3  # metres
TOWARDS = (0.0, 0.8660254, 0.5)  # from the sheet to the camera


def distance(frame: float) -> float:
    """Metres from the camera to the sheet at a frame."""
    return FARTHEST * (NEAREST / FARTHEST) ** ((frame - 1) / (FRAMES - 1))


def zoom(path: Path | str, detail: float = 1.0) -> Path:
    """Write the stage; ``detail`` does nothing to a sheet of two triangles but is taken as by the other stages."""
    stage = usd.new_stage(meters_per_unit=1.0)
    owner = metal(stage, "sheet", "iron", 0.03)
    cut = usd.profile(owner, "cut", shape="quartic")
    usd.layer(
        owner, "fine", cut, order=1, distribution="worley", patterns=12, angleSpread=20.0, length=3000.0, width=12.0,
        depth=3.0, coverage=0.4, seed=5,
    )
    usd.layer(
        owner, "deep", cut, order=2, distribution="worley", patterns=6, angleSpread=360.0, length=9000.0, width=40.0,
        depth=14.0, coverage=0.1, seed=6,
    )
    flat = shapes.sheet(lambda u, v: np.stack([4 * (u - 0.5), 0 * u, 4 * (0.5 - v)], axis=-1), 1, 1)
    usd.mesh(stage, "sheet", flat, owner)
    usd.distant_light(stage, "sun", (0.02, -1.0, 0.05), 4.0, 3.0)
    usd.dome_light(stage, "ambient", 0.5, (0.8, 0.9, 1.0))
    usd.camera(stage, tuple(10.0 * c for c in TOWARDS), (0.0, 0.0, 0.0), lens=135.0)
    camera = UsdGeom.Camera.Get(stage, "/World/camera")
    op = camera.GetPrim().GetAttribute("xformOp:transform")
    for frame in range(1, FRAMES + 1):
        eye = tuple(distance(frame) * c for c in TOWARDS)
        op.Set(Gf.Matrix4d(*usd.looking(eye, (0.0, 0.0, 0.0))), frame)
        camera.GetFocusDistanceAttr().Set(distance(frame), frame)
    camera.GetClippingRangeAttr().Set(Gf.Vec2f(NEAREST / 100, 1000.0))
    stage.SetStartTimeCode(1)
    stage.SetEndTimeCode(FRAMES)
    usd.settings(stage, 320, 240)
    return usd.save(stage, path, "Four decades of distance over one scratched sheet.")
