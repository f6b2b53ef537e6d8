"""Analytical anisotropic lobes, as functions of few angles: what stencil models are compared with.

Each lobe is turned by an azimuth about the normal; ``x`` and ``y`` below are components of the half vector in its
frame. All are reciprocal. Sources: Ward 1992; Ashikhmin and Shirley 2000; Kurt, Szirmay-Kalos and Krivanek 2010, with
Schlick's Fresnel term and the Beckmann form; GGX with height-correlated Smith shadowing (Heitz 2014).
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np


class Angles(NamedTuple):
    """What lobes depend on, [n] each but ``half`` and the sums [n, 3] of directions."""

    half: np.ndarray
    cos_i: np.ndarray
    cos_o: np.ndarray
    cos_d: np.ndarray  # half vector to either direction
    light: np.ndarray
    view: np.ndarray


def angles(light: np.ndarray, view: np.ndarray) -> Angles:
    """Angles of pairs of directions [n, 3] above the horizon."""
    total = light + view
    length = np.maximum(np.linalg.norm(total, axis=-1, keepdims=True), 1e-12)
    cos_i, cos_o = np.maximum(light[:, 2], 1e-3), np.maximum(view[:, 2], 1e-3)
    return Angles(total / length, cos_i, cos_o, np.maximum(0.5 * length[:, 0], 1e-3), light, view)


def _frame(at: Angles, azimuth: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    c, s = np.cos(azimuth), np.sin(azimuth)
    hx, hy, hz = at.half.T
    return hx * c + hy * s, hy * c - hx * s, np.maximum(hz, 1e-6)


def _schlick(f0: float, cos_d: np.ndarray) -> np.ndarray:
    return f0 + (1.0 - f0) * (1.0 - cos_d) ** 5


def ward(p: np.ndarray, at: Angles) -> np.ndarray:
    """Azimuth, log ax, log ay."""
    x, y, z = _frame(at, p[0])
    ax, ay = np.exp(p[1:3])
    exponent = -((x / ax) ** 2 + (y / ay) ** 2) / z**2
    return np.exp(exponent) / (4.0 * np.pi * ax * ay * np.sqrt(at.cos_i * at.cos_o))


def ashikhmin_shirley(p: np.ndarray, at: Angles) -> np.ndarray:
    """Azimuth, log of the exponents, f0."""
    x, y, z = _frame(at, p[0])
    ex, ey = np.exp(p[1:3])
    power = (ex * x**2 + ey * y**2) / np.maximum(x**2 + y**2, 1e-12)
    density = np.sqrt((ex + 1.0) * (ey + 1.0)) / (8.0 * np.pi) * z**power
    return density * _schlick(p[3], at.cos_d) / (at.cos_d * np.maximum(at.cos_i, at.cos_o))


def kurt(p: np.ndarray, at: Angles) -> np.ndarray:
    """Azimuth, log mx, log my, f0, alpha."""
    x, y, z = _frame(at, p[0])
    mx, my = np.exp(p[1:3])
    density = np.exp(-((x / mx) ** 2 + (y / my) ** 2) / z**2) / (np.pi * mx * my * z**4)
    return density * _schlick(p[3], at.cos_d) / (4.0 * at.cos_d * (at.cos_i * at.cos_o) ** p[4])


def ggx(p: np.ndarray, at: Angles) -> np.ndarray:
    """Azimuth, log of the widths, f0."""
    x, y, z = _frame(at, p[0])
    ax, ay = np.exp(p[1:3])
    density = 1.0 / (np.pi * ax * ay * ((x / ax) ** 2 + (y / ay) ** 2 + z**2) ** 2)
    c, s = np.cos(p[0]), np.sin(p[0])

    def stretched(w: np.ndarray) -> np.ndarray:
        along, across = w[:, 0] * c + w[:, 1] * s, w[:, 1] * c - w[:, 0] * s
        return np.sqrt(w[:, 2] ** 2 + (ax * along) ** 2 + (ay * across) ** 2)

    shadow = stretched(at.view) * at.cos_i + stretched(at.light) * at.cos_o
    return 0.5 * density * _schlick(p[3], at.cos_d) / np.maximum(shadow, 1e-9)


class Shape(NamedTuple):
    """A lobe: its function, a start besides the azimuth, and bounds of all its numbers."""

    function: Callable[[np.ndarray, Angles], np.ndarray]
    start: tuple[float, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]


_TURN = np.inf
SHAPES = {
    "kurt": Shape(kurt, (-2.0, -0.5, 0.3, 0.5), (-_TURN, -5.0, -5.0, 0.0, 0.0), (_TURN, 3.0, 3.0, 1.0, 2.0)),
    "ward": Shape(ward, (-2.0, -0.5), (-_TURN, -5.0, -5.0), (_TURN, 3.0, 3.0)),
    "ashikhmin-shirley": Shape(ashikhmin_shirley, (4.0, 1.0, 0.3), (-_TURN, -4.0, -4.0, 0.0), (_TURN, 11.0, 11.0, 1.0)),
    "ggx": Shape(ggx, (-2.0, -0.5, 0.3), (-_TURN, -5.0, -5.0, 0.0), (_TURN, 1.0, 1.0, 1.0)),
}
