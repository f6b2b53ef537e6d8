"""Where what is seen may change along a line: the edges of grooves, projected.

A line in the plane z = 0, base + b step, and a direction d with d_z > 0, given by its slope (d_x, d_y) / d_z, span a
plane that cuts the grooves. Seen along d, what lies at b can change only where an edge of the surface projects to b:
a vertex of a profile, an end plane, or where facets of two pieces cross. Those b are gathered in rising order, as
events (b, height, piece, vertex): the height at which that happens, infinite where it happens at many, and whose vertex
it is, -1 where it is none.
"""

import warp as wp

from .planes_device import TIE, Height, Line, facet_height, meet, opening_wall, strip_of, wall_height
from .solid_device import GROUP, GrooveSet, Piece, box_of, grouped, piece_at
from .taper_device import edge_seen

wp.set_module_options({"enable_backward": False})

PLANES = wp.constant(16)  # compared at once
EVENTS = wp.constant(48)  # gathered at once; the caller asks again from the last one on


@wp.func
def insert(events: wp.array(dtype=wp.vec4d), found: int, event: wp.vec4d) -> int:
    """Put an event in its place among the ``found`` sorted ones; of too many the last is dropped."""
    n = int(found)
    j = int(n)
    if n == EVENTS:
        j = n - 1
        if events[j][0] <= event[0]:
            j = -1
    else:
        n = n + 1
    if j >= 0:
        while j > 0 and events[wp.max(j - 1, 0)][0] > event[0]:
            events[j] = events[j - 1]
            j = j - 1
        events[j] = event
    return n


@wp.func
def nameless(b: wp.float64, z: wp.float64) -> wp.vec4d:
    """An event that is no vertex of a piece."""
    return wp.vec4d(b, z, wp.float64(-1.0), wp.float64(-1.0))


@wp.func
def stride(
    grooves: GrooveSet, piece: Piece, j: int, s: wp.float64, x: wp.float64, per: wp.float64, floor: Height,
    start: wp.float64, stop: wp.float64,
) -> int:  # fmt: skip
    """How many vertices to go on from vertex ``j``: 1, or past a run of facets none of which shows in (start, stop)
    above the plane ``floor``; (v_x - v_z s - x) per is where a vertex of the profile is seen."""
    result = int(1)
    last = piece.first + piece.count - 1
    if grouped(piece) and (j - piece.first) % GROUP == 0 and j < last:
        box = box_of(grooves.vertices, piece, j)
        b0 = (box[0] - wp.max(box[1] * s, box[3] * s) - x) * per
        b1 = (box[2] - wp.min(box[1] * s, box[3] * s) - x) * per
        lowest = floor.at + wp.min(start * floor.rise, stop * floor.rise)
        if wp.max(b0, b1) < start or wp.min(b0, b1) > stop or box[3] < lowest:
            result = wp.min(GROUP, last - j)
    return result


@wp.func
def piece_meets(
    grooves: GrooveSet, other: Piece, line: Line, own: Height, floor: Height, start: wp.float64, stop: wp.float64,
    events: wp.array(dtype=wp.vec4d), found: int,
) -> int:  # fmt: skip
    """Gather where a plane meets facets of a piece."""
    n = int(found)
    for i in range(other.first, other.first + other.count - 1):
        b = meet(own, facet_height(grooves, other, i, line), start, stop)
        if b < stop and own.at + b * own.rise >= floor.at + b * floor.rise:
            n = insert(events, n, nameless(b, own.at + b * own.rise))
    return n


