"""The pieces that a footprint needs, found in a grid over the plane."""

import warp as wp

from ...scratches.grid_device import Grid, cell_at
from .footprint_device import Footprint, swept_range, touches
from .solid_device import GrooveSet, piece_at

wp.set_module_options({"enable_backward": False})


@wp.func
def find_repeated(
    grooves: GrooveSet, f: Footprint, slope_o: wp.vec2d, slope_i: wp.vec2d, ids: wp.array(dtype=int), room: int
) -> int:  # fmt: skip
    """``find_near`` for pieces that repeat, which need no grid."""
    count = int(0)
    for s in range(grooves.sets):
        piece = grooves.pieces[grooves.start + s]
        step = grooves.steps[grooves.first_step + s]
        apart = wp.dot(wp.vec2d(step[0], step[1]), piece.across)
        x = swept_range(grooves, f, slope_o, slope_i, piece.across)
        at = wp.dot(piece.origin, piece.across)
        low = (x[0] - at - piece.high[0]) / apart
        high = (x[1] - at - piece.low[0]) / apart
        last = step[2] - wp.float64(1.0)
        first = int(wp.clamp(wp.floor(wp.min(low, high)), wp.float64(0.0), last))
        stop = int(wp.clamp(wp.ceil(wp.max(low, high)), wp.float64(0.0), last))
        if stop - first > 2 * room:
            count += stop - first
        else:
            for i in range(first, stop + 1):
                k = i * grooves.sets + s
                if touches(grooves, piece_at(grooves, k), f, slope_o, slope_i):
                    if count < room:
                        ids[count] = k
                    count += 1
    return count


@wp.func
def find_near(
    grooves: GrooveSet, grid: Grid, f: Footprint, slope_o: wp.vec2d, slope_i: wp.vec2d, ids: wp.array(dtype=int),
    room: int,
) -> int:  # fmt: skip
    """Write the pieces that ``touches`` says yes to into ``ids``, each once; how many there are.

    That may be more than ``room``: then only the first ``room`` were written, and the caller must find another way
    (a footprint over so many grooves is the statistical models' affair). The footprint is enlarged by the grooves'
    heights and depths along the view and the light.
    """
    if grooves.sets > 0:
        return find_repeated(grooves, f, slope_o, slope_i, ids, room)
    x = swept_range(grooves, f, slope_o, slope_i, wp.vec2d(wp.float64(1.0), wp.float64(0.0)))
    y = swept_range(grooves, f, slope_o, slope_i, wp.vec2d(wp.float64(0.0), wp.float64(1.0)))
    i0 = wp.max(cell_at(grid, 0, x[0]), 0)
    i1 = wp.min(cell_at(grid, 0, x[1]), grid.columns - 1)
    j0 = wp.max(cell_at(grid, 1, y[0]), 0)
    j1 = wp.min(cell_at(grid, 1, y[1]), grid.rows - 1)
    count = int(0)
    for j in range(j0, j1 + 1):
        for i in range(i0, i1 + 1):
            cell = grid.first + j * grid.columns + i
            for e in range(grid.starts[cell], grid.starts[cell + 1]):
                k = grid.items[e]
                known = bool(False)
                for a in range(wp.min(count, room)):
                    if ids[a] == k:
                        known = True
                if not known and touches(grooves, piece_at(grooves, k), f, slope_o, slope_i):
                    if count < room:
                        ids[count] = k
                    count += 1
    return count
