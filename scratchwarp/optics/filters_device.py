"""Pixel reconstruction filters by importance sampling: offsets from the pixel centre, every sample of weight 1.

``u`` in [0, 1)^2, ``width`` the full side of the square support [pixels]. All filters are separable, non-negative and
inverted exactly, so the film needs no weights. Source: Ernst, Stamminger and Greiner 2006, "Filter Importance
Sampling"; the window of Harris 1978 (four-term Blackman-Harris).
"""

import warp as wp

_GAUSSIAN_CUT = wp.constant(0.9973002039367398)  # erf(3 / sqrt(2)): the support ends at three standard deviations
_SQRT_HALF = wp.constant(0.7071067811865476)
_TWO_PI = wp.constant(6.283185307179586)
# a_j / (2 pi j a_0) of the Blackman-Harris window
_BH1 = wp.constant(0.48829 / 0.35875 / 6.283185307179586)
_BH2 = wp.constant(0.14128 / 0.35875 / 12.566370614359172)
_BH3 = wp.constant(0.01168 / 0.35875 / 18.84955592153876)


@wp.func
def filter_offset_box(u: wp.vec2, width: float) -> wp.vec2:
    """Uniform over the support."""
    return wp.vec2((u[0] - 0.5) * width, (u[1] - 0.5) * width)


@wp.func
def gaussian_quantile(u: float) -> float:
    """Inverse CDF of a Gaussian cut at three standard deviations, in units of its full support: [-0.5, 0.5]."""
    # the standard deviation is a sixth of the support: sqrt(2) / 6 = sqrt(1/2) / 3
    return wp.clamp(wp.erfinv((2.0 * u - 1.0) * _GAUSSIAN_CUT) * _SQRT_HALF / 3.0, -0.5, 0.5)


@wp.func
def filter_offset_gaussian(u: wp.vec2, width: float) -> wp.vec2:
    """Gaussian of standard deviation ``width`` / 6, cut at the support (3 sigma)."""
    return wp.vec2(gaussian_quantile(u[0]) * width, gaussian_quantile(u[1]) * width)


@wp.func
def blackman_harris_quantile(u: float) -> float:
    """Inverse CDF of the Blackman-Harris window, in units of its full support: [-0.5, 0.5].

    An odd polynomial of the normal quantile is within 5e-4 (least squares over the range that float32 reaches); two
    Newton steps finish. The sines of multiples of the angle follow from one sine and cosine.
    """
    z = wp.clamp(1.4142135623730951 * wp.erfinv(2.0 * u - 1.0), -5.3, 5.3)
    z2 = z * z
    t = wp.clamp(z * (1.4298281e-1 + z2 * (-1.39164668e-3 + z2 * (-2.5951875e-5 + z2 * 4.906409e-7))), -0.5, 0.5)
    for _step in range(2):
        angle = _TWO_PI * t
        s1 = wp.sin(angle)
        c1 = wp.cos(angle)
        s2 = 2.0 * s1 * c1
        c2 = 2.0 * c1 * c1 - 1.0
        s3 = s2 * c1 + c2 * s1
        c3 = c2 * c1 - s2 * s1
        excess = 0.5 + t + _BH1 * s1 + _BH2 * s2 + _BH3 * s3 - u
        density = 1.0 + _TWO_PI * (_BH1 * c1 + 2.0 * _BH2 * c2 + 3.0 * _BH3 * c3)
        # next to the ends the density is too small for a step in float32: the polynomial stands
        t = wp.where(density > 1.0e-3, wp.clamp(t - excess / wp.max(density, 1.0e-3), -0.5, 0.5), t)
    return t


@wp.func
def filter_offset_blackman_harris(u: wp.vec2, width: float) -> wp.vec2:
    """Four-term Blackman-Harris window over the support; its standard deviation is ``width`` / 7.22."""
    return wp.vec2(blackman_harris_quantile(u[0]) * width, blackman_harris_quantile(u[1]) * width)


@wp.func
def filter_density_box(at: wp.vec2, width: float) -> float:
    """Density of ``filter_offset_box`` at an offset [1 / pixel^2]."""
    return wp.where(wp.max(wp.abs(at[0]), wp.abs(at[1])) <= 0.5 * width, 1.0 / (width * width), 0.0)


@wp.func
def filter_density_gaussian(at: wp.vec2, width: float) -> float:
    """Density of ``filter_offset_gaussian``."""
    x = 6.0 / width * at
    # 36 / (2 pi 0.9973^2)
    inside = wp.where(wp.max(wp.abs(x[0]), wp.abs(x[1])) <= 3.0, 5.760641, 0.0)
    return inside / (width * width) * wp.exp(-0.5 * wp.dot(x, x))


@wp.func
def blackman_harris_density(t: float) -> float:
    """Density over the full support [-0.5, 0.5]."""
    angle = _TWO_PI * t
    waves = _BH1 * wp.cos(angle) + 2.0 * _BH2 * wp.cos(2.0 * angle) + 3.0 * _BH3 * wp.cos(3.0 * angle)
    return wp.where(wp.abs(t) <= 0.5, wp.max(1.0 + _TWO_PI * waves, 0.0), 0.0)


@wp.func
def filter_density_blackman_harris(at: wp.vec2, width: float) -> float:
    """Density of ``filter_offset_blackman_harris``."""
    return blackman_harris_density(at[0] / width) * blackman_harris_density(at[1] / width) / (width * width)
