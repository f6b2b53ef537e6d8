"""Dome light: constant, or an image whose distribution is built here."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from scratchwarp.lights import dome_device as device
from scratchwarp.lights.arcs_device import arcs_dome
from scratchwarp.lights.levels import levels
from scratchwarp.lights.lit_device import lit_dome
from scratchwarp.lights.model import LightModel, Packer
from scratchwarp.scene.light import DomeLight


def _cumulate(weights: np.ndarray) -> np.ndarray:
    """Cumulative distribution of each row of [n, k], float32 [n, k + 1], from exactly 0 to exactly 1; a row of zeros
    becomes uniform."""
    weights = np.where(weights.sum(1, keepdims=True) > 0.0, weights, 1.0)
    sums = np.cumsum(weights, axis=1)
    cdf = np.zeros((weights.shape[0], weights.shape[1] + 1))
    cdf[:, 1:] = sums / sums[:, -1:]
    return cdf.astype(np.float32)


def distribution(pixels: np.ndarray) -> np.ndarray | None:
    """Marginal over rows, then conditionals over columns, of a latlong image [h, w, 4]; None when it is black.

    A cell's weight is the mean over the texel's square of the bilinear interpolant that is rendered (1/8, 6/8, 1/8 each
    way, repeating across, clamped above and below) times its solid angle, so that no lit direction has density 0.
    """
    bright = np.maximum(pixels[..., :3], 0.0).mean(-1, dtype=np.float64)
    bright = 0.75 * bright + 0.125 * (np.roll(bright, 1, 1) + np.roll(bright, -1, 1))
    padded = np.concatenate([bright[:1], bright, bright[-1:]])
    bright = 0.75 * bright + 0.125 * (padded[:-2] + padded[2:])
    rows = len(bright)
    band = -np.diff(np.cos(np.pi * np.arange(rows + 1) / rows))
    weights = bright * band[:, None]
    if not weights.sum() > 0.0:
        return None
    marginal = _cumulate(weights.sum(1)[None])[0]
    return np.concatenate([marginal, _cumulate(weights).ravel()])


def _pack(light: DomeLight, packer: Packer) -> Mapping[str, Any]:
    fields: dict[str, Any] = {f"e{name}": light.rotation[:, i] for i, name in enumerate("xyz")}
    texture = packer.image(light.texture)
    cdf = distribution(packer.images[texture]) if texture >= 0 else None
    if cdf is not None:
        rows, columns = packer.images[texture].shape[:2]
        fields.update(rows=rows, columns=columns, cdf=packer.put_cdf(cdf))
    if texture >= 0 and packer.filtered:
        copies = levels(packer.images[texture])
        fields.update(first_level=len(packer.images), levels=len(copies))
        packer.images.extend(copies)
    return {**fields, "texture": texture, "camera_visible": int(light.camera_visible)}


DOME = LightModel(
    "dome", DomeLight, _pack, device.sample_dome, device.hit_dome, device.span_dome, arcs=arcs_dome, lit=lit_dome
)
