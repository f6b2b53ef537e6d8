"""Images averaged over a footprint: look-up in pyramids, along the footprint's longer axis at random.

A footprint is a parallelogram. Its shorter edge chooses the level; along the longer one a place is drawn, so that over
samples the mean is that of the parallelogram, without the blur of a square around it.
"""

import warp as wp

from .texture_device import TextureAtlas, texel_bilinear

wp.set_module_options({"enable_backward": False})

# A footprint longer than this many widths is averaged over squares of its length over this.
LONGEST = wp.constant(16.0)


@wp.struct
class Pyramids:
    """Images of all levels in one atlas; pyramid i is images ``first[i]`` to ``first[i] + levels[i] - 1``."""

    atlas: TextureAtlas
    first: wp.array(dtype=int)
    levels: wp.array(dtype=int)


@wp.struct
class Averaged:
    """The mean value, and whether it is one of several texels: 0 under footprints of a quarter of a texel, 1 from three
    quarters on."""

    value: wp.vec4
    coarse: float


@wp.func
def averaged(p: Pyramids, index: int, uv: wp.vec2d, jx: wp.vec2, jy: wp.vec2, u: float) -> Averaged:
    """Mean of pyramid ``index``, repeating, over the parallelogram of edges ``jx``, ``jy`` about ``uv``; ``u`` in
    [0, 1) draws the place along its longer axis."""
    first = p.first[index]
    size = wp.vec2(float(p.atlas.width[first]), float(p.atlas.height[first]))
    tx = wp.length(wp.cw_mul(jx, size))
    ty = wp.length(wp.cw_mul(jy, size))
    long = jx
    if ty > tx:
        long = jy
    width = wp.max(wp.min(tx, ty), wp.max(tx, ty) / LONGEST)
    shift = u - 0.5
    x = uv[0] + wp.float64(shift * long[0])
    y = uv[1] + wp.float64(shift * long[1])
    at = wp.vec2(float(x - wp.floor(x)), float(y - wp.floor(y)))
    level = wp.clamp(wp.log2(wp.max(width, 1.0e-6)), 0.0, float(p.levels[index] - 1))
    lower = int(level)
    part = level - float(lower)
    result = Averaged()
    result.value = texel_bilinear(p.atlas, first + lower, at, 2, 2)
    if part > 0.0:
        result.value = wp.lerp(result.value, texel_bilinear(p.atlas, first + lower + 1, at, 2, 2), part)
    result.coarse = wp.clamp(2.0 * width - 0.5, 0.0, 1.0)
    return result
