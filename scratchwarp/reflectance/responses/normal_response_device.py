"""Facets around the normals of a scratch normal map (Kang and Cho 2011), filtered over the footprint.

The map's pyramid holds the means of the normals' x and y and of their products. What a footprint averages away of the
normals goes into the lobe: the covariance of the facets is that of their distribution, widths^2 / 2, plus that of the
normals, and the lobe is turned into the sum's own axes.
"""

import warp as wp

from ...optics.frames_device import Frame, frame_with_tangent, to_local, to_world
from ...optics.microfacets_device import half_vector
from ..base_device import BaseSample, BaseTerms
from ..mdf.distributions_device import ASHIKHMIN_SHIRLEY
from ..mdf.lobe_device import Lobe, lobe_eval, lobe_pdf, lobe_sample
from .response_device import (
    Moments,
    NormalMapData,
    ResponseArrays,
    ResponseAt,
    Spot,
    facet_reflectance,
    from_axes,
    to_axes,
)

wp.set_module_options({"enable_backward": False})

_LONGEST = wp.constant(0.99)


@wp.func
def level_moments(arrays: ResponseArrays, level: int, s: float, t: float) -> Moments:
    """Bilinear, repeated; (s, t) in [0, 1), t upwards."""
    shape = arrays.levels[level]
    x = s * float(shape[1]) - 0.5
    y = (1.0 - t) * float(shape[2]) - 0.5
    fx = x - wp.floor(x)
    fy = y - wp.floor(y)
    i = (int(wp.floor(x)) + shape[1]) % shape[1]
    j = (int(wp.floor(y)) + shape[2]) % shape[2]
    i1 = (i + 1) % shape[1]
    j1 = (j + 1) % shape[2]
    upper = shape[0] + j * shape[1]
    lower = shape[0] + j1 * shape[1]
    above = (1.0 - fx) * arrays.moments[upper + i] + fx * arrays.moments[upper + i1]
    below = (1.0 - fx) * arrays.moments[lower + i] + fx * arrays.moments[lower + i1]
    return (1.0 - fy) * above + fy * below


@wp.func
def footprint_moments(arrays: ResponseArrays, m: NormalMapData, spot: Spot) -> Moments:
    """Means over the footprint: between two levels of the pyramid, by its longer edge."""
    shape = arrays.levels[m.first_level]
    size = wp.vec2(m.repeats[0] * float(shape[1]), m.repeats[1] * float(shape[2]))
    along = wp.length(wp.cw_mul(spot.jx, size))
    aside = wp.length(wp.cw_mul(spot.jy, size))
    at = wp.clamp(wp.log2(wp.max(wp.max(along, aside), 1.0)), 0.0, float(m.levels - 1))
    low = wp.min(int(at), m.levels - 1)
    f = at - float(low)
    s = spot.uv[0] * wp.float64(m.repeats[0])
    t = spot.uv[1] * wp.float64(m.repeats[1])
    u = float(s - wp.floor(s))
    v = float(t - wp.floor(t))
    found = level_moments(arrays, m.first_level + low, u, v)
    if f > 0.0:
        found = (1.0 - f) * found + f * level_moments(arrays, m.first_level + low + 1, u, v)
    return found


