"""ScratchMeasuredAPI to Measured."""

from typing import Any

import numpy as np
from pxr import Usd

from scratchwarp.scene import Measured, StageError

from .color import color
from .reading import Reading

_MODES = ("width", "a", "b", "kd", "ks", "alpha")


def read_measured(reading: Reading, prim: Usd.Prim) -> Measured | None:
    """ScratchMeasuredAPI's values, None where it is not applied or holds nothing (with a warning).

    Arrays of modes that differ in length raise StageError, naming the prim.
    """
    if "ScratchMeasuredAPI" not in prim.GetAppliedSchemas():
        return None

    def get(attribute: str) -> Any:
        return reading.value(prim, f"scratch:measured:{attribute}")

    path, source, asset = prim.GetPath(), str(get("source")), get("file")
    if source == "file" and not (asset and asset.resolvedPath):
        authored = f"{asset.path}: no such file" if asset and asset.path else "scratch:measured:file is empty"
        reading.warn(path, f"{authored}; the surface is used in place of the measured base")
        return None
    azimuth = np.radians(np.asarray(get("modes:azimuth"), np.float64))
    if source == "stencils" and not len(azimuth):
        reading.warn(path, "ScratchMeasuredAPI has no modes; the surface is used in place of the measured base")
        return None
    colors = prim.GetAttribute("scratch:measured:modes:color")
    ground = prim.GetAttribute("scratch:measured:background")
    background = np.asarray(color(reading, ground, np.array(get("background"), np.float64)))
    if np.ptp(background) > 1e-6:
        reading.warn(path, "scratch:measured:background is a grey scale of the last mode's colour; its mean is used")
    authored_colors = np.asarray(get("modes:color"), np.float64).reshape(-1, 3)
    try:
        return Measured(
            source=source,
            file=asset.resolvedPath if source == "file" else "",
            format=str(get("format")),
            azimuth=azimuth,
            color=color(reading, colors, authored_colors),
            beta=float(get("beta")),
            betas=np.asarray(get("modes:beta"), np.float64),
            background=float(background.mean()),
            k=float(get("k")),
            specular_alpha=float(get("specularAlpha")),
            retro=bool(get("retro")),
            mask=str(get("mask")),
            **{name: np.asarray(get(f"modes:{name}"), np.float64) for name in _MODES},
        )
    except ValueError as error:
        raise StageError(f"{reading.path}: {path}: {error}") from None
