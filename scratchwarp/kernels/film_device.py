"""Sums that the kernel leaves for each pixel."""

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.struct
class FilmArrays:
    """Sums over samples, shape [h, w] of the rendered window."""

    color: wp.array2d(dtype=wp.vec3)
    base: wp.array2d(dtype=wp.vec3)
    scratches: wp.array2d(dtype=wp.vec3)
    square: wp.array2d(dtype=float)  # of the luminance, for the variance
    albedo: wp.array2d(dtype=wp.vec3)
    normal: wp.array2d(dtype=wp.vec3)
    position: wp.array2d(dtype=wp.vec3)
    depth: wp.array2d(dtype=float)
    alpha: wp.array2d(dtype=float)
    hits: wp.array2d(dtype=int)
    nearest: wp.array2d(dtype=float)
    instance: wp.array2d(dtype=int)  # of the nearest hit
    rays: wp.array2d(dtype=int)
    invalid: wp.array2d(dtype=int)  # samples that were not finite


@wp.struct
class Window:
    """The pixels of one launch: the window's corner in the image, the tile in the window, and the samples."""

    x0: int
    y0: int
    tile_x: int
    tile_y: int
    tile_w: int
    tile_h: int
    first: int
    count: int
    seed: wp.uint32
    filter_width: float
    max_depth: int
