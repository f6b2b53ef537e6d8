"""One scratch in the plane of the shading point: its complex response S and what follows from it.

Frame of the scratch: (along u, across v, normal n). Amplitudes are divided by sqrt(A_C) lambda, A_C = pi sigma^2, so
that |amplitude|^2 is a BRDF [1/sr] (Velinov et al. 2018 Eq. 1). k = 2 pi / lambda.
"""

import warp as wp

from .complex_device import complex_product, phasor, power
from .faddeeva_device import damped_erf_between
from .lobe_device import sinc
from .outline_device import outline_transform
from .real_device import HALF, ONE, PI, TWO, ZERO, real, vec2, vec3, vec4

_SQRT2 = wp.constant(real(1.4142135623730951))


@wp.struct
class WaveScratch:
    """Lengths in micrometres. ``first``, ``count``: rows of its outline, none for a rectangle. ``start`` and ``end``
    along u from the shading point, both infinite for an endless scratch."""

    cosine: real  # of the azimuth of u
    sine: real
    width: real
    depth: real
    offset: real
    sigma: real
    start: real
    end: real
    depth_spread: real
    roughness: real
    first: int
    count: int


@wp.func
def to_scratch(s: WaveScratch, w: vec3) -> vec3:
    """Components along u, v and n of a vector in the shading frame."""
    return vec3(w[0] * s.cosine + w[1] * s.sine, w[1] * s.cosine - w[0] * s.sine, w[2])


@wp.func
def is_finite(s: WaveScratch) -> bool:
    """Whether the scratch has an end."""
    return wp.isfinite(s.start) or wp.isfinite(s.end)


@wp.func
def along_amplitude(s: WaveScratch, wavelength: real, xi1: real) -> vec2:
    """eta / (sqrt(2 A_C) e^{-s_b^2 / 2 sigma^2} e^{-i k s_b xi_2}), Eq. 5; e^{-(sigma k xi_1)^2 / 2} without ends."""
    y = _SQRT2 * PI * (s.sigma / wavelength) * xi1
    r = vec2(wp.exp(-y * y), ZERO)
    if is_finite(s):
        scale = ONE / (_SQRT2 * s.sigma)
        r = HALF * damped_erf_between(s.start * scale, s.end * scale, y)
    return r


@wp.func
def along_share(s: WaveScratch) -> real:
    """Share of the integral over xi_1 of |eta|^2 that the ends leave, [erf(end / sigma) - erf(start / sigma)] / 2
    (Parseval)."""
    r = ONE
    if is_finite(s):
        x0 = s.start / s.sigma
        x1 = s.end / s.sigma
        # same sign: the complement keeps the digits
        if x0 > ZERO:
            r = HALF * (wp.erfc(x0) - wp.erfc(x1))
        elif x1 < ZERO:
            r = HALF * (wp.erfc(-x1) - wp.erfc(-x0))
        else:
            r = HALF * (wp.erf(x1) - wp.erf(x0))
    return r


@wp.func
def offset_weight(s: WaveScratch) -> real:
    """e^{-s_b^2 / sigma^2} (Eq. 10, with the square that it lacks)."""
    x = s.offset / s.sigma
    return wp.exp(-x * x)


@wp.func
def depth_power(s: WaveScratch, wavelength: real, g: real) -> real:
    """Mean |D|^2 = 4 sin^2(k g depth / 2), g the sum of the cosines, 2 for small angles (Eq. 11 in its stable form).

    With v = (k g depth_spread)^2 of depths that vary along the scratch and r = (k g roughness)^2 of its floor: 1 +
    e^{-r} - 2 e^{-(r + v)/2} cos(k g depth).
    """
    cycles = g * s.depth / wavelength
    sine = wp.sin(PI * (cycles - wp.rint(cycles)))
    r = real(4.0) * sine * sine
    if s.depth_spread > ZERO or s.roughness > ZERO:
        wave = TWO * PI * g / wavelength
        rough = wp.exp(-HALF * wave * wave * s.roughness * s.roughness)
        spread = wp.exp(-HALF * wave * wave * s.depth_spread * s.depth_spread)
        r = (ONE - rough) * (ONE - rough) + TWO * rough * (ONE - spread) + rough * spread * r
    return r


