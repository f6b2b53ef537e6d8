"""The printed form of area lights, written straight down in numba: Velinov et al. 2018 Eq. 27, 29 and 31 to 41.

With the exponents of Eq. 35 and 40 mended, without which it does not run; float64 like the other side. One call is one
light, one scratch, one wavelength.
"""

import math

import numba
import numpy as np

A0, B0 = 0.66142739, 0.38272292


@numba.njit
def si(x):
    """Eq. 29."""
    sign = math.copysign(1.0, x)
    return (
        0.5 * math.pi * math.tanh(x)
        - A0 * x / (1.0 + (x - sign * B0) ** 2)
        + sign * (1.0 - math.cos(x)) / (1.0 + abs(x))
    )


@numba.njit
def bound(q, k, width, sigma):
    """N of Eq. 27."""
    if q == 0.0:
        return 0.0
    x = k * width * q
    return (
        math.sqrt(math.pi)
        / (sigma * k)
        * (2.0 * si(x) / (k * width) - 4.0 * math.sin(0.5 * x) ** 2 / (k * k * width * width * q))
    )


@numba.njit
def response(q0, q1, width, depth, sigma, offset, wavelength):
    """Eq. 27 between two bounds, over A_C lambda^2."""
    k = 2.0 * math.pi / wavelength
    depth2 = 2.0 - 2.0 * math.cos(2.0 * k * depth)
    eta2 = 2.0 * math.exp(-((offset / sigma) ** 2))
    return width * width * depth2 * eta2 * (bound(q1, k, width, sigma) - bound(q0, k, width, sigma)) / wavelength**2


@numba.njit
def sphere(cx, cy, cz, radius, ox, oy, oz, azimuth, width, depth, sigma, offset, wavelength):
    """Eq. 31 to 35 and 37, 27: a sphere as the disk through its centre, clipped at the horizon."""
    if oz <= 0.0 or cz <= -radius:
        return 0.0
    c, s = math.cos(azimuth), math.sin(azimuth)
    p1, p2, p3 = cx * c + cy * s, cy * c - cx * s, cz
    o1, o2 = ox * c + oy * s, oy * c - ox * s
    distance = math.sqrt(p1 * p1 + p2 * p2 + p3 * p3)
    p1, p2, p3 = p1 / distance, p2 / distance, p3 / distance
    # the disk that is tangent to the cone: r = R d / sqrt(d^2 - R^2), over d
    r = radius / math.sqrt((distance - radius) * (distance + radius))
    # Duff et al. 2017
    sign = math.copysign(1.0, p3)
    a = -1.0 / (sign + p3)
    b = p1 * p2 * a
    t1, t2, t3 = 1.0 + sign * p1 * p1 * a, sign * b, -sign * p1
    b1, b2, b3 = b, sign + p2 * p2 * a, -p2
    norm = math.sqrt(1.0 + r * r)
    constant = p1 + o1 * norm
    disc = (b1 * r) ** 2 + (t1 * r) ** 2 - constant * constant
    if disc <= 0.0:
        return 0.0
    q = -(b1 * r + math.copysign(math.sqrt(disc), b1))
    va, vb = q / (constant - t1 * r), (constant + t1 * r) / q
    q0, q1 = 0.0, 0.0
    for i in range(2):
        v = va if i == 0 else vb
        sine, cosine = 2.0 * v / (1.0 + v * v), (1.0 - v * v) / (1.0 + v * v)
        xi2 = (p2 + r * cosine * t2 + r * sine * b2) / norm
        if p3 + r * cosine * t3 + r * sine * b3 < 0.0:
            # where the line leaves the hemisphere
            xi2 = math.copysign(math.sqrt(max(0.0, 1.0 - o1 * o1)), xi2)
        if i == 0:
            q0 = o2 + xi2
        else:
            q1 = o2 + xi2
    return response(min(q0, q1), max(q0, q1), width, depth, sigma, offset, wavelength)


