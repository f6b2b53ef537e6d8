"""A uniform grid over the pattern plane: which strips lie in which cell."""

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.struct
class Strip:
    """An oriented box: points center + u along + v across (unit, perpendicular), |u| <= half[0], |v| <= half[1]."""

    center: wp.vec2d
    along: wp.vec2d
    half: wp.vec2d


@wp.struct
class Grid:
    """Cells of edge ``cell`` from ``origin``; those of cell (i, j) are ``items[starts[k]]`` on, k = first + j columns
    + i. ``first``: where its cells begin in ``starts``; several grids can share the arrays. ``halved`` 1: two strips to
    an item, 16 bits each, and ``starts`` counts strips.
    """

    origin: wp.vec2d
    cell: wp.float64
    columns: int
    rows: int
    first: int
    halved: int
    starts: wp.array(dtype=int)
    items: wp.array(dtype=int)


@wp.func
def cell_at(grid: Grid, axis: int, x: wp.float64) -> int:
    """Column (axis 0) or row (axis 1) of a coordinate, clamped to one before the first and one past the last."""
    last = wp.where(axis == 0, grid.columns, grid.rows)
    return int(wp.clamp(wp.floor((x - grid.origin[axis]) / grid.cell), wp.float64(-1.0), wp.float64(last)))


@wp.func
def item_at(grid: Grid, e: int) -> int:
    """Strip number ``e`` of those listed."""
    k = int(0)
    if grid.halved == 1:
        k = (grid.items[e >> 1] >> (16 * (e & 1))) & 0xFFFF
    else:
        k = grid.items[e]
    return k


@wp.func
def strip_in_cell(grid: Grid, strip: Strip, i: int, j: int) -> bool:
    """Whether a strip touches cell (i, j): no axis of either parts them."""
    half = wp.float64(0.5) * grid.cell
    x = strip.center[0] - grid.origin[0] - (wp.float64(i) + wp.float64(0.5)) * grid.cell
    y = strip.center[1] - grid.origin[1] - (wp.float64(j) + wp.float64(0.5)) * grid.cell
    c = wp.abs(strip.along[0])
    s = wp.abs(strip.along[1])
    slack = wp.float64(1.0 + 1e-9)
    apart = wp.abs(x) > slack * (half + strip.half[0] * c + strip.half[1] * s)
    apart = apart or wp.abs(y) > slack * (half + strip.half[0] * s + strip.half[1] * c)
    u = x * strip.along[0] + y * strip.along[1]
    v = y * strip.along[0] - x * strip.along[1]
    apart = apart or wp.abs(u) > slack * (strip.half[0] + half * (c + s))
    apart = apart or wp.abs(v) > slack * (strip.half[1] + half * (c + s))
    return not apart


@wp.func
def row_cells(grid: Grid, strip: Strip, j: int) -> wp.vec2i:
    """First and last column of row ``j``, within the grid, that a strip may touch."""
    c = wp.abs(strip.along[0])
    s = wp.abs(strip.along[1])
    y = grid.origin[1] + (wp.float64(j) + wp.float64(0.5)) * grid.cell - strip.center[1]
    # within the row y the strip's middle line is at x = y c / s, and reaches half of (row, width) beyond
    middle = strip.center[0]
    reach = wp.float64(1.0 + 1e-9) * (strip.half[0] * c + strip.half[1] * s)
    low = middle - reach
    high = middle + reach
    if s > wp.float64(1e-6):
        middle += y * strip.along[0] / strip.along[1]
        reach = wp.float64(1.0 + 1e-9) * (wp.float64(0.5) * grid.cell * c + strip.half[1]) / s
        low = wp.max(low, middle - reach)
        high = wp.min(high, middle + reach)
    return wp.vec2i(wp.max(cell_at(grid, 0, low), 0), wp.min(cell_at(grid, 0, high), grid.columns - 1))


@wp.func
def strip_cells(grid: Grid, strip: Strip) -> wp.vec4i:
    """First and last column, first and last row of a strip's bounding box, within the grid."""
    c = wp.abs(strip.along[0])
    s = wp.abs(strip.along[1])
    x = (wp.float64(1.0 + 1e-9)) * (strip.half[0] * c + strip.half[1] * s)
    y = (wp.float64(1.0 + 1e-9)) * (strip.half[0] * s + strip.half[1] * c)
    return wp.vec4i(
        wp.clamp(cell_at(grid, 0, strip.center[0] - x), 0, grid.columns - 1),
        wp.clamp(cell_at(grid, 0, strip.center[0] + x), 0, grid.columns - 1),
        wp.clamp(cell_at(grid, 1, strip.center[1] - y), 0, grid.rows - 1),
        wp.clamp(cell_at(grid, 1, strip.center[1] + y), 0, grid.rows - 1),
    )
