"""Pieces whose profile changes along them: rays against their facets, and where their edges are seen.

At u along the piece the profile is scaled by Sx = sx + gx u across and by Sz = sz + gz u upwards. The edges that its
vertices draw are straight; a facet between two of them is flat where both scales grow alike, else slightly twisted (a
bilinear patch), which rays meet exactly.
"""

import warp as wp

from .solid_device import GrooveSet, Piece, size_at

wp.set_module_options({"enable_backward": False})


@wp.func
def meets_facet(
    grooves: GrooveSet, piece: Piece, v: wp.vec2d, e: wp.vec2d, r: wp.vec2d, dxy: wp.vec2d, z: wp.float64,
    dz: wp.float64, side: wp.float64,
) -> wp.float64:  # fmt: skip
    """Where the ray (r, z) + t (dxy, dz), r from the piece's origin, meets the facet from vertex ``v`` to ``v + e``:
    out of the air into the solid (``side`` 1) or out of the solid (-1). t, or -1.

    e_x (z - v_z Sz) Sx - e_z (x - v_x Sx) Sz = 0 is quadratic in t; of two roots one falls through, one rises.
    """
    zero = wp.float64(0.0)
    taper = grooves.tapers[piece.taper]
    du = wp.dot(dxy, piece.along)
    size = size_at(grooves, piece, r)
    gx = taper.grow[0] * du
    gz = taper.grow[1] * du
    x = wp.dot(r, piece.across)
    dx = wp.dot(dxy, piece.across)
    up = z - v[1] * size[1]
    dup = dz - v[1] * gz
    aside = x - v[0] * size[0]
    daside = dx - v[0] * gx
    a = e[0] * dup * gx - e[1] * daside * gz
    b = e[0] * (up * gx + dup * size[0]) - e[1] * (aside * gz + daside * size[1])
    c = e[0] * up * size[0] - e[1] * aside * size[1]
    q = b * b - wp.float64(4.0) * a * c
    result = wp.float64(-1.0)
    if q > zero:
        # the root where the slope of the quadratic, side times, is -sqrt(q)
        root = -side * wp.sqrt(q)
        t = wp.float64(-1.0)
        if b * root >= zero:
            if b + root != zero:
                t = -wp.float64(2.0) * c / (b + root)
        elif a != zero:
            t = (root - b) / (wp.float64(2.0) * a)
        if t > zero:
            there = size_at(grooves, piece, r + t * dxy)
            if wp.min(there[0], there[1]) > zero:
                w = ((x + t * dx) / there[0] - v[0]) * e[0] + ((z + t * dz) / there[1] - v[1]) * e[1]
                e2 = wp.dot(e, e)
                if w >= wp.float64(-1e-12) * e2 and w <= wp.float64(1.0 + 1e-12) * e2:
                    result = t
    return result


@wp.func
def normal_at(grooves: GrooveSet, piece: Piece, e: wp.vec2d, r: wp.vec2d, z: wp.float64) -> wp.vec3d:
    """Unit normal, into the air, of the facet along ``e`` at ``r`` from the piece's origin and height ``z``."""
    taper = grooves.tapers[piece.taper]
    size = size_at(grooves, piece, r)
    x = wp.dot(r, piece.across)
    m = -e[1] / size[0] * piece.across
    m += (e[1] * x * taper.grow[0] / (size[0] * size[0]) - e[0] * z * taper.grow[1] / (size[1] * size[1])) * piece.along
    return wp.normalize(wp.vec3d(m[0], m[1], e[0] / size[1]))


@wp.func
def meets_opening(grooves: GrooveSet, piece: Piece, x: wp.float64, r: wp.vec2d, dxy: wp.vec2d) -> wp.vec3d:
    """Where a ray meets the vertical wall over the edge of an opening at profile ``x``: t (-1: nowhere), and the
    wall's horizontal normal."""
    taper = grooves.tapers[piece.taper]
    size = size_at(grooves, piece, r)
    m = wp.normalize(piece.across - x * taper.grow[0] * piece.along)
    rate = wp.dot(dxy, piece.across) - x * taper.grow[0] * wp.dot(dxy, piece.along)
    t = wp.float64(-1.0)
    if rate != wp.float64(0.0):
        t = (x * size[0] - wp.dot(r, piece.across)) / rate
    return wp.vec3d(t, m[0], m[1])


@wp.func
def edge_seen(
    grooves: GrooveSet, piece: Piece, v: wp.vec2d, base: wp.vec2d, step: wp.vec2d, slope: wp.vec2d
) -> wp.vec3d:  # fmt: skip
    """The edge that vertex ``v`` draws, seen along ``slope`` on the line base + b step: (b, its height there, 1), or
    (0, 0, 0) where it runs along the line."""
    taper = grooves.tapers[piece.taper]
    rise = v[1] * taper.grow[1]
    run = piece.along + v[0] * taper.grow[0] * piece.across - rise * slope
    at = piece.origin + v[0] * taper.size[0] * piece.across - v[1] * taper.size[1] * slope - base
    area = step[0] * run[1] - step[1] * run[0]
    result = wp.vec3d(wp.float64(0.0), wp.float64(0.0), wp.float64(0.0))
    if wp.abs(area) > wp.float64(1e-14) * wp.length(step) * wp.length(run):
        b = (at[0] * run[1] - at[1] * run[0]) / area
        u = (at[0] * step[1] - at[1] * step[0]) / area
        result = wp.vec3d(b, v[1] * taper.size[1] + u * rise, wp.float64(1.0))
    return result
