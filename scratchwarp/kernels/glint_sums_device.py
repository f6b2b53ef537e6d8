"""Sums over wavelengths and slices: what one scratch sends to the viewer of the slices of a light."""

import warp as wp

from ..reflectance.diffraction.response_device import (
    across_integral,
    across_integral_paper,
    along_variance,
    depth_response,
)
from .glint_across_device import across_numeric, across_value
from .glint_arrays_device import (
    GlintArrays,
    Strand,
    WaveLayer,
    WaveMaterial,
    reflectance_at,
    reflectance_color,
    wide_integral,
)
from .glint_bands_device import order_interval, order_point
from .glint_fringes_device import scratch_fringes
from .glint_pairs_device import pair_point, pair_slices
from .lobe_device import largest

_CHANNELS = wp.constant(wp.vec3(0.612, 0.549, 0.465))  # um
REACH = wp.constant(3.3)  # standard deviations
_SQRT_PI = wp.constant(1.7724538509)
_SQRT_TWO_PI = wp.constant(2.5066282746)


@wp.struct
class View:
    """A strand from a viewer: omega_o in its frame, its layer and material, the spread of xi_1 over the footprint and
    its shift, and the longest standard deviation of xi_1 among the wavelengths."""

    o: wp.vec3
    spread: float
    shift: float
    deviation: float


@wp.struct
class Slices:
    """Which slices: ``count`` from u0 to u1; ``whole``: they stand for the whole Gaussian. ``round``: the light begins
    and ends round."""

    count: int
    whole: int
    u0: float
    u1: float
    round: int


@wp.func
def slice_at(a: GlintArrays, s: Slices, i: int) -> wp.vec2:
    """(u, weight) of a slice; the weight of a whole Gaussian adds up to 1, else to the range of u."""
    r = wp.vec2(s.u0, 1.0)
    if s.whole == 1:
        if s.count == 2:
            r = wp.vec2(wp.where(i == 0, s.u0, s.u1), 0.5)
    else:
        t = a.nodes[i][0]
        w = a.nodes[i][1] * (s.u1 - s.u0)
        if s.round == 1:
            # takes out the square roots with which a round light begins and ends
            w = w * 6.0 * t * (1.0 - t)
            t = t * t * (3.0 - 2.0 * t)
        r = wp.vec2(s.u0 + t * (s.u1 - s.u0), w)
    return r


@wp.func
def cosine_of(o: wp.vec3, u: float, psi: float) -> float:
    """Cosine of half the angle between the viewer and the direction (u, psi)."""
    s = wp.sqrt(wp.max((1.0 - u) * (1.0 + u), 0.0))
    i = wp.vec3(u, s * wp.sin(psi), s * wp.cos(psi))
    return wp.sqrt(wp.max(0.5 + 0.5 * wp.dot(i, o), 0.0))


@wp.func
def as_xi2(o: wp.vec3, u: float, psi: wp.vec4) -> wp.vec4:
    """Intervals of psi as intervals of xi_2."""
    s = wp.sqrt(wp.max((1.0 - u) * (1.0 + u), 0.0))
    r = wp.vec4(0.0, 0.0, 0.0, 0.0)
    if psi[1] > psi[0]:
        r[0] = o[1] + s * wp.sin(psi[0])
        r[1] = r[0] + 2.0 * s * wp.cos(0.5 * (psi[0] + psi[1])) * wp.sin(0.5 * (psi[1] - psi[0]))
    if psi[3] > psi[2]:
        r[2] = o[1] + s * wp.sin(psi[2])
        r[3] = o[1] + s * wp.sin(psi[3])
    return r


