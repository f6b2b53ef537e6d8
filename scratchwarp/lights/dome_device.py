"""Dome light on the device: constant, or an image around everything, sampled by its brightness.

Axes ex, ey, ez: pole +Y = ey; longitude 0 is +Z = ez, longitude pi/2 is +X = ex; the image's left edge is longitude pi,
its right edge -pi, its top latitude pi/2 (OpenEXR's latlong map, whole texels). Uses ex, ey, ez, texture, rows,
columns, cdf (rows + 1 numbers of the marginal, then columns + 1 for each row).
"""

import warp as wp

from scratchwarp.lights.cap_device import whole_span
from scratchwarp.lights.cdf_device import interval_of
from scratchwarp.lights.light_device import FAR, Light, LightArrays, LightHit, LightSample, Span, no_hit, no_sample
from scratchwarp.optics.sampling_device import sample_uniform_sphere
from scratchwarp.reflectance.texture_device import texel_bilinear

_PI = wp.constant(3.141592653589793)
_UNIFORM = wp.constant(0.07957747154594767)  # 1 / (4 pi)


@wp.func
def dome_radiance(arrays: LightArrays, light: Light, uv: wp.vec2) -> wp.vec3:
    """Radiance at image coordinates (u from the left, v up)."""
    result = light.radiance
    if light.texture >= 0:
        t = texel_bilinear(arrays.atlas, light.texture, uv, 2, 1)
        result = wp.cw_mul(result, wp.vec3(t[0], t[1], t[2]))
    return result


@wp.func
def cell_pdf(light: Light, arrays: LightArrays, row: int, column: int) -> float:
    """Density [1/sr] within a cell: its probability over its solid angle."""
    marginal = arrays.cdf[light.cdf + row + 1] - arrays.cdf[light.cdf + row]
    first = light.cdf + light.rows + 1 + row * (light.columns + 1) + column
    conditional = arrays.cdf[first + 1] - arrays.cdf[first]
    step = _PI / float(light.rows)
    # cos(top) - cos(bottom) of the row, as a product
    band = 2.0 * wp.sin(step * (float(row) + 0.5)) * wp.sin(0.5 * step)
    return marginal * conditional * float(light.columns) / (2.0 * _PI * band)


@wp.func
def sample_dome(arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec2) -> LightSample:
    """Cells of the image by their mean brightness and solid angle, uniform within a cell; the sphere when constant."""
    s = no_sample()
    s.distance = FAR
    if light.rows == 0:
        s.wi = sample_uniform_sphere(u)
        s.radiance = light.radiance
        s.pdf = _UNIFORM
    else:
        row = interval_of(arrays.cdf, light.cdf, light.rows, u[1])
        low = arrays.cdf[light.cdf + row]
        high = arrays.cdf[light.cdf + row + 1]
        t = wp.clamp((u[1] - low) / wp.max(high - low, 1.0e-30), 0.0, 1.0)
        first = light.cdf + light.rows + 1 + row * (light.columns + 1)
        column = interval_of(arrays.cdf, first, light.columns, u[0])
        low = arrays.cdf[first + column]
        high = arrays.cdf[first + column + 1]
        across = wp.clamp((u[0] - low) / wp.max(high - low, 1.0e-30), 0.0, 1.0)
        step = _PI / float(light.rows)
        # uniform in the sine of latitude: by the half angle from the nearer pole, which keeps its digits there
        from_top = step * float(row)
        half0 = wp.sin(0.5 * from_top)
        half1 = wp.sin(0.5 * (from_top + step))
        half2 = half0 * half0 + t * (half1 * half1 - half0 * half0)
        polar = 2.0 * wp.asin(wp.sqrt(wp.min(half2, 1.0)))
        s_u = (float(column) + across) / float(light.columns)
        longitude = _PI * (1.0 - 2.0 * s_u)
        ring = wp.sin(polar)
        s.wi = ring * wp.sin(longitude) * light.ex + wp.cos(polar) * light.ey + ring * wp.cos(longitude) * light.ez
        s.radiance = dome_radiance(arrays, light, wp.vec2(s_u, 1.0 - polar / _PI))
        s.pdf = cell_pdf(light, arrays, row, column)
    return s


@wp.func
def hit_dome(arrays: LightArrays, light: Light, x: wp.vec3, w: wp.vec3) -> LightHit:
    """The dome is met in every direction."""
    h = no_hit()
    h.distance = FAR
    if light.texture < 0:
        h.radiance = light.radiance
        h.pdf = _UNIFORM
    else:
        a = wp.dot(w, light.ex)
        b = wp.dot(w, light.ey)
        c = wp.dot(w, light.ez)
        polar = wp.atan2(wp.sqrt(a * a + c * c), b)
        s_u = 0.5 - 0.5 * wp.atan2(a, c) / _PI
        h.radiance = dome_radiance(arrays, light, wp.vec2(s_u, 1.0 - polar / _PI))
        h.pdf = _UNIFORM
        if light.rows > 0:
            row = wp.clamp(int(polar / _PI * float(light.rows)), 0, light.rows - 1)
            column = wp.clamp(int(s_u * float(light.columns)), 0, light.columns - 1)
            h.pdf = cell_pdf(light, arrays, row, column)
    return h


@wp.func
def span_dome(
    arrays: LightArrays, light: Light, x: wp.vec3, u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float
) -> Span:
    """Everywhere."""
    return whole_span()
