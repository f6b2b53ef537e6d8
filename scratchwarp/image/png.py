"""A film as a picture to look at: 8-bit PNG through an OpenColorIO view."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio

from ..whole import whole
from .exr import put
from .layers import channels
from .view import View


def write(layers: Mapping[str, np.ndarray], path: Path, metadata: Mapping[str, Any], view: View) -> None:
    """Write ``color`` through ``view``, with straight alpha where ``alpha`` is anywhere below 1.

    A pixel that shines without covering anything (alpha 0, colour above 0) gets the alpha of its brightest channel, for
    straight alpha has no other way to keep its light. ValueError on NaN, OSError when the file cannot be written.
    """
    color = channels("color", layers["color"]).pixels
    if "alpha" in layers and float(np.min(layers["alpha"])) < 1:
        alpha = np.clip(channels("alpha", layers["alpha"]).pixels, 0, 1)
        alpha = np.where(alpha > 0, alpha, np.clip(color.max(-1, keepdims=True), 0, 1))
        shown = np.concatenate([view.apply(color / np.where(alpha > 0, alpha, 1)), alpha], axis=2)
    else:
        shown = view.apply(color)
    eight = np.rint(np.clip(shown, 0, 1) * 255).astype(np.uint8)
    height, width, count = eight.shape
    spec = oiio.ImageSpec(width, height, count, oiio.UINT8)
    spec.attribute("oiio:UnassociatedAlpha", 1)
    spec.attribute("Software", str(metadata.get("Software", "scratchwarp")))
    spec.attribute("Description", f"{view.display}, {view.view}")
    with whole(path) as draft:
        put(spec, eight, draft, path)
