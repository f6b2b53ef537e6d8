"""Wave optics by brute force in NumPy and SciPy, from the definitions: fields on grids, light by samples."""

import numpy as np
from scipy import special, stats


def unit(v):
    v = np.asarray(v, float)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def pair(xi1, xi2):
    """Two directions, mirror images of each other, whose sum has these components."""
    half = 0.5 * np.stack(np.broadcast_arrays(xi1, xi2), axis=-1)
    z = np.sqrt(1.0 - np.sum(half**2, axis=-1))
    return np.concatenate((half, z[..., None]), axis=-1)


def big_m(x):
    """Integral of (1 - cos t) / t^2 over [0, x]."""
    x = np.asarray(x, float)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(x == 0.0, 0.0, special.sici(x)[0] - 2.0 * np.sin(0.5 * x) ** 2 / x)


def depth_power(depth, wavelength):
    """|1 - e^{i 4 pi D / lambda}|^2, D [um], lambda [nm]."""
    return np.abs(1.0 - np.exp(4j * np.pi * depth * 1e3 / wavelength)) ** 2


def brdf(s, wavelength, xi1, xi2, g=2.0):
    """An endless rectangle's [1/sr] as the formulas have it."""
    wave = wavelength * 1e-3
    k = 2.0 * np.pi / wave
    sigma = s.coherence_radius
    lobe = 2.0 * (s.width / wave) ** 2 * np.sinc(s.width * xi2 / wave) ** 2
    depth = np.abs(1.0 - np.exp(1j * k * g * s.depth)) ** 2
    return lobe * depth * np.exp(-((s.offset / sigma) ** 2) - (sigma * k * xi1) ** 2)


def field_brdf(slots, sigma, wavelength, omega_i, omega_o, mirror, reach=6.0, step=0.004, dependent=False):
    """|F|^2 / (A_C lambda^2), F the integral over the plane of Gaussian times (mirror - (1 - e^{-i k g h})) e^{-i k
    xi.x}, on a grid. ``slots``: (azimuth, start, end, height across of v) of grooves that do not meet."""
    wave = wavelength * 1e-3
    k = 2.0 * np.pi / wave
    n = int(reach * sigma / step)
    at = (np.arange(-n, n) + 0.5) * step
    gauss = np.exp(-0.5 * at**2 / sigma**2)
    out = []
    for wi, wo in zip(omega_i, omega_o, strict=True):
        g = wi[2] + wo[2] if dependent else 2.0

        def transform(values, xi):
            return np.sum(gauss * values * np.exp(-1j * k * xi * at)) * step

        xi = wi + wo
        field = mirror * transform(1.0, xi[0]) * transform(1.0, xi[1])
        for azimuth, start, end, height in slots:
            c, s = np.cos(azimuth), np.sin(azimuth)
            along, across = xi[0] * c + xi[1] * s, xi[1] * c - xi[0] * s
            inside = transform((at > start) & (at < end), along)
            field -= inside * transform(1.0 - np.exp(-1j * k * g * height(at)), across)
        out.append(np.abs(field) ** 2 / (np.pi * sigma**2 * wave**2))
    return np.array(out)


def inside_sphere(center, radius):
    """Whether rays from the origin meet a sphere."""
    center = np.asarray(center, float)

    def inside(w):
        along = w @ center
        return (center @ center <= radius**2) | ((along > 0.0) & (center @ center - along**2 <= radius**2))

    return inside


def inside_polygon(vertices):
    """Whether rays from the origin pass through a polygon: the angle that its outline turns around them."""
    vertices = np.asarray(vertices, float)
    normal = np.cross(vertices, np.roll(vertices, -1, axis=0)).sum(axis=0)
    basis = unit(np.cross(normal, vertices[1] - vertices[0])), unit(vertices[1] - vertices[0])

    def inside(w):
        reach = (vertices[0] @ normal) / (w @ normal)
        spoke = vertices - (reach[..., None] * w)[..., None, :]
        z = spoke @ basis[0] + 1j * (spoke @ basis[1])
        turn = np.angle(np.roll(z, -1, axis=-1) / z).sum(axis=-1)
        return (np.abs(turn) > np.pi) & (reach > 0.0)

    return inside


def sampled_radiance(inside, omega_o, azimuth, sigma, wavelength, across, log2=15):
    """Integral of |S|^2 / (A_C lambda^2) d xi over a light: Sobol points, xi_1 by the Gaussian's quantiles, psi even.
    ``across(xi2, g)`` is |W D|^2 / lambda^2."""
    c, s = np.cos(azimuth), np.sin(azimuth)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    wo = turn @ omega_o
    k = 2.0 * np.pi / (wavelength * 1e-3)
    square = stats.qmc.Sobol(2, seed=7).random_base2(log2)
    xi1 = stats.norm.ppf(square[:, 0]) / (np.sqrt(2.0) * sigma * k)
    u, psi = xi1 - wo[0], np.pi * (square[:, 1] - 0.5)
    length = np.sqrt(np.maximum(1.0 - u**2, 0.0))
    w = np.stack((u, length * np.sin(psi), length * np.cos(psi)), axis=-1)
    value = 2.0 * across(wo[1] + w[:, 1], wo[2] + w[:, 2]) * w[:, 2]
    lit = inside(w @ turn) & (np.abs(u) < 1.0)
    return np.mean(np.where(lit, value, 0.0)) * np.pi * np.sqrt(np.pi) / (sigma * k)
