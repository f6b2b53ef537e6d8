"""What every response over solid angle takes and returns, and the data of all of them.

A response is a pair of device functions over directions in its own frame (n = +z; on a scratch x runs along it):
``eval(arrays, at, wo, wi) -> BaseTerms`` (f_r cos(theta_i) and the density) and ``sample(arrays, at, wo, u, v) ->
BaseSample``. One that varies over the surface has a third, ``place(arrays, at, spot) -> ResponseAt``.
"""

import warp as wp

from ..mdf.lobe_device import Lobe
from ..measured.grid_device import GridBrdf
from ..measured.merl_device import MerlBrdf
from ..measured.rgl_device import RglBrdf
from ..stencils.stencil_device import Stencil
from .half_device import HalfTable

wp.set_module_options({"enable_backward": False})

# Cosines at which reflectances are tabulated, in equal steps of their square root.
NODES = 65


@wp.struct
class ResponseData:
    """One response of a layer or a base: its kind (from 1), its place among those of that kind, the row of its
    reflectance."""

    kind: int
    index: int
    reflectance: int


@wp.struct
class ResponseAt:
    """A response at a point; kind 0: none. The rest is for ``place`` to fill: its own axes in the frame's tangent
    plane, and in them a perturbed normal's x and y and widths of the lobe."""

    kind: int
    index: int
    reflectance: int
    delta: wp.vec2
    x: float
    y: float
    x_axis: wp.vec2
    y_axis: wp.vec2


@wp.struct
class Spot:
    """Where a response is placed: uv, how it changes along the two edges of the footprint, and the directions of the
    uv square's u and v (perpendicular to it) in the response's frame."""

    uv: wp.vec2d
    jx: wp.vec2
    jy: wp.vec2
    u_axis: wp.vec2
    v_axis: wp.vec2


Moments = wp.types.vector(length=5, dtype=wp.float32)  # means of x, y, x^2, y^2, x y of normals


@wp.struct
class NormalMapData:
    """A normal map and its facets; ``levels`` levels of its pyramid from ``first_level`` on, the finest first.

    ``distribution`` and ``deformation`` are positions in ``mdf.DISTRIBUTIONS`` and ``mdf.KINDS``, -1: the normal is
    turned and nothing deformed. ``x``, ``y``: widths along the frame's x and y; of Ashikhmin-Shirley, too.
    """

    first_level: int
    levels: int
    repeats: wp.vec2
    distribution: int
    deformation: int
    x: float
    y: float


@wp.struct
class UtiaData:
    """A file of a UTIA measurement and how to draw from it."""

    brdf: GridBrdf
    half: HalfTable


@wp.struct
class MerlData:
    """A file of a MERL measurement and how to draw from it."""

    brdf: MerlBrdf
    half: HalfTable


@wp.struct
class RglData:
    """A file of an RGL measurement and how to draw from it."""

    brdf: RglBrdf
    half: HalfTable


@wp.struct
class ResponseArrays:
    """All responses: ``reflectances [row, node]``, then the data of each kind.

    ``levels``: (first texel, width, height) of each level of a pyramid, row 0 at the top.
    """

    records: wp.array(dtype=ResponseData)
    reflectances: wp.array2d(dtype=wp.vec3)
    facets: wp.array(dtype=Lobe)
    stencils: wp.array(dtype=Stencil)
    maps: wp.array(dtype=NormalMapData)
    levels: wp.array(dtype=wp.vec3i)
    moments: wp.array(dtype=Moments)
    utia: wp.array(dtype=UtiaData)
    merl: wp.array(dtype=MerlData)
    rgl: wp.array(dtype=RglData)


@wp.func
def facet_reflectance(arrays: ResponseArrays, row: int, cos_theta: float) -> wp.vec3:
    """Reflectance of a facet, linear between nodes; 1 without a row."""
    result = wp.vec3(1.0, 1.0, 1.0)
    if row >= 0:
        at = wp.sqrt(wp.clamp(cos_theta, 0.0, 1.0)) * float(NODES - 1)
        low = wp.min(int(at), NODES - 2)
        f = at - float(low)
        result = (1.0 - f) * arrays.reflectances[row, low] + f * arrays.reflectances[row, low + 1]
    return result


@wp.func
def to_axes(at: ResponseAt, w: wp.vec3) -> wp.vec3:
    """A direction in the response's own axes."""
    tangent = wp.vec2(w[0], w[1])
    return wp.vec3(wp.dot(tangent, at.x_axis), wp.dot(tangent, at.y_axis), w[2])


@wp.func
def from_axes(at: ResponseAt, w: wp.vec3) -> wp.vec3:
    """A direction of the response's own axes, in the frame."""
    tangent = w[0] * at.x_axis + w[1] * at.y_axis
    return wp.vec3(tangent[0], tangent[1], w[2])
