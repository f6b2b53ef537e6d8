"""A reflector of ``optics.fresnel`` as rows over the cosine in the plane of the cross-section, for slices in theta.

At theta the cosine of incidence is cos(theta) times the one in the plane, so one trace serves every theta, colour and
model.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from scratchwarp.optics.fresnel import Conductor, Dielectric, Mirror, amplitudes

# Rows are interpolated linearly between this many cosines: error below 1e-5 for metals and glass.
NODES = 2049


@dataclass(frozen=True, eq=False)
class Rows:
    """Layers, slice by slice and in each channel by channel. ``power`` float32 ``[layers, NODES]``; or, polarised,
    ``amplitude`` float32 ``[layers, NODES, 4]`` (re r_s, im r_s, re r_p, im r_p) and ``sine`` ``[layers]`` of
    theta."""

    channels: int
    layers: int
    power: np.ndarray | None = None
    amplitude: np.ndarray | None = None
    sine: np.ndarray | None = None


def reflecting(fresnel: Any) -> Any | None:
    """``fresnel``, or None for a mirror, which needs no rows. ValueError on anything that is no reflector."""
    if fresnel is None or isinstance(fresnel, Mirror):
        return None
    if not hasattr(fresnel, "reflectance") or not hasattr(fresnel, "channels"):
        raise ValueError(
            f"fresnel must be a reflector of optics (Mirror, Conductor, Dielectric, Schlick), got {fresnel!r}"
        )
    return fresnel


@lru_cache(maxsize=64)
def rows(fresnel: Any, mu: tuple[float, ...], polarised: bool) -> Rows:
    """Rows of ``fresnel`` at each cos(theta) of ``mu``. ``polarised`` needs the exact model of a conductor or
    dielectric (ValueError)."""
    cosine = np.linspace(0.0, 1.0, NODES)
    channels = int(fresnel.channels)
    layers = len(mu) * channels
    if not polarised:
        power = np.concatenate([np.moveaxis(fresnel.reflectance(cosine * m), -1, 0) for m in mu])
        return Rows(channels, layers, power=power.astype(np.float32))
    if getattr(fresnel, "model", None) != "exact" or not isinstance(fresnel, Conductor | Dielectric):
        raise ValueError(f"polarised needs an exact Conductor or Dielectric, got fresnel={fresnel!r}")
    indices = (
        [(fresnel.ior, 0.0)] if isinstance(fresnel, Dielectric) else list(zip(fresnel.eta, fresnel.k, strict=True))
    )
    amplitude = np.empty((layers, NODES, 4), np.float32)
    for layer, (m, (eta, k)) in enumerate((m, index) for m in mu for index in indices):
        r_s, r_p = amplitudes(cosine * m, eta, k)
        amplitude[layer] = np.stack((r_s.real, r_s.imag, r_p.real, r_p.imag), axis=-1)
    sine = np.repeat(np.sqrt(np.maximum(1.0 - np.square(mu), 0.0)), channels)
    return Rows(channels, layers, amplitude=amplitude, sine=sine.astype(np.float32))