@wp.func
def across_power(s: WaveScratch, outlines: wp.array(dtype=vec4), wavelength: real, xi2: real, g: real) -> real:
    """|W D|^2 / lambda^2 across the scratch at xi_2: sinc^2 of a rectangle, |P|^2 of an outline."""
    if s.count > 0:
        p = outline_transform(outlines, s.first, s.count, s.width / wavelength, s.depth / wavelength, xi2, g)
        return power(p)
    ratio = s.width / wavelength
    lobe = ratio * sinc(ratio * xi2)
    return lobe * lobe * depth_power(s, wavelength, g)


@wp.func
def across_amplitude(s: WaveScratch, outlines: wp.array(dtype=vec4), wavelength: real, xi2: real, g: real) -> vec2:
    """W D / lambda, complex (Eq. 3 and 4): the integral of 1 - e^{i phase} over the width, over lambda."""
    if s.count > 0:
        return outline_transform(outlines, s.first, s.count, s.width / wavelength, s.depth / wavelength, xi2, g)
    ratio = s.width / wavelength
    wave = TWO * PI * g * s.roughness / wavelength
    rough = wp.exp(-HALF * wave * wave)
    cycles = g * s.depth / wavelength
    sine = wp.sin(PI * (cycles - wp.rint(cycles)))
    cosine = wp.cos(PI * (cycles - wp.rint(cycles)))
    # 1 - rough e^{i a} = (1 - rough) + rough (1 - e^{i a}), 1 - e^{i a} = 2 sin^2(a/2) - 2 i sin(a/2) cos(a/2)
    d = vec2(ONE - rough + rough * TWO * sine * sine, -rough * TWO * sine * cosine)
    return ratio * sinc(ratio * xi2) * d


@wp.func
def sum_of_cosines(omega_i: vec3, omega_o: vec3, angle_dependent: int) -> real:
    """g of the depth phase k g depth: gamma_i + gamma_o, or 2 for small angles (Eq. 4)."""
    return wp.where(angle_dependent != 0, omega_i[2] + omega_o[2], TWO)


@wp.func
def scratch_amplitude(
    s: WaveScratch,
    outlines: wp.array(dtype=vec4),
    wavelength: real,
    omega_i: vec3,
    omega_o: vec3,
    angle_dependent: int,
) -> vec2:
    """S / (sqrt(A_C) lambda) of one scratch (Eq. 2 to 5); directions in the shading frame, above the horizon."""
    xi = to_scratch(s, omega_i + omega_o)
    g = sum_of_cosines(omega_i, omega_o, angle_dependent)
    x = s.offset / s.sigma
    place = _SQRT2 * wp.exp(-HALF * x * x) * phasor(-s.offset * xi[1] / wavelength)
    response = complex_product(
        along_amplitude(s, wavelength, xi[0]), across_amplitude(s, outlines, wavelength, xi[1], g)
    )
    return complex_product(place, response)


@wp.func
def scratch_brdf(
    s: WaveScratch,
    outlines: wp.array(dtype=vec4),
    wavelength: real,
    omega_i: vec3,
    omega_o: vec3,
    angle_dependent: int,
) -> real:
    """|S|^2 / (A_C lambda^2) [1/sr], 0 at and below the horizon; without ends 2 (W / lambda)^2 sinc^2 |D|^2 e^{-s_b^2
    / sigma^2} e^{-(sigma k xi_1)^2}."""
    r = ZERO
    if omega_i[2] > ZERO and omega_o[2] > ZERO:
        xi = to_scratch(s, omega_i + omega_o)
        g = sum_of_cosines(omega_i, omega_o, angle_dependent)
        along = power(along_amplitude(s, wavelength, xi[0]))
        if along > ZERO:
            r = TWO * offset_weight(s) * along * across_power(s, outlines, wavelength, xi[1], g)
    return r


@wp.func
def mirror_amplitude(sigma: real, wavelength: real, omega_i: vec3, omega_o: vec3) -> real:
    """B / (sqrt(A_C) lambda) of the flat surface, B = 2 pi sigma^2 e^{-(sigma k |xi|)^2 / 2}."""
    xi = omega_i + omega_o
    ratio = sigma / wavelength
    wave = TWO * PI * ratio
    exponent = HALF * wave * wave * (xi[0] * xi[0] + xi[1] * xi[1])
    return TWO * wp.sqrt(PI) * ratio * wp.exp(-exponent)
