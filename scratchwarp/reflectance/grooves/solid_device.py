"""The solid that grooves leave: pieces of grooves, and whether a point lies inside.

A piece is a straight stretch of a groove: its profile, extruded along ``along``, between two vertical end planes. Below
z = 0 the solid is what no piece digs away, so the lower height wins; above, what any piece adds, so the higher one
wins; what one piece digs through the plane also cuts away what other pieces pile up over it. Nothing of this depends on
the order of the pieces. A mitred end is two pieces across each other, ``partner`` of one another, that dig where both
do.
"""

import warp as wp

wp.set_module_options({"enable_backward": False})


GROUP = wp.constant(8)  # facets in a run of a long profile that has a box of its own
LONG = wp.constant(12)  # vertices from which on profiles have such boxes


@wp.struct
class Piece:
    """A straight stretch of a groove.

    A point at ``r`` from ``origin`` has profile x = dot(r, across); it belongs to the stretch where dot(r, end0) <=
    reach0 and dot(r, end1) <= reach1 (unit normals outwards). ``caps``: 1 where a wall may stand at the first end,
    plus 2 where one may at the other; 4 and 8 where facets turn there.
    ``first``, ``count``: its vertices, before which lie the boxes (low, high) of runs of them where it is ``grouped``.
    ``low``, ``high``: smallest and largest x and z of the profile. ``partner``: the other piece of a mitred end among
    those found, or -1. ``path``: the groove it belongs to. ``taper``: the ``Taper`` of a stretch whose profile grows or
    shrinks, or -1; ``low`` and ``high`` then hold all along it.
    """

    origin: wp.vec2d
    along: wp.vec2d
    across: wp.vec2d
    end0: wp.vec2d
    end1: wp.vec2d
    low: wp.vec2d
    high: wp.vec2d
    reach0: wp.float64
    reach1: wp.float64
    first: int
    count: int
    caps: int
    partner: int
    path: int
    taper: int


@wp.struct
class Taper:
    """How the profile of a piece changes along it: at u = dot(r, along) x and z are ``size`` + u ``grow`` times those
    of the vertices; ``low``, ``high`` as in ``Piece``."""

    size: wp.vec2d
    grow: wp.vec2d
    low: wp.vec2d
    high: wp.vec2d


@wp.struct
class GroovePath:
    """What the stretches of a path share, and all that is stored of them besides their points.

    ``first``: number of its first piece; ``point``: its first point; ``count``: stretches, of rings how many rings;
    ``section``, ``corners``: first vertex of its profile and how many; ``kind``: ``LOOP``, ``CAPPED``, ... added up;
    ``taper``: the ``Taper`` of its first piece, or -1; ``number``: the path's place among those that were given.
    """

    first: int
    point: int
    count: int
    section: int
    corners: int
    kind: int
    taper: int
    number: int


@wp.struct
class GrooveSet:
    """A pattern: paths, their points, the vertices (x, z) of their profiles; and ``pieces``, room for those near a
    footprint, which ``near_device`` makes there.

    No profile facet crosses z = 0. ``bottom`` <= 0 <= ``top``: the lowest and highest z; ``skin``: the length by which
    a point is moved off a surface to see what lies on its sides; ``mixed``: 1 where something digs and something piles
    up; ``wide``: how far profiles reach from their paths. Paths ``first_path`` on: ``path_count`` of them lie in the
    grid; ``sets`` further ones are there several times, each moved by ``steps`` (x, y, how many there are), the first
    of them ``first_step``, or as rings.
    """

    pieces: wp.array(dtype=Piece)
    paths: wp.array(dtype=GroovePath)
    points: wp.array(dtype=wp.vec2d)
    vertices: wp.array(dtype=wp.vec2d)
    bottom: wp.float64
    top: wp.float64
    skin: wp.float64
    mixed: int
    wide: wp.float64
    first_path: int
    path_count: int
    sets: int
    first_step: int
    steps: wp.array(dtype=wp.vec3d)
    tapers: wp.array(dtype=Taper)


@wp.func
def groups(count: int) -> int:
    """Runs of a profile of so many vertices."""
    return (count - 2 + GROUP) / GROUP


@wp.func
def grouped(piece: Piece) -> bool:
    """Whether runs of a piece's facets have boxes."""
    return piece.count >= LONG and piece.taper < 0


@wp.func
def piece_at(grooves: GrooveSet, k: int) -> Piece:
    """Piece number ``k`` of those that were found."""
    return grooves.pieces[k]


@wp.func
def size_at(grooves: GrooveSet, piece: Piece, r: wp.vec2d) -> wp.vec2d:
    """What x and z of the profile are multiplied with at ``r`` from the piece's origin."""
    size = wp.vec2d(wp.float64(1.0), wp.float64(1.0))
    if piece.taper >= 0:
        taper = grooves.tapers[piece.taper]
        size = taper.size + wp.dot(r, piece.along) * taper.grow
    return size


@wp.func
def flat(p: wp.vec3d) -> wp.vec2d:
    """x and y."""
    return wp.vec2d(p[0], p[1])


@wp.func
def in_stretch(piece: Piece, r: wp.vec2d, slack: wp.float64) -> bool:
    """Whether ``r`` from the piece's origin lies between its end planes."""
    return wp.dot(r, piece.end0) <= piece.reach0 + slack and wp.dot(r, piece.end1) <= piece.reach1 + slack


