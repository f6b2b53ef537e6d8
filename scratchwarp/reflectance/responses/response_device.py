"""What every response over solid angle takes and returns, and the data of all of them.

A response is a pair of device functions over directions in its own frame (n = +z; on a scratch x runs along it):
``eval(arrays, at, wo, wi) -> BaseTerms`` (f_r cos(theta_i) and the density) and ``sample(arrays, at, wo, u, v) ->
BaseSample``. One that varies over the surface has a third, ``place(arrays, at, spot) -> ResponseAt``.
"""

import warp as wp

from ..mdf.lobe_device import Lobe

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
    """A response at a point; kind 0: none. The rest is for ``place`` to fill: a perturbed normal's x and y, widths of
    the lobe, and the turn of its axes from the frame's."""

    kind: int
    index: int
    reflectance: int
    delta: wp.vec2
    x: float
    y: float
    cos_turn: float
    sin_turn: float


@wp.struct
class Spot:
    """Where a response is placed: uv, how it changes along the two edges of the footprint, and the directions of the
    uv square's u and v (perpendicular to it) in the response's frame."""

    uv: wp.vec2d
    jx: wp.vec2
    jy: wp.vec2
    u_axis: wp.vec2
    v_axis: wp.vec2


@wp.struct
class ResponseArrays:
    """All responses: ``reflectances [row, node]``, then the data of each kind."""

    records: wp.array(dtype=ResponseData)
    reflectances: wp.array2d(dtype=wp.vec3)
    facets: wp.array(dtype=Lobe)


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
