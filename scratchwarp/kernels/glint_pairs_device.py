"""Two scratches under one footprint: what they add to each other, in closed form.

The footprint sees |sum of S_m|^2 (Velinov et al. 2018 Eq. 1). The product of two nearly parallel scratches y_m and y_n
across, averaged over a Gaussian footprint, is that of one scratch half way between them times e^{-d^2 / 4 sigma^2},
d = y_m - y_n, and it oscillates as Re(P_m conj(P_n) e^{-i k d xi_2}). Where they run at an angle phi, d changes along
them by phi t: averaged over what the footprint holds, of variance c, that leaves e^{-(k xi_2 phi)^2 c / 2}; the half
square of the coherence radius in c is what their lobes, which then lie apart, still share.

Each factor is a positive semidefinite function of the two scratches, and so is their product: the sum over all pairs
of a footprint, each scratch with itself included, is not negative but for rounding. For that everything else has to be
common to all pairs: nodes of xi_2, the mean and the variance of the footprint along, the bin of 1 / wavelength. Over
a node's interval and over the bin the oscillation is integrated exactly, so that neither needs to resolve it.
"""

import warp as wp

from ..reflectance.diffraction.outline_device import outline_transform
from ..reflectance.diffraction.response_device import along_variance
from .glint_arrays_device import GlintArrays, Strand, WaveLayer, WaveMaterial, reflectance_at, reflectance_color
from .glint_stretch_device import between

MOST_MATES = 256
"""Scratches under one footprint that interfere; further ones add their light."""
_TILT = wp.constant(0.1)  # rad, beyond which scratches do not interfere
_NODES = wp.constant(32.0)  # of xi_2 to a fringe of the widest scratch
_SQRT_TWO_PI = wp.constant(2.5066282746)
_SQRT_PI = wp.constant(1.7724538509)


@wp.func
def sinc(t: float) -> float:
    """sin(pi t) / (pi t)."""
    r = 1.0 - (wp.pi * wp.pi / 6.0) * t * t
    if wp.abs(t) > 1.0e-2:
        r = wp.sin(wp.pi * (t - 2.0 * wp.rint(0.5 * t))) / (wp.pi * t)
    return r


@wp.func
def paired(
    one: Strand, two: Strand, itself: int, step_x: wp.vec3, step_y: wp.vec3, sigma: float, widest: float
) -> Strand:
    """Both as one strand in the frame of the first, length 0 where they share nothing; ``sigma`` [m]; ``widest`` [um]
    of all under the footprint."""
    r = one
    r.length = 0.0
    way = wp.where(wp.dot(one.frame.x, two.frame.x) < 0.0, -1.0, 1.0)
    tilt = way * wp.dot(two.frame.x, one.frame.y)
    size = wp.abs(tilt) / _TILT
    if size < 1.0:
        low = wp.where(way > 0.0, two.low, -two.high)
        high = wp.where(way > 0.0, two.high, -two.low)
        low = wp.max(low, one.low)
        high = wp.min(high, one.high)
        if high > low:
            xt = wp.dot(step_x, one.frame.x)
            xv = wp.dot(step_x, one.frame.y)
            yt = wp.dot(step_y, one.frame.x)
            yv = wp.dot(step_y, one.frame.y)
            soft = 0.5 * sigma * sigma
            c_tt = (xt * xt + yt * yt) / 6.0 + soft
            c_tv = (xt * xv + yt * yv) / 6.0
            c_vv = (xv * xv + yv * yv) / 6.0 + soft
            d = one.at - way * two.at
            middle = 0.5 * (one.at + way * two.at)
            mean = c_tv * middle / c_vv
            variance = wp.max(c_tt - c_tv * c_tv / c_vv, soft)
            deviation = wp.sqrt(variance)
            held = between((low - mean) / deviation, (high - mean) / deviation)
            near = 0.5 * d / sigma
            # ends smoothly: Wendland's function, positive definite as all else
            taper = wp.pow(1.0 - size, 3.0) * (3.0 * size + 1.0)
            density = wp.exp(-0.5 * middle * middle / c_vv - near * near) / (_SQRT_TWO_PI * wp.sqrt(c_vv))
            r.length = 1.0e-6 * density * held.part * taper
            r.mean = mean + deviation * held.mean
            r.variance = variance * held.variance
            r.pair.kind = wp.where(itself == 1, 1, 2)
            r.pair.width = two.width
            r.pair.depth = two.depth
            r.pair.layer = two.layer
            r.pair.way = way
            r.pair.apart = 1.0e6 * (d - tilt * mean)
            r.pair.tilt = tilt
            r.pair.variance = 1.0e12 * variance
            r.pair.widest = widest
    return r


@wp.func
def across_amplitude(
    a: GlintArrays, layer: WaveLayer, width: float, depth: float, wavelength: float, xi2: float, g: float
) -> wp.vec2:
    """P / lambda of a cross-section; ``g``: sum of the cosines."""
    ratio = width / wavelength
    if layer.facets > 0:
        p = outline_transform(
            a.outlines,
            layer.outline,
            layer.facets,
            wp.float64(ratio),
            wp.float64(depth / wavelength),
            wp.float64(xi2),
            wp.float64(g),
        )
        return wp.vec2(float(p[0]), float(p[1]))
    cycles = g * depth / wavelength
    angle = wp.pi * (cycles - wp.rint(cycles))
    sine = wp.sin(angle)
    wave = 2.0 * wp.pi * g / wavelength
    rough = wp.exp(-0.5 * wave * wave * layer.roughness * layer.roughness)
    lobe = ratio * sinc(ratio * xi2)
    return lobe * wp.vec2(1.0 - rough + 2.0 * rough * sine * sine, -2.0 * rough * sine * wp.cos(angle))


