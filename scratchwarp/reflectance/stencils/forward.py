"""The stencil model and its derivatives on the host, float64, over independent pairs of directions: what the fit calls.

The gauge of the fit: a = 1 - b and ks = 1, so that a mode has 8 numbers, azimuth, width, b, log alpha, q = kd, color
[3]; after the modes come a beta for each crossing, then background, k and log of the specular exponent.
"""

from dataclasses import dataclass

import numpy as np

from .angles import Pairs
from .model import Mode, Model

MODE = 8
AZIMUTH, WIDTH, B, LOG_ALPHA, Q, COLOR = 0, 1, 2, 3, 4, 5
SOFTNESS = 0.15
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_TINY = 1e-300


def count(modes: int) -> int:
    """Numbers of a model."""
    return MODE * modes + (modes - 1) + 3


@dataclass
class Band:
    """One mode over all pairs: mask M and power P with their derivatives, each [n]."""

    mask: np.ndarray
    power: np.ndarray
    mask_azimuth: np.ndarray
    mask_width: np.ndarray
    power_azimuth: np.ndarray
    power_b: np.ndarray
    power_log_alpha: np.ndarray


def band(numbers: np.ndarray, where: Pairs, derivatives: bool = True) -> Band:
    """Mask and ((1 - |H . U|) (1 - b + b / (cos_i cos_o)))^alpha of one mode."""
    c, s = np.cos(numbers[AZIMUTH]), np.sin(numbers[AZIMUTH])
    hx, hy = where.half[:, 0], where.half[:, 1]
    offset = hx * c + hy * s
    x = 1.0 - np.abs(offset)
    soft = max(SOFTNESS * numbers[WIDTH], 1e-9)
    y = np.clip((x - numbers[WIDTH]) / (2.0 * soft) + 0.5, 0.0, 1.0)
    mask = y * y * (3.0 - 2.0 * y)
    rise = where.inverse_cosines - 1.0
    scale = np.maximum(1.0 + numbers[B] * rise, 1e-6)
    log = np.log(np.maximum(x, _TINY)) + np.log(scale)
    alpha = np.exp(numbers[LOG_ALPHA])
    power = np.exp(np.minimum(alpha * log, 60.0))
    none = np.empty(0)
    if not derivatives:
        return Band(mask, power, none, none, none, none, none)
    x_azimuth = -np.sign(offset) * (hy * c - hx * s)
    slope = 6.0 * y * (1.0 - y)
    y_width = -0.5 / soft - (y - 0.5) * (SOFTNESS / soft)
    return Band(
        mask,
        power,
        slope * x_azimuth * (0.5 / soft),
        slope * y_width,
        alpha * power / np.maximum(x, 1e-12) * x_azimuth,
        alpha * power / scale * rise,
        alpha * power * log,
    )


