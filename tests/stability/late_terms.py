"""As ``terms``, of what came later: pairs of scratches, stretches of them, fringes under the sun, changing grooves,
glass."""

from typing import Any

import numpy as np
import warp as wp
from scipy import special

from scratchwarp.kernels.glint_arrays_device import GlintArrays
from scratchwarp.kernels.glint_fringes import fringes
from scratchwarp.optics import spectra
from scratchwarp.reflectance.diffraction.color import to_rgb
from scratchwarp.reflectance.grooves.solid_device import GrooveSet, Taper

from . import probe_late_kernels as probes
from .terms import Term

F = np.float32
PI = np.float32(np.pi)
GROW = 1e-12


def _held(a: Any, b: Any, *_: Any) -> Any:
    return special.ndtr(-a) - special.ndtr(-b)


def _held_naive(a: Any, b: Any, *_: Any) -> Any:
    root = np.sqrt(F(2))
    return F(0.5) * (special.erf(b / root) - special.erf(a / root))


def _variance(a: Any, b: Any, *_: Any) -> Any:
    """Moments about the middle by Gauss: no difference of large numbers."""
    node, weight = np.polynomial.legendre.leggauss(20)
    middle, half = 0.5 * (a + b)[:, None], 0.5 * (b - a)[:, None]
    density = weight * np.exp(-0.5 * (middle + half * node) ** 2)
    mass = density.sum(1)
    mean = (density * half * node).sum(1) / mass
    return (density * (half * node) ** 2).sum(1) / mass - mean**2


def _variance_naive(a: Any, b: Any, *_: Any) -> Any:
    at_a, at_b = np.exp(F(-0.5) * a * a), np.exp(F(-0.5) * b * b)
    scale = F(1) / (np.sqrt(F(2) * PI) * _held_naive(a, b))
    mean = (at_a - at_b) * scale
    return F(1) + (a * at_a - b * at_b) * scale - mean * mean


def _cycles(depth: Any, wave: Any) -> Any:
    """Real part of 1 - e^{i phase}, times the ratio of width and wavelength."""
    return 2.0 * np.sin(np.pi * np.remainder(2.0 * depth / wave, 1.0)) ** 2 / wave


def _cycles_naive(depth: Any, wave: Any) -> Any:
    return (F(1) - np.cos(F(4) * PI * depth / wave)) / wave


def _spectrum() -> tuple[Any, Any]:
    """Wavelengths [um] and the green that the eye makes of them, as the table's."""
    wave = np.arange(spectra.WAVELENGTHS[0] + 0.05, spectra.WAVELENGTHS[-1], 0.1)
    density = spectra.cmf(wave)
    return wave * 1e-3, to_rgb(density / density.sum(axis=0))[:, 1]


def _green(width: Any, depth: Any, xi2: Any, *_: Any) -> Any:
    wave, green = _spectrum()
    lobe = 2.0 * (width[:, None] / wave) ** 2 * np.sinc(width[:, None] * xi2[:, None] / wave) ** 2
    return (green * lobe * 4.0 * np.sin(2.0 * np.pi * depth[:, None] / wave) ** 2).sum(1)


def _green_naive(width: Any, depth: Any, xi2: Any, *_: Any) -> Any:
    wave, green = _spectrum()

    def g(offset: Any) -> Any:
        return (green * np.cos(2.0 * np.pi * offset[:, None].astype(float) / wave)).sum(1).astype(F)

    a, b = width * np.abs(xi2), F(2) * depth
    total = g(0 * a) - g(a) - g(b) + F(0.5) * (g(a + b) + g(a - b))
    return F(2) / (PI * PI) / (xi2 * xi2) * total


def _coefficients(x: Any, y: Any, z: Any, du: Any, dy: Any) -> Any:
    """Of the quadratic of the facet from (-1, 0) to (1, -1), both scales 1 + GROW u, the ray falling by 1."""
    size, grow = 1.0 + GROW * x, GROW * du
    aside, daside = y + size, dy + grow
    a = -2.0 * grow + daside * grow
    b = 2.0 * (z * grow - size) + aside * grow + daside * size
    return a, b, 2.0 * z * size + aside * size


