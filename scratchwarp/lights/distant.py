"""Distant light: the cap of directions within half its angle."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scratchwarp.lights import distant_device as device
from scratchwarp.lights.arcs_device import arcs_distant
from scratchwarp.lights.lit_device import lit_distant
from scratchwarp.lights.model import LightModel, Packer, unit
from scratchwarp.scene.light import DistantLight


def _pack(light: DistantLight, packer: Packer) -> Mapping[str, Any]:
    half = light.angle / 2.0
    return {
        "center": -unit(light.direction),
        "half_angle": half,
        "size": 4.0 * np.pi * np.sin(half / 2.0) ** 2,
        "delta": int(half < 1e-6),  # below, directions in the cap differ by less than float32 resolves
        **({"radiance": light.radiance * np.pi * np.sin(half) ** 2} if 0.0 < half < 1e-6 else {}),
    }


DISTANT = LightModel(
    "distant",
    DistantLight,
    _pack,
    device.sample_distant,
    device.hit_distant,
    device.span_distant,
    arcs=arcs_distant,
    lit=lit_distant,
)
