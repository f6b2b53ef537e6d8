"""Explicit scratches cut to triangles: a piece of one scratch in the plane of one triangle.

Plane of a triangle: origin at its first corner, x along its first edge, y to the left of that seen from outside. A
piece keeps its middle in float64 in that plane and all else relative to the middle, so that micrometres survive
kilometres of scene and of triangle.
"""

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.struct
class Segment:
    """48 bytes. ``half``: from the middle to the end. ``turn_a``, ``turn_b``: angle [rad] from the chord to the
    scratch's own direction at start and end, so that a scratch turns without a jump from piece to piece."""

    middle: wp.vec2d  # [m]
    half: wp.vec2  # [m]
    width: float  # [um]
    depth: float  # [um]
    turn_a: float
    turn_b: float
    triangle: int
    layer: int


@wp.struct
class Plane:
    """A triangle's plane: first corner, unit axes, and its corners b = (bx, 0), c = (cx, cy) in them [m]."""

    origin: wp.vec3
    x: wp.vec3
    y: wp.vec3
    n: wp.vec3
    bx: float
    cx: float
    cy: float


@wp.func
def plane_of(a: wp.vec3, b: wp.vec3, c: wp.vec3) -> Plane:
    """The plane of a triangle; all lengths 0 where it has no area."""
    r = Plane()
    r.origin = a
    ab = b - a
    ac = c - a
    n = wp.cross(ab, ac)
    area = wp.length(n)
    r.bx = wp.length(ab)
    if area > 0.0 and r.bx > 0.0:
        r.n = n / area
        r.x = ab / r.bx
        r.y = wp.cross(r.n, r.x)
        r.cx = wp.dot(ac, r.x)
        r.cy = wp.dot(ac, r.y)
    return r


@wp.func
def in_plane(plane: Plane, p: wp.vec3d) -> wp.vec2d:
    """Coordinates of a point, projected along the normal."""
    d = p - wp.vec3d(plane.origin)
    return wp.vec2d(wp.dot(d, wp.vec3d(plane.x)), wp.dot(d, wp.vec3d(plane.y)))


@wp.func
def clip_to(low_high: wp.vec2d, at_start: wp.float64, at_end: wp.float64) -> wp.vec2d:
    """The part of [low, high] in [0, 1] where a linear function with these values at 0 and 1 is not negative."""
    zero = wp.float64(0.0)
    r = low_high
    if at_start < zero and at_end < zero:
        r[1] = wp.float64(-1.0)
    elif at_start < zero:
        r[0] = wp.max(r[0], at_start / (at_start - at_end))
    elif at_end < zero:
        r[1] = wp.min(r[1], at_start / (at_start - at_end))
    return r


@wp.func
def turn_between(chord: wp.vec2, direction: wp.vec2) -> float:
    """Signed angle [rad] from one vector to another; 0 where one has no length."""
    across = chord[0] * direction[1] - chord[1] * direction[0]
    along = wp.dot(chord, direction)
    r = float(0.0)
    if across != 0.0 or along != 0.0:
        r = wp.atan2(across, along)
    return r
