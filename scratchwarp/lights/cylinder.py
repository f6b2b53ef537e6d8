"""Cylinder light: the side of a round cylinder."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scratchwarp.lights import cylinder_device as device
from scratchwarp.lights.cylinder_arcs_device import arcs_cylinder, lit_cylinder
from scratchwarp.lights.model import LightModel, Packer, unit
from scratchwarp.scene.light import CylinderLight


def _pack(light: CylinderLight, packer: Packer) -> Mapping[str, Any]:
    half = float(np.linalg.norm(light.axis))
    return {
        "center": light.center,
        "ex": unit(light.axis),
        "ez": unit(light.forward),
        "radius": light.radius,
        "half_length": half,
        "size": 4.0 * np.pi * light.radius * half,
    }


CYLINDER = LightModel(
    "cylinder",
    CylinderLight,
    _pack,
    device.sample_cylinder,
    device.hit_cylinder,
    device.span_cylinder,
    arcs=arcs_cylinder,
    lit=lit_cylinder,
)
