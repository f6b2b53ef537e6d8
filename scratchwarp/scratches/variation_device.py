"""One scratch of a layer on the device: how wide and deep it is there, and which of the layer's tables stands for
it."""

import warp as wp

from ..optics.hash_device import pcg_hash, unit_float
from .layer_device import LayerHit

wp.set_module_options({"enable_backward": False})

WIDTH = wp.constant(wp.uint32(0x15EBCA6B))
DEPTH = wp.constant(wp.uint32(0x2545F491))
PROFILE = wp.constant(wp.uint32(0x632BE5AB))


@wp.struct
class VariationData:
    """How the scratches of a sublayer differ, and its tables: ``blends`` runs of ``aspects`` tables each."""

    aspects: int
    blends: int
    low: float  # wall angle of the first table
    scale: float  # tables a radian of wall angle
    aspect: float  # depth over width of the mean scratch
    depth: float  # relative variation
    own: int  # 1: scratches have aspects of their own


@wp.func
def along_scratch(scratch: wp.uint32, salt: wp.uint32, along: float) -> float:
    """A number in [0, 1] that belongs to a scratch and changes smoothly along it, ``along`` in wavelengths.

    A triangle wave of random phase with a wobble in its speed: over all scratches uniform at each place, so that what
    many scratches are on average does not depend on how any of them changes.
    """
    h = pcg_hash(scratch ^ salt)
    phase = unit_float(h)
    at = phase
    if along != 0.0:
        wobble = 2.0 * wp.pi * unit_float(pcg_hash(h))
        at += along + 0.06 * (wp.sin(4.0 * wp.pi * along + wobble) - wp.sin(wobble))
        at = at - wp.floor(at)
    return 1.0 - wp.abs(2.0 * at - 1.0)


@wp.func
def stretch(scratch: wp.uint32, along: float, variation: float) -> float:
    """Width of a scratch over the mean width."""
    return 1.0 + variation * (2.0 * along_scratch(scratch, WIDTH, along) - 1.0)


@wp.func
def drawn_stretch(u: float, variation: float, power: float) -> float:
    """Width over mean width of a scratch drawn by what it covers, width to the ``power`` 1 or 2."""
    low = wp.pow(1.0 - variation, power + 1.0)
    high = wp.pow(1.0 + variation, power + 1.0)
    return wp.pow(low + u * (high - low), 1.0 / (power + 1.0))


@wp.func
def varied_table(first: int, v: VariationData, hit: LayerHit, u: wp.uint32) -> int:
    """Table of the scratch that ``hit`` met: drawn from the nearest nodes by linear interpolation; ``u``: random
    bits."""
    table = first
    if v.aspects > 1:
        aspect = v.aspect / wp.max(hit.stretch, 1.0e-6)
        if v.own == 1 and hit.aspect >= 0.0:
            aspect = hit.aspect
        aspect *= 1.0 + v.depth * (2.0 * along_scratch(hit.scratch, DEPTH, hit.along) - 1.0)
        at = wp.clamp((wp.atan(2.0 * aspect) - v.low) * v.scale, 0.0, float(v.aspects - 1))
        table += wp.min(int(at + unit_float(u)), v.aspects - 1)
    if v.blends > 1:
        part = along_scratch(hit.scratch, PROFILE, hit.along) * float(v.blends - 1)
        table += v.aspects * wp.min(int(part + unit_float(pcg_hash(u))), v.blends - 1)
    return table
