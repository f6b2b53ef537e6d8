"""The deformation of the disk of facet normals (Kang and Cho, Eq. 3 and 5), in float32 and float64.

A perturbed normal moves the centre of the disk to ``c`` = (delta_x, delta_y); every other point moves by a share of
``c`` that falls to 0 at the rim. The linear form is exactly invertible and keeps the integral of D times the cosine
(its Jacobian is 1 - c . p / |p|, and D is even). The square root is the paper's Eq. 5; it is not the inverse of its
Eq. 4 and may leave the disk, where the density is 0.
"""

from typing import Any

import warp as wp

LINEAR = wp.constant(0)
SQUARE_ROOT = wp.constant(1)


@wp.func
def rim_ratio(p: Any, c: Any):
    """|R p| / |R c| with R where the ray from ``c`` through ``p`` meets the rim: 1 at ``c``, 0 on the rim.

    The inverse of the distance to the rim in units of |p - c| is taken in the form that adds terms of one sign; at
    p = c no direction is needed, at |c| = 1 only the second form occurs.
    """
    zero = p.dtype(0.0)
    d = p - c
    d2 = wp.dot(d, d)
    b = wp.dot(c, d)
    length = wp.length(c)
    left = wp.max((p.dtype(1.0) - length) * (p.dtype(1.0) + length), zero)
    root = wp.sqrt(b * b + d2 * left)
    near = zero
    if b >= zero:
        near = wp.where(d2 > zero, (root + b) / wp.max(left, p.dtype(1.0e-30)), zero)
    else:
        near = d2 / (root - b)
    return wp.clamp(p.dtype(1.0) - near, zero, p.dtype(1.0))


@wp.func
def inverse_deform_point(kind: int, p: Any, c: Any):
    """The point that the deformation brings to ``p``; by the square root, perhaps one outside the disk."""
    ratio = rim_ratio(p, c)
    if kind == SQUARE_ROOT:
        ratio = wp.sqrt(ratio)
    return p - ratio * c


@wp.func
def deform_point(kind: int, p: Any, c: Any):
    """Where the deformation brings ``p`` (Eq. 3 and 4)."""
    share = wp.max(p.dtype(1.0) - wp.length(p), p.dtype(0.0))
    if kind == SQUARE_ROOT:
        share = wp.sqrt(share)
    return p + share * c


@wp.func
def deform_jacobian(p: Any, c: Any):
    """Area of the image of a unit of area at ``p`` under the linear deformation, in [1 - |c|, 1 + |c|]."""
    length = wp.length(p)
    return p.dtype(1.0) - wp.where(length > p.dtype(0.0), wp.dot(p, c) / wp.max(length, p.dtype(1.0e-30)), p.dtype(0.0))
