"""UsdUVTexture with its primvar reader and transform, to TextureInput."""

from typing import Any

import numpy as np
from pxr import Sdf, Usd, UsdShade

from scratchwarp.scene import TextureInput
from scratchwarp.scene.texture import CHANNELS, WRAPS

from .color import space_of
from .reading import Reading, fits
from .shader_input import constant, is_output, source_of
from .texture import Textures


def read_texture_input(
    reading: Reading, node: UsdShade.Shader, output: str, default: Any, textures: Textures, automatic: str = "auto"
) -> Any:
    """A TextureInput for ``output`` (rgb, r, g, b, a) of a UsdUVTexture.

    ``automatic``: colour space of an image whose sourceColorSpace is auto and whose file attribute has none.

    When the image cannot be read: the authored ``fallback`` of that output, else ``default``. Wrapping that is not
    authored is ``repeat``; ``useMetadata`` is ``black``, as UsdPreviewSurface has it for files without metadata.
    """
    path = node.GetPath()
    if output not in CHANNELS:
        reading.warn(path, f"outputs:{output} is none of a UsdUVTexture; the input's default is used")
        return default
    file = source_of(node, "file")
    asset = constant(reading, file, Sdf.AssetPath()) if file else None
    space = _space(reading, node, file)
    index = textures.index(path, asset, automatic if space == "auto" else space)
    is_color = isinstance(default, tuple)
    if index < 0:
        fallback = _get(reading, node, "fallback", None)
        if fallback is not None and not fits(fallback, (0.0, 0.0, 0.0, 1.0)):
            fallback = None
        if fallback is None:
            return default
        if is_color and output == "rgb":
            return tuple(float(v) for v in fallback)[:3]
        value = float(fallback["rgba".index(output) if output != "rgb" else 0])
        return (value, value, value) if is_color else value
    uv_set, transform = _coordinates(reading, node)
    scale, bias = _numbers(reading, node, "scale", 1.0), _numbers(reading, node, "bias", 0.0)
    return TextureInput(
        texture=index,
        channel=output,
        scale=scale,
        bias=bias,
        wrap_s=_wrap(reading, node, "wrapS"),
        wrap_t=_wrap(reading, node, "wrapT"),
        transform=transform,
        uv_set=uv_set,
    )


def _get(reading: Reading, node: UsdShade.Shader, name: str, otherwise: Any = None) -> Any:
    source = source_of(node, name)
    return otherwise if source is None or is_output(source) else constant(reading, source, otherwise)


def _numbers(reading: Reading, node: UsdShade.Shader, name: str, otherwise: float) -> np.ndarray:
    """A float4 input, finite."""
    values = np.array(_get(reading, node, name, (otherwise,) * 4), np.float64)
    if np.isfinite(values).all():
        return values
    reading.warn(node.GetPath(), f"inputs:{name} is {tuple(values.tolist())}; {otherwise:g} is used")
    return np.full(4, otherwise)


def _space(reading: Reading, node: UsdShade.Shader, file: Usd.Attribute | None) -> str:
    """sourceColorSpace, unless it is auto and the file attribute says more by itself."""
    space = str(_get(reading, node, "sourceColorSpace", "auto"))
    if space == "auto" and file is not None:
        return space_of(file) or "auto"
    return space


def _wrap(reading: Reading, node: UsdShade.Shader, name: str) -> str:
    wrap = str(_get(reading, node, name, "repeat"))
    if wrap == "useMetadata":
        return "black"
    if wrap not in WRAPS:
        reading.warn(node.GetPath(), f"inputs:{name} is {wrap!r}; repeat is used")
        return "repeat"
    return wrap


def _coordinates(reading: Reading, node: UsdShade.Shader) -> tuple[str, np.ndarray]:
    """(uv set, matrix [2, 3]) of the nodes behind ``inputs:st``; transforms may follow one another."""
    matrix = np.eye(3)
    seen: set = set()
    current, name = node, "st"
    while True:
        source = source_of(current, name)
        if source is None or not is_output(source):
            if source is not None:
                reading.warn(current.GetPath(), f"a constant inputs:{name} is not honoured; primvars:st is used")
            return "st", matrix[:2]
        current = UsdShade.Shader(source.GetPrim())
        kind = str(current.GetShaderId() or "")
        if kind == "UsdPrimvarReader_float2":
            return str(_get(reading, current, "varname", "st") or "st"), matrix[:2]
        if kind != "UsdTransform2d" or current.GetPath() in seen:
            reading.warn(node.GetPath(), f"texture coordinates from {kind or source.GetPath()}; primvars:st is used")
            return "st", matrix[:2]
        seen.add(current.GetPath())
        matrix = matrix @ _transform(reading, current)
        name = "in"


def _transform(reading: Reading, node: UsdShade.Shader) -> np.ndarray:
    """UsdTransform2d: scale, then rotate counter-clockwise [degrees], then translate."""
    sx, sy = (float(v) for v in _get(reading, node, "scale", (1.0, 1.0)))
    tx, ty = (float(v) for v in _get(reading, node, "translation", (0.0, 0.0)))
    turn = np.radians(float(_get(reading, node, "rotation", 0.0)))
    if not np.isfinite((sx, sy, tx, ty, turn)).all():
        reading.warn(node.GetPath(), "its inputs are not finite; it is ignored")
        return np.eye(3)
    c, s = np.cos(turn), np.sin(turn)
    return np.array([[c * sx, -s * sy, tx], [s * sx, c * sy, ty], [0.0, 0.0, 1.0]])
