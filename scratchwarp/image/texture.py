"""An image file as a texture: linear Rec.709, four channels, float32."""

from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio

from ..scene import Budget, TooLarge
from .bounds import check_size, legible, one_line
from .layers import HALF_MAX
from .view import BUILTIN

_UNTOUCHED = ("raw", "data", "identity", "unknown", "lin_rec709_scene", "lin_rec709")
_SRGB = ("sRGB", "srgb_rec709_scene", "srgb_rec709")


def read_texture(path: str | Path, color_space: str = "auto", budget: Budget | None = None) -> np.ndarray:
    """Read the first image of a file that OpenImageIO knows (PNG, JPEG, EXR, HDR, TIFF and more).

    ``color_space``: ``sRGB``, ``raw``, a USD colour space name such as ``lin_ap1_scene``, or ``auto``: 8-bit images of
    three or more channels are sRGB unless the file says that it is linear, all others are left as they are
    (UsdUVTexture).

    Returns float32 [h, w, 4], row 0 at the top, alpha not multiplied into the colour (files that store it multiplied,
    such as EXR, are left so); grey is repeated into R, G and B, a missing alpha is 1, inf becomes 65504.
    OSError when the file is missing or cannot be decoded; ValueError naming the first NaN pixel or the unknown colour
    space. TooLarge (a ValueError), before anything is allocated, where the image would take more than ``budget`` leaves
    (None: most of this machine's memory) or claims a size that its file cannot hold.
    """
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"{path}: no such image file")
    hints = oiio.ImageSpec()
    hints.attribute("oiio:UnassociatedAlpha", 1)
    file = oiio.ImageInput.open(str(path), hints)
    if file is None:
        raise OSError(f"{path}: cannot be read as an image ({one_line(oiio.geterror) or 'unknown format'})")
    spec = file.spec()
    try:
        check_size(path, spec, budget)
    except TooLarge:
        file.close()
        raise
    pixels = file.read_image(oiio.FLOAT)
    message = one_line(file.geterror)
    file.close()
    if pixels is None:
        raise OSError(f"{path}: cannot be decoded ({message})")
    with legible(path):
        rgba = _rgba(np.asarray(pixels, dtype=np.float32).reshape(spec.height, spec.width, -1), list(spec.channelnames))
    if np.isnan(rgba).any():
        y, x, _ = (int(i) for i in np.argwhere(np.isnan(rgba))[0])
        raise ValueError(f"{path}: pixel ({x}, {y}) is NaN; repair the image")
    np.clip(rgba, -HALF_MAX if rgba.min() == -np.inf else None, HALF_MAX if rgba.max() == np.inf else None, out=rgba)
    with legible(path):
        automatic = _automatic(spec)
    space = automatic if color_space == "auto" else color_space
    return rgba if space in _UNTOUCHED else _to_rec709(rgba, space, path)


def _rgba(pixels: np.ndarray, names: list[str]) -> np.ndarray:
    """Pick or make R, G, B and A."""
    if {"R", "G", "B"} <= set(names):
        picked = [names.index(n) for n in "RGB"]
        alpha = names.index("A") if "A" in names else -1
    else:
        picked = [0, 1, 2] if len(names) >= 3 else [0, 0, 0]
        alpha = {2: 1, 4: 3}.get(len(names), -1)
    rgba = np.ones((*pixels.shape[:2], 4), np.float32)
    rgba[..., :3] = pixels[..., picked]
    if alpha >= 0:
        rgba[..., 3] = pixels[..., alpha]
    return rgba


def _automatic(spec: Any) -> str:
    said = spec.get_string_attribute("oiio:ColorSpace").lower()
    linear = said.startswith("lin") or spec.get_float_attribute("oiio:Gamma", 0.0) == 1.0
    return "sRGB" if spec.format == oiio.UINT8 and spec.nchannels >= 3 and not linear else "raw"


def _to_rec709(rgba: np.ndarray, space: str, path: Path) -> np.ndarray:
    if space in _SRGB:
        # IEC 61966-2-1; OpenColorIO's own is an approximation, off by up to 2.4e-5.
        color = rgba[..., :3]
        rgba[..., :3] = np.where(color <= 0.04045, color / 12.92, ((np.maximum(color, 0) + 0.055) / 1.055) ** 2.4)
        return rgba
    for config in (BUILTIN, "ocio://default"):
        colors = oiio.ColorConfig(config)
        if colors.resolve(space) in colors.getColorSpaceNames():
            linear = colors.resolve("lin_rec709_scene")
            source = oiio.ImageBuf(np.ascontiguousarray(rgba))
            given = colors.resolve(space)
            done = oiio.ImageBufAlgo.colorconvert(source, given, linear, unpremult=False, colorconfig=config)
            if done.has_error:
                raise ValueError(f"{path}: colour space {space!r}: {done.geterror()}")
            return np.asarray(done.get_pixels(oiio.FLOAT), dtype=np.float32)
    raise ValueError(f"{path}: colour space {space!r} is not known; use auto, raw, sRGB or a USD colour space name")