@wp.func
def point_light(
    a: GlintArrays, wave: WaveMaterial, layer: WaveLayer, strand: Strand, view: View, i: wp.vec3
) -> wp.vec3:
    """Irradiance 1 from one direction, times the cosine."""
    total = wp.vec3(0.0, 0.0, 0.0)
    x = i[0] + view.o[0] + view.shift
    xi2 = i[1] + view.o[1]
    cosine = wp.sqrt(wp.max(0.5 + 0.5 * wp.dot(i, view.o), 0.0))
    g = wp.where(layer.angles == 1, i[2] + view.o[2], 2.0)
    for k in range(wave.count):
        wavelength = a.wavelengths[wave.first + k]
        own = along_variance(wave.sigma, wavelength)
        variance = own + view.spread
        value = wp.sqrt(own / variance) * wp.exp(-0.5 * x * x / variance)
        value *= across_value(a, layer, strand, wavelength, xi2, g)
        if layer.per_wavelength == 1:
            value *= reflectance_at(a, layer.reflect, k, cosine)
        total += value * a.colors[wave.first + k]
    total = total * (2.0 * _SQRT_PI * wave.sigma * strand.length * i[2])
    if layer.per_wavelength == 0:
        total = wp.cw_mul(total, reflectance_color(a, layer.reflect, cosine))
    return total


@wp.func
def point_color(
    a: GlintArrays, wave: WaveMaterial, layer: WaveLayer, strand: Strand, view: View, i: wp.vec3
) -> wp.vec3:
    """``point_light`` with all wavelengths at once."""
    x = i[0] + view.o[0] + view.shift
    xi2 = i[1] + view.o[1]
    total = scratch_fringes(a.fringes, wave.sigma, x, view.spread, strand.width, strand.depth, xi2)
    if largest(total) > 0.0:
        cosine = wp.sqrt(wp.max(0.5 + 0.5 * wp.dot(i, view.o), 0.0))
        total = wp.cw_mul(total, reflectance_color(a, layer.reflect, cosine))
    return total * (_SQRT_PI * wave.sigma * strand.length * i[2])


