"""Disk light: an ellipse."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scratchwarp.lights import disk_device as device
from scratchwarp.lights.arcs_device import arcs_disk
from scratchwarp.lights.lit_device import lit_disk
from scratchwarp.lights.model import LightModel, Packer, reciprocal, unit
from scratchwarp.scene.light import DiskLight


def _pack(light: DiskLight, packer: Packer) -> Mapping[str, Any]:
    # the ellipse's own axes are orthogonal also where a sheared transform's images of X and Y are not
    _, lengths, axes = np.linalg.svd(np.stack([light.ex, light.ey]), full_matrices=False)
    ex, ey = lengths[:, None] * axes
    rx, ry, area = reciprocal(ex, ey)
    return {
        "center": light.center,
        "ex": ex,
        "ey": ey,
        "ez": unit(light.normal),
        "rx": rx,
        "ry": ry,
        "size": np.pi * area,
    }


DISK = LightModel(
    "disk", DiskLight, _pack, device.sample_disk, device.hit_disk, device.span_disk, arcs=arcs_disk, lit=lit_disk
)