@wp.func
def pair_value(a: GlintArrays, strand: Strand, wave: WaveMaterial, wavelength: float, xi2: float, g: float) -> float:
    """Re(P_m conj(P_n) e^{-i k d xi_2}) / lambda^2 over the wavelength's bin, with what the tilt leaves."""
    pair = strand.pair
    one = across_amplitude(a, a.layers[strand.layer], strand.width, strand.depth, wavelength, xi2, g)
    r = float(0.0)
    if pair.kind == 1:
        r = wp.dot(one, one)
    else:
        two = across_amplitude(a, a.layers[pair.layer], pair.width, pair.depth, wavelength, pair.way * xi2, g)
        cycles = pair.apart * xi2 / wavelength
        angle = 2.0 * wp.pi * (cycles - wp.rint(cycles))
        real = one[0] * two[0] + one[1] * two[1]
        imaginary = one[1] * two[0] - one[0] * two[1]
        turn = 2.0 * wp.pi / wavelength * xi2 * pair.tilt
        left = wp.exp(-0.5 * turn * turn * pair.variance) * sinc(pair.apart * xi2 * wave.bin)
        r = left * (real * wp.cos(angle) + imaginary * wp.sin(angle))
    return r


@wp.func
def along_value(strand: Strand, own: float, spread: float, x: float, xi2: float) -> float:
    """The lobe along half way between both."""
    variance = own + spread
    y = x + 0.5 * strand.pair.tilt * xi2
    return wp.sqrt(own / variance) * wp.exp(-0.5 * y * y / variance)


@wp.func
def pair_reflectance(a: GlintArrays, strand: Strand, wavelength: int, cosine: float) -> wp.vec3:
    """Geometric mean of what both reflect at a wavelength of the material."""
    one = a.layers[strand.layer]
    two = a.layers[strand.pair.layer]
    r = wp.vec3(1.0, 1.0, 1.0)
    both = wp.vec3(1.0, 1.0, 1.0)
    if one.per_wavelength == 1:
        r = reflectance_at(a, one.reflect, wavelength, cosine) * r
    else:
        r = reflectance_color(a, one.reflect, cosine)
    if strand.pair.kind == 1:
        return r
    if two.per_wavelength == 1:
        both = reflectance_at(a, two.reflect, wavelength, cosine) * both
    else:
        both = reflectance_color(a, two.reflect, cosine)
    for c in range(3):
        r[c] = wp.sqrt(wp.max(r[c] * both[c], 0.0))
    return r


@wp.func
def pair_point(
    a: GlintArrays,
    wave: WaveMaterial,
    layer: WaveLayer,
    strand: Strand,
    spread: float,
    shift: float,
    i: wp.vec3,
    o: wp.vec3,
) -> wp.vec3:
    """Under irradiance 1 across one direction."""
    total = wp.vec3(0.0, 0.0, 0.0)
    x = i[0] + o[0] + shift
    xi2 = i[1] + o[1]
    cosine = wp.sqrt(wp.max(0.5 + 0.5 * wp.dot(i, o), 0.0))
    g = wp.where(layer.angles == 1, i[2] + o[2], 2.0)
    for k in range(wave.count):
        wavelength = a.wavelengths[wave.first + k]
        value = along_value(strand, along_variance(wave.sigma, wavelength), spread, x, xi2)
        value *= pair_value(a, strand, wave, wavelength, xi2, g)
        total += value * wp.cw_mul(pair_reflectance(a, strand, k, cosine), a.colors[wave.first + k])
    return total * (2.0 * _SQRT_PI * wave.sigma * strand.length * i[2] * float(strand.pair.kind))


@wp.func
def pair_slices(
    a: GlintArrays,
    wave: WaveMaterial,
    layer: WaveLayer,
    strand: Strand,
    spread: float,
    o: wp.vec3,
    shift: float,
    whole: int,
    count: int,
    places: wp.array(dtype=wp.vec3),
    cuts: wp.array(dtype=wp.vec4),
) -> wp.vec3:
    """Over the slices of a light, as ``glint_sums_device.radiance_of``."""
    total = wp.vec3(0.0, 0.0, 0.0)
    for i in range(count):
        place = places[i]
        u = place[0] - o[0] - shift
        s2 = wp.max((1.0 - u) * (1.0 + u), 0.0)
        for half in range(2):
            low = cuts[i][2 * half]
            high = cuts[i][2 * half + 1]
            if high > low:
                for k in range(wave.count):
                    wavelength = a.wavelengths[wave.first + k]
                    own = along_variance(wave.sigma, wavelength)
                    panels = wp.clamp(wp.ceil(_NODES * strand.pair.widest * (high - low) / wavelength), 1.0, 4096.0)
                    step = (high - low) / panels
                    value = float(0.0)
                    for n in range(int(panels)):
                        xi2 = low + step * (float(n) + 0.5)
                        g = float(2.0)
                        if layer.angles == 1:
                            across = xi2 - o[1]
                            g = o[2] + wp.sqrt(wp.max(s2 - across * across, 0.0))
                        part = pair_value(a, strand, wave, wavelength, xi2, g)
                        if whole == 0:
                            part *= along_value(strand, own, spread, place[0], xi2)
                        value += part
                    if whole == 1:
                        value *= _SQRT_TWO_PI * wp.sqrt(own)
                    # over a node's interval, the oscillation exactly
                    value *= place[1] * step * sinc(strand.pair.apart * step / wavelength)
                    color = wp.cw_mul(pair_reflectance(a, strand, k, place[2]), a.colors[wave.first + k])
                    total += value * color
    return total * (2.0 * _SQRT_PI * wave.sigma * strand.length * float(strand.pair.kind))
