"""Orthonormal frames and the angles of the scratch frame on the device.

Scratch frame: omega = sin(theta) u + cos(theta) (sin(phi) v + cos(phi) n); azimuth a: u = (cos a, sin a, 0), v = (-sin
a, cos a, 0), n = (0, 0, 1) in the shading frame.
"""

import warp as wp


@wp.struct
class Frame:
    """Right-handed orthonormal axes in world space: ``x`` tangent, ``y`` bitangent, ``n`` normal."""

    x: wp.vec3
    y: wp.vec3
    n: wp.vec3


@wp.func
def frame_around(n: wp.vec3) -> Frame:
    """Some frame around a unit normal, without a branch on its direction (Duff et al. 2017)."""
    f = Frame()
    sign = wp.where(n[2] >= 0.0, 1.0, -1.0)
    a = -1.0 / (sign + n[2])
    b = n[0] * n[1] * a
    f.x = wp.vec3(1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0])
    f.y = wp.vec3(b, sign + n[1] * n[1] * a, -n[1])
    f.n = n
    return f


@wp.func
def frame_with_tangent(n: wp.vec3, tangent: wp.vec3) -> Frame:
    """The frame around a unit normal with x nearest to ``tangent``; any frame where that is parallel to n or zero."""
    f = frame_around(n)
    flat = tangent - wp.dot(tangent, n) * n
    length2 = wp.dot(flat, flat)
    if length2 > 1.0e-10 * wp.dot(tangent, tangent):
        # a tangent close to n loses its digits in the difference: project once more
        flat = flat / wp.sqrt(length2)
        f.x = wp.normalize(flat - wp.dot(flat, n) * n)
        f.y = wp.cross(n, f.x)
    return f


@wp.func
def to_local(f: Frame, w: wp.vec3) -> wp.vec3:
    """World direction to frame coordinates."""
    return wp.vec3(wp.dot(w, f.x), wp.dot(w, f.y), wp.dot(w, f.n))


@wp.func
def to_world(f: Frame, w: wp.vec3) -> wp.vec3:
    """Frame coordinates to a world direction."""
    return w[0] * f.x + w[1] * f.y + w[2] * f.n


@wp.func
def scratch_angles(w: wp.vec3, azimuth: float) -> wp.vec2:
    """(theta, phi) of a unit shading-frame direction for a scratch at ``azimuth``; phi in (-pi, pi], 0 along n."""
    c = wp.cos(azimuth)
    s = wp.sin(azimuth)
    along = w[0] * c + w[1] * s
    across = w[1] * c - w[0] * s
    # atan2 keeps the digits that asin loses next to +-pi/2
    return wp.vec2(wp.atan2(along, wp.sqrt(across * across + w[2] * w[2])), wp.atan2(across, w[2]))


@wp.func
def scratch_direction(theta: float, phi: float, azimuth: float) -> wp.vec3:
    """The shading-frame direction of scratch angles, inverse of ``scratch_angles``."""
    c = wp.cos(azimuth)
    s = wp.sin(azimuth)
    along = wp.sin(theta)
    across = wp.cos(theta) * wp.sin(phi)
    return wp.vec3(along * c - across * s, along * s + across * c, wp.cos(theta) * wp.cos(phi))
