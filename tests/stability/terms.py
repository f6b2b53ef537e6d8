"""Stable formulations: where each is, what hard input it is for, what is right there, and the naive form.

``run`` is the device function; ``right`` the value in float64 (or better), written in another way; ``naive`` the form
that stands in textbooks and papers, in the arithmetic of the device. Inputs are float32 numbers that both begin with.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp
from scipy import special

from . import probe_kernels as probes

F = np.float32
PI = np.float32(np.pi)


@dataclass(frozen=True)
class Term:
    """One stable formulation.

    ``where``: file and function below scratchwarp/. ``kernel`` and ``column``: its probe. ``inputs`` [n, k].
    ``right(x)``: float64 rows to values; ``naive(x)``: rows in the device's arithmetic to values. ``tolerance``:
    relative, and ``floor``: absolute, of the stable form. ``why``: what the naive form does. ``more()``: what the
    kernel takes after its rows.
    """

    where: str
    kernel: Any
    inputs: Any
    right: Callable[..., Any]
    naive: Callable[..., Any]
    why: str
    tolerance: float = 1e-5
    floor: float = 0.0
    column: int = 0
    double: bool = False
    more: Callable[[], Any] | None = None

    def rows(self) -> np.ndarray:
        """Inputs as the device gets them, six columns."""
        rows = np.atleast_2d(np.asarray(self.inputs, np.float64 if self.double else np.float32))
        padded = np.zeros((len(rows), 6), rows.dtype)
        padded[:, : rows.shape[1]] = rows
        return padded

    def run(self) -> np.ndarray:
        """Values of the device function."""
        rows = self.rows()
        dtype = wp.float64 if self.double else float
        out = wp.zeros((len(rows), 6), dtype=dtype, device="cpu")
        given = [wp.array(rows, dtype=dtype, device="cpu"), out, *([self.more()] if self.more else [])]
        wp.launch(self.kernel, len(rows), inputs=given, device="cpu")
        return out.numpy()[:, self.column].astype(float)

    def expected(self) -> np.ndarray:
        """Right values."""
        return np.asarray(self.right(*self.rows().astype(float).T), float)

    def naively(self) -> np.ndarray:
        """Values of the naive form."""
        with np.errstate(all="ignore"):
            return np.asarray(self.naive(*self.rows().T), float)

    def off(self, values: np.ndarray) -> np.ndarray:
        """Error of values in units of what is allowed; inf where they are not finite."""
        right = self.expected()
        error = np.abs(values - right) / (self.tolerance * np.abs(right) + self.floor)
        return np.where(np.isfinite(values), error, np.inf)


def _unit(*v: float) -> np.ndarray:
    return np.asarray(v, float) / np.linalg.norm(v)


def _cap_width(x: Any, y: Any, z: Any, half: Any, sine: Any, *_: Any) -> Any:
    """Extent of the slice inside a cap, by rho cos(phi - middle) s + p1 sin >= cos a; long double."""
    p = np.stack([x, y, z]).astype(np.longdouble)
    p = p / np.sqrt((p**2).sum(0))
    s = np.sqrt((1 - np.longdouble(sine)) * (1 + np.longdouble(sine)))
    rho = np.hypot(p[1], p[2])
    return 2.0 * np.arccos((np.cos(np.longdouble(half)) - p[0] * sine) / (s * rho))


def _cap_naive(x: Any, y: Any, z: Any, half: Any, sine: Any, *_: Any) -> Any:
    p = np.stack([x, y, z]) / np.sqrt((np.stack([x, y, z]) ** 2).sum(0))
    kap = (np.cos(half) - p[0] * sine) / (np.sqrt(F(1) - sine * sine) * np.hypot(p[1], p[2]))
    return F(2) * np.arccos(kap)


def _near_side(d: Any, r: Any, x: Any, *_: Any) -> Any:
    d, r, x = (np.longdouble(v) for v in (d, r, x))
    return np.sqrt(d * d - x * x) - np.sqrt(r * r - x * x)


def _conductor(c: Any, eta: Any, k: Any, *_: Any) -> Any:
    """By complex arithmetic."""
    m = np.sqrt((eta + 1j * k) ** 2 - (1 - c * c))
    rs, rp = (c - m) / (c + m), ((eta + 1j * k) ** 2 * c - m) / ((eta + 1j * k) ** 2 * c + m)
    return 0.5 * (abs(rs) ** 2 + abs(rp) ** 2)


def _conductor_naive(c: Any, eta: Any, k: Any, *_: Any) -> Any:
    s2 = F(1) - c * c
    t = eta * eta - k * k - s2
    modulus = np.sqrt(t * t + F(4) * eta * eta * k * k)
    a = np.sqrt(F(0.5) * (modulus + t))
    b = np.sqrt(F(0.5) * (modulus - t))
    rs = ((a - c) ** 2 + b * b) / ((a + c) ** 2 + b * b)
    rp = rs * ((a * c - s2) ** 2 + b * b * c * c) / ((a * c + s2) ** 2 + b * b * c * c)
    return F(0.5) * (rs + rp)


def _dielectric(c: Any, ior: Any, *_: Any) -> Any:
    axial = np.sqrt((np.longdouble(ior) - 1) * (np.longdouble(ior) + 1) + np.longdouble(c) ** 2)
    rs, rp = (c - axial) / (c + axial), (ior * ior * c - axial) / (ior * ior * c + axial)
    return 0.5 * (rs**2 + rp**2)


def _dielectric_naive(c: Any, ior: Any, *_: Any) -> Any:
    axial = ior * np.sqrt(F(1) - (F(1) - c * c) / (ior * ior))
    rs, rp = (c - axial) / (c + axial), (ior * ior * c - axial) / (ior * ior * c + axial)
    return F(0.5) * (rs**2 + rp**2)


def _ggx_naive(x: Any, z: Any, a: Any, *_: Any) -> Any:
    c2 = z * z
    return a * a / (PI * (c2 * (a * a - F(1)) + F(1)) ** 2)


def _big_m(x: Any) -> Any:
    x = np.asarray(x, float)
    return special.sici(x)[0] - 2.0 * np.sin(0.5 * x) ** 2 / x


def _m_step(t0: Any, t1: Any, *_: Any) -> Any:
    """Integral of (1 - cos x) / x^2 by Gauss: no difference of large numbers."""
    node, weight = np.polynomial.legendre.leggauss(40)
    a, b = 2 * np.pi * t0[:, None], 2 * np.pi * t1[:, None]
    x = 0.5 * (a + b) + 0.5 * (b - a) * node
    return (0.5 * (b - a) * weight * 2 * np.sin(0.5 * x) ** 2 / x**2).sum(1)


def _m_naive(t0: Any, t1: Any, *_: Any) -> Any:
    """The formula in float32."""

    def m(t: Any) -> Any:
        x = F(2) * PI * t.astype(F)
        return special.sici(x)[0].astype(F) - (F(1) - np.cos(x)) / x

    return m(t1) - m(t0)


def _across(unused: Any, ratio: Any, low: Any, high: Any, *_: Any) -> Any:
    return _m_step(ratio * low, ratio * high) / np.pi / ratio


def _across_naive(unused: Any, ratio: Any, low: Any, high: Any, *_: Any) -> Any:
    return _m_naive(ratio * low, ratio * high) / PI / ratio


def _bands(x: Any, extent: Any, pitch: Any, width: Any, *_: Any) -> Any:
    """By counting points of the footprint."""
    at = x + extent * ((np.arange(200_000)[:, None] + 0.5) / 200_000 - 0.5)
    return (np.mod(at, pitch) < width).mean(0)


def _bands_naive(*rows: Any) -> Any:
    x, extent, pitch, width = (np.asarray(r, F) for r in rows[:4])

    def covered(at: Any) -> Any:
        cell = np.floor(at / pitch)
        return cell * width + np.minimum(at - cell * pitch, width)

    return (covered(x + F(0.5) * extent) - covered(x - F(0.5) * extent)) / extent


def _rim(px: Any, py: Any, cx: Any, cy: Any, *_: Any) -> Any:
    """Rim distances along the ray from c through p, in long double."""
    p, c = np.stack([px, py]).astype(np.longdouble), np.stack([cx, cy]).astype(np.longdouble)
    d = (p - c) / np.hypot(*(p - c))
    b = (c * d).sum(0)
    rim = -b + np.sqrt(b * b + 1 - (c * c).sum(0))
    return 1 - np.hypot(*(p - c)) / rim


def _rim_naive(px: Any, py: Any, cx: Any, cy: Any, *_: Any) -> Any:
    d = np.stack([px - cx, py - cy])
    d = d / np.hypot(*d)
    b = cx * d[0] + cy * d[1]
    rim = -b + np.sqrt(b * b + F(1) - cx * cx - cy * cy)
    return F(1) - np.hypot(px - cx, py - cy) / rim


def _ends(x0: Any, x1: Any, y: Any, *_: Any) -> Any:
    """|e^{-y^2} (erf(x1 + i y) - erf(x0 + i y))| by Faddeeva's w; x0 < 0 < x1."""
    tail = [np.exp(-x * x - 2j * x * y) * special.wofz(-y + 1j * x) for x in (x1, -x0)]
    return np.abs(2 * np.exp(-y * y) - tail[0] - np.conj(tail[1]))


