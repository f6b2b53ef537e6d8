"""Texture look-up on the device: all images of a scene in one array of texels."""

import warp as wp


@wp.struct
class TextureAtlas:
    """``texels``: all images, row by row, row 0 at the top; image i starts at ``offset[i]`` and is ``width[i]`` by
    ``height[i]`` texels."""

    texels: wp.array[wp.vec4]
    offset: wp.array[int]
    width: wp.array[int]
    height: wp.array[int]


@wp.func
def wrap_texel(i: int, size: int, wrap: int) -> int:
    """Texel index of ``i`` under a wrap mode (0 black, 1 clamp, 2 repeat, 3 mirror); -1: black."""
    result = i
    if wrap == 2:
        result = i % size
        if result < 0:
            result += size
    elif wrap == 3:
        period = 2 * size
        folded = i % period
        if folded < 0:
            folded += period
        result = wp.where(folded < size, folded, period - 1 - folded)
    elif wrap == 1:
        result = wp.clamp(i, 0, size - 1)
    elif i < 0 or i >= size:
        result = -1
    return result


@wp.func
def texel(atlas: TextureAtlas, index: int, column: int, row: int, wrap_s: int, wrap_t: int) -> wp.vec4:
    """One texel of image ``index``; ``row`` counts from the top; zero where the wrap mode is black."""
    width = atlas.width[index]
    x = wrap_texel(column, width, wrap_s)
    y = wrap_texel(row, atlas.height[index], wrap_t)
    value = wp.vec4(0.0, 0.0, 0.0, 0.0)
    if x >= 0 and y >= 0:
        value = atlas.texels[atlas.offset[index] + y * width + x]
    return value


@wp.func
def reduce_coordinate(s: float, wrap: int) -> float:
    """``s`` brought near [0, 1] for its wrap mode, so that far coordinates keep their digits and fit an integer."""
    result = wp.clamp(s, -1.0, 2.0)
    if wrap == 2:
        result = s - wp.floor(s)
    elif wrap == 3:
        result = s - 2.0 * wp.floor(0.5 * s)
    return wp.where(wp.isfinite(s), result, 0.0)


@wp.func
def texel_bilinear(atlas: TextureAtlas, index: int, uv: wp.vec2, wrap_s: int, wrap_t: int) -> wp.vec4:
    """Bilinear value of image ``index`` at ``uv``: v up, (0, 0) the lower left corner, texel centres at half-integers.

    ``wrap_s``, ``wrap_t``: 0 black, 1 clamp, 2 repeat, 3 mirror (positions in ``scene.texture.WRAPS``).
    """
    x = reduce_coordinate(uv[0], wrap_s) * float(atlas.width[index]) - 0.5
    y = (1.0 - reduce_coordinate(uv[1], wrap_t)) * float(atlas.height[index]) - 0.5
    left = wp.floor(x)
    top = wp.floor(y)
    fx = x - left
    fy = y - top
    i = int(left)
    j = int(top)
    upper = wp.lerp(texel(atlas, index, i, j, wrap_s, wrap_t), texel(atlas, index, i + 1, j, wrap_s, wrap_t), fx)
    j += 1
    lower = wp.lerp(texel(atlas, index, i, j, wrap_s, wrap_t), texel(atlas, index, i + 1, j, wrap_s, wrap_t), fx)
    return wp.vec4(wp.lerp(upper, lower, fy))
