"""Lights: records to device structs, and what a kernel asks of them.

Files:
    light_device    Light, LightArrays, LightSample, LightHit, Span: what every light's device functions take and return
    model           LightModel: what a kind declares; Packer: what its host side writes into
    registry        MODELS: record class -> kind; a new light is its two files and a line there
    pack            pack(scene) -> PackedLights
    query           sample, hit, span, irradiance of one light over NumPy arrays; query_kernels: their kernels
    arcs_device     where exactly a scratch cone crosses a light (cylinder_arcs_device, too); quartic_device: roots
    lit_device      what lies along a direction that meets the light
    levels          smaller copies of a dome's image
    cap_device      scratch-cone intervals of caps (sphere, distant)
    polygon_device  solid angles and scratch-cone intervals of flat outlines (rect, disk, cylinder, mesh)
    spherical_rect_device  uniform sampling of the solid angle of a rectangle (rect, disk)
    cdf_device      cumulative distributions (dome, mesh)
    distant, sphere, rect, disk, cylinder, dome, mesh: each with its ``_device`` functions
"""

from scratchwarp.lights.model import LightModel
from scratchwarp.lights.pack import PackedLights, pack, pack_lights
from scratchwarp.lights.query import hit, irradiance, sample, span
from scratchwarp.lights.registry import MODELS

__all__ = ["MODELS", "LightModel", "PackedLights", "hit", "irradiance", "pack", "pack_lights", "sample", "span"]
