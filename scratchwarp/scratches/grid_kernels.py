"""Kernels that fill the grid: count each cell's strips, then write them in order."""

import warp as wp

from .grid_device import Grid, Strip, row_cells, strip_cells, strip_in_cell

wp.set_module_options({"enable_backward": False})


@wp.kernel
def fill(grid: Grid, strips: wp.array(dtype=Strip), counts: wp.array(dtype=int), writing: int):
    """One thread, all strips in order, so that a cell lists them in rising order: counts them, or writes them too."""
    for k in range(strips.shape[0]):
        strip = strips[k]
        box = strip_cells(grid, strip)
        for j in range(box[2], box[3] + 1):
            row = row_cells(grid, strip, j)
            for i in range(wp.max(row[0], box[0]), wp.min(row[1], box[1]) + 1):
                if strip_in_cell(grid, strip, i, j):
                    cell = j * grid.columns + i
                    if writing == 1:
                        grid.items[grid.starts[cell] + counts[cell]] = k
                    counts[cell] = counts[cell] + 1
