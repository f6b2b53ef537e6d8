"""What every distribution takes and returns.

Pattern space: the plane in which a layer is laid out, (u, v) of the surface in micrometres (space surface) or in
fractions of the uv square (space uv). Positions there are float64: a metre holds 10^6 micrometres and float32 would
round a scratch away.
"""

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.struct
class LayerData:
    """One sublayer. Lengths in pattern units; see ``kernels.material.pack_layer`` for where each value comes from."""

    kind: int  # position in scratches.KINDS
    uv_space: int  # 1: pattern space is the uv square
    cos_a: float  # direction of the scratches in pattern space
    sin_a: float
    inv_length: wp.float64  # cells a pattern unit along the scratch
    inv_width: wp.float64  # cells a pattern unit across
    radius: float  # threshold d of Eq. 7, in cells
    width_variation: float  # relative, uniform in 1 -+ this
    offset: wp.vec2d  # cells
    seed: wp.uint32
    width: wp.float64  # regular patterns: scratch width and distance
    pitch: wp.float64
    center: wp.vec2d  # uv
    bend: wp.float64  # amplitude of the sideways wave that curves the scratches
    bend_number: wp.float64  # its wave number, radians a pattern unit
    mean: float  # coverage of a large footprint
    table: int  # profile table, -1 for a diffuse scratch
    keeps_diffuse: int  # 1: the base's diffuse term shines through the scratch
    diffuse: wp.vec3  # albedo of a diffuse scratch
    weight: float  # estimated reflectance, for choosing among lobes
    first: int  # curves: first segment
    bvh: wp.uint64  # curves: hierarchy over the segments
    reach: float  # curves: how far from its box a segment's strip may lie
    curve_uv: int  # curves: 1 when segments lie in the uv square
    width_uv: int  # curves: 1 when half widths are fractions of it
    response: int  # what it reflects by in place of a table, -1: nothing
    f0: wp.vec3  # F0 of the table, where a textured base has its own at each point; else 0
    maps: int  # masks and directions of the layer in ``kernels.maps_device``, -1: none
    near: int  # 1: laid out groove by groove where it is near, and left out there
    varied: int  # 1: scratches differ from one another
    wave: float  # wavelengths of the variation along a scratch in a pattern unit; 0: none


@wp.struct
class LayerHit:
    """Covered fraction of the footprint, and the unit direction of the scratches there, in pattern space.

    Where scratches vary, also one of them drawn by what it covers: ``scratch`` its hash, ``along`` where on it in
    wavelengths of its variation, ``stretch`` its width there over the mean width; ``aspect``, of explicit scratches,
    its depth over width.
    """

    alpha: float
    direction: wp.vec2
    scratch: wp.uint32
    along: float
    stretch: float
    aspect: float


@wp.func
def longer(a: wp.vec2, b: wp.vec2) -> wp.vec2:
    """The longer of two vectors."""
    result = a
    if wp.dot(b, b) > wp.dot(a, a):
        result = b
    return result


@wp.func
def random_bits(phase: float) -> wp.uint32:
    """Random bits from a random number in [0, 1)."""
    return wp.uint32(wp.clamp(phase, 0.0, 0.9999999) * 4294967040.0)
