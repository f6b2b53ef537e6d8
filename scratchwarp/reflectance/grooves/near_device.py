"""The pieces that a footprint needs: made from the paths that a grid over the plane lists, or that repeat."""

import warp as wp

from ...scratches.grid_device import Grid, cell_at, item_at
from .footprint_device import Footprint, swept_range, touches
from .solid_device import GroovePath, GrooveSet, Piece
from .stored_device import RINGS, chords_of, mitred, path_with, phase_of, piece_made, ring_piece, stretch, with_section

wp.set_module_options({"enable_backward": False})

_X = wp.constant(wp.vec2d(1.0, 0.0))
_Y = wp.constant(wp.vec2d(0.0, 1.0))


@wp.func
def as_array(room: wp.array(dtype=Piece)) -> wp.array(dtype=Piece):
    """A local array (``wp.zeros`` in a kernel) that fits into ``GrooveSet.pieces``."""
    return room


@wp.func
def with_room(grooves: GrooveSet, room: wp.array(dtype=Piece)) -> GrooveSet:
    """A pattern with room for pieces that are found."""
    result = GrooveSet()
    result.pieces = room
    result.paths = grooves.paths
    result.points = grooves.points
    result.vertices = grooves.vertices
    result.bottom = grooves.bottom
    result.top = grooves.top
    result.skin = grooves.skin
    result.mixed = grooves.mixed
    result.wide = grooves.wide
    result.first_path = grooves.first_path
    result.path_count = grooves.path_count
    result.sets = grooves.sets
    result.first_step = grooves.first_step
    result.steps = grooves.steps
    result.tapers = grooves.tapers
    return result


@wp.func
def passed_by(grooves: GrooveSet, path: GroovePath, own: int, x: wp.vec2d, y: wp.vec2d) -> bool:
    """Whether the box from (x[0], y[0]) to (x[1], y[1]) lies aside of a stretch, told before the piece is made."""
    result = bool(False)
    if own < path.count:
        half = wp.float64(0.5)
        start = grooves.points[path.point + own]
        run = grooves.points[path.point + own + 1] - start
        to = wp.vec2d(half * (x[0] + x[1]), half * (y[0] + y[1])) - start
        reach = wp.length(wp.vec2d(half * (x[1] - x[0]), half * (y[1] - y[0]))) + grooves.wide
        aside = run[0] * to[1] - run[1] * to[0]
        result = aside * aside > reach * reach * wp.dot(run, run)
    return result


@wp.func
def find_lines(
    grooves: GrooveSet, path: GroovePath, step: wp.vec3d, f: Footprint, slope_o: wp.vec2d, slope_i: wp.vec2d,
    found: int, room: int,
) -> int:  # fmt: skip
    """``find_near`` for a line that is there several times; ``found``: how many pieces there are before."""
    half = wp.float64(0.5)
    count = int(found)
    piece = stretch(grooves, path, 0)
    origin = piece.origin
    apart = wp.dot(wp.vec2d(step[0], step[1]), piece.across)
    x = swept_range(grooves, f, slope_o, slope_i, piece.across)
    at = wp.dot(origin, piece.across)
    low = (x[0] - at - piece.high[0]) / apart
    high = (x[1] - at - piece.low[0]) / apart
    last = step[2] - wp.float64(1.0)
    first = int(wp.clamp(wp.floor(wp.min(low, high)), wp.float64(0.0), last))
    stop = int(wp.clamp(wp.ceil(wp.max(low, high)), wp.float64(0.0), last))
    if stop - first > 2 * room + 2:
        # there is no room for all: those next to the middle stand for them
        spare = wp.max(room - count, 0)
        begin = wp.clamp(half * (low + high), wp.float64(first), wp.float64(stop)) - wp.float64(spare / 2)
        begin = wp.floor(wp.clamp(begin, wp.float64(first), wp.float64(stop - spare)))
        for k in range(spare):
            piece.origin = origin + (begin + wp.float64(k)) * wp.vec2d(step[0], step[1])
            grooves.pieces[count + k] = piece
        count += stop - first
    else:
        for i in range(first, stop + 1):
            piece.origin = origin + wp.float64(i) * wp.vec2d(step[0], step[1])
            if touches(grooves, piece, f, slope_o, slope_i):
                if count < room:
                    grooves.pieces[count] = piece
                count += 1
    return count