def _meets(*row: Any) -> Any:
    """By bisection in long double."""
    a, b, c = _coefficients(*(np.asarray(r, np.longdouble) for r in row[:5]))
    low, high = np.zeros_like(a), np.full_like(a, 4.0)
    for _ in range(80):
        middle = 0.5 * (low + high)
        over = (a * middle + b) * middle + c > 0.0
        low, high = np.where(over, middle, low), np.where(over, high, middle)
    return low


def _meets_naive(*row: Any) -> Any:
    a, b, c = _coefficients(*row[:5])
    return (-np.sqrt(b * b - 4.0 * a * c) - b) / (2.0 * a)


def _refracted(c: Any, ior: Any, *_: Any) -> Any:
    c, ior = np.longdouble(c), np.longdouble(ior)
    return np.sqrt((ior - 1) * (ior + 1) + c * c) / ior


def _refracted_naive(c: Any, ior: Any, *_: Any) -> Any:
    return np.sqrt(F(1) - (F(1) - c * c) / (ior * ior))


def _tapers() -> Any:
    table: Any = Taper
    row = np.zeros(1, table.numpy_dtype())
    row["size"], row["grow"] = 1.0, GROW
    made: Any = GrooveSet()
    made.tapers = wp.array(row, dtype=Taper, device="cpu")
    return made


# 3 whole waves and a little more
NEARLY = 0.4 * (3.0 + 1e-3 / np.pi) / 2.0
LATE: dict[str, Term] = {
    "a footprint's tail on a stretch": Term(
        "kernels/glint_stretch_device.py:between", probes.pairs, [[4.0, 4.5], [-4.6, -4.2], [3.0, 3.4]],
        _held, _held_naive, "two erf of nearly 1 cancel: some per thousand", 2e-5, more=GlintArrays,
    ),
    "a short stretch": Term(
        "kernels/glint_stretch_device.py:between", probes.pairs, [[0.5, 0.501], [-2.0, -1.95], [0.0, 0.1]],
        _variance, _variance_naive, "1 + ... - mean^2 is rounding, negative as well", 2e-3, column=1, more=GlintArrays,
    ),
    "zeros of sinc for pairs": Term(
        "kernels/glint_pairs_device.py:sinc", probes.pairs, [[0.0], [1e-40], [1000.0], [5e-3]],
        lambda t, *_: np.where(t == 1000.0, 0.0, np.sinc(t)), lambda t, *_: np.sin(PI * t) / (PI * t),
        "0 / 0, and light in its zeros", 1e-6, 1e-12, column=2, more=GlintArrays,
    ),
    "amplitude of whole waves": Term(
        "kernels/glint_pairs_device.py:across_amplitude", probes.pairs, [[NEARLY, 0.4], [0.8, 0.4]],
        lambda d, w, *_: _cycles(d, w), lambda d, w, *_: _cycles_naive(d, w), "1 - cos loses half of the digits",
        2e-3, 1e-9, column=3, more=GlintArrays,
    ),
    "fringes next to the mirror direction": Term(
        "kernels/glint_fringes_device.py:fringes_of", probes.fringes,
        [[3.0, 1.0, 0.0], [3.0, 1.0, 1e-5], [2.0, 0.7, 1e-3]], _green, _green_naive,
        "a second difference of numbers that are nearly alike, over xi_2^2", 2e-3,
        more=lambda: wp.array(fringes(), dtype=wp.vec3, device="cpu"),
    ),
    "facets that are hardly twisted": Term(
        "reflectance/grooves/taper_device.py:meets_facet", probes.tapers,
        [[0.1, -0.4, 0.5, 0.1, 0.0], [2.0, 0.3, 0.2, 0.7, 0.1]], _meets, _meets_naive,
        "-b - sqrt(b^2 - 4 a c) cancels: half per thousand", 1e-12, double=True, more=_tapers,
    ),
    "refraction at grazing angles": Term(
        "optics/refraction_device.py:refract", probes.refraction,
        [[1e-4, 1.0], [1e-3, 1.0], [1e-3, 1 + 1e-6], [1e-3, 1.00001], [0.0045, 1 / 1.00001], [0.5, 1.5]],
        _refracted, _refracted_naive, "1 - sin^2 / ior^2 cancels: 0 at 1e-4, per thousands to per cents", 1e-5,
    ),
}  # fmt: skip
