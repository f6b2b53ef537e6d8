"""Sphere light, or a point."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scratchwarp.lights import sphere_device as device
from scratchwarp.lights.arcs_device import arcs_sphere
from scratchwarp.lights.lit_device import lit_sphere
from scratchwarp.lights.model import LightModel, Packer, unit
from scratchwarp.scene.light import SphereLight


def _pack(light: SphereLight, packer: Packer) -> Mapping[str, Any]:
    return {
        "center": light.center,
        "radius": light.radius,
        "ez": unit(light.axis),
        "size": 4.0 * np.pi * light.radius**2,
        "delta": int(light.point or light.radius == 0.0),
    }


SPHERE = LightModel(
    "sphere",
    SphereLight,
    _pack,
    device.sample_sphere,
    device.hit_sphere,
    device.span_sphere,
    arcs=arcs_sphere,
    lit=lit_sphere,
)
