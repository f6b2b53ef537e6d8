"""Layers to and from multi-layer OpenEXR."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio

from ..whole import whole
from .bounds import check_size, legible, one_line
from .layers import channels, gather

# ITU-R BT.709 primaries and the D65 white point: red, green, blue, white as (x, y).
CHROMATICITIES = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)


def write(
    layers: Mapping[str, np.ndarray],
    path: Path,
    metadata: Mapping[str, Any],
    window: tuple[int, int, int, int] | None,
    full_size: tuple[int, int] | None,
) -> None:
    """Write ``layers`` (name -> [h, w] or [h, w, 3]) as one part, zip compressed.

    ``window``: (xmin, xmax, ymin, ymax) in pixels from the top left, the maxima exclusive, that the arrays cover of an
    image of ``full_size`` (width, height); None: all of it. ValueError on NaN or ill-matched shapes, OSError when the
    file cannot be written.
    """
    parts = [channels(name, values) for name, values in layers.items()]
    shapes = {part.pixels.shape[:2] for part in parts}
    if len(shapes) != 1:
        raise ValueError(f"{path}: layers differ in size: {', '.join(f'{w} x {h}' for h, w in sorted(shapes))}")
    (height, width), names = shapes.pop(), [name for part in parts for name in part.names]
    spec = oiio.ImageSpec(width, height, len(names), oiio.FLOAT)
    spec.channelnames = tuple(names)
    spec.channelformats = tuple(oiio.TypeDesc("half" if part.half else "float") for part in parts for _ in part.names)
    if window is not None:
        x0, x1, y0, y1 = window
        if (x1 - x0, y1 - y0) != (width, height):
            raise ValueError(f"{path}: crop {window} does not match the {width} x {height} pixels of the film")
        spec.x, spec.y = x0, y0
    spec.full_x, spec.full_y = 0, 0
    spec.full_width, spec.full_height = full_size or (width, height)
    spec.attribute("compression", "zip")
    spec.attribute("chromaticities", "float[8]", CHROMATICITIES)
    for key, value in metadata.items():
        _attribute(spec, key, value)
    pixels = np.concatenate([part.pixels for part in parts], axis=2)
    with whole(path) as draft:
        put(spec, pixels, draft, path)


def put(spec: Any, pixels: np.ndarray, draft: Path, path: Path) -> None:
    """Write ``pixels`` to ``draft`` as ``spec`` says; OSError naming ``path``, the file it is for, when that fails."""
    output = oiio.ImageOutput.create(str(draft))
    if output is None:
        raise OSError(f"{path}: {oiio.geterror()}")
    good = output.open(str(draft), spec)
    good = good and output.write_image(np.ascontiguousarray(pixels))
    message = output.geterror()
    if not (output.close() and good):
        raise OSError(f"{path}: cannot be written ({(message or output.geterror()).replace(str(draft), str(path))})")


def read(path: Path) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Layers and header of an EXR file: name -> float32 [h, w] or [h, w, n]; OSError when it cannot be read,
    TooLarge (a ValueError) where it claims more than memory or its file can hold."""
    file = oiio.ImageInput.open(str(path))
    if file is None:
        raise OSError(f"{path}: {one_line(oiio.geterror)}")
    spec = file.spec()
    try:
        check_size(path, spec, None, spec.nchannels)
        pixels = file.read_image(oiio.FLOAT)
    finally:
        message = one_line(file.geterror)
        file.close()
    if pixels is None:
        raise OSError(f"{path}: {message}")
    layers = {}
    with legible(path):
        names, header = list(spec.channelnames), {a.name: a.value for a in spec.extra_attribs}
    for name, indices in gather(names).items():
        values = np.ascontiguousarray(pixels[..., indices], dtype=np.float32)
        layers[name] = values[..., 0] if len(indices) == 1 else values
    return layers, header


def _attribute(spec: Any, key: str, value: Any) -> None:
    """Set one header entry: text, whole number, number, 16 numbers (a matrix, row vectors), or any list of numbers.

    A whole number that a signed 32-bit entry cannot hold becomes text.
    """
    if isinstance(value, bool | int | np.integer):
        value = int(value) if -(2**31) <= int(value) < 2**31 else str(value)
    elif isinstance(value, float | np.floating):
        value = float(value)
    if isinstance(value, str | int | float):
        spec.attribute(key, value)
        return
    numbers = tuple(float(v) for v in np.asarray(value, dtype=np.float64).ravel())
    if numbers:
        spec.attribute(key, "matrix" if len(numbers) == 16 else f"float[{len(numbers)}]", numbers)
