"""What model normalMap of a scratch layer reads, to NormalMap."""

from collections.abc import Callable
from typing import Any

import numpy as np

from scratchwarp.scene import NormalMap

from .reading import Reading
from .texture import Textures


def read_normal_map(
    reading: Reading, where: str, get: Callable[[str], Any], textures: Textures | None
) -> NormalMap | None:
    """The map of a layer of model normalMap whose attributes ``get`` reads; None without an image.

    One that another model leaves unread gives a warning that names ``where``. Raises ValueError on values that none can
    have.
    """
    asset = get("normalTexture")
    if textures is None or not (asset and asset.path):
        return None
    if str(get("model")) != "normalMap":
        reading.warn(where, "its normalTexture is read by model normalMap alone")
        return None
    index = textures.index(where, asset, "raw")
    if index < 0:
        return None
    along, across = (float(np.clip(v, 1e-3, 1.0)) for v in get("facetRoughness"))
    u, v = (float(value) for value in get("normalRepeats"))
    try:
        return NormalMap(
            texture=index,
            repeats=(u, v),
            strength=float(get("normalStrength")),
            deformation=str(get("normalDeformation")),
            facets=str(get("facets")),
            roughness=(along, across),
        )
    except ValueError as error:
        raise ValueError(f"{where}: {error}") from None
