"""Grooves as a height z(x, y) and rays that march over it: NumPy, no code or idea of the library's own.

A ray takes ``STEPS`` equal steps between the highest and the lowest z and halves the step in which it dives under the
surface; the normal is a finite difference, which over a wall lies flat. What a step jumps over is lost, so the depth
in the tests is some hundred times the step.
"""

import numpy as np

STEPS = 400


def section(points):
    """f(x) of a height field profile, 0 outside."""
    p = np.asarray(points, float)
    return lambda x: np.interp(x, p[:, 0], p[:, 1], left=0.0, right=0.0)


def straight(a, b, f, ends="cap", reach=(-0.5, 0.5)):
    """Height of one straight groove from a to b; ``reach``: first and last x of the profile."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    length = np.linalg.norm(b - a)
    u = (b - a) / length
    v = np.array([-u[1], u[0]])

    def height(x, y):
        along, across = (x - a[0]) * u[0] + (y - a[1]) * u[1], (x - a[0]) * v[0] + (y - a[1]) * v[1]
        inside = np.where((along >= 0) & (along <= length), f(across), 0.0)
        if ends == "cap":
            return inside
        beyond = np.maximum(-along, along - length)
        end = np.where((across >= reach[0]) & (across <= reach[1]) & (beyond <= reach[1]), 1.0, 0.0)
        return np.where(beyond > 0, end * np.maximum(f(across), f(beyond)), f(across))

    return height


def corner(a, b, c, f):
    """Height of a groove from far beyond a through b to far beyond c, mitred at b."""
    a, b, c = (np.asarray(p, float) for p in (a, b, c))
    u1, u2 = (b - a) / np.linalg.norm(b - a), (c - b) / np.linalg.norm(c - b)

    def height(x, y):
        rx, ry = x - b[0], y - b[1]
        first = rx * (u1 + u2)[0] + ry * (u1 + u2)[1] <= 0
        return np.where(first, f(-rx * u1[1] + ry * u1[0]), f(-rx * u2[1] + ry * u2[0]))

    return height


def together(*heights):
    """The lowest where anything digs, else the highest."""

    def height(x, y):
        z = np.stack([h(x, y) for h in heights])
        return np.where(z.min(0) < 0, z.min(0), z.max(0))

    return height


def march(height, p, d, z_end, z_start):
    """(hit, point) of rays p + t d, from height ``z_start`` to ``z_end``; p [n, 3], d [3]."""
    span = (z_end - z_start) / d[2]
    low = np.zeros(len(p))
    high = np.full(len(p), np.nan)
    for k in range(1, STEPS + 1):
        t = span * k / STEPS
        q = p + t * d
        under = np.isnan(high) & (q[:, 2] < height(q[:, 0], q[:, 1]))
        high[under] = t
        low[np.isnan(high)] = t
    hit = ~np.isnan(high)
    a, b = low[hit], high[hit]
    for _ in range(45):
        m = 0.5 * (a + b)
        q = p[hit] + m[:, None] * d
        under = q[:, 2] < height(q[:, 0], q[:, 1])
        a, b = np.where(under, a, m), np.where(under, m, b)
    point = p.copy()
    point[hit] += a[:, None] * d
    return hit, point


def disk(count):
    """Points of the unit disk, evenly: an R2 sequence, mapped by area."""
    k = np.arange(count) + 0.5
    u, w = (k * 0.7548776662466927) % 1.0, (k * 0.5698402909980532) % 1.0
    return np.stack([np.sqrt(u) * np.cos(2 * np.pi * w), np.sqrt(u) * np.sin(2 * np.pi * w)], 1)


def mean_radiance(height, bottom, top, center, axis1, axis2, o, i, value, count=20000):
    """Mean of value(n, o, i) where lit; the surface lies between ``bottom`` and ``top``."""
    o, i = np.asarray(o, float), np.asarray(i, float)
    base = np.asarray(center, float) + disk(count) @ np.array([axis1, axis2], float)
    p = np.concatenate([base, np.zeros((count, 1))], 1)
    margin = 1e-3 * (top - bottom)
    start = p + (top + margin) / o[2] * o
    hit, q = march(height, start, -o, bottom - margin, top + margin)
    assert hit.all()
    step = 1e-7
    gx = (height(q[:, 0] + step, q[:, 1]) - height(q[:, 0] - step, q[:, 1])) / (2 * step)
    gy = (height(q[:, 0], q[:, 1] + step) - height(q[:, 0], q[:, 1] - step)) / (2 * step)
    n = np.stack([-gx, -gy, np.ones(count)], 1)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    result = np.zeros(count)
    lit = (n @ i > 0) & (n @ o > 0)
    away = q + 1e-6 * (top - bottom) * n
    # every ray climbs to the top, in its own number of equal steps
    dark = np.zeros(count, bool)
    span = (top - away[:, 2]) / i[2]
    for k in range(1, STEPS + 1):
        r = away + (span * k / STEPS)[:, None] * i
        dark |= (r[:, 2] < height(r[:, 0], r[:, 1])) & (span > 0)
    keep = lit & ~dark
    result[keep] = value(n[keep], o, i)
    return result.mean()


def diffuse(n, o, i):
    """Lambert of albedo 1."""
    return n @ i / np.pi


def ggx(alpha):
    """Isotropic GGX times the cosine, separable Smith."""

    def value(n, o, i):
        h = (o + i) / np.linalg.norm(o + i)
        c = n @ h
        d = alpha**2 / (np.pi * (c**2 * (alpha**2 - 1) + 1) ** 2)

        def g(w):
            cosine = n @ w
            return 2 * cosine / (cosine + np.sqrt(alpha**2 + (1 - alpha**2) * cosine**2))

        return d * g(o) * g(i) / (4 * (n @ o))

    return value
