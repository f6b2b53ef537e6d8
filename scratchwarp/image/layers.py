"""Which channels a layer of an image has and at which precision they are kept.

A layer is a named array: [h, w] with one channel, or [h, w, 3]. ``color`` and ``alpha`` become R G B A, every other
layer ``name.R`` and so on; positions, directions and normals end in X Y Z.
"""

from dataclasses import dataclass

import numpy as np

HALF_MAX = 65504.0

# Layers whose three numbers are a vector, and layers that half precision would spoil.
_VECTORS = ("normal", "P", "scratchDirection", "tangent")
_FLOATS = ("depth", "P", "primId", "spp", "scratchCount", "footprint", "variance")
# Layers that may hold inf where the camera sees nothing.
_MAY_BE_INFINITE = ("depth", "P")


@dataclass(frozen=True, eq=False)
class Channels:
    """One layer ready to be written: channel names, half or float, and pixels of shape [h, w, len(names)], float32."""

    names: tuple[str, ...]
    half: bool
    pixels: np.ndarray


def channels(layer: str, values: np.ndarray) -> Channels:
    """The channels of one layer.

    Colours and normals are half, unless they hold values beyond 65504, the largest half; depth, positions and counts
    are float. ValueError naming the layer and pixel (x, y from the top left) on a NaN, on an inf where the layer has no
    use for one, and on a shape that is neither [h, w] nor [h, w, 3].
    """
    pixels = np.asarray(values)
    if pixels.ndim == 2:
        pixels = pixels[..., None]
    if pixels.ndim != 3 or pixels.shape[2] not in (1, 3) or 0 in pixels.shape:
        raise ValueError(f"layer {layer!r} has shape {list(np.shape(values))}, expected [h, w] or [h, w, 3]")
    pixels = pixels.astype(np.float32)
    check(layer, pixels)
    half = layer not in _FLOATS and (pixels.shape[2] == 3 or layer == "alpha")
    return Channels(_names(layer, pixels.shape[2]), half and float(np.abs(pixels).max()) <= HALF_MAX, pixels)


def check(layer: str, values: np.ndarray) -> None:
    """ValueError naming the layer and pixel of the first NaN, or inf where the layer has no use for one."""
    if values.dtype.kind != "f":
        return
    bad = np.isnan(values) if layer in _MAY_BE_INFINITE else ~np.isfinite(values)
    if bad.any():
        place = tuple(int(i) for i in np.argwhere(bad)[0])
        where = f"pixel (x {place[1]}, y {place[0]})" if len(place) > 1 else f"index {place[0]}"
        count = int(bad.any(-1).sum()) if values.ndim == 3 else int(bad.sum())
        raise ValueError(f"layer {layer!r} is {values[place]} at {where}, {count} places in all; nothing was written")


def gather(names: list[str]) -> dict[str, list[int]]:
    """The inverse of ``channels`` for the names of a file: layer -> indices of its channels in order R G B or X Y Z."""
    layers: dict[str, dict[str, int]] = {}
    for index, name in enumerate(names):
        layer, _, part = name.rpartition(".")
        if not layer:
            layer, part = ("color", name) if name in ("R", "G", "B") else ("alpha" if name == "A" else name, "")
        layers.setdefault(layer, {})[part] = index
    order = "RXUGYVBZWA"
    return {k: [i for _, i in sorted(v.items(), key=lambda item: order.find(item[0]))] for k, v in layers.items()}


def _names(layer: str, count: int) -> tuple[str, ...]:
    if layer == "color":
        return ("R", "G", "B")
    if layer == "alpha":
        return ("A",)
    if layer == "depth":
        return ("depth.Z",)
    if count == 1:
        return (layer,)
    return tuple(f"{layer}.{part}" for part in ("XYZ" if layer in _VECTORS else "RGB"))
