"""What maps make of a layer at a point: how much of it is there, and which way its scratches run.

Directions are averaged at twice their angle. What the average leaves of a unit vector, R, says how far directions
spread under the footprint; they are drawn from the wrapped normal distribution of that R, so that a highlight is as
wide from afar as the directions near by make it.

A pattern is laid in one of ``BINS`` directions near the local one, drawn with the weights of linear interpolation:
the scratches of a direction shade into those of the next, at most half a bin off the direction that they reflect by.
"""

import warp as wp

from ..optics.hash_device import pcg_hash, unit_float
from ..reflectance.pyramid_device import Pyramids, averaged
from ..scratches.layer_device import LayerData, random_bits
from .geometry_device import Geometry, Surface

wp.set_module_options({"enable_backward": False})

BINS = wp.constant(32)


@wp.struct
class LayerMaps:
    """Maps of one sublayer: pyramids of textures and rows of primvars, -1 for none."""

    mask: int
    mask_primvar: int
    orientation: int
    orientation_primvar: int
    cos_a: float  # direction of the sublayer, by which the map's is turned further
    sin_a: float


@wp.struct
class MapSet:
    """Maps of the sublayers that have any; ``LayerData.maps`` is their place here."""

    layers: wp.array(dtype=LayerMaps)
    pyramids: Pyramids
    masks: wp.array2d(dtype=float)  # [primvar, corner]
    directions: wp.array2d(dtype=wp.vec2)  # [primvar, corner], at twice the angle from dP/du


@wp.func
def masked(maps: MapSet, index: int, s: Surface, jx: wp.vec2, jy: wp.vec2, phase: float) -> float:
    """What masks leave of a sublayer, in [0, 1]; ``index``: its maps, -1 for none."""
    left = float(1.0)
    if index < 0:
        return left
    m = maps.layers[index]
    if m.mask >= 0:
        left = wp.clamp(averaged(maps.pyramids, m.mask, s.uv, jx, jy, phase).value[0], 0.0, 1.0)
    if m.mask_primvar >= 0:
        c = 3 * s.face
        row = m.mask_primvar
        value = s.bary[0] * maps.masks[row, c] + s.bary[1] * maps.masks[row, c + 1] + s.bary[2] * maps.masks[row, c + 2]
        left *= wp.clamp(value, 0.0, 1.0)
    return left


@wp.func
def oriented(maps: MapSet, index: int, s: Surface, jx: wp.vec2, jy: wp.vec2, phase: float) -> wp.vec2:
    """Direction of a sublayer's scratches as (cos, sin) of the angle from dP/du; (0, 0) where no map turns it."""
    result = wp.vec2(0.0, 0.0)
    if index < 0:
        return result
    m = maps.layers[index]
    if m.orientation >= 0 or m.orientation_primvar >= 0:
        two = wp.vec2(0.0, 0.0)
        spread = float(0.0)
        if m.orientation_primvar >= 0:
            c = 3 * s.face
            row = m.orientation_primvar
            two = (
                s.bary[0] * maps.directions[row, c]
                + s.bary[1] * maps.directions[row, c + 1]
                + s.bary[2] * maps.directions[row, c + 2]
            )
        else:
            found = averaged(maps.pyramids, m.orientation, s.uv, jx, jy, phase)
            two = wp.vec2(found.value[0], found.value[1])
            r = wp.clamp(wp.length(two), 1.0e-6, 1.0)
            spread = wp.sqrt(-2.0 * wp.log(r)) * found.coarse
        bits = pcg_hash(random_bits(phase) ^ wp.uint32(0x1B873593))
        normal = wp.sqrt(-2.0 * wp.log(1.0 - unit_float(bits))) * wp.cos(2.0 * wp.pi * unit_float(pcg_hash(bits)))
        angle = float(0.0)
        if two[0] != 0.0 or two[1] != 0.0:
            angle = 0.5 * (wp.atan2(two[1], two[0]) + spread * normal)
        x = wp.cos(angle)
        y = wp.sin(angle)
        result = wp.vec2(m.cos_a * x - m.sin_a * y, m.cos_a * y + m.sin_a * x)
    return result


@wp.func
def in_pattern(g: Geometry, s: Surface, along: wp.vec3, flip: wp.vec2d) -> wp.vec2:
    """A direction on the surface as a unit vector in pattern space."""
    du = g.dpdu[s.face]
    dv = g.dpdv[s.face]
    # du and dv need not be at right angles: along = a du + b dv
    normal = wp.cross(du, dv)
    a = wp.dot(wp.cross(along, dv), normal) * float(flip[0])
    b = wp.dot(wp.cross(du, along), normal) * float(flip[1])
    longest = wp.max(wp.abs(a), wp.abs(b))
    result = wp.vec2(1.0, 0.0)
    if longest > 0.0:
        result = wp.normalize(wp.vec2(a / longest, b / longest))
    return result


@wp.func
def laid_along(layer: LayerData, direction: wp.vec2, u: float) -> LayerData:
    """The layer with its pattern laid in one of the directions next to ``direction`` (pattern space)."""
    turned = layer
    turn = wp.atan2(direction[1], direction[0]) / wp.pi * float(BINS)
    bin = int(wp.floor(turn + u)) % BINS
    if bin < 0:
        bin += BINS
    angle = float(bin) * wp.pi / float(BINS)
    turned.cos_a = wp.cos(angle)
    turned.sin_a = wp.sin(angle)
    turned.seed = pcg_hash(layer.seed + wp.uint32(bin))
    return turned


@wp.func
def follow(hit: wp.vec2, laid: LayerData, direction: wp.vec2) -> wp.vec2:
    """``direction``, turned by as much as the pattern's own curves turn ``hit`` out of the direction it is laid in."""
    along = hit[0] * laid.cos_a + hit[1] * laid.sin_a
    aside = hit[1] * laid.cos_a - hit[0] * laid.sin_a
    return wp.vec2(along * direction[0] - aside * direction[1], along * direction[1] + aside * direction[0])