@wp.func
def find_rings(
    grooves: GrooveSet, path: GroovePath, f: Footprint, slope_o: wp.vec2d, slope_i: wp.vec2d, found: int, room: int
) -> int:  # fmt: skip
    """``find_near`` for rings."""
    half = wp.float64(0.5)
    count = int(found)
    center = grooves.points[path.point]
    inner = grooves.points[path.point + 1][0]
    pitch = grooves.points[path.point + 1][1]
    x = swept_range(grooves, f, slope_o, slope_i, _X) - wp.vec2d(center[0], center[0])
    y = swept_range(grooves, f, slope_o, slope_i, _Y) - wp.vec2d(center[1], center[1])
    middle = half * wp.vec2d(x[0] + x[1], y[0] + y[1])
    box = half * wp.vec2d(x[1] - x[0], y[1] - y[0])
    away = wp.length(middle)
    near = wp.length(wp.max(wp.vec2d(wp.abs(middle[0]), wp.abs(middle[1])) - box, wp.vec2d()))
    far = wp.length(wp.vec2d(wp.abs(middle[0]), wp.abs(middle[1])) + box)
    form = with_section(grooves, path)
    # chords and mitred corners leave the circle by no more than this
    wide = wp.float64(1.15) * wp.max(-form.low[0], form.high[0]) + wp.float64(0.05) * (form.high[0] - form.low[0])
    last = wp.float64(path.count - 1)
    first = int(wp.clamp(wp.floor((near - wide - inner) / pitch), wp.float64(0.0), last))
    stop = int(wp.clamp(wp.ceil((far + wide - inner) / pitch), wp.float64(0.0), last))
    if stop - first > 2 * room + 8:
        # as for lines
        turned = wp.atan2(middle[1], middle[0])
        spare = wp.max(room - count, 0)
        begin = wp.clamp((away - inner) / pitch, wp.float64(first), wp.float64(stop)) - wp.float64(spare / 2)
        begin = wp.clamp(begin, wp.float64(first), wp.float64(stop - spare))
        for k in range(spare):
            ring = int(begin) + k
            n = chords_of(inner + wp.float64(ring) * pitch, form.high[0] - form.low[0])
            j = int(wp.floor(turned * wp.float64(n) / wp.float64(2.0 * wp.PI) - phase_of(ring)))
            grooves.pieces[count + k] = ring_piece(grooves, path, ring, j)
        count += stop - first
    else:
        reach = wp.length(box) + wide
        turn = half * wp.float64(wp.PI)
        spread = wp.float64(wp.PI)
        if away > reach:
            turn = wp.atan2(middle[1], middle[0])
            spread = wp.asin(reach / away)
        for ring in range(first, stop + 1):
            n = chords_of(inner + wp.float64(ring) * pitch, form.high[0] - form.low[0])
            scale = wp.float64(n) / wp.float64(2.0 * wp.PI)
            j = int(wp.floor((turn - spread) * scale)) - 1  # a phase is less than a chord
            j1 = wp.min(int(wp.floor((turn + spread) * scale)), j + n - 1)
            while j <= j1:
                piece = ring_piece(grooves, path, ring, j)
                if touches(grooves, piece, f, slope_o, slope_i):
                    if count < room:
                        grooves.pieces[count] = piece
                    count += 1
                j += 1
    return count


