"""Rays against grooves: the first surface that a ray meets, from outside or from within the solid.

Every facet, end wall and the ground is tried. A crossing counts when the solid lies behind it and air before it
(``solid_device.is_solid`` a skin off the surface to both sides), whatever pieces overlap there: intersections, ends and
corners need no rule of their own.
"""

import warp as wp

from .solid_device import GROUP, GrooveSet, Piece, box_of, flat, grouped, in_stretch, is_solid, piece_at
from .taper_device import meets_facet, meets_opening, normal_at

wp.set_module_options({"enable_backward": False})


@wp.struct
class Crossing:
    """Where a ray meets a surface: distance in units of the ray's direction (infinite: nowhere), unit normal, piece.

    ``piece`` is -1 on the ground; ``facet`` the first vertex of the piece's facet, -1 on walls and on the ground.
    """

    distance: wp.float64
    normal: wp.vec3d
    piece: int
    facet: int


@wp.func
def path_of(grooves: GrooveSet, piece: int) -> int:
    """The number of the path that a piece belongs to, as it was given; -1 for the ground."""
    path = int(-1)
    if piece >= 0:
        path = piece_at(grooves, piece).path
    return path


@wp.func
def is_surface(
    grooves: GrooveSet, ids: wp.array(dtype=int), count: int, q: wp.vec3d, n: wp.vec3d
) -> bool:  # fmt: skip
    """Whether ``q`` has the solid behind it and air before it, along the unit normal ``n``."""
    return is_solid(grooves, ids, count, q - grooves.skin * n) and not is_solid(
        grooves, ids, count, q + grooves.skin * n
    )


@wp.func
def passes_by(
    piece: Piece, x: wp.float64, z: wp.float64, dx: wp.float64, dz: wp.float64, limit: wp.float64
) -> bool:  # fmt: skip
    """Whether the ray (x, z) + t (dx, dz), 0 < t < ``limit``, misses the box about a piece's profile."""
    # between the heights of the box; a level ray is told by its height alone
    t0 = wp.float64(0.0)
    t1 = limit
    if dz != wp.float64(0.0):
        low = (piece.low[1] - z) / dz
        high = (piece.high[1] - z) / dz
        t0 = wp.max(t0, wp.min(low, high))
        t1 = wp.min(t1, wp.max(low, high))
    x0 = x + t0 * dx
    x1 = x0
    if dx != wp.float64(0.0):
        x1 = x + t1 * dx
    slack = wp.float64(1e-9) * (piece.high[0] - piece.low[0])
    return t1 < t0 or wp.max(x0, x1) < piece.low[0] - slack or wp.min(x0, x1) > piece.high[0] + slack


@wp.func
def stride_past(
    grooves: GrooveSet, piece: Piece, j: int, x: wp.float64, z: wp.float64, dx: wp.float64, dz: wp.float64
) -> int:  # fmt: skip
    """How many facets from vertex ``j`` on lie on one side of the line (x, z) + t (dx, dz); 0 where that is unknown."""
    result = int(0)
    if grouped(piece) and (j - piece.first) % GROUP == 0:
        box = box_of(grooves.vertices, piece, j)
        x0 = (box[0] - x) * dz
        x1 = (box[2] - x) * dz
        z0 = (box[1] - z) * dx
        z1 = (box[3] - z) * dx
        low = wp.min(x0, x1) - wp.max(z0, z1)
        high = wp.max(x0, x1) - wp.min(z0, z1)
        if low > wp.float64(0.0) or high <= wp.float64(0.0):
            result = GROUP
    return result


