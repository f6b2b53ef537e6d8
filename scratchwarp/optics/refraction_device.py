"""Refraction at a facet, on the device, in the arithmetic (float32 or float64) of what it is given."""

from typing import Any

import warp as wp


@wp.func
def axial_squared(cosine: Any, ior: Any):
    """ior^2 cos^2 of the refracted direction, ior^2 - sin^2, at or below 0 where reflection is total.

    ``cosine``: of the angle of incidence; ``ior``: relative, of the far side. Written so that an index of nearly 1 and
    a grazing direction cancel nothing: 1 - sin^2 / ior^2 does, and is 0 or several times too large there.
    """
    one = type(cosine)(1.0)
    return (ior - one) * (ior + one) + cosine * cosine


@wp.func
def refract(o: Any, n: Any, cosine: Any, ior: Any):
    """Unit direction in which what leaves along ``o`` came from the other side of a facet of normal ``n`` (Snell).

    ``cosine`` = n . o > 0, ``axial_squared`` > 0. For an index of 1 it is -o.
    """
    axial = wp.sqrt(axial_squared(cosine, ior))
    return wp.normalize(-axial * n - (o - cosine * n))
