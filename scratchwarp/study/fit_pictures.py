"""A BRDF unfolded into a picture, as Filip et al. 2015 show it, and slices of it as a chart.

Blocks of rows are elevations of the light, 0 to 75 degrees from the top, blocks of columns those of the view; inside a
block the azimuths run over a whole turn.
"""

from collections.abc import Mapping

import numpy as np

from ..reflectance.measured.comparison import luminance
from ..reflectance.stencils.angles import PHIS, SIZE, THETAS

DIFFERENCE = 3.0  # differences are shown so many times brighter, as the paper does
_LINE = np.array([0.02, 0.02, 0.025])
_COLORS = ("#222222", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00")


def white(reference: np.ndarray) -> float:
    """The value that is shown white: what 99.5 per cent of the luminances stay below, above 0."""
    return max(float(np.quantile(luminance(np.asarray(reference, np.float64)), 0.995)), 1e-12)


def unfolded(values: np.ndarray, shown_white: float, scale: int = 2) -> np.ndarray:
    """Linear Rec.709 pixels of a BRDF [288, 288, 3], ``scale`` pixels each, with lines between elevations."""
    pixels = np.clip(np.asarray(values, np.float64) / shown_white, 0.0, 1.0)
    pixels = pixels.repeat(scale, axis=0).repeat(scale, axis=1)
    step = PHIS * scale
    framed = np.empty((SIZE * scale + THETAS + 1, SIZE * scale + THETAS + 1, 3))
    framed[:] = _LINE
    for row in range(THETAS):
        for column in range(THETAS):
            y, x = 1 + row * (step + 1), 1 + column * (step + 1)
            block = pixels[row * step : (row + 1) * step, column * step : (column + 1) * step]
            framed[y : y + step, x : x + step] = block
    return framed.astype(np.float32)


def difference(reference: np.ndarray, found: np.ndarray, shown_white: float, scale: int = 2) -> np.ndarray:
    """``unfolded`` of how far ``found`` is off, ``DIFFERENCE`` times brighter."""
    return unfolded(DIFFERENCE * np.abs(np.asarray(found) - np.asarray(reference)), shown_white, scale)


def beside(*pictures: np.ndarray) -> np.ndarray:
    """Pictures of one height side by side."""
    gap = np.ones((pictures[0].shape[0], 8, 3), np.float32)
    parts = [part for picture in pictures for part in (picture, gap)]
    return np.concatenate(parts[:-1], axis=1)


def slice_chart(values: Mapping[str, np.ndarray], theta_i: int = 5, theta_o: int = 4, phi_i: int = 0) -> str:
    """SVG of luminance over the azimuth of the view, one line for each BRDF by its label.

    ``theta_i``, ``theta_o``, ``phi_i``: indices of the grid (75, 60 and 0 degrees: the slice that the paper detects its
    modes in).
    """
    wide, high, left, top = 720, 260, 56, 12
    curves = {}
    for name, brdf in values.items():
        row = np.asarray(brdf, np.float64)[PHIS * theta_i + phi_i, PHIS * theta_o : PHIS * (theta_o + 1)]
        curves[name] = np.append(luminance(row), luminance(row[:1]))
    most = max(float(max(curve.max() for curve in curves.values())), 1e-12)
    x = left + (wide - left - 12) * np.arange(PHIS + 1) / PHIS
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high + 22 * len(curves) + 44}" role="img">']
    parts.append('<g font-family="sans-serif" font-size="12" fill="#444" stroke="none">')
    for degrees in range(0, 361, 60):
        at = left + (wide - left - 12) * degrees / 360
        parts.append(f'<path d="M{at:.1f} {top}V{high}" stroke="#ddd" fill="none"/>')
        parts.append(f'<text x="{at:.1f}" y="{high + 16}" text-anchor="middle">{degrees}</text>')
    for share in (0.0, 0.5, 1.0):
        y = high - (high - top) * share
        parts.append(f'<path d="M{left} {y:.1f}H{wide - 12}" stroke="#ddd" fill="none"/>')
        parts.append(f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{share * most:.3g}</text>')
    middle, says = (wide + left) / 2, "azimuth of the view, degrees"
    parts.append(f'<text x="{middle}" y="{high + 34}" text-anchor="middle">{says}</text>')
    for number, (name, curve) in enumerate(curves.items()):
        color = _COLORS[number % len(_COLORS)]
        points = np.stack([x, high - (high - top) * curve / most], axis=-1)
        line = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
        width = 3 if number == 0 else 1.6
        parts.append(f'<polyline points="{line}" fill="none" stroke="{color}" stroke-width="{width}"/>')
        below = high + 56 + 22 * number
        parts.append(f'<path d="M{left} {below - 4}h28" stroke="{color}" stroke-width="3"/>')
        parts.append(f'<text x="{left + 36}" y="{below}">{name}</text>')
    return "\n".join([*parts, "</g>", "</svg>", ""])
