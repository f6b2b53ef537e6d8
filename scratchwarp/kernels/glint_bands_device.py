"""Regular patterns that diffract: how many of their lines a footprint holds, which way they run, their orders.

Parallel lines at a pitch below the coherence radius are a grating. The sum over all pairs of them, e^{-(m P)^2 / 4
sigma^2} cos(k xi_2 m P), is by Poisson's formula a sum over orders,

    f = 4 pi (sigma W / (lambda P))^2 sinc^2 |D|^2 sum over n of e^{-(sigma k)^2 (xi_1^2 + (xi_2 - n lambda / P)^2)}.

Order 0 lies in the mirror direction, where it and what interferes with the base are the base's: it keeps 1 - a (1 - a)
|D|^2, a = W / P. Over a light each other order shows the wavelengths lambda = P xi_2 / n that the light's interval of
xi_2 gives: an integral over wavelengths, not a sampling of them.
"""

import warp as wp

from ..optics.frames_device import frame_with_tangent
from ..reflectance.diffraction.response_device import along_variance
from .geometry_device import Geometry, Surface, uv_motion
from .glint_across_device import across_value
from .glint_arrays_device import BandData, GlintArrays, Spectrum, Strand, WaveLayer, WaveMaterial, reflectance_at

_vec3x = wp.types.vector(length=3, dtype=float)
_NODES = wp.constant(_vec3x(0.112701665, 0.5, 0.887298335))
_WEIGHTS = wp.constant(_vec3x(0.277777778, 0.444444444, 0.277777778))
_PANEL = wp.constant(0.04)  # um of wavelength for three nodes
_LONGEST_PITCH = wp.constant(1000.0)  # um: orders closer than any eye tells apart, thousands of them
_SQRT_TWO_PI = wp.constant(2.5066282746)
_SQRT_PI = wp.constant(1.7724538509)

LINEAR = wp.constant(0)
CONCENTRIC = wp.constant(1)
SPIRAL = wp.constant(2)


@wp.func
def spectrum_at(s: Spectrum, wavelength: float) -> wp.vec3:
    """Linear between the nodes, 0 outside."""
    at = (wavelength - s.first) / s.step
    r = wp.vec3(0.0, 0.0, 0.0)
    if at > 0.0 and at < float(s.colors.shape[0] - 1):
        cell = int(at)
        t = at - float(cell)
        r = (1.0 - t) * s.colors[cell] + t * s.colors[cell + 1]
    return r


@wp.func
def last_wavelength(s: Spectrum) -> float:
    """The longest."""
    return s.first + s.step * float(s.colors.shape[0] - 1)


@wp.func
def lines_held(at: float, deviation: float, pitch: float) -> float:
    """Sum of a Gaussian's density over lines ``pitch`` apart, the nearest ``at`` away; 1 / pitch where it is wide."""
    r = 1.0 / pitch
    if deviation < 0.6 * pitch:
        r = 0.0
        for i in range(7):
            x = (at + float(i - 3) * pitch) / deviation
            r += wp.exp(-0.5 * x * x) / (_SQRT_TWO_PI * deviation)
    return r


@wp.func
def band_strand(
    band: BandData, g: Geometry, s: Surface, n: wp.vec3, step_x: wp.vec3, step_y: wp.vec3, sigma: float
) -> Strand:
    """All lines of a pattern under the footprint as one strand; ``sigma`` [m]."""
    r = Strand()
    du = g.dpdu[s.face]
    dv = g.dpdv[s.face]
    outward = wp.where(s.outside == 1, 1.0, -1.0) * s.ng
    handed = wp.where(wp.dot(wp.cross(du, dv), outward) < 0.0, -1.0, 1.0)
    scale = wp.vec2d(wp.float64(1.0), wp.float64(1.0))
    if band.uv_space == 0:
        scale = g.pattern_scale[s.instance]
    sx = float(scale[0])
    sy = handed * float(scale[1])
    qx = s.uv[0] * scale[0]
    qy = s.uv[1] * scale[1] * wp.float64(handed)
    across = wp.vec2(-band.sin_a, band.cos_a)
    y = wp.float64(band.cos_y) * qy - wp.float64(band.sin_y) * qx
    round = float(0.0)
    if band.kind != LINEAR:
        dx = qx - band.center[0] * scale[0]
        dy = qy - band.center[1] * scale[1] * wp.float64(handed)
        y = wp.sqrt(dx * dx + dy * dy)
        round = float(y)
        across = wp.vec2(1.0, 0.0)
        if y > wp.float64(0.0):
            across = wp.vec2(float(dx / y), float(dy / y))
            if band.kind == SPIRAL:
                climb = float(band.pitch / (wp.float64(2.0 * wp.pi) * y))
                y = y - band.pitch * wp.atan2(dy, dx) / wp.float64(2.0 * wp.pi)
                across = wp.normalize(across - climb * wp.vec2(-across[1], across[0]))
    # from the pattern to the surface
    mapped = du * (-across[1] / sx) + dv * (across[0] / sy)
    along = mapped - wp.dot(mapped, s.ng) * s.ng
    size = wp.length(along)
    if size > 0.0:
        t = along / size
        v = wp.cross(s.ng, t)
        j = uv_motion(g, s, v)
        rate = across[0] * (j[0] * sx) + across[1] * (j[1] * sy)  # pattern units a metre
        a_rate = wp.abs(rate)
        if a_rate > 0.0:
            xt = wp.dot(step_x, t)
            xv = wp.dot(step_x, v)
            yt = wp.dot(step_y, t)
            yv = wp.dot(step_y, v)
            soft = 0.5 * sigma * sigma
            c_tt = (xt * xt + yt * yt) / 6.0 + soft
            c_vv = (xv * xv + yv * yv) / 6.0 + soft
            pitch = 1.0e6 * float(band.pitch) / a_rate
            y = y + band.offset * band.pitch - wp.float64(0.5) * band.width
            at = y - wp.rint(y / band.pitch) * band.pitch
            r.length = band.share * lines_held(1.0e6 * float(at) / a_rate, 1.0e6 * wp.sqrt(c_vv), pitch)
            r.part = band.share
            r.variance = c_tt
            r.frame = frame_with_tangent(n, t)
            if band.kind != LINEAR and round > 0.0:
                toward = -wp.sign(rate) * wp.sign(wp.dot(v, r.frame.y))
                r.bend_y = toward * a_rate / round
            r.width = float(band.width)
            r.depth = band.depth
            if band.uv_space == 1:
                r.width = 1.0e6 * float(band.width) / a_rate
                r.depth = 1.0e6 * band.depth / a_rate
            r.layer = band.layer
            if band.coherent == 1 and pitch <= wp.min(1.0e6 * sigma, _LONGEST_PITCH):
                r.pitch = pitch
    return r