@wp.func
def find_near(
    grooves: GrooveSet, grid: Grid, f: Footprint, slope_o: wp.vec2d, slope_i: wp.vec2d, ids: wp.array(dtype=int),
    room: int,
) -> int:  # fmt: skip
    """Make the pieces that ``touches`` says yes to in ``grooves.pieces``, each once; how many there are.

    ``ids`` [room] becomes their places there, 0, 1, 2 and so on. There may be more than ``room``: then only that many
    were made, and the caller must find another way (a footprint over so many grooves is the statistical models'
    affair). The footprint is enlarged by the grooves' heights and depths along the view and the light. Both pieces of a
    mitred end are made where either is needed.
    """
    count = int(0)
    for s in range(grooves.sets):
        path = grooves.paths[grooves.first_path + grooves.path_count + s]
        if path.kind & RINGS != 0:
            count = find_rings(grooves, path, f, slope_o, slope_i, count, room)
        else:
            step = grooves.steps[grooves.first_step + s]
            count = find_lines(grooves, path, step, f, slope_o, slope_i, count, room)
    repeated = int(count)
    if grooves.path_count > 0:
        x = swept_range(grooves, f, slope_o, slope_i, _X)
        y = swept_range(grooves, f, slope_o, slope_i, _Y)
        i0 = wp.max(cell_at(grid, 0, x[0]), 0)
        i1 = wp.min(cell_at(grid, 0, x[1]), grid.columns - 1)
        j0 = wp.max(cell_at(grid, 1, y[0]), 0)
        j1 = wp.min(cell_at(grid, 1, y[1]), grid.rows - 1)
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                cell = grid.first + j * grid.columns + i
                for e in range(grid.starts[cell], grid.starts[cell + 1]):
                    k = item_at(grid, e)
                    known = bool(False)
                    for a in range(repeated, wp.min(count, room)):
                        if ids[a] == k:
                            known = True
                    if not known:
                        path = grooves.paths[path_with(grooves, k)]
                        own = k - path.first
                        piece = Piece()
                        met = not passed_by(grooves, path, own, x, y)
                        if met:
                            piece = piece_made(grooves, path, own)
                            met = touches(grooves, piece, f, slope_o, slope_i)
                        if met:
                            if own < path.count:
                                if count < room:
                                    grooves.pieces[count] = piece
                                    ids[count] = k
                                count += 1
                            else:
                                half = (own - path.count) % 2
                                other = mitred(grooves, path, (own - path.count) / 2, 1 - half)
                                if count + 1 < room:
                                    piece.partner = count + 1
                                    other.partner = count
                                    grooves.pieces[count] = piece
                                    grooves.pieces[count + 1] = other
                                    ids[count] = k
                                    ids[count + 1] = k + 1 - 2 * half
                                elif count < room:
                                    grooves.pieces[count] = piece
                                    ids[count] = k
                                count += 2
    for a in range(wp.min(count, room)):
        ids[a] = a
    return count


@wp.func
def anything_near(
    grooves: GrooveSet, grid: Grid, f: Footprint, slope_o: wp.vec2d, slope_i: wp.vec2d
) -> bool:  # fmt: skip
    """Whether ``find_near`` would find something."""
    found = bool(False)
    for s in range(grooves.sets):
        if not found:
            path = grooves.paths[grooves.first_path + grooves.path_count + s]
            if path.kind & RINGS != 0:
                found = find_rings(grooves, path, f, slope_o, slope_i, 0, 0) > 0
            else:
                step = grooves.steps[grooves.first_step + s]
                found = find_lines(grooves, path, step, f, slope_o, slope_i, 0, 0) > 0
    if not found and grooves.path_count > 0:
        x = swept_range(grooves, f, slope_o, slope_i, _X)
        y = swept_range(grooves, f, slope_o, slope_i, _Y)
        i1 = wp.min(cell_at(grid, 0, x[1]), grid.columns - 1)
        j1 = wp.min(cell_at(grid, 1, y[1]), grid.rows - 1)
        j = wp.max(cell_at(grid, 1, y[0]), 0)
        while j <= j1 and not found:
            i = wp.max(cell_at(grid, 0, x[0]), 0)
            while i <= i1 and not found:
                cell = grid.first + j * grid.columns + i
                e = int(grid.starts[cell])
                while e < grid.starts[cell + 1] and not found:
                    k = item_at(grid, e)
                    path = grooves.paths[path_with(grooves, k)]
                    if not passed_by(grooves, path, k - path.first, x, y):
                        found = touches(grooves, piece_made(grooves, path, k - path.first), f, slope_o, slope_i)
                    e += 1
                i += 1
            j += 1
    return found
