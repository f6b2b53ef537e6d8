"""Rect light: a parallelogram with an image."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scratchwarp.lights import rect_device as device
from scratchwarp.lights.arcs_device import arcs_rect
from scratchwarp.lights.lit_device import lit_rect
from scratchwarp.lights.model import LightModel, Packer, reciprocal, unit
from scratchwarp.scene.light import RectLight

_SMALL = 0.02  # [sr]; the spherical map's angles, of error 5e-7, then place a point within 3e-5 of the edge length


def _pack(light: RectLight, packer: Packer) -> Mapping[str, Any]:
    rx, ry, area = reciprocal(light.ex, light.ey)
    sheared = abs(light.ex @ light.ey) > 1e-5 * np.linalg.norm(light.ex) * np.linalg.norm(light.ey)
    return {
        "center": light.center,
        "ex": light.ex,
        "ey": light.ey,
        "ez": unit(light.normal),
        "rx": rx,
        "ry": ry,
        "size": 4.0 * area,
        "half_angle": np.inf if sheared else _SMALL,
        "texture": packer.image(light.texture),
    }


RECT = LightModel(
    "rect", RectLight, _pack, device.sample_rect, device.hit_rect, device.span_rect, arcs=arcs_rect, lit=lit_rect
)
