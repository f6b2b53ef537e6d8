"""The lobe that a sample chose, scratch or base, and how the material's layers are weighed to choose it."""

import warp as wp

from ..lights.light_device import Light
from ..optics.frames_device import Frame
from ..reflectance.base_device import Base
from ..reflectance.responses.response_device import ResponseAt

wp.set_module_options({"enable_backward": False})


@wp.struct
class Crossed:
    """A pair of a layer and a small light on its scratches' cones, drawn by what it reflects: ``own`` of ``total``."""

    total: float
    own: float
    alpha: float  # what the layer covers
    layer: int
    table: int
    kind: int  # of the light
    light: int
    along: wp.vec3  # the scratches
    bits: wp.uint32


@wp.struct
class Lobe:
    """One reflecting lobe at a point, ``scale`` holding 1 / probability of having chosen it."""

    scratch: int  # 1: a mirror cone from a table, 2: Lambert, 3: a response; 0: the base
    frame: Frame  # shading frame; for a scratch x runs along it
    wo: wp.vec3  # in the frame
    scale: float
    base: Base
    w_diffuse: float  # what the scratches leave of the base's diffuse and specular lobes
    w_specular: float
    table: int
    row: int
    tint: wp.vec3  # of a table's scratch, where bases are textured: local over tabulated reflectance
    sin_theta: float  # of the incident cone, sin(theta_i) = -sin(theta_o)
    diffuse_share: wp.vec3  # part of the base's value that is diffuse in the direction that was sampled from it
    response: ResponseAt  # in place of ``base``; kind 0: none
    sent: wp.vec4  # light of small lights along the cones of all scratches there, and the rays it took


@wp.struct
class Layers:
    """What the layers at a point add up to."""

    covered: float  # sum of alpha, at most 1
    kept: float  # part of it through which the base's diffuse term is seen
    weight: float  # sum of alpha times reflectance
    chosen: int  # layer drawn in proportion to that, or -1
    direction: wp.vec3  # of the chosen scratches, in the tangent plane
    xi: float  # what is left of the random number
    table: int  # of the chosen scratches
    crossed: Crossed


@wp.func
def multiplier(light: Light, lobe: Lobe) -> wp.vec3:
    """What a light's diffuse and specular multipliers make of light that was found along a sampled direction."""
    one = wp.vec3(1.0, 1.0, 1.0)
    result = light.specular * one
    if lobe.scratch != 1:
        result = light.diffuse * lobe.diffuse_share + light.specular * (one - lobe.diffuse_share)
    return result


@wp.func
def power_heuristic(a: float, b: float) -> float:
    """Weight of a sample drawn with density ``a`` where another way has density ``b`` (Veach, exponent 2)."""
    ratio = b / wp.max(a, 1.0e-30)
    return 1.0 / (1.0 + ratio * ratio)


@wp.func
def mirrored_at(direction: wp.vec3, ng: wp.vec3) -> wp.vec3:
    """The mirror image of a direction in the facet's plane.

    A shading normal spreads a lobe below the facet. That part is folded back above it, so that no energy is lost at
    silhouettes: a lobe f becomes f(w) + f(mirrored w), its density likewise, for w above the facet.
    """
    return direction - 2.0 * wp.dot(direction, ng) * ng


@wp.func
def largest(c: wp.vec3) -> float:
    """The largest channel."""
    return wp.max(wp.max(c[0], c[1]), c[2])


@wp.func
def luminance(c: wp.vec3) -> float:
    """Y of linear Rec.709."""
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]


@wp.func
def lent_tint(local: wp.vec3, tabulated: wp.vec3, sin_theta: float) -> wp.vec3:
    """What a scratch of a textured base reflects over what its table does, at most 1.

    By Schlick's reflectance at cos(theta), the greatest cosine of incidence that facets see on the cone: exact for
    facets that face the viewer and as theta goes to pi / 2; a little dark beside them, a little light after several
    bounces.
    """
    result = wp.vec3(1.0, 1.0, 1.0)
    if tabulated[0] > 0.0:
        left = wp.pow(1.0 - wp.sqrt(wp.max(1.0 - sin_theta * sin_theta, 0.0)), 5.0)
        for c in range(3):
            own = local[c] + (1.0 - local[c]) * left
            table = tabulated[c] + (1.0 - tabulated[c]) * left
            result[c] = wp.clamp(own / wp.max(table, 1.0e-6), 0.0, 1.0)
    return result
