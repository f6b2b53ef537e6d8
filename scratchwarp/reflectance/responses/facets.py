"""Ashikhmin and Shirley's distribution fitted to the slopes of a profile."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from ..mdf.lobe import Lobe
from ..mdf.lobe_device import Lobe as DeviceLobe

# Exponent along the scratch: nearly all light within half a degree of the mirror cone (Raymond 2016, Figure 7a).
ALONG = 1e4


def fitted(polyline: np.ndarray) -> Lobe:
    """The lobe whose facets have the mean square tilt of a cross-section's, ``polyline [n, 2]`` (x, z).

    Facets weigh by their share of the base line; those of overhangs and walls are seen from nowhere above and count
    nothing. With D cos(tilt) ~ cos^(e + 1) across the scratch, the mean of sin^2(tilt) is 1 / (e + 3).
    """
    edge = np.diff(np.asarray(polyline, np.float64), axis=0)
    share = np.maximum(edge[:, 0], 0.0)
    sine2 = edge[:, 1] ** 2 / np.maximum((edge**2).sum(axis=1), 1e-300)
    mean = float((share * sine2).sum() / max(share.sum(), 1e-300))
    across = 1.0 / max(mean, 1e-9) - 3.0
    return Lobe("ashikhmin-shirley", ALONG, float(np.clip(across, 0.0, ALONG)))


def pack(values: Sequence[Lobe], arrays: Any, device: str, textures: Sequence[Any] = ()) -> None:
    """Put the lobes into ``arrays.facets``."""
    arrays.facets = wp.array([lobe.to_device() for lobe in values], dtype=DeviceLobe, device=device)