@wp.func
def normal_response_place(arrays: ResponseArrays, at: ResponseAt, spot: Spot) -> ResponseAt:
    """The mean normal, and the lobe widened by the others, in the axes of the widened lobe."""
    m = arrays.maps[at.index]
    found = footprint_moments(arrays, m, spot)
    # from the map's axes to the frame's
    u = spot.u_axis
    v = spot.v_axis
    mean = found[0] * u + found[1] * v
    xx = wp.max(found[2] - found[0] * found[0], 0.0)
    yy = wp.max(found[3] - found[1] * found[1], 0.0)
    xy = found[4] - found[0] * found[1]
    a = 0.5 * m.x * m.x + xx * u[0] * u[0] + 2.0 * xy * u[0] * v[0] + yy * v[0] * v[0]
    b = 0.5 * m.y * m.y + xx * u[1] * u[1] + 2.0 * xy * u[1] * v[1] + yy * v[1] * v[1]
    c = xx * u[0] * u[1] + xy * (u[0] * v[1] + u[1] * v[0]) + yy * v[0] * v[1]
    turn = 0.5 * wp.atan2(2.0 * c, a - b)
    middle = 0.5 * (a + b)
    apart = wp.sqrt(0.25 * (a - b) * (a - b) + c * c)
    r = at
    r.x_axis = wp.vec2(wp.cos(turn), wp.sin(turn))
    r.y_axis = wp.vec2(-r.x_axis[1], r.x_axis[0])
    r.x = wp.clamp(wp.sqrt(2.0 * (middle + apart)), 1.0e-3, 1.0)
    r.y = wp.clamp(wp.sqrt(2.0 * wp.max(middle - apart, 0.0)), 1.0e-3, 1.0)
    length = wp.length(mean)
    mean = mean * wp.min(_LONGEST / wp.max(length, 1.0e-20), 1.0)
    r.delta = wp.vec2(wp.dot(mean, r.x_axis), wp.dot(mean, r.y_axis))
    return r


@wp.func
def placed_lobe(m: NormalMapData, at: ResponseAt) -> Lobe:
    """The lobe with the widths that the point has."""
    lobe = Lobe()
    lobe.distribution = m.distribution
    lobe.kind = wp.max(m.deformation, 0)
    lobe.x = at.x
    lobe.y = at.y
    if m.distribution == ASHIKHMIN_SHIRLEY:
        lobe.x = 2.0 / (at.x * at.x) - 2.0
        lobe.y = 2.0 / (at.y * at.y) - 2.0
    return lobe


@wp.func
def mapped_frame(at: ResponseAt) -> Frame:
    """The frame about the perturbed normal, in the response's axes."""
    n = wp.vec3(at.delta[0], at.delta[1], wp.sqrt(wp.max(1.0 - wp.dot(at.delta, at.delta), 0.0)))
    return frame_with_tangent(n, wp.vec3(1.0, 0.0, 0.0))


@wp.func
def normal_response_eval(arrays: ResponseArrays, at: ResponseAt, wo: wp.vec3, wi: wp.vec3) -> BaseTerms:
    """f_r cos(theta_i) and density."""
    t = BaseTerms()
    if wo[2] > 0.0 and wi[2] > 0.0:
        m = arrays.maps[at.index]
        lobe = placed_lobe(m, at)
        o = to_axes(at, wo)
        i = to_axes(at, wi)
        delta = at.delta
        if m.deformation < 0:
            f = mapped_frame(at)
            o = to_local(f, o)
            i = to_local(f, i)
            delta = wp.vec2(0.0, 0.0)
        if o[2] > 0.0 and i[2] > 0.0:
            value = lobe_eval(lobe, delta, o, i) * i[2]
            t.value = value * facet_reflectance(arrays, at.reflectance, wp.dot(wo, half_vector(wo, wi)))
            t.pdf = lobe_pdf(lobe, delta, o, i)
    return t


@wp.func
def normal_response_sample(arrays: ResponseArrays, at: ResponseAt, wo: wp.vec3, u: wp.vec2, v: float) -> BaseSample:
    """A direction; pdf 0: none."""
    m = arrays.maps[at.index]
    lobe = placed_lobe(m, at)
    o = to_axes(at, wo)
    delta = at.delta
    f = mapped_frame(at)
    if m.deformation < 0:
        o = to_local(f, o)
        delta = wp.vec2(0.0, 0.0)
    drawn = lobe_sample(lobe, delta, o, u, v)
    w = drawn.wi
    if m.deformation < 0:
        w = to_world(f, w)
    s = BaseSample()
    s.wi = from_axes(at, w)
    if drawn.pdf > 0.0 and s.wi[2] > 0.0 and wo[2] > 0.0:
        s.pdf = drawn.pdf
        reflected = facet_reflectance(arrays, at.reflectance, wp.dot(wo, half_vector(wo, s.wi)))
        s.weight = drawn.weight * reflected
    return s