@wp.func
def cast(
    grooves: GrooveSet, ids: wp.array(dtype=int), count: int, p: wp.vec3d, d: wp.vec3d, limit: wp.float64,
    anything: int, inside: int,
) -> Crossing:  # fmt: skip
    """The first surface that the ray ``p + t d``, 0 < t < ``limit``, meets.

    ``anything`` 1: any surface will do (shadow rays). ``inside`` 0: ``p`` lies in the air, a skin off its own surface;
    1: in the solid. Normals point into the air always.
    """
    zero = wp.float64(0.0)
    hit = Crossing()
    hit.distance = wp.float64(wp.inf)
    hit.piece = -1
    hit.facet = -1
    best = limit
    side = wp.float64(1 - 2 * inside)
    xy = flat(p)
    dxy = flat(d)
    if side * d[2] < zero:
        t = -p[2] / d[2]
        n = wp.vec3d(zero, zero, wp.float64(1.0))
        if t > zero and t < best and is_surface(grooves, ids, count, p + t * d, n):
            hit.distance = t
            hit.normal = n
            best = t
    for a in range(count):
        piece = piece_at(grooves, ids[a])
        r = xy - piece.origin
        x = wp.dot(r, piece.across)
        dx = wp.dot(dxy, piece.across)
        last = piece.first + piece.count - 1
        if passes_by(piece, x, p[2], dx, d[2], best) or (anything == 1 and best == zero):
            last = piece.first
        j = int(piece.first)
        while j < last:
            on = int(0)
            if grooves.mixed == 0:
                on = stride_past(grooves, piece, j, x, p[2], dx, d[2])
            # on which side of the ray each vertex lies; a facet is met where that changes
            v = grooves.vertices[j]
            w = v
            was = zero
            aside = zero
            if on == 0:
                w = grooves.vertices[j + 1]
                was = (v[0] - x) * d[2] - (v[1] - p[2]) * dx
                aside = (w[0] - x) * d[2] - (w[1] - p[2]) * dx
                on = 1
            if piece.taper >= 0 and (v[1] != zero or w[1] != zero) and not (anything == 1 and best == zero):
                e = w - v
                t = meets_facet(grooves, piece, v, e, r, dxy, p[2], d[2], side)
                if t > zero and t < best and in_stretch(piece, r + t * dxy, wp.float64(0.25) * grooves.skin):
                    n = normal_at(grooves, piece, e, r + t * dxy, p[2] + t * d[2])
                    if is_surface(grooves, ids, count, p + t * d, n):
                        hit.distance = t
                        hit.normal = n
                        hit.piece = ids[a]
                        hit.facet = j
                        best = t
            if piece.taper < 0 and (was > zero) != (aside > zero) and side * (aside - was) < zero:
                if (v[1] != zero or w[1] != zero) and not (anything == 1 and best == zero):
                    e = w - v
                    t = (e[0] * (v[1] - p[2]) - e[1] * (v[0] - x)) / (aside - was)
                    if t > zero and t < best and in_stretch(piece, r + t * dxy, wp.float64(0.25) * grooves.skin):
                        m = e / wp.length(e)
                        n = wp.vec3d(-m[1] * piece.across[0], -m[1] * piece.across[1], m[0])
                        if is_surface(grooves, ids, count, p + t * d, n):
                            hit.distance = t
                            hit.normal = n
                            hit.piece = ids[a]
                            hit.facet = j
                            best = t
            if grooves.mixed == 1 and v[1] == zero and (dx != zero or piece.taper >= 0):
                # the wall that an opening cuts into what other pieces pile up
                m = piece.across
                t = zero
                if piece.taper >= 0:
                    opening = meets_opening(grooves, piece, v[0], r, dxy)
                    t = opening[0]
                    m = wp.vec2d(opening[1], opening[2])
                else:
                    t = (v[0] - x) / dx
                if t > zero and t < best and p[2] + t * d[2] > zero and p[2] + t * d[2] < grooves.top:
                    n = -side * wp.sign(wp.dot(m, dxy)) * wp.vec3d(m[0], m[1], zero)
                    if is_surface(grooves, ids, count, p + t * d, n):
                        hit.distance = t
                        hit.normal = n
                        hit.piece = ids[a]
                        hit.facet = -1
                        best = t
            j += on
        for end in range(2):
            m = wp.where(end == 0, piece.end0, piece.end1)
            reach = wp.where(end == 0, piece.reach0, piece.reach1)
            wall = (piece.caps >> end) & 1
            dm = wp.dot(m, dxy)
            if wall == 1 and dm != zero:
                t = (reach - wp.dot(m, r)) / dm
                if t > zero and t < best and p[2] + t * d[2] > grooves.bottom and p[2] + t * d[2] < grooves.top:
                    n = -side * wp.sign(dm) * wp.vec3d(m[0], m[1], zero)
                    if is_surface(grooves, ids, count, p + t * d, n):
                        hit.distance = t
                        hit.normal = n
                        hit.piece = ids[a]
                        hit.facet = -1
                        best = t
        if anything == 1 and hit.distance < limit:
            best = zero
    return hit