def _ends_naive(x0: Any, x1: Any, y: Any, *_: Any) -> Any:
    return np.abs(np.exp(-y * y) * (special.erf(x1 + 1j * y) - special.erf(x0 + 1j * y)))


def _fringes(depth: Any, wave: Any) -> Any:
    return 4.0 * np.sin(2.0 * np.pi * np.remainder(depth / wave, 0.5)) ** 2


EDGE = F(59.9999)
NEAR = 1.0 - 2.0**-24
# 3 half waves and a little more: |D|^2 is 4e-6, and rounding 3 of anything to float32 turns it by 8e-4
STEP = 0.4 * (3.0 + 1e-3 / np.pi) / 2.0
LAMP = _unit(0.3, 0.2, 1.0)
TERMS: dict[str, Term] = {
    "1 - cos": Term(
        "optics/sampling_device.py:cone_one_minus_cos", probes.angles, [[1e-4], [1e-6], [3e-3], [1.0]],
        lambda a, *_: 2 * np.sin(a / 2) ** 2, lambda a, *_: F(1) - np.cos(a), "0 for a cone below 2e-4",
    ),
    "1 - cos of a sphere": Term(
        "lights/sphere_device.py:sphere_one_minus_cos", probes.angles, [[1e-4], [1e-3], [0.5]],
        lambda r, *_: r * r / (1 + np.sqrt(1 - r * r)), lambda r, *_: F(1) - np.sqrt(F(1) - r * r),
        "0 for a lamp of 1e-4 of its distance", column=1,
    ),
    "difference of sines": Term(
        "reflectance/cone_sums_device.py:sine_step", probes.angles, [[0, 1.5, 1.50003], [0, 0.7, 0.70001]],
        lambda _, a, b, *__: 2 * np.sin((b - a) / 2) * np.cos((a + b) / 2), lambda _, a, b, *__: np.sin(b) - np.sin(a),
        "a narrow bin at grazing angles is off by per cents", 3e-6, column=2,
    ),
    "angle of two planes": Term(
        "lights/spherical_rect_device.py:edge_angle", probes.angles, [[1e-3], [1e-2]],
        lambda a, *_: a, lambda a, *_: np.arccos(np.cos(a)), "half of the digits", 1e-5, column=3,
    ),
    "near side of a huge lamp": Term(
        "lights/sphere_device.py:near_distance", probes.reach, [[1e6 + 1, 1e6, 1e3], [1001.0, 1000.0, 30.0]],
        _near_side, lambda d, r, x, *_: np.sqrt(d * d - x * x) - np.sqrt(r * r - x * x),
        "a difference of large numbers", 1e-6,
    ),
    "interval of a small lamp": Term(
        "lights/cap_device.py:span_cap", probes.cap,
        [[*LAMP, 1e-3, LAMP[0] + 3e-4], [*LAMP, 1e-3, LAMP[0]], [*LAMP, 0.1, LAMP[0] - 0.05]],
        _cap_width, _cap_naive, "wrong by some per cent to several times", 2e-3,
    ),
    "solid angle of a small rectangle": Term(
        "lights/spherical_rect_device.py:rect_solid_angle", probes.rectangle, [[1e-2], [1e-3], [0.1]],
        lambda a, *_: 4 * np.arctan(a * a / (2 * np.sqrt(4 + 2 * a * a))),
        lambda a, *_: F(4) * np.arccos(-(a / F(2)) ** 2 / (F(1) + (a / F(2)) ** 2)) - F(2) * PI,
        "the sum of four angles less 2 pi has an error of 5e-7", 1e-4,
    ),
    "dielectric at grazing incidence": Term(
        "optics/fresnel_device.py:fresnel_dielectric", probes.fresnel, [[1e-3, 1 + 1e-6], [1e-3, 1.00001], [1e-4, 1.5]],
        _dielectric, _dielectric_naive, "sin^2 / ior^2 and 1 are all but equal", 1e-3,
    ),
    "conductor of little absorption": Term(
        "optics/fresnel_device.py:fresnel_conductor", probes.fresnel, [[0.7, 0.05, 6.0], [0.9, 0.001, 9.0]],
        _conductor, _conductor_naive, "what little is absorbed comes from a difference of large numbers", 1e-6,
        column=1,
    ),
    "GGX at its peak": Term(
        "optics/microfacets_device.py:ggx_d", probes.facets, [[1e-4, 1.0, 1e-4], [0.0, 1.0, 1e-4], [2e-4, 1.0, 1e-4]],
        lambda x, z, a, *_: 1 / (np.pi * a * a * ((x / a) ** 2 + z * z) ** 2), _ggx_naive,
        "cos^2 (alpha^2 - 1) + 1 is 0: infinite", 1e-4,
    ),
    "masking of two grazing directions": Term(
        "optics/microfacets_device.py:ggx_reflection", probes.facets, [[1e-20, 1.0, 0.3], [1e-6, 1.0, 0.3]],
        lambda c, z, a, *_: 1 / (4 * np.pi * a * a * c * np.sqrt(c * c + a * a)),
        lambda c, z, a, *_: F(1) / (PI * a * a) / (F(1) + (np.sqrt(F(1) + a * a / (c * c)) - F(1)))
        / (F(4) * c * c), "tangents overflow at the horizon", 1e-4, column=1,
    ),
    "half vector of opposite directions": Term(
        "optics/microfacets_device.py:half_vector", probes.halves, [[0.6, 0.0, 0.8, -0.6, 0.0, -0.8]],
        lambda *_: np.ones(1), lambda a, b, c, d, e, f: (c + f) / np.sqrt((a + d) ** 2 + (b + e) ** 2 + (c + f) ** 2),
        "0 / 0", column=2,
    ),
    "frame about -z": Term(
        "optics/frames_device.py:frame_around", probes.frames, [[0.0, 0.0, -1.0], [1e-4, 1e-4, -1.0], [1e-9, 0.0, 1.0]],
        lambda *_: np.ones(3), lambda x, y, z, *_: np.hypot(F(1) - x * x / (F(1) + z), x * y / (F(1) + z)),
        "1 / (1 + n_z)", 1e-5, column=1,
    ),
    "tangent close to the normal": Term(
        "optics/frames_device.py:frame_with_tangent", probes.frames, [[0.3, 0.4, 0.5, 0.30002, 0.4, 0.5]],
        lambda *_: np.zeros(1), lambda *r: _once(*r), "what is left of it leans by 1e-3", 0.0, 2e-6, column=2,
    ),
    "angles along a scratch": Term(
        "optics/frames_device.py:scratch_angles", probes.along,
        [[np.sqrt(1 - 1e-8), 1e-4, 0.0], [np.sqrt(1 - 1e-6), 6e-4, 8e-4]],
        lambda x, y, z, *_: np.arctan2(x, np.hypot(y, z)), lambda x, *_: np.arcsin(x), "half of the digits", 1e-6,
    ),
    "centre of the disk": Term(
        "optics/sampling_device.py:sample_concentric_disk", probes.warps, [[0.5, 0.5]],
        lambda *_: np.zeros(1), lambda u, v, *_: (F(2) * u - F(1)) * np.cos(PI / 4 * (F(2) * v - 1) / (F(2) * u - 1)),
        "0 / 0", 0.0, 1e-30,
    ),
    "sine of a narrow cone": Term(
        "optics/sampling_device.py:sample_cone", probes.warps, [[0.0, 0.0, 1e-8], [0.0, 0.0, 1e-6]],
        lambda a, b, d, *_: np.sqrt(0.5 * d * (2 - 0.5 * d)),
        lambda a, b, d, *_: np.sqrt(F(1) - (F(1) - F(0.5) * d) ** 2), "0 below 1e-7", column=2,
    ),
    "cosine beyond the horizon": Term(
        "reflectance/profile_table_device.py:cone_direction", probes.cone, [[1 + 1.2e-7, 0.0], [-1 - 1.2e-7, 1.0]],
        lambda *_: np.zeros(2), lambda s, p, *_: np.sqrt(F(1) - s * s) * np.cos(p), "NaN by rounding", 0.0, 1e-6,
        column=2,
    ),
    "sinc^2 at 0": Term(
        "reflectance/diffraction/response_device.py:sinc2", probes.narrow, [[0.0], [1e-40], [3.0], [1e-3]],
        lambda t, *_: np.sinc(t) ** 2, lambda t, *_: (np.sin(PI * t) / (PI * t)) ** 2, "0 / 0, and light in its zeros",
        1e-5, 1e-20,
    ),
    "narrow interval across": Term(
        "reflectance/diffraction/response_device.py:across_integral", probes.narrow,
        [[0.0, 15.0, 1.9, 1.90002], [0.0, 15.0, 0.5, 0.5001], [0.0, 7.5, 1.5, 1.5005]],
        _across, _across_naive, "two M of pi / 2 cancel: per cents", 2e-3, column=1,
    ),
    "phase of whole waves": Term(
        "reflectance/diffraction/response_device.py:depth_response", probes.narrow, [[0.0, STEP, 0.4], [0.0, 0.8, 0.4]],
        lambda x, d, w, *_: _fringes(d, w), lambda x, d, w, *_: F(2) - F(2) * np.cos(F(4) * PI * d / w),
        "2 - 2 cos loses half of the digits", 2e-3, 1e-9, column=2,
    ),
    "strip without a footprint": Term(
        "scratches/curves_device.py:overlap", probes.cover, [[0.5, 0.0, 0.0, 1.0], [0.5, 1e-30, 0.0, 1.0]],
        lambda *_: np.ones(2),
        lambda c, e, a, b, *_: (np.minimum(c + F(0.5) * e, b) - np.maximum(c - F(0.5) * e, a)) / e, "0 / 0",
    ),
    "deformation near its centre": Term(
        "reflectance/mdf/deform_device.py:rim_ratio", probes.deform, [[0.5, 0.0, 0.5, 0.0], [0.999, 0.0, 0.999, 0.0]],
        lambda *_: np.ones(2), _rim_naive, "p = c has no direction: 0 / 0", 1e-6,
    ),
    "deformation to the rim": Term(
        "reflectance/mdf/deform_device.py:rim_ratio", probes.deform, [[0.999995, 1e-7, 0.99999, 0.0]],
        _rim, _rim_naive, "-b + sqrt(b^2 + ...) cancels", 1e-4,
    ),
    "bands far from the origin": Term(
        "scratches/lines_device.py:band_coverage", probes.bands,
        [[1e7 + 0.3, 2.0, 3.0, 1.0], [1e10 + 5.1, 2.5, 3.0, 1.0], [7.2, 4.0, 3.0, 1.0]],
        _bands, _bands_naive, "in float32, ten metres off, a micrometre is gone", 1e-4, double=True,
    ),
    "zeros of sinc": Term(
        "reflectance/diffraction/lobe_device.py:sinc", probes.waves, [[0.0], [1e-310], [1000.0], [0.5]],
        lambda t, *_: np.where(t == 1000.0, 0.0, np.sinc(t)), lambda t, *_: np.sin(np.pi * t) / (np.pi * t),
        "0 / 0, and 1e-13 of light in its zeros", 1e-12, 1e-18, double=True,
    ),
    "difference of M far out": Term(
        "reflectance/diffraction/lobe_device.py:lobe_integral", probes.waves,
        [[94 * 1.9 / (2 * np.pi), 94 * 1.90002 / (2 * np.pi)], [94 * 0.9 / (2 * np.pi), 94 * 0.902 / (2 * np.pi)]],
        _m_step, _m_naive, "per cents in float32", 1e-6, column=1, double=True,
    ),
    "few scratches among dense ones": Term(
        "reflectance/diffraction/energy_device.py:balanced_weights", probes.waves, [[0.0], [1e-12], [1e-17]],
        lambda x, *_: 1 - x / 2, lambda x, *_: (1.0 - np.exp(-x)) / x, "0 / 0", 1e-9, column=2, double=True,
    ),
    "chord next to the edge": Term(
        "reflectance/diffraction/ellipse_device.py:chord", probes.waves, [[60.0, 60.0, 0.0, EDGE]],
        lambda a1, a2, angle, y, *_: 2 * np.sqrt((a1 - y) * (a1 + y)),
        lambda a1, a2, angle, y, *_: F(2) * a1.astype(F) * np.sqrt(F(1) - (y.astype(F) / a1.astype(F)) ** 2),
        "1 - y^2 / h^2: half a per cent in float32", 1e-5, column=3, double=True,
    ),
    "edge-on footprint": Term(
        "reflectance/diffraction/ellipse_device.py:chord", probes.waves, [[60.0, 0.0, 0.0, 0.0]],
        lambda a1, *_: 2 * a1, lambda a1, a2, angle, y, *_: a1 * a2 / np.hypot(a1 * np.sin(angle), a2), "0 / 0",
        column=3, double=True,
    ),
    "ends far from the cone": Term(
        "reflectance/diffraction/faddeeva_device.py:damped_erf_between", probes.waves,
        [[-0.6, 0.7, 33.0], [-0.6, 0.7, 40.0]], _ends, _ends_naive, "0 times infinity", 1e-9, column=4, double=True,
    ),
}  # fmt: skip


def _once(nx: Any, ny: Any, nz: Any, tx: Any, ty: Any, tz: Any) -> Any:
    n, t = np.stack([nx, ny, nz]), np.stack([tx, ty, tz])
    n = n / np.sqrt((n * n).sum(0))
    flat = t - (t * n).sum(0) * n
    flat = flat / np.sqrt((flat * flat).sum(0))
    return np.abs((flat * n).sum(0))