@wp.func
def run_meets(
    grooves: GrooveSet, other: Piece, line: Line, own: wp.array(dtype=wp.vec4d), behind: wp.array(dtype=int), many: int,
    floor: Height, start: wp.float64, stop: wp.float64, events: wp.array(dtype=wp.vec4d), found: int,
) -> int:  # fmt: skip
    """``piece_meets`` of a straight piece with ``many`` planes at once, each (at, rise, low, high)."""
    zero = wp.float64(0.0)
    n = int(found)
    s = wp.dot(line.slope, other.across)
    x = wp.dot(line.base - other.origin, other.across)
    dx = wp.dot(line.step, other.across)
    per = wp.float64(0.0)
    if dx != zero:
        per = wp.float64(1.0) / dx
    last = wp.vec2d(zero, zero)
    before = zero
    joined = int(0)
    i = int(other.first)
    while i < other.first + other.count and dx != zero:
        v = grooves.vertices[i]
        b1 = (v[0] - v[1] * s - x) * per
        low = wp.max(wp.min(before, b1), start)
        high = wp.min(wp.max(before, b1), stop)
        if joined == 1 and low < high:
            front = (b1 - before) * dx > zero
            for k in range(many):
                p = own[k]
                if p[2] < high and p[3] > low and (front or behind[k] == 0):
                    at0 = p[0] + before * p[1] - last[1]
                    at1 = p[0] + b1 * p[1] - v[1]
                    if at0 != at1:
                        b = before + (b1 - before) * (at0 / (at0 - at1))
                        z = p[0] + b * p[1]
                        # where they only touch counts as well: a facet that follows another may not be there
                        inside = b > wp.max(low, p[2]) - TIE and b < wp.min(high, p[3]) + TIE
                        if inside and b > start and b < stop and z >= floor.at + b * floor.rise:
                            n = insert(events, n, nameless(b, z))
        last = v
        before = b1
        on = stride(grooves, other, i, s, x, per, floor, start, stop)
        joined = wp.where(on == 1, 1, 0)
        i += on
    return n


@wp.func
def wall_meets(
    grooves: GrooveSet, ids: wp.array(dtype=int), count: int, line: Line, wall: Height, floor: Height,
    start: wp.float64, stop: wp.float64, events: wp.array(dtype=wp.vec4d), found: int,
) -> int:  # fmt: skip
    """Gather where a vertical wall meets facets or end walls of any piece."""
    n = int(found)
    if wp.max(wall.low, start) < wp.min(wall.high, stop):
        for c in range(count):
            other = piece_at(grooves, ids[c])
            for end in range(2):
                if (other.caps >> end) & 1 == 1:
                    m = wp.where(end == 0, other.end0, other.end1)
                    reach = wp.where(end == 0, other.reach0, other.reach1) + wp.dot(m, other.origin)
                    b = meet(wall, wall_height(m, reach, line, grooves.bottom, grooves.top), start, stop)
                    if b < stop:
                        n = insert(events, n, nameless(b, wall.at + b * wall.rise))
            if grooves.mixed == 1:
                for j in range(other.first, other.first + other.count):
                    if grooves.vertices[j][1] == wp.float64(0.0):
                        b = meet(wall, opening_wall(grooves, other, j, line), start, stop)
                        if b < stop:
                            n = insert(events, n, nameless(b, wall.at + b * wall.rise))
            strip = strip_of(other, line)
            if wp.max(strip[0], wp.max(wall.low, start)) < wp.min(strip[1], wp.min(wall.high, stop)):
                n = piece_meets(grooves, other, line, wall, floor, start, stop, events, n)
    return n


@wp.func
def turns(
    grooves: GrooveSet, piece: Piece, facet: Height, line: Line, start: wp.float64, stop: wp.float64,
    events: wp.array(dtype=wp.vec4d), found: int,
) -> int:  # fmt: skip
    """Gather where a facet goes over to that of the next stretch of its groove."""
    n = int(found)
    for end in range(2):
        if (piece.caps >> (2 + end)) & 1 == 1:
            m = wp.where(end == 0, piece.end0, piece.end1)
            reach = wp.where(end == 0, piece.reach0, piece.reach1) + wp.dot(m, piece.origin)
            b = meet(facet, wall_height(m, reach, line, grooves.bottom, grooves.top), start, stop)
            if b < stop:
                n = insert(events, n, nameless(b, facet.at + b * facet.rise))
    return n


@wp.func
def later_meets(
    grooves: GrooveSet, ids: wp.array(dtype=int), first: int, count: int, line: Line, planes: wp.array(dtype=wp.vec4d),
    behind: wp.array(dtype=int), many: int, floor: Height, start: wp.float64, stop: wp.float64,
    events: wp.array(dtype=wp.vec4d), found: int,
) -> int:  # fmt: skip
    """Gather where ``many`` planes of a piece meet facets of the pieces ``ids[first .. count - 1]``."""
    n = int(found)
    if many > 0:
        low = stop
        high = start
        for k in range(many):
            low = wp.min(low, planes[k][2])
            high = wp.max(high, planes[k][3])
        low = wp.max(low - TIE, start)
        high = wp.min(high + TIE, stop)
        for c in range(first, count):
            other = piece_at(grooves, ids[c])
            strip = strip_of(other, line)
            if wp.max(strip[0], low) < wp.min(strip[1], high):
                if other.taper < 0:
                    n = run_meets(grooves, other, line, planes, behind, many, floor, low, high, events, n)
                else:
                    for k in range(many):
                        own = Height()
                        own.at = planes[k][0]
                        own.rise = planes[k][1]
                        own.low = planes[k][2]
                        own.high = planes[k][3]
                        n = piece_meets(grooves, other, line, own, floor, start, stop, events, n)
    return n


