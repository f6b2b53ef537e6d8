"""Tangent-space normal maps: written as textures that a UsdPreviewSurface reads, and read from any that others
wrote."""

from pathlib import Path

import numpy as np
import OpenImageIO as oiio

from ..whole import whole
from .exr import put
from .texture import read_texture

NORMAL_SUFFIXES = (".png", ".exr")


def write_normals(normals: np.ndarray, path: str | Path) -> None:
    """Write unit normals [h, w, 3], row 0 at the top, as 16-bit PNG or float EXR; whole or not at all.

    A component n is kept as 0.5 n + 0.5 in either, so that a UsdUVTexture with scale 2, bias -1 and raw colours gives
    it back. ValueError on another suffix, shape or length; OSError when the file cannot be written.
    """
    target = Path(path)
    if target.suffix.lower() not in NORMAL_SUFFIXES:
        raise ValueError(f"{target}: the suffix {target.suffix!r} is not one of {', '.join(NORMAL_SUFFIXES)}")
    values = np.asarray(normals, np.float64)
    if values.ndim != 3 or values.shape[2] != 3 or 0 in values.shape:
        raise ValueError(f"normals must have shape [h, w, 3], got {list(values.shape)}")
    length = np.linalg.norm(values, axis=-1)
    if not np.all(np.abs(length - 1.0) < 1e-3):
        worst = length.flat[int(np.argmax(np.where(np.isfinite(length), np.abs(length - 1.0), np.inf)))]
        raise ValueError(f"normals must be unit, got a length of {worst:g}")
    encoded = np.clip(0.5 * values + 0.5, 0.0, 1.0)
    height, width = values.shape[:2]
    png = target.suffix.lower() == ".png"
    spec = oiio.ImageSpec(width, height, 3, oiio.UINT16 if png else oiio.FLOAT)
    spec.attribute("Software", "scratchwarp")
    if png:
        spec.attribute("oiio:Gamma", 1.0)
        pixels = np.rint(65535.0 * encoded).astype(np.uint16)
    else:
        spec.attribute("compression", "zip")
        pixels = encoded.astype(np.float32)
    with whole(target) as draft:
        put(spec, pixels, draft, target)


def read_normals(path: str | Path, flip_green: bool = False) -> np.ndarray:
    """Unit normals, float32 [h, w, 3], of a tangent-space normal map of any format and depth, row 0 at the top.

    Files with a component below 0 hold normals as they are, others 0.5 n + 0.5. z is made up from x and y where the
    file leaves it out (its blue is everywhere 0) and never points inwards. ``flip_green``: the map has y downwards
    (DirectX). A pixel of length 0 is the flat normal. Raises as ``read_texture`` does.
    """
    values = read_texture(path, "raw")[..., :3].astype(np.float64)
    if values.min() >= 0.0:
        blank = not np.any(values[..., 2])
        values = 2.0 * values - 1.0
        if blank:
            values[..., 2] = np.sqrt(np.maximum(1.0 - np.sum(values[..., :2] ** 2, axis=-1), 0.0))
    if flip_green:
        values[..., 1] *= -1.0
    values[..., 2] = np.maximum(values[..., 2], 0.0)
    length = np.linalg.norm(values, axis=-1, keepdims=True)
    flat = np.broadcast_to((0.0, 0.0, 1.0), values.shape)
    return np.where(length > 1e-6, values / np.maximum(length, 1e-6), flat).astype(np.float32)
