"""The stencil model on the device: f_r [1/sr] of a pair of directions, float32 (Filip et al. 2015, Eq. 2 to 10).

Powers are taken as exp(alpha log(...)) with log(1 - |H . U|) by a form that keeps its digits near the ridge, so that
sharp highlights do not sit on the rounding of 1. Powers stop at e^60: towards grazing, where (1 / (cos_i cos_o))^alpha
grows beyond any albedo, the model as printed gives large finite numbers. ``hold`` ends that growth where measurements
end.
"""

import warp as wp

from ...optics.microfacets_device import half_vector

wp.set_module_options({"enable_backward": False})

_LEAST_COSINES = wp.constant(1.0e-6)
_HELD_COSINE = wp.constant(0.25881904510252074)  # of 75 degrees
_GREATEST_POWER = wp.constant(60.0)
_GREATEST = wp.constant(1.0e30)


@wp.struct
class StencilMode:
    """One mode: axis U in the surface, edges of its mask, the numbers of Eq. 6, translucency towards the next."""

    axis: wp.vec2
    low: float
    high: float
    a: float
    b: float
    kd: float
    ks: float
    alpha: float
    color: wp.vec3
    beta: float
    probability: float  # of drawing from this highlight


@wp.struct
class Stencil:
    """A model. ``hold`` 1: elevations beyond 75 degrees scale highlights no further; ``conserve`` 1: ``limit`` is used.

    ``limit [theta, phi]``: the factor that energy allows views at cos theta = (1 - row / (rows - 1))^2."""

    modes: wp.array(dtype=StencilMode)
    background: float
    k: float
    specular_alpha: float
    retro: int
    p_diffuse: float
    p_specular: float
    hold: int
    conserve: int
    limit: wp.array2d(dtype=float)


@wp.func
def stencil_half(retro: int, wo: wp.vec3, wi: wp.vec3) -> wp.vec3:
    """The half vector; of the light turned by 180 degrees when the highlights are retro-reflective."""
    turned = wp.where(retro == 1, wp.vec3(-wi[0], -wi[1], wi[2]), wi)
    return half_vector(wo, turned)


@wp.func
def axis_offset(mode: StencilMode, h: wp.vec3) -> float:
    """H . U, 0 on the ridge of the highlight."""
    return h[0] * mode.axis[0] + h[1] * mode.axis[1]


@wp.func
def stencil_mask(mode: StencilMode, x: float) -> float:
    """M at x = 1 - |H . U|: 0 below w - d_w, 1 above w + d_w, smoothstep between."""
    m = float(0.0)
    if x >= mode.high:
        m = 1.0
    elif x > mode.low:
        y = (x - mode.low) / wp.max(mode.high - mode.low, 1.0e-20)
        m = y * y * (3.0 - 2.0 * y)
    return m


@wp.func
def stencil_power(s: float, scale: float, alpha: float) -> float:
    """((1 - s) scale)^alpha for s in [0, 1]; 0 where the base is not positive, unless alpha is 0."""
    result = wp.where(alpha == 0.0, 1.0, 0.0)
    x = 1.0 - s
    if x > 0.0 and scale > 0.0 and alpha > 0.0:
        # log(1 - s) with the rounding of 1 - s taken back
        log_x = wp.where(s > 0.5, wp.log(x), wp.where(x < 1.0, wp.log(x) * s / wp.max(1.0 - x, 1.0e-20), -s))
        result = wp.exp(wp.min(alpha * (log_x + wp.log(scale)), _GREATEST_POWER))
    return result


@wp.func
def mode_value(mode: StencilMode, s: float, inverse_cosines: float) -> wp.vec3:
    """T of Eq. 6."""
    power = stencil_power(s, mode.a + mode.b * inverse_cosines, mode.alpha)
    return wp.max(mode.kd + mode.ks * power, 0.0) * mode.color


@wp.func
def limit_at(limit: wp.array2d(dtype=float), w: wp.vec3) -> float:
    """The factor of a direction, between the nodes of ``limit``; directions half a turn apart have the same."""
    rows = limit.shape[0]
    columns = limit.shape[1]
    y = (1.0 - wp.sqrt(wp.clamp(w[2], 0.0, 1.0))) * float(rows - 1)
    row = wp.clamp(int(y), 0, rows - 2)
    fy = wp.clamp(y - float(row), 0.0, 1.0)
    x = wp.atan2(w[1], w[0]) / wp.pi
    x = (x - wp.floor(x)) * float(columns)
    column = wp.clamp(int(x), 0, columns - 1)
    fx = wp.clamp(x - float(column), 0.0, 1.0)
    after = wp.where(column == columns - 1, 0, column + 1)
    above = (1.0 - fx) * limit[row, column] + fx * limit[row, after]
    below = (1.0 - fx) * limit[row + 1, column] + fx * limit[row + 1, after]
    return (1.0 - fy) * above + fy * below


@wp.func
def stencil_eval(stencil: Stencil, wo: wp.vec3, wi: wp.vec3) -> wp.vec3:
    """f_r [1/sr], B_S of Eq. 10; 0 below the horizon. ``conserve``: times the smaller factor of the two directions."""
    f = wp.vec3(0.0, 0.0, 0.0)
    if wo[2] > 0.0 and wi[2] > 0.0:
        h = stencil_half(stencil.retro, wo, wi)
        inverse = 1.0 / wp.max(wo[2] * wi[2], _LEAST_COSINES)
        if stencil.hold == 1:
            inverse = 1.0 / (wp.max(wo[2], _HELD_COSINE) * wp.max(wi[2], _HELD_COSINE))
        last = stencil.modes.shape[0] - 1
        f = stencil.background * stencil.modes[last].color
        below = wp.vec3(0.0, 0.0, 0.0)
        # from the weakest mode to the dominant one on top (Eq. 7 and 8)
        for n in range(last + 1):
            mode = stencil.modes[last - n]
            s = wp.abs(axis_offset(mode, h))
            m = stencil_mask(mode, 1.0 - s)
            t = mode_value(mode, s, inverse)
            f = (1.0 - m) * f + m * ((1.0 - mode.beta) * t + mode.beta * below)
            below = t
        top = stencil.modes[0]
        highlight = stencil.k * stencil_power(1.0 - wp.clamp(h[2], 0.0, 1.0), 1.0, stencil.specular_alpha)
        f = wp.max(highlight * (top.a + top.b * inverse), 1.0) * f
        f = wp.vec3(wp.min(f[0], _GREATEST), wp.min(f[1], _GREATEST), wp.min(f[2], _GREATEST))
        if stencil.conserve == 1:
            f = wp.min(limit_at(stencil.limit, wo), limit_at(stencil.limit, wi)) * f
    return f