@wp.func
def gather_edges(
    grooves: GrooveSet, ids: wp.array(dtype=int), count: int, line: Line, floor: Height, piece_seen: int,
    facet_seen: int, start: wp.float64, stop: wp.float64, events: wp.array(dtype=wp.vec4d),
) -> int:  # fmt: skip
    """How many events with b in (start, stop) were written, rising: at most ``EVENTS``, the first of them.

    Left out is what lies below the plane ``floor`` (z = at + b rise; at minus infinity: nothing), which is in front of
    it, and the ends of the facet ``facet_seen`` of ``piece_seen``, which lies on that plane (-1: none).
    """
    zero = wp.float64(0.0)
    planes = wp.zeros(shape=PLANES, dtype=wp.vec4d)
    behind = wp.zeros(shape=PLANES, dtype=int)
    n = int(0)
    for a in range(count):
        piece = piece_at(grooves, ids[a])
        strip = strip_of(piece, line)
        shown = wp.max(strip[0], start) < wp.min(strip[1], stop)
        if piece.caps & 3 > 0:
            for end in range(2):
                m = wp.where(end == 0, piece.end0, piece.end1)
                wall = (piece.caps >> end) & 1
                reach = wp.where(end == 0, piece.reach0, piece.reach1) + wp.dot(m, piece.origin)
                dm = wp.dot(m, line.step)
                if wall == 1 and dm != zero:
                    b = (reach - wp.dot(m, line.base)) / dm
                    if b > start and b < stop:
                        n = insert(events, n, nameless(b, wp.float64(wp.inf)))
                    height = wall_height(m, reach, line, grooves.bottom, grooves.top)
                    n = wall_meets(grooves, ids, count, line, height, floor, start, stop, events, n)
        if shown:
            s = wp.dot(line.slope, piece.across)
            x = wp.dot(line.base - piece.origin, piece.across)
            dx = wp.dot(line.step, piece.across)
            per = wp.float64(1.0) / dx
            before = zero
            above = int(0)
            joined = int(0)
            many = int(0)
            j = int(piece.first)
            while j < piece.first + piece.count:
                v = grooves.vertices[j]
                b = (v[0] - v[1] * s - x) * per
                z = v[1]
                if piece.taper >= 0:
                    seen = edge_seen(grooves, piece, v, line.base, line.step, line.slope)
                    b = wp.where(seen[2] > zero, seen[0], stop)
                    z = seen[1]
                was = int(above)
                above = wp.where(z >= floor.at + b * floor.rise, 1, 0)
                own_end = ids[a] == piece_seen and facet_seen >= 0 and (j == facet_seen or j == facet_seen + 1)
                if b > start and b < stop and above == 1 and not own_end:
                    n = insert(events, n, wp.vec4d(b, z, wp.float64(ids[a]), wp.float64(j)))
                if joined == 1 and (count > 1 or piece.caps > 3):
                    crossed = wp.max(wp.min(before, b), start) < wp.min(wp.max(before, b), stop)
                    if piece.taper >= 0 or (crossed and above + was > 0):
                        own = facet_height(grooves, piece, j - 1, line)
                        if piece.caps > 3:
                            n = turns(grooves, piece, own, line, start, stop, events, n)
                        if wp.max(own.low, start) < wp.min(own.high, stop):
                            planes[many] = wp.vec4d(own.at, own.rise, own.low, own.high)
                            behind[many] = wp.where(piece.taper < 0 and (b - before) * dx < zero, 1, 0)
                            many += 1
                            if many == PLANES:
                                n = later_meets(
                                    grooves, ids, a + 1, count, line, planes, behind, many, floor, start, stop, events,
                                    n,
                                )  # fmt: skip
                                many = 0
                before = b
                if grooves.mixed == 1 and v[1] == zero:
                    height = opening_wall(grooves, piece, j, line)
                    n = wall_meets(grooves, ids, count, line, height, floor, start, stop, events, n)
                on = int(1)
                if grooves.mixed == 0:
                    on = stride(grooves, piece, j, s, x, per, floor, start, stop)
                joined = wp.where(on == 1, 1, 0)
                j += on
            n = later_meets(
                grooves, ids, a + 1, count, line, planes, behind, many, floor, start, stop, events, n
            )  # fmt: skip
    return n
