"""The lobe of a strand across it: rectangles, other cross-sections, depths whose phase depends on the directions."""

import warp as wp

from ..reflectance.diffraction.lobe_device import sinc
from ..reflectance.diffraction.outline_device import outline_transform
from ..reflectance.diffraction.real_device import real
from ..reflectance.diffraction.response_device import across_integral, depth_response, sinc2
from .glint_arrays_device import GlintArrays, Strand, WaveLayer
from .glint_lobes_device import lobe_at

_vec5 = wp.types.vector(length=5, dtype=float)
# Beyond so many cycles fringes are so fine that their mean is taken: in closed form of facets, of rectangles at 160
# places of each slice and wavelength.
_MOST_PANELS = wp.constant(256.0)
_FEW_PANELS = wp.constant(32)
# Scratches of more cycles, wider than light is coherent: fringes a few hundredths of a degree apart are seen by no one.
_FINE = wp.constant(2048.0)
# Gauss-Legendre over [0, 1].
_FIVE = wp.constant(_vec5(0.0469100770, 0.2307653449, 0.5, 0.7692346551, 0.9530899230))
_FIVE_WEIGHTS = wp.constant(_vec5(0.1184634425, 0.2393143352, 0.2844444444, 0.2393143352, 0.1184634425))


@wp.func
def across_value(a: GlintArrays, layer: WaveLayer, strand: Strand, wavelength: float, xi2: float, g: float) -> float:
    """|P|^2 / lambda^2 of a strand's cross-section across it; ``g``: sum of the cosines, 2 for small angles."""
    ratio = strand.width / wavelength
    if layer.facets > 0:
        lobe = lobe_at(a, layer, ratio * xi2, strand.depth / wavelength * g)
        if lobe >= 0.0:
            return ratio * ratio * lobe
        depth = wp.float64(strand.depth / wavelength)
        p = outline_transform(
            a.outlines, layer.outline, layer.facets, wp.float64(ratio), depth, wp.float64(xi2), wp.float64(g)
        )
        return float(p[0] * p[0] + p[1] * p[1])
    return (
        ratio
        * ratio
        * sinc2(ratio * xi2)
        * depth_response(strand.depth, wavelength, g, layer.depth_spread, layer.roughness)
    )


@wp.func
def cosines_at(layer: WaveLayer, o: wp.vec3, s2: float, xi2: float) -> float:
    """Sum of the cosines of both directions where the slice, of radius squared ``s2``, has xi_2; 2 for small angles."""
    r = float(2.0)
    if layer.angles == 1:
        across = xi2 - o[1]
        r = o[2] + wp.sqrt(wp.max(s2 - across * across, 0.0))
    return r


@wp.func
def across_facets(
    a: GlintArrays, layer: WaveLayer, strand: Strand, wavelength: float, o: wp.vec3, s2: float, low: float, high: float
) -> float:
    """``across_numeric`` without the fringes that facets far from one another make together: the lobe of each, that of
    what all of them take from the mirror direction, and what both have in common.

    With d, h, r of a facet in wavelengths and W, the sum of d: |P|^2 = W^2 sinc^2(W xi_2) + sum of d^2 sinc^2(d xi_2 +
    g r) [1 - 2 cos(2 pi g h) sinc(g r)]. Of scratches of 1,000 to 50,000 wavelengths the integral is within 2 %.
    """
    whole = strand.width / wavelength
    deep = strand.depth / wavelength
    total = float(0.0)
    covered = float(0.0)
    middle = cosines_at(layer, o, s2, 0.5 * (low + high))
    for i in range(layer.facets):
        row = a.outlines[layer.outline + i]
        d = float(row[2]) * whole
        rise = float(row[3]) * deep
        if d > 0.0:
            g = cosines_at(layer, o, s2, wp.clamp(-middle * rise / d, low, high))
            shift = g * rise
            cycles = g * float(row[1]) * deep
            common = 1.0 - 2.0 * wp.cos(2.0 * wp.pi * (cycles - wp.rint(cycles))) * float(sinc(real(shift)))
            covered += d
            total += common * d * d * across_integral(d, low + shift / d, high + shift / d)
    total += covered * covered * across_integral(covered, low, high)
    return wp.max(total, 0.0)


@wp.func
def across_numeric(
    a: GlintArrays, layer: WaveLayer, strand: Strand, wavelength: float, o: wp.vec3, u: float, low: float, high: float
) -> float:
    """Integral of ``across_value`` over xi_2 in [low, high] of the slice u: five nodes for each cycle of phase."""
    total = float(0.0)
    if high > low:
        s2 = wp.max((1.0 - u) * (1.0 + u), 0.0)
        cycles = (strand.width + 2.0 * strand.depth) / wavelength * (high - low)
        panels = int(wp.max(wp.ceil(cycles), 1.0))
        if cycles > _MOST_PANELS:
            panels = _FEW_PANELS
        if layer.facets > 0:
            fine = cycles > 1.0 and strand.width + 2.0 * strand.depth > _FINE * wavelength
            if fine or cycles > _MOST_PANELS:
                return across_facets(a, layer, strand, wavelength, o, s2, low, high)
        width = (high - low) / float(panels)
        for i in range(panels):
            for j in range(5):
                xi2 = low + width * (float(i) + _FIVE[j])
                g = cosines_at(layer, o, s2, xi2)
                total += _FIVE_WEIGHTS[j] * width * across_value(a, layer, strand, wavelength, xi2, g)
    return total
