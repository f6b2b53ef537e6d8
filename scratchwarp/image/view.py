"""Scene-linear pixels through a named OpenColorIO view.

The configuration is one that OpenColorIO carries inside, named with its version, so that a picture looks the same on
every machine; ``$OCIO`` is looked at only when ``openColorIO`` is asked for.
"""

import os
from dataclasses import dataclass

import numpy as np
import OpenImageIO as oiio

BUILTIN = "ocio://cg-config-v1.0.0_aces-v1.3_ocio-v2.1"
MODES = ("disabled", "sRGB", "openColorIO")


@dataclass(frozen=True)
class View:
    """An OpenColorIO display and view of a configuration; empty display or view: the configuration's default."""

    display: str = "sRGB - Display"
    view: str = "Un-tone-mapped"
    config: str = BUILTIN

    def apply(self, pixels: np.ndarray) -> np.ndarray:
        """Linear Rec.709 pixels [h, w, 3] to display values [h, w, 3], float32, not clamped.

        ValueError naming the display, view or configuration that OpenColorIO does not know.
        """
        colors = oiio.ColorConfig(self.config)
        if colors.geterror():
            raise ValueError(f"OpenColorIO configuration {self.config!r} cannot be read")
        display = self.display or colors.getDefaultDisplayName()
        known = list(colors.getDisplayNames())
        if display not in known:
            raise ValueError(f"OpenColorIO display {display!r} is not one of {', '.join(known)}")
        view = self.view or colors.getDefaultViewName(display)
        known = list(colors.getViewNames(display))
        if view not in known:
            raise ValueError(f"OpenColorIO view {view!r} of display {display!r} is not one of {', '.join(known)}")
        source = oiio.ImageBuf(np.ascontiguousarray(pixels, dtype=np.float32))
        linear = colors.resolve("lin_rec709_scene")
        shown = oiio.ImageBufAlgo.ociodisplay(source, display, view, fromspace=linear, colorconfig=self.config)
        if shown.has_error:
            raise ValueError(f"OpenColorIO display {display!r}, view {view!r}: {shown.geterror()}")
        return np.asarray(shown.get_pixels(oiio.FLOAT), dtype=np.float32)


SRGB = View()
LINEAR = View(view="Raw")


def color_view(mode: str = "sRGB", display: str = "", view: str = "") -> View:
    """The view that usdrecord's colour correction mode names.

    ``disabled``: linear values as they are; ``sRGB``: the sRGB curve without tone mapping; ``openColorIO``: ``display``
    and ``view`` (empty: the default) of the configuration in ``$OCIO``, or of the built-in ACES one without it.
    """
    if mode not in MODES:
        raise ValueError(f"colorCorrectionMode is {mode!r}, expected one of {', '.join(MODES)}")
    if mode != "openColorIO" and (display or view):
        raise ValueError(f"a display or view needs colorCorrectionMode openColorIO, not {mode!r}")
    if mode == "openColorIO":
        return View(display, view, os.environ.get("OCIO") or BUILTIN)
    return SRGB if mode == "sRGB" else LINEAR