def coefficients(masks: list[np.ndarray], betas: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """Share of the background and of each mode's T in B (Eq. 9 for any number of modes)."""
    clear = np.ones_like(masks[0])
    shares = [np.zeros_like(clear) for _ in masks]
    for k, mask in enumerate(masks):
        seen = clear * mask
        if k + 1 < len(masks):
            shares[k] = shares[k] + seen * (1.0 - betas[k])
            shares[k + 1] = shares[k + 1] + seen * betas[k]
        else:
            shares[k] = shares[k] + seen
        clear = clear * (1.0 - mask)
    return clear, shares


def model_values(numbers: np.ndarray, modes: int, where: Pairs) -> np.ndarray:
    """B_S [3, n] alone, by the sum of Eq. 9."""
    bands = [band(numbers[MODE * k :], where, derivatives=False) for k in range(modes)]
    clear, shares = coefficients([b.mask for b in bands], numbers[MODE * modes : MODE * modes + modes - 1])
    colors = [numbers[MODE * k + COLOR : MODE * k + COLOR + 3, None] for k in range(modes)]
    matte = numbers[-3] * colors[-1] * clear
    for k, (share, color, b) in enumerate(zip(shares, colors, bands, strict=True)):
        matte = matte + color * (share * np.maximum(numbers[MODE * k + Q] + b.power, 0.0))
    gain = 1.0 + numbers[B] * (where.inverse_cosines - 1.0)
    lobe = np.exp(np.exp(numbers[-1]) * np.log(np.maximum(where.half[:, 2], 1e-12)))
    return matte * np.maximum(numbers[-2] * lobe * gain, 1.0)


def model_and_slopes(numbers: np.ndarray, modes: int, where: Pairs) -> tuple[np.ndarray, np.ndarray]:
    """B_S [3, n] and its derivatives [numbers, 3, n]."""
    n = len(where.weight)
    bands = [band(numbers[MODE * k :], where) for k in range(modes)]
    betas = numbers[MODE * modes : MODE * modes + modes - 1]
    background, k_s, log_s = numbers[-3:]
    colors = [numbers[MODE * k + COLOR : MODE * k + COLOR + 3] for k in range(modes)]
    lights = [np.maximum(numbers[MODE * k + Q] + b.power, 0.0) for k, b in enumerate(bands)]
    clear, shares = coefficients([b.mask for b in bands], betas)

    values = np.empty((3, n))
    slopes = np.zeros((count(modes), 3, n))
    z = np.maximum(where.half[:, 2], 1e-12)
    rise = where.inverse_cosines - 1.0
    lobe = np.exp(np.exp(log_s) * np.log(z))
    gain = 1.0 + numbers[B] * rise
    factor = np.maximum(k_s * lobe * gain, 1.0)
    shining = (k_s * lobe * gain > 1.0).astype(float)

    for c in range(3):
        t = [color[c] * light for color, light in zip(colors, lights, strict=True)]
        below = [np.zeros(n)] * modes + [np.full(n, background * colors[-1][c])]
        crossed = [np.zeros(n)] * modes
        for k in range(modes - 1, -1, -1):
            crossed[k] = t[k] if k == modes - 1 else (1.0 - betas[k]) * t[k] + betas[k] * t[k + 1]
            below[k] = below[k + 1] + bands[k].mask * (crossed[k] - below[k + 1])
        matte = below[0]
        values[c] = matte * factor
        visible = np.ones(n)
        for k, b in enumerate(bands):
            row = MODE * k
            by_mask = visible * (crossed[k] - below[k + 1])
            by_power = shares[k] * colors[k][c] * (lights[k] > 0.0)
            slopes[row + AZIMUTH, c] = by_mask * b.mask_azimuth + by_power * b.power_azimuth
            slopes[row + WIDTH, c] = by_mask * b.mask_width
            slopes[row + B, c] = by_power * b.power_b
            slopes[row + LOG_ALPHA, c] = by_power * b.power_log_alpha
            slopes[row + Q, c] = by_power
            slopes[row + COLOR + c, c] = shares[k] * lights[k]
            if k + 1 < modes:
                slopes[MODE * modes + k, c] = visible * b.mask * (t[k + 1] - t[k])
            visible = visible * (1.0 - b.mask)
        slopes[MODE * (modes - 1) + COLOR + c, c] += background * clear
        slopes[-3, c] = clear * colors[-1][c]
        slopes[:, c] *= factor
        glow = matte * shining
        slopes[B, c] += glow * k_s * lobe * rise
        slopes[-2, c] = glow * lobe * gain
        slopes[-1, c] = glow * k_s * lobe * gain * np.exp(log_s) * np.log(z)
    return values, slopes


def to_model(numbers: np.ndarray, modes: int, retro: bool = False) -> Model:
    """The record of a vector of numbers, colours scaled to luminance 1."""
    found = []
    for k in range(modes):
        v = numbers[MODE * k : MODE * (k + 1)]
        color = np.maximum(v[COLOR:], 0.0)
        ks = float(color @ _LUMINANCE)
        color = color / ks if ks > 0.0 else np.ones(3)
        b, alpha = float(v[B]), float(np.exp(v[LOG_ALPHA]))
        azimuth = float(v[AZIMUTH] % np.pi)
        found.append(Mode(azimuth, float(v[WIDTH]), 1.0 - b, b, float(v[Q]) * ks, ks, alpha, tuple(color)))
    scale = found[-1].ks
    betas = tuple(float(v) for v in numbers[MODE * modes : MODE * modes + modes - 1])
    background = float(numbers[-3]) * scale
    return Model(tuple(found), betas, background, float(numbers[-2]), float(np.exp(numbers[-1])), retro)