def make_glint_sums(method: str, gratings: bool, lookup: bool, numeric: bool, pairs: bool, fringes: bool):
    """(slices of a light, radiance under them, radiance under a direction).

    ``method``: "slices", "closed-form" or "paper"; ``gratings``: whether any pattern shows orders; ``lookup``: area
    lights by the tables of ``wide_integral`` instead of wavelengths; ``numeric``: some cross-section is no rectangle
    or some phase depends on angles; ``pairs``: strands stand for pairs of scratches;
    ``fringes``: lights without extent by the table of ``scratch_fringes``.
    """
    single = method != "slices"
    across = across_integral_paper if method == "paper" else across_integral

    @wp.func
    def xi1_slices(a: GlintArrays, view: View, low: float, high: float, rounded: int) -> Slices:
        """The slices to take of a light that fills u from ``low`` to ``high``."""
        r = Slices()
        middle = -view.o[0] - view.shift
        if wp.static(single):
            if middle > low and middle < high:
                r.count = 1
                r.whole = 1
                r.u0 = middle
        else:
            reach = REACH * view.deviation
            first = wp.max(low, middle - reach)
            last = wp.min(high, middle + reach)
            if first < last:
                r.u0 = first
                r.u1 = last
                r.round = rounded
                r.count = a.slices
                if first > low and last < high:
                    r.whole = 1
                    r.count = 2
                    r.u0 = middle - view.deviation
                    r.u1 = middle + view.deviation
        return r

    @wp.func
    def radiance_of(
        a: GlintArrays,
        wave: WaveMaterial,
        layer: WaveLayer,
        strand: Strand,
        view: View,
        whole: int,
        count: int,
        places: wp.array(dtype=wp.vec3),
        cuts: wp.array(dtype=wp.vec4),
    ) -> wp.vec3:
        """Sum over wavelengths and slices. ``places``: (xi_1, weight, cosine of the half angle); ``cuts``: intervals
        of xi_2."""
        total = wp.vec3(0.0, 0.0, 0.0)
        if wp.static(pairs):
            if strand.pair.kind > 0:
                return pair_slices(a, wave, layer, strand, view.spread, view.o, view.shift, whole, count, places, cuts)
        if wp.static(gratings):
            if strand.pitch > 0.0:
                for i in range(count):
                    c = cuts[i]
                    for half in range(2):
                        low = c[2 * half]
                        high = c[2 * half + 1]
                        if high > low:
                            # orders on either side of the mirror direction are alike
                            total += order_interval(
                                a, wave, layer, strand, view.spread, whole, places[i], wp.max(low, 0.0), high
                            )
                            total += order_interval(
                                a, wave, layer, strand, view.spread, whole, places[i], wp.max(-high, 0.0), -low
                            )
                if layer.per_wavelength == 0:
                    total = wp.cw_mul(total, reflectance_color(a, layer.reflect, places[count / 2][2]))
                return total
        if wp.static(lookup):
            if layer.wide_depths > 0:
                for i in range(count):
                    c = cuts[i]
                    held = wp.vec3(places[i][1], places[i][1], places[i][1])
                    if whole == 0:
                        # of the Gaussian along, by the middle wavelength of each channel
                        x2 = places[i][0] * places[i][0]
                        for channel in range(3):
                            variance = along_variance(wave.sigma, _CHANNELS[channel]) + view.spread
                            held[channel] *= wp.exp(-0.5 * x2 / variance) / (_SQRT_TWO_PI * wp.sqrt(variance))
                    if largest(held) > 0.0:
                        held = wp.cw_mul(held, reflectance_color(a, layer.reflect, places[i][2]))
                        for half in range(2):
                            if c[2 * half + 1] > c[2 * half]:
                                end = wide_integral(a, layer, strand.depth, strand.width * c[2 * half + 1])
                                begin = wide_integral(a, layer, strand.depth, strand.width * c[2 * half])
                                total += wp.cw_mul(held, end - begin)
                return total * (2.0 / wp.pi * strand.length * strand.width)
        special = wp.static(numeric) and (layer.facets > 0 or layer.angles == 1)
        for k in range(wave.count):
            wavelength = a.wavelengths[wave.first + k]
            ratio = strand.width / wavelength
            own = along_variance(wave.sigma, wavelength)
            variance = own + view.spread
            value = float(0.0)
            for i in range(count):
                along = places[i][1] * _SQRT_TWO_PI * wp.sqrt(own)
                if whole == 0:
                    x = places[i][0]
                    along = places[i][1] * wp.sqrt(own / variance) * wp.exp(-0.5 * x * x / variance)
                c = cuts[i]
                seen = float(0.0)
                if wp.static(numeric):
                    if special:
                        u = places[i][0] - view.o[0] - view.shift
                        seen = across_numeric(a, layer, strand, wavelength, view.o, u, c[0], c[1])
                        seen += across_numeric(a, layer, strand, wavelength, view.o, u, c[2], c[3])
                if not special:
                    seen = across(ratio, c[0], c[1]) + across(ratio, c[2], c[3])
                if layer.per_wavelength == 1:
                    seen *= reflectance_at(a, layer.reflect, k, places[i][2])
                value += along * seen
            if not special:
                value *= ratio * ratio
                value *= depth_response(strand.depth, wavelength, 2.0, layer.depth_spread, layer.roughness)
            total += value * a.colors[wave.first + k]
        total = total * (2.0 * _SQRT_PI * wave.sigma * strand.length)
        if layer.per_wavelength == 0:
            total = wp.cw_mul(total, reflectance_color(a, layer.reflect, places[count / 2][2]))
        return total

    @wp.func
    def radiance_from(
        a: GlintArrays, wave: WaveMaterial, layer: WaveLayer, strand: Strand, view: View, i: wp.vec3
    ) -> wp.vec3:
        """Under irradiance 1 across ``i``."""
        if wp.static(pairs):
            if strand.pair.kind > 0:
                return pair_point(a, wave, layer, strand, view.spread, view.shift, i, view.o)
        if wp.static(gratings):
            if strand.pitch > 0.0:
                cosine = wp.sqrt(wp.max(0.5 + 0.5 * wp.dot(i, view.o), 0.0))
                x = i[0] + view.o[0] + view.shift
                total = i[2] * order_point(a, wave, layer, strand, view.spread, x, i[1] + view.o[1], cosine)
                if layer.per_wavelength == 0:
                    total = wp.cw_mul(total, reflectance_color(a, layer.reflect, cosine))
                return total
        if wp.static(fringes):
            if layer.fringes == 1:
                return point_color(a, wave, layer, strand, view, i)
        return point_light(a, wave, layer, strand, view, i)

    return xi1_slices, radiance_of, radiance_from
