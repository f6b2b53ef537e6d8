"""Random scratches, lights and views that look along the line xi_1 = 0 of a light."""

import numpy as np

from scratchwarp import diffraction

from .brute_force import unit


def scratches(count, seed=0, **fields):
    """Widths and depths of 0.8 to 6 um at all azimuths, and wavelengths [nm]."""
    rng = np.random.default_rng(seed)
    low, high = 0.8, 6.0
    s = diffraction.Scratch(
        rng.uniform(low, high, count), rng.uniform(low, high, count), rng.uniform(-7.0, 7.0, count), **fields
    )
    return s, rng.uniform(400.0, 750.0, count)


def centers(count, seed=1):
    """Unit directions above the horizon."""
    v = np.random.default_rng(seed).normal(size=(count, 3))
    v[:, 2] = np.abs(v[:, 2]) + 0.05
    return unit(v)


def view(light, xi1, s, seed=2):
    """Views for which the unit direction ``light`` lies at ``xi1``, anywhere across."""
    rng = np.random.default_rng(seed)
    c, d = np.cos(s.azimuth), np.sin(s.azimuth)
    u = xi1 - (light[:, 0] * c + light[:, 1] * d)
    v = rng.uniform(-0.7, 0.7, len(light)) * np.sqrt(np.maximum(1.0 - u * u, 0.0))
    z = np.sqrt(np.maximum(1.0 - u * u - v * v, 1e-9))
    return unit(np.stack((u * c - v * d, u * d + v * c, z), axis=-1))


def polygons(count, size, corners, seed=3, star=1.0):
    """Polygons ``[count, corners, 3]`` around unit directions in random planes; every second corner drawn in by
    ``star``."""
    rng = np.random.default_rng(seed)
    c = centers(count, seed)
    x = unit(np.cross(c, rng.normal(size=(count, 3))))
    y = unit(np.cross(c, x) + 0.5 * c)
    angle = 2.0 * np.pi * np.arange(corners) / corners + rng.uniform(0.0, 6.0, (count, 1))
    radius = size * np.where(np.arange(corners) % 2 == 1, star, 1.0)[:, None]
    return c[:, None] + radius * (np.cos(angle)[..., None] * x[:, None] + np.sin(angle)[..., None] * y[:, None])
