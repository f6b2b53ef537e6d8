"""Lights: records to device structs, and what a kernel asks of them.

Files:
    light_device    Light, LightArrays, LightSample, LightHit, Span: what every light's device functions take and return
    model           LightModel: what a kind declares; Packer: what its host side writes into
    registry        MODELS: record class -> kind; a new light is its two files and a line there
    pack            pack(scene) -> PackedLights
    cap_device      cone samples and scratch-cone intervals of caps (sphere, distant)
    polygon_device  solid angles and scratch-cone intervals of flat outlines (rect, disk, cylinder)
    distant, sphere, rect, dome: each with its ``_device`` functions
"""

from scratchwarp.lights.model import LightModel
from scratchwarp.lights.pack import PackedLights, pack, pack_lights
from scratchwarp.lights.registry import MODELS

__all__ = ["MODELS", "LightModel", "PackedLights", "pack", "pack_lights"]
