"""The grid of a UTIA measurement, and what of it is independent for a model with the symmetries of a stencil.

Direction 48 it + ip has theta = 15 it and phi = 7.5 ip degrees. A stencil is reciprocal and the same after half a turn
of both directions, and at theta = 0 all azimuths are one direction: of the 288 x 288 pairs some 14,500 are left. The
least-squares fit to them, each with the number of pairs it stands for, is the fit to all.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

THETAS, PHIS = 6, 48
SIZE = THETAS * PHIS


class Pairs(NamedTuple):
    """Independent pairs of directions and where the measured ones went."""

    half: np.ndarray  # [n, 3] half vector, azimuth in [0, pi)
    inverse_cosines: np.ndarray  # [n] 1 / (cos_i cos_o)
    weight: np.ndarray  # [n] measured pairs that it stands for
    elevations: np.ndarray  # [n] number of its pair of elevations
    member: np.ndarray  # [288 * 288] which pair a measured one belongs to


@lru_cache(maxsize=1)
def grid_directions() -> np.ndarray:
    """Unit directions of the grid, read-only float64 [288, 3]."""
    theta = np.repeat(np.radians(15.0 * np.arange(THETAS)), PHIS)
    phi = np.tile(np.radians(7.5 * np.arange(PHIS)), THETAS)
    w = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    w.setflags(write=False)
    return w


@lru_cache(maxsize=2)
def pairs(retro: bool = False) -> Pairs:
    """The independent pairs of the grid; ``retro``: half vectors of the light turned by half a turn."""
    t, p = np.divmod(np.arange(SIZE), PHIS)
    p = np.where(t == 0, 0, p)
    ti, tv = np.meshgrid(t, t, indexing="ij")
    pi, pv = np.meshgrid(p, p, indexing="ij")
    keys = []
    for turn in (0, PHIS // 2):
        a = np.where(ti == 0, 0, (pi + turn) % PHIS)
        b = np.where(tv == 0, 0, (pv + turn) % PHIS)
        keys += [_key(ti, a, tv, b), _key(tv, b, ti, a)]
    key = np.minimum.reduce(keys).ravel()
    names, first, member, count = np.unique(key, return_index=True, return_inverse=True, return_counts=True)
    w = grid_directions()
    wi, wo = w[first // SIZE], w[first % SIZE]
    light = wi * np.array([-1.0, -1.0, 1.0]) if retro else wi
    half = light + wo
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    ei, eo = t[first // SIZE], t[first % SIZE]
    elevations = np.maximum(ei, eo) * THETAS + np.minimum(ei, eo)
    result = Pairs(half, 1.0 / (wi[:, 2] * wo[:, 2]), count.astype(float), elevations, member.ravel())
    for array in result:
        array.setflags(write=False)
    return result


def _key(ti: np.ndarray, pi: np.ndarray, tv: np.ndarray, pv: np.ndarray) -> np.ndarray:
    return ((ti * PHIS + pi) * THETAS + tv) * PHIS + pv


def collapse(brdf: np.ndarray, where: Pairs) -> np.ndarray:
    """Means of a measurement [288, 288, 3] over what each independent pair stands for, [n, 3]."""
    flat = brdf.reshape(-1, 3)
    sums = [np.bincount(where.member, flat[:, c], len(where.weight)) for c in range(3)]
    return np.stack(sums, axis=-1) / where.weight[:, None]
