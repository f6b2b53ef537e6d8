"""Stencil models for the renderer, with the factors that keep every view's albedo below 1."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from ..stencils.evaluation import pack as pack_model
from ..stencils.evaluation import sample
from ..stencils.model import Model
from ..stencils.stencil_device import Stencil


def albedo(model: Model) -> tuple[float, float, float]:
    """Directional albedo at 45 degrees, the mean over azimuths, as rendered."""
    n = 2048
    k = np.arange(n) + 0.5
    golden = (np.sqrt(5.0) - 1.0) / 2.0
    u = np.stack([k / n, (k * golden) % 1.0, (k * (np.sqrt(2.0) - 1.0)) % 1.0], axis=-1)
    phi = 2.0 * np.pi * ((k * (np.sqrt(3.0) - 1.0)) % 1.0)
    half = np.sqrt(0.5)
    wo = np.stack([half * np.cos(phi), half * np.sin(phi), np.full(n, half)], axis=-1)
    r, g, b = np.clip(sample(model, wo, u, energy_conserving=True).weight.mean(axis=0, dtype=float), 0.0, 1.0)
    return float(r), float(g), float(b)


def pack(values: Sequence[Model], arrays: Any, device: str, textures: Sequence[Any] = ()) -> Any:
    """Put the models into ``arrays.stencils``; returns what must outlive them."""
    models = [pack_model(model, energy_conserving=True) for model in values]
    arrays.stencils = wp.array(models, dtype=Stencil, device=device)
    return models
