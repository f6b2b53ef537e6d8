"""Energy of a stencil model: how often each part is sampled, and what factor keeps every view below 1.

The paper leaves energy conservation open. Here each direction has the factor 1 / max(1, albedo) and a pair of
directions the smaller of its two, which is reciprocal and bounds every view by 1. Albedos are per-channel maxima.
(1 / (cos_i cos_o))^alpha has no finite albedo, so that the growth towards grazing ends at 75 degrees, where
measurements do; on the grid of a measurement nothing changes.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import warp as wp

from . import stencil_kernels as kernels
from .model import Model
from .stencil_device import Stencil, StencilMode

_ROWS, _COLUMNS = 24, 24  # of the table of factors
_SAMPLES = 2048  # of each node's albedo
_LEAST_DIFFUSE = 0.1
_LEAST_COSINE = 1e-3


def device_model(model: Model, probabilities: np.ndarray, limit: np.ndarray | None = None, hold: bool = False) -> Any:
    """The device struct of ``model``; ``probabilities``: diffuse, specular, then each mode."""
    modes = []
    for number, mode in enumerate(model.modes):
        m = StencilMode()
        m.axis = wp.vec2(float(np.cos(mode.azimuth)), float(np.sin(mode.azimuth)))
        soft = mode.softness if model.mask == "smooth" else 0.0
        m.low, m.high = mode.width - soft, mode.width + soft
        for name in ("a", "b", "kd", "ks", "alpha"):
            setattr(m, name, getattr(mode, name))
        m.color = wp.vec3(*mode.color)
        m.beta = model.beta[number] if number < len(model.beta) else 0.0
        m.probability = float(probabilities[2 + number])
        modes.append(m)
    s = Stencil()
    s.modes = wp.array(modes, dtype=StencilMode, device="cpu")
    s.background, s.k, s.specular_alpha = model.background, model.k, model.specular_alpha
    s.retro = int(model.retro)
    s.p_diffuse, s.p_specular = float(probabilities[0]), float(probabilities[1])
    s.hold, s.conserve = int(hold), int(limit is not None)
    s.limit = wp.array(np.ones((2, 1)) if limit is None else limit, dtype=float, device="cpu")
    return s


def run(stencil: Any, wi: np.ndarray, wo: np.ndarray, density: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """f_r [n, 3] and density [n] (empty unless asked for) of directions [n, 3], float32."""
    arrays: list[Any] = [wp.array(np.ascontiguousarray(w, np.float32), dtype=wp.vec3, device="cpu") for w in (wi, wo)]
    value = wp.zeros(len(wi), dtype=wp.vec3, device="cpu")
    pdf = wp.zeros(len(wi) if density else 0, dtype=float, device="cpu")
    wp.launch(kernels.evaluate, len(wi), inputs=[stencil, *arrays], outputs=[value, pdf], device="cpu")
    return value.numpy(), pdf.numpy()


def draw(stencil: Any, wo: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Directions [n, 3], weights [n, 3] and densities [n] for views and uniform numbers [n, 3]."""
    arrays: list[Any] = [wp.array(np.ascontiguousarray(a, np.float32), dtype=wp.vec3, device="cpu") for a in (wo, u)]
    outputs: list[Any] = [wp.zeros(len(wo), dtype=d, device="cpu") for d in (wp.vec3, wp.vec3, float)]
    wp.launch(kernels.sample, len(wo), inputs=[stencil, *arrays], outputs=outputs, device="cpu")
    wi, weight, pdf = (a.numpy() for a in outputs)
    return wi, weight, pdf


def _direction(theta: np.ndarray, phi: np.ndarray) -> np.ndarray:
    parts = np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta))
    return np.stack(parts, axis=-1)


def probabilities(model: Model) -> np.ndarray:
    """Shares of the energy of each part over a few views, the cosine never below a tenth: [2 + modes]."""
    theta = np.arcsin(np.sqrt((np.arange(12) + 0.5) / 12))
    wi = _direction(theta[:, None], (np.arange(32) + 0.5) / 32 * 2 * np.pi).reshape(-1, 3)
    wo = _direction(np.array([0.2, 0.7, 1.1])[:, None], np.arange(8) / 8 * np.pi + 0.05).reshape(-1, 1, 3)
    pairs = [np.ascontiguousarray(a.reshape(-1, 3)) for a in np.broadcast_arrays(wi[None], wo)]
    even = np.zeros(2 + len(model.modes))

    def energy(variant: Model) -> float:
        return float(run(device_model(variant, even, hold=True), pairs[0], pairs[1])[0].astype(float).mean())

    flat = replace(model, modes=tuple(replace(m, ks=0.0) for m in model.modes), k=0.0)
    parts = np.zeros(2 + len(model.modes))
    parts[0] = energy(flat)
    matte = energy(replace(model, k=0.0))
    parts[1] = max(energy(model) - matte, 0.0)
    for number, mode in enumerate(model.modes):
        parts[2 + number] = max(energy(flat.edit(number, ks=mode.ks)) - parts[0], 0.0)
    total = parts.sum()
    if not 0.0 < total < np.inf:
        parts[:], total = 0.0, 1.0
        parts[0] = 1.0
    parts /= total
    rest = parts[1:].sum()
    parts[0] = max(parts[0], _LEAST_DIFFUSE)
    if rest > 0.0:
        parts[1:] *= (1.0 - parts[0]) / rest
    else:
        parts[0] = 1.0
    return parts


def limits(model: Model, shares: np.ndarray) -> np.ndarray:
    """1 / max(1, albedo) at views of cos theta = (1 - row / (rows - 1))^2 and azimuths over half a turn, float64."""
    cosines = np.maximum((1.0 - np.arange(_ROWS) / (_ROWS - 1)) ** 2, _LEAST_COSINE)
    views = _direction(np.arccos(cosines)[:, None], np.arange(_COLUMNS) / _COLUMNS * np.pi).reshape(-1, 3)
    golden = (np.sqrt(5.0) - 1.0) / 2.0
    n = np.arange(_SAMPLES)
    # rank-1 points for the direction; the choice of part runs through all of [0, 1) in another order
    u = np.stack([(n + 0.5) / _SAMPLES, (0.5 + n * golden) % 1.0, (0.5 + n * (np.sqrt(2.0) - 1.0)) % 1.0], axis=-1)
    stencil = device_model(model, shares, hold=True)
    albedo = np.zeros(len(views))
    for row, view in enumerate(views):
        weight = draw(stencil, np.broadcast_to(view, u.shape), u)[1]
        albedo[row] = weight.astype(float).mean(axis=0).max()
    table = albedo.reshape(_ROWS, _COLUMNS)
    # between nodes the factor is interpolated: let each node answer for its neighbours, grazing ones above all
    rows = np.maximum(table, np.vstack([table[1:], table[-1:]]))
    wide = np.maximum(rows, 0.5 * (np.roll(rows, 1, axis=1) + np.roll(rows, -1, axis=1)))
    return 1.0 / np.maximum(wide * 1.01, 1.0)