@wp.func
def box_of(vertices: wp.array(dtype=wp.vec2d), piece: Piece, j: int) -> wp.vec4d:
    """(lowest x, z, highest x, z) of the run of facets of a ``grouped`` piece that begins at vertex ``j``."""
    at = piece.first - 2 * groups(piece.count) + (j - piece.first) / GROUP * 2
    low = vertices[at]
    high = vertices[at + 1]
    return wp.vec4d(low[0], low[1], high[0], high[1])


@wp.func
def stride_at(vertices: wp.array(dtype=wp.vec2d), piece: Piece, j: int, x: wp.float64) -> int:
    """How many facets from vertex ``j`` on can be left out because none lies over ``x``; 0 where that is not known."""
    result = int(0)
    if grouped(piece) and (j - piece.first) % GROUP == 0:
        box = box_of(vertices, piece, j)
        if x < box[0] or x > box[2]:
            result = GROUP
    return result


@wp.func
def beyond_facets(
    vertices: wp.array(dtype=wp.vec2d), piece: Piece, x: wp.float64, z: wp.float64, sign: wp.float64
) -> bool:
    """Whether (x, z) lies beyond an odd number of the profile's facets under (sign 1) or over (-1) the plane."""
    zero = wp.float64(0.0)
    odd = int(0)
    j = int(piece.first)
    while j < piece.first + piece.count - 1:
        on = stride_at(vertices, piece, j, x)
        if on == 0:
            on = 1
            a = vertices[j]
            b = vertices[j + 1]
            if sign * a[1] <= zero and sign * b[1] <= zero and (a[0] <= x) != (b[0] <= x):
                if sign * (a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0])) < sign * z:
                    odd = 1 - odd
        j += on
    return odd == 1


@wp.func
def is_dug(vertices: wp.array(dtype=wp.vec2d), piece: Piece, x: wp.float64, z: wp.float64) -> bool:
    """Whether the profile leaves air at (x, z), z <= 0: an odd number of facets below."""
    result = False
    if piece.taper >= 0 or (x >= piece.low[0] and x <= piece.high[0] and z > piece.low[1]):
        result = beyond_facets(vertices, piece, x, z, wp.float64(1.0))
    return result


@wp.func
def is_piled(vertices: wp.array(dtype=wp.vec2d), piece: Piece, x: wp.float64, z: wp.float64) -> bool:
    """Whether the profile piles solid up at (x, z), z >= 0: an odd number of facets above."""
    result = False
    if piece.taper >= 0 or (x >= piece.low[0] and x <= piece.high[0] and z < piece.high[1]):
        result = beyond_facets(vertices, piece, x, z, wp.float64(-1.0))
    return result


@wp.func
def digs_at(grooves: GrooveSet, k: int, xy: wp.vec2d, z: wp.float64) -> bool:
    """Whether piece ``k`` digs away the point (xy, z), z <= 0; at z = 0: whether it opens the plane there."""
    piece = piece_at(grooves, k)
    result = bool(False)
    r = xy - piece.origin
    x = wp.dot(r, piece.across)
    if x >= piece.low[0] and x <= piece.high[0] and in_stretch(piece, r, wp.float64(0.25) * grooves.skin):
        size = size_at(grooves, piece, r)
        if wp.min(size[0], size[1]) > wp.float64(0.0):
            result = is_dug(grooves.vertices, piece, x / size[0], z / size[1])
        if result and piece.partner >= 0:
            other = piece_at(grooves, piece.partner)
            y = wp.dot(xy - other.origin, other.across)
            result = in_stretch(other, xy - other.origin, wp.float64(0.25) * grooves.skin)
            result = result and is_dug(grooves.vertices, other, y, z)
    return result


@wp.func
def piles_at(grooves: GrooveSet, k: int, xy: wp.vec2d, z: wp.float64) -> bool:
    """Whether piece ``k`` piles solid up at the point (xy, z), z >= 0.

    At a mitred end the higher of the two profiles counts where they also dig (a rim goes round the end), else the
    lower one.
    """
    piece = piece_at(grooves, k)
    result = bool(False)
    r = xy - piece.origin
    x = wp.dot(r, piece.across)
    if x >= piece.low[0] and x <= piece.high[0] and in_stretch(piece, r, wp.float64(0.25) * grooves.skin):
        size = size_at(grooves, piece, r)
        if wp.min(size[0], size[1]) > wp.float64(0.0):
            result = is_piled(grooves.vertices, piece, x / size[0], z / size[1])
        if piece.partner >= 0:
            other = piece_at(grooves, piece.partner)
            y = wp.dot(xy - other.origin, other.across)
            also = is_piled(grooves.vertices, other, y, z)
            if piece.low[1] < wp.float64(0.0):
                result = (result or also) and in_stretch(other, xy - other.origin, wp.float64(0.25) * grooves.skin)
            else:
                result = result and also
    return result


@wp.func
def is_solid(grooves: GrooveSet, ids: wp.array(dtype=int), count: int, p: wp.vec3d) -> bool:
    """Whether ``p`` lies in the solid, as far as the pieces ``ids[0]`` to ``ids[count - 1]`` tell."""
    zero = wp.float64(0.0)
    xy = flat(p)
    result = bool(p[2] < zero)
    if result:
        for a in range(count):
            if result and digs_at(grooves, ids[a], xy, p[2]):
                result = False
    elif p[2] < grooves.top:
        for a in range(count):
            if not result and piles_at(grooves, ids[a], xy, p[2]):
                result = bool(True)
                if grooves.mixed == 1:
                    for c in range(count):
                        own = ids[c] == ids[a] or ids[c] == piece_at(grooves, ids[a]).partner
                        if result and not own and digs_at(grooves, ids[c], xy, zero):
                            result = False
    return result