@numba.njit
def polygon(vertices, ox, oy, oz, azimuth, width, depth, sigma, offset, wavelength):
    """Eq. 36 and 38 to 40, 27: a polygon ``[k, 3]`` above the horizon, edge by edge, bounds sorted."""
    if oz <= 0.0:
        return 0.0
    c, s = math.cos(azimuth), math.sin(azimuth)
    o1, o2 = ox * c + oy * s, oy * c - ox * s
    found = np.empty(8)
    count = 0
    corners = len(vertices)
    for i in range(corners):
        v, w = vertices[i], vertices[(i + 1) % corners]
        u1, u2, u3 = v[0] * c + v[1] * s, v[1] * c - v[0] * s, v[2]
        w1, w2, w3 = w[0] * c + w[1] * s, w[1] * c - w[0] * s, w[2]
        n = 1.0 / math.sqrt(u1 * u1 + u2 * u2 + u3 * u3)
        u1, u2, u3 = u1 * n, u2 * n, u3 * n
        n = 1.0 / math.sqrt(w1 * w1 + w2 * w2 + w3 * w3)
        w1, w2, w3 = w1 * n, w2 * n, w3 * n
        dot = u1 * w1 + u2 * w2 + u3 * w3
        g1, g2, g3 = w1 - u1 * dot, w2 - u2 * dot, w3 - u3 * dot
        n = math.sqrt(g1 * g1 + g2 * g2 + g3 * g3)
        if n == 0.0:
            continue
        g1, g2, g3 = g1 / n, g2 / n, g3 / n
        disc = g1 * g1 + u1 * u1 - o1 * o1
        if disc <= 0.0:
            continue
        q = -(g1 + math.copysign(math.sqrt(disc), g1))
        end = math.acos(min(1.0, max(-1.0, dot)))
        for j in range(2):
            t = q / (o1 - u1) if j == 0 else (o1 + u1) / q
            angle = 2.0 * math.atan(t)
            if 0.0 <= angle < end and count < 8:
                found[count] = o2 + u2 * math.cos(angle) + g2 * math.sin(angle)
                count += 1
    if count < 2:
        return 0.0
    line = np.sort(found[:count])
    total = 0.0
    for i in range(0, count - 1, 2):
        total += response(line[i], line[i + 1], width, depth, sigma, offset, wavelength)
    return total


@numba.njit
def spheres(center, radius, wo, azimuth, width, depth, sigma, offset, wavelength):
    """``sphere`` for every row."""
    out = np.empty(len(radius))
    for i in range(len(out)):
        out[i] = sphere(
            center[i, 0], center[i, 1], center[i, 2], radius[i], wo[i, 0], wo[i, 1], wo[i, 2], azimuth[i], width[i],
            depth[i], sigma, offset[i], wavelength[i],
        )  # fmt: skip
    return out


@numba.njit
def polygons(vertices, wo, azimuth, width, depth, sigma, offset, wavelength):
    """``polygon`` for every row of ``vertices`` [n, k, 3]."""
    out = np.empty(len(vertices))
    for i in range(len(out)):
        out[i] = polygon(
            vertices[i], wo[i, 0], wo[i, 1], wo[i, 2], azimuth[i], width[i], depth[i], sigma, offset[i], wavelength[i]
        )
    return out


@numba.njit
def sampled(center, radius, wo, azimuth, width, depth, sigma, angle, offset, a1, a2, wavelength, samples, seed):
    """Spheres and elliptic footprints by random directions in the cap and points in the ellipse: the mean of |S|^2
    cos(theta) / (A_C lambda^2) over both, times the solid angle; ``offset`` to the centre of each footprint."""
    np.random.seed(seed)
    out = np.empty(len(radius))
    for i in range(len(out)):
        c, s = math.cos(azimuth[i]), math.sin(azimuth[i])
        d = math.sqrt(center[i, 0] ** 2 + center[i, 1] ** 2 + center[i, 2] ** 2)
        p1, p2, p3 = center[i, 0] / d, center[i, 1] / d, center[i, 2] / d
        sine2 = (radius[i] / d) ** 2
        turn = 1.0 - math.sqrt(1.0 - sine2)
        sign = math.copysign(1.0, p3)
        a = -1.0 / (sign + p3)
        b = p1 * p2 * a
        t1, t2, t3 = 1.0 + sign * p1 * p1 * a, sign * b, -sign * p1
        b1, b2, b3 = b, sign + p2 * p2 * a, -p2
        k = 2.0 * math.pi / wavelength[i]
        total = 0.0
        for _ in range(samples):
            z = turn * np.random.random()
            around = 2.0 * math.pi * np.random.random()
            flat = math.sqrt(z * (2.0 - z))
            x, y = flat * math.cos(around), flat * math.sin(around)
            w1 = p1 * (1.0 - z) + x * t1 + y * b1
            w2 = p2 * (1.0 - z) + x * t2 + y * b2
            w3 = p3 * (1.0 - z) + x * t3 + y * b3
            far, where = math.sqrt(np.random.random()), 2.0 * math.pi * np.random.random()
            across = far * (-a1 * math.cos(where) * math.sin(angle[i]) + a2 * math.sin(where) * math.cos(angle[i]))
            if w3 > 0.0:
                xi1 = (w1 + wo[i, 0]) * c + (w2 + wo[i, 1]) * s
                xi2 = (w2 + wo[i, 1]) * c - (w1 + wo[i, 0]) * s
                e = (sigma * k * xi1) ** 2 + ((offset[i] - across) / sigma) ** 2
                if e < 80.0:
                    t = math.pi * width[i] * xi2 / wavelength[i]
                    lobe = 1.0 if abs(t) < 1e-8 else math.sin(t) / t
                    total += w3 * lobe * lobe * math.exp(-e)
        factor = 2.0 * (width[i] / wavelength[i]) ** 2 * 4.0 * math.sin(k * depth[i]) ** 2
        out[i] = factor * 2.0 * math.pi * turn * total / samples
    return out
