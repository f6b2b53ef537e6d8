"""A table from the distribution of a profile's facets and their masking, each facet reflecting once.

The comparison model of Raymond 2016, Figure 7b: what microfacet theory makes of a cross-section. A facet of slope angle
a sends phi_i to phi_o = 2 a - phi_i; its share of the light is cos(phi_i - a) / (cos(a) cos(phi_i)) times its share of
the base line, times the masking G(phi_i) G(phi_o). G is Smith's, which makes the visible facets' projected areas add up
to that of the base line: G(phi) = cos(phi) / sum of share max(0, cos(phi - a)) / cos(a).
"""

from typing import Any

import numpy as np

from scratchwarp.profiles import theta as theta_models
from scratchwarp.profiles.profile import Profile, normalised
from scratchwarp.profiles.reflectors import reflecting
from scratchwarp.profiles.table import Table, bin_angles, bin_weights, cumulative

# Directions of incidence in a bin; facets shorter than this share of the base line are left out.
_INSIDE = 8
_SHORTEST = 1e-6
_SLOPES = 4096


def _slopes(profile: Profile) -> tuple[np.ndarray, np.ndarray]:
    """(slope angle of the facets' normals, share of the base line), gathered into ``_SLOPES`` angles at most."""
    vertices, controls = normalised(profile)
    t = np.arange(65)[:, None, None] / 64
    arcs = (1 - t) ** 2 * vertices[:-1] + 2 * t * (1 - t) * controls + t**2 * vertices[1:]
    edge = np.diff(arcs, axis=0).reshape(-1, 2)
    edge = edge[edge[:, 0] > _SHORTEST / 64]
    angle = np.arctan2(-edge[:, 1], edge[:, 0])
    if len(angle) <= _SLOPES:
        return angle, edge[:, 0] / edge[:, 0].sum()
    cell = np.clip(((angle / np.pi + 0.5) * _SLOPES).astype(int), 0, _SLOPES - 1)
    share = np.bincount(cell, edge[:, 0], _SLOPES)
    mean = np.bincount(cell, edge[:, 0] * angle, _SLOPES)
    kept = share > 0.0
    return mean[kept] / share[kept], share[kept] / share.sum()


def _masking(phi: np.ndarray, angle: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Smith's G at each of ``phi`` [n]."""
    seen = np.zeros_like(phi)
    for a, s in zip(angle, share, strict=True):
        seen += s * np.maximum(np.cos(phi - a), 0.0) / np.cos(a)
    return np.minimum(np.cos(phi) / np.maximum(seen, 1e-12), 1.0)


def facet_table(profile: Profile, fresnel: Any = None, resolution: int = 256, theta_model: str = "table") -> Table:
    """The table of a profile's facet distribution with masking, of one reflection (Raymond 2016, Figure 7b).

    ``fresnel``: a reflector of ``optics``, None for a mirror; ``resolution``: bins M each way; ``theta_model``: as for
    ``simulate``. Energy that masking takes away counts as ``lost``. Raises ValueError naming the argument.
    """
    if not 2 <= int(resolution) <= 4096:
        raise ValueError(f"resolution must lie in [2, 4096], got {resolution}")
    bins = int(resolution)
    angles, weights = bin_angles(bins), bin_weights(bins)
    slope, share = _slopes(profile)
    # sines evenly inside each bin: cosine-weighted directions
    edges = np.sin(np.arange(bins + 1) * (np.pi / bins) - 0.5 * np.pi)
    inside = edges[:-1, None] + np.diff(edges)[:, None] * (np.arange(_INSIDE) + 0.5) / _INSIDE
    phi_i = np.arcsin(np.clip(inside, -1.0, 1.0)).ravel()
    column = np.repeat(np.arange(bins), _INSIDE)
    lookup = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 4 * bins + 1)
    masks = _masking(lookup, slope, share)
    g_i = np.interp(phi_i, lookup, masks)
    hits = np.zeros(bins * bins)
    for a, s in zip(slope, share, strict=True):
        phi_o = 2.0 * a - phi_i
        arriving = s * np.maximum(np.cos(phi_i - a), 0.0) / (np.cos(a) * np.cos(phi_i))
        g_o = np.interp(phi_o, lookup, masks)
        up = np.abs(phi_o) < 0.5 * np.pi
        row = np.clip(((phi_o / np.pi + 0.5) * bins).astype(int), 0, bins - 1)
        hits += np.bincount((row * bins + column)[up], (arriving * g_i * g_o)[up], bins * bins)
    mirror = hits.reshape(bins, bins) / (_INSIDE * weights[:, None])
    mirror = 0.5 * (mirror + mirror.T)  # reciprocal up to what eight directions a bin leave
    by_bounce = np.zeros((3, bins, bins), np.float32)
    by_bounce[0] = mirror
    lost = np.clip(1.0 - weights @ mirror, 0.0, 1.0)
    fields: dict[str, Any] = {"angles": angles, "weights": weights, "lost": lost, "theta_model": theta_model}
    reflector, normal, gamma, slices, cosines = reflecting(fresnel), None, None, None, None
    if reflector is not None:
        cosines = theta_models.nodes(theta_model)
        local = np.cos(0.5 * (angles[:, None] - angles[None, :]))
        each = [mirror[..., None] * reflector.reflectance(local * mu) for mu in cosines]
        slices = np.stack(each).astype(np.float32)
        slices = slices[..., 0] if reflector.channels == 1 else slices
        normal = slices[0]
        gamma = np.ones_like(normal)
    return Table(
        mirror=mirror.astype(np.float32),
        by_bounce=by_bounce,
        normal=normal,
        gamma=gamma,
        cdf=cumulative(mirror.astype(np.float32), weights),
        slices=slices,
        slice_cosines=cosines,
        **fields,
    )
