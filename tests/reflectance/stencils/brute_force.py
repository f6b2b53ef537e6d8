"""The stencil model in plain float64, from the equations of the paper with the mask the right way round."""

import numpy as np


def direction(theta, phi):
    return np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), -1)


def mask(x, w, dw, binary):
    if binary or dw == 0.0:
        return (x >= w).astype(float)
    y = (x - w + dw) / (2 * dw)
    return np.where(x <= w - dw, 0.0, np.where(x >= w + dw, 1.0, y**2 * (3 - 2 * y)))


def brdf(model, wi, wo):
    """B_S of Eq. 10 for directions above the horizon; B is built from the last mode upwards (Eq. 7 and 8)."""
    light = wi * [-1, -1, 1] if model.retro else wi
    h = light + wo
    h = h / np.linalg.norm(h, axis=-1, keepdims=True)
    cc = wi[..., 2] * wo[..., 2]
    t, m = [], []
    for mode in model.modes:
        u = np.array([np.cos(mode.azimuth), np.sin(mode.azimuth), 0.0])
        x = 1 - np.abs(np.sum(h * u, axis=-1))
        e = x * (mode.a + mode.b / cc)
        t.append(np.array(mode.color) * np.maximum(0, mode.kd + mode.ks * e**mode.alpha)[..., None])
        dw = 0.15 * mode.width if mode.half_width is None else mode.half_width
        m.append(mask(x, mode.width, dw, model.mask == "binary")[..., None])
    b = (1 - m[-1]) * model.background * np.array(model.modes[-1].color) + m[-1] * t[-1]
    for k in range(len(t) - 2, -1, -1):
        beta = model.beta[k]
        b = (1 - m[k]) * b + m[k] * ((1 - beta) * t[k] + beta * t[k + 1])
    top = model.modes[0]
    return b * np.maximum(1, model.k * h[..., 2] ** model.specular_alpha * (top.a + top.b / cc))[..., None]
