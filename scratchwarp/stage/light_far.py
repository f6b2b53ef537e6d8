"""Lights from infinity: distant lights and domes."""

import numpy as np
from pxr import Usd, UsdGeom

from scratchwarp.scene import DistantLight, DomeLight, Light

from .light import common, radiance, through
from .reading import Reading
from .texture import Textures

# Dome frame (pole +Y, longitude 0 at +Z) to a Z-up one: the pole +Z, longitude 0 at -Y (DomeLight_1's poleAxis).
_POLE_Z = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def distant_size_factor(angle: float) -> float:
    """sizeFactor of a distant light of full angle ``angle`` [rad]; with it intensity is illuminance."""
    half = min(max(angle / 2, 0.0), np.pi)
    if half == 0:
        return 1.0
    projected = np.sin(half) ** 2
    return float(np.pi * (projected if half <= np.pi / 2 else 2 - projected))


def distant(reading: Reading, prim: Usd.Prim, metric: np.ndarray, textures: Textures) -> Light:
    """Light that travels along the prim's -Z."""
    angle = float(np.radians(min(max(reading.number(prim, "inputs:angle", 0.53), 0.0), 360.0)))
    direction = -metric[:3, 2]
    return DistantLight(
        **common(reading, prim),
        radiance=radiance(reading, prim, distant_size_factor(angle)),
        direction=direction / max(float(np.linalg.norm(direction)), 1e-300),
        angle=angle,
    )


def dome(reading: Reading, prim: Usd.Prim, metric: np.ndarray, textures: Textures) -> Light:
    """Light from all around; DomeLight_1 turns its pole to ``poleAxis``, DomeLight keeps it at +Y."""
    rotation = _rotation(metric[:3, :3])
    pole = str(reading.value(prim, "poleAxis", "Y"))
    if pole == "scene":
        pole = str(UsdGeom.GetStageUpAxis(reading.stage))
    if pole == "Z":
        rotation = rotation @ _POLE_Z
    texture = -1
    attribute = prim.GetAttribute("inputs:texture:file")
    asset = reading.value(prim, "inputs:texture:file")
    if asset and asset.path:
        layout = str(reading.value(prim, "inputs:texture:format", "automatic"))
        if layout in ("automatic", "latlong"):
            texture = textures.index(attribute.GetPath(), asset, attribute.GetColorSpace() or "auto")
        else:
            reading.warn(prim.GetPath(), f"inputs:texture:format {layout!r} is not honoured; the dome shines evenly")
    if prim.GetRelationship("portals").GetForwardedTargets():
        reading.warn(prim.GetPath(), "portals are not honoured")
    emitted = through(reading, prim, radiance(reading, prim, 1.0), textures, texture)
    return DomeLight(**common(reading, prim), radiance=emitted, rotation=rotation, texture=texture)


def _rotation(matrix: np.ndarray) -> np.ndarray:
    """The nearest rotation (or reflection) to a matrix [3, 3]."""
    left, _, right = np.linalg.svd(matrix)
    return left @ right
