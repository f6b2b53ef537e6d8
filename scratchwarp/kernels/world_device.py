"""What a render kernel reads, one struct a concept: the lights and the scratches of a scene."""

import warp as wp

from ..lights.light_device import Light, LightArrays
from ..reflectance.profile_table_device import TableArrays
from ..reflectance.responses.response_device import ResponseArrays
from ..scratches.curves_device import SegmentArrays
from ..scratches.layer_device import LayerData
from ..scratches.variation_device import VariationData
from .glint_arrays_device import GlintArrays
from .groove_arrays_device import GrooveArrays
from .highlights_device import HighlightArrays
from .maps_device import MapSet

wp.set_module_options({"enable_backward": False})


@wp.struct
class LightSet:
    """All lights, sorted by kind: those of kind j are ``lights[starts[j] .. starts[j + 1]]``."""

    lights: wp.array(dtype=Light)
    starts: wp.array(dtype=int)
    links: wp.array2d(dtype=wp.uint8)  # [light, instance]: 1 where the light lights the instance
    arrays: LightArrays
    taps: int  # look-ups along a cone into a light that is not even
    tap_width: float  # share of their distance over which an image is averaged
    highlights: HighlightArrays  # where they are mirrored in spots smaller than a pixel


@wp.struct
class ScratchSet:
    """All sublayers, the segments of explicit ones, the profile tables and responses they reflect by, and what of them
    diffracts."""

    layers: wp.array(dtype=LayerData)
    variations: wp.array(dtype=VariationData)  # of each layer, where scratches of some layer differ
    maps: MapSet  # of each layer, where some layer has any
    segments: SegmentArrays
    tables: TableArrays
    responses: ResponseArrays
    glints: GlintArrays
    grooves: GrooveArrays  # those laid out one by one