@wp.func
def near_reflectance(a: GlintArrays, wave: WaveMaterial, layer: WaveLayer, wavelength: float, cosine: float) -> float:
    """Reflectance at any wavelength, by the nearest of the material's, which lie evenly in 1 / wavelength."""
    r = float(1.0)
    if layer.per_wavelength == 1:
        first = 1.0 / a.wavelengths[wave.first]
        last = 1.0 / wave.longest
        at = (first - 1.0 / wavelength) / wp.max(first - last, 1.0e-6) * float(wave.count - 1)
        r = reflectance_at(a, layer.reflect, int(wp.clamp(at + 0.5, 0.0, float(wave.count - 1))), cosine)
    return r


@wp.func
def order_point(
    a: GlintArrays,
    wave: WaveMaterial,
    layer: WaveLayer,
    strand: Strand,
    spread: float,
    xi1: float,
    xi2: float,
    cosine: float,
) -> wp.vec3:
    """All orders but 0 towards one direction, for irradiance 1: each shows one wavelength. Small angles."""
    total = wp.vec3(0.0, 0.0, 0.0)
    reach = strand.pitch * wp.abs(xi2)
    first = int(wp.ceil(reach / last_wavelength(a.spectrum)))
    last = int(wp.floor(reach / a.spectrum.first))
    for n in range(wp.max(first, 1), last + 1):
        wavelength = reach / float(n)
        own = along_variance(wave.sigma, wavelength)
        variance = own + spread
        value = wp.sqrt(own / variance) * wp.exp(-0.5 * xi1 * xi1 / variance)
        value *= 2.0 * _SQRT_PI * wave.sigma * wavelength / (strand.pitch * float(n))
        value *= across_value(a, layer, strand, wavelength, xi2, 2.0)
        total += value * near_reflectance(a, wave, layer, wavelength, cosine) * spectrum_at(a.spectrum, wavelength)
    return total


@wp.func
def order_interval(
    a: GlintArrays,
    wave: WaveMaterial,
    layer: WaveLayer,
    strand: Strand,
    spread: float,
    whole: int,
    place: wp.vec3,
    low: float,
    high: float,
) -> wp.vec3:
    """All orders but 0 over 0 <= ``low`` < |xi_2| < ``high`` of one slice; ``place``: (xi_1, weight, cosine)."""
    total = wp.vec3(0.0, 0.0, 0.0)
    if high > low:
        shortest = a.spectrum.first
        longest = last_wavelength(a.spectrum)
        first = int(wp.ceil(strand.pitch * low / longest))
        last = int(wp.floor(strand.pitch * high / shortest))
        for n in range(wp.max(first, 1), last + 1):
            begin = wp.max(strand.pitch * low / float(n), shortest)
            end = wp.min(strand.pitch * high / float(n), longest)
            if end > begin:
                part = wp.vec3(0.0, 0.0, 0.0)
                panels = int(wp.ceil((end - begin) / _PANEL))
                width = (end - begin) / float(panels)
                for i in range(panels):
                    for j in range(3):
                        wavelength = begin + width * (float(i) + _NODES[j])
                        value = _WEIGHTS[j] * width
                        if whole == 0:
                            variance = along_variance(wave.sigma, wavelength) + spread
                            x = place[0]
                            value *= wp.exp(-0.5 * x * x / variance) / (_SQRT_TWO_PI * wp.sqrt(variance))
                        lobe = across_value(a, layer, strand, wavelength, float(n) * wavelength / strand.pitch, 2.0)
                        value *= lobe * (wavelength / strand.pitch) * (wavelength / strand.pitch)
                        value *= near_reflectance(a, wave, layer, wavelength, place[2])
                        part += value * spectrum_at(a.spectrum, wavelength)
                total += part
        total = total * place[1]
    return total
