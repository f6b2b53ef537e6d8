"""Dome light on the device: constant, or an image around everything, sampled by its brightness.

Axes ex, ey, ez: pole +Y = ey; longitude 0 is +Z = ez, longitude pi/2 is +X = ex; the image's left edge is longitude pi,
its right edge -pi, its top latitude pi/2 (OpenEXR's latlong map, whole texels). Uses ex, ey, ez, texture, rows, columns,
cdf (rows + 1 numbers of the marginal, then columns + 1 for each row).
"""

import warp as wp

from scratchwarp.lights.cap_device import whole_span
from scratchwarp.lights.light_device import FAR, Light, LightArrays, LightHit, LightSample, Span, no_hit, no_sample
from scratchwarp.optics.sampling_device import sample_uniform_sphere
from scratchwarp.reflectance.texture_device import texel_bilinear

_PI = wp.constant(3.141592653589793)
_UNIFORM = wp.constant(0.07957747154594767)  # 1 / (4 pi)


@wp.func
def interval_of(cdf: wp.array(dtype=float), first: int, count: int, u: float) -> int:
    """The i in [0, count) with cdf[first + i] <= u < cdf[first + i + 1]; never an empty interval unless all are."""
    low = int(0)
    high = int(count)
    while high - low > 1:
        middle = (low + high) // 2
        if cdf[first + middle] <= u:
            low = middle
        else:
            high = middle
    return low


@wp.func
def dome_radiance(arrays: LightArrays, l: Light, uv: wp.vec2) -> wp.vec3:
    """Radiance at image coordinates (u from the left, v up)."""
    result = l.radiance
    if l.texture >= 0:
        t = texel_bilinear(arrays.atlas, l.texture, uv, 2, 1)
        result = wp.cw_mul(result, wp.vec3(t[0], t[1], t[2]))
    return result


@wp.func
def cell_pdf(l: Light, arrays: LightArrays, row: int, column: int) -> float:
    """Density [1/sr] within a cell: its probability over its solid angle."""
    marginal = arrays.cdf[l.cdf + row + 1] - arrays.cdf[l.cdf + row]
    first = l.cdf + l.rows + 1 + row * (l.columns + 1) + column
    conditional = arrays.cdf[first + 1] - arrays.cdf[first]
    step = _PI / float(l.rows)
    # cos(top) - cos(bottom) of the row, as a product
    band = 2.0 * wp.sin(step * (float(row) + 0.5)) * wp.sin(0.5 * step)
    return marginal * conditional * float(l.columns) / (2.0 * _PI * band)


@wp.func
def sample_dome(arrays: LightArrays, l: Light, x: wp.vec3, u: wp.vec2) -> LightSample:
    """Cells of the image by their mean brightness and solid angle, uniform within a cell; the sphere when constant."""
    s = no_sample()
    s.distance = FAR
    if l.rows == 0:
        s.wi = sample_uniform_sphere(u)
        s.radiance = l.radiance
        s.pdf = _UNIFORM
    else:
        row = interval_of(arrays.cdf, l.cdf, l.rows, u[1])
        low = arrays.cdf[l.cdf + row]
        high = arrays.cdf[l.cdf + row + 1]
        t = wp.clamp((u[1] - low) / wp.max(high - low, 1.0e-30), 0.0, 1.0)
        first = l.cdf + l.rows + 1 + row * (l.columns + 1)
        column = interval_of(arrays.cdf, first, l.columns, u[0])
        low = arrays.cdf[first + column]
        high = arrays.cdf[first + column + 1]
        across = wp.clamp((u[0] - low) / wp.max(high - low, 1.0e-30), 0.0, 1.0)
        step = _PI / float(l.rows)
        # uniform in the sine of latitude: by the half angle from the nearer pole, which keeps its digits there
        from_top = step * float(row)
        half0 = wp.sin(0.5 * from_top)
        half1 = wp.sin(0.5 * (from_top + step))
        half2 = half0 * half0 + t * (half1 * half1 - half0 * half0)
        polar = 2.0 * wp.asin(wp.sqrt(wp.min(half2, 1.0)))
        s_u = (float(column) + across) / float(l.columns)
        longitude = _PI * (1.0 - 2.0 * s_u)
        ring = wp.sin(polar)
        s.wi = ring * wp.sin(longitude) * l.ex + wp.cos(polar) * l.ey + ring * wp.cos(longitude) * l.ez
        s.radiance = dome_radiance(arrays, l, wp.vec2(s_u, 1.0 - polar / _PI))
        s.pdf = cell_pdf(l, arrays, row, column)
    return s


@wp.func
def hit_dome(arrays: LightArrays, l: Light, x: wp.vec3, w: wp.vec3) -> LightHit:
    """The dome is met in every direction."""
    h = no_hit()
    h.distance = FAR
    if l.texture < 0:
        h.radiance = l.radiance
        h.pdf = _UNIFORM
    else:
        a = wp.dot(w, l.ex)
        b = wp.dot(w, l.ey)
        c = wp.dot(w, l.ez)
        polar = wp.atan2(wp.sqrt(a * a + c * c), b)
        s_u = 0.5 - 0.5 * wp.atan2(a, c) / _PI
        h.radiance = dome_radiance(arrays, l, wp.vec2(s_u, 1.0 - polar / _PI))
        h.pdf = _UNIFORM
        if l.rows > 0:
            row = wp.clamp(int(polar / _PI * float(l.rows)), 0, l.rows - 1)
            column = wp.clamp(int(s_u * float(l.columns)), 0, l.columns - 1)
            h.pdf = cell_pdf(l, arrays, row, column)
    return h


@wp.func
def span_dome(arrays: LightArrays, l: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float) -> Span:
    """Everywhere."""
    return whole_span()
