"""Images of scratches that diffract, by quadrature over pixels, lights and wavelengths in NumPy, float64.

Shares nothing with the renderer but the description of the scene: rays by brute force over triangles, scratches cut to
triangles in uv by clipping, a point of the surface at a time (no footprint: pixels are averaged over many points), and
at each the integral over the light's solid angle of |S|^2 / (A_C lambda^2) = 2 (W / lambda)^2 sinc^2 |D|^2 e^{-s_b^2 /
sigma^2} e^{-(sigma k xi_1)^2}, ends by its share [erf], by Gauss-Legendre nodes in xi_1 (Gauss-Hermite where the light
covers the Gaussian) and in psi: no closed form.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import erf, erfinv

X1, W1 = np.polynomial.legendre.leggauss(16)
X0, W0 = np.polynomial.hermite.hermgauss(4)


@dataclass(frozen=True)
class Patch:
    """Triangles ``corners`` [m, 3, 3] with vertex normals and uv [m, 3, 3], [m, 3, 2]."""

    corners: np.ndarray
    normals: np.ndarray
    uvs: np.ndarray


def image(patch, lines, light, at, weights, size, pixels, per_pixel, along, sigma=60.0):
    """Radiance [pixels, pixels, 3] of the scratches alone, seen from above (orthographic along -z, y up).

    ``lines``: rows (u0, v0, u1, v1, width [um], depth [um]); ``light(points, frames)``: the lights as seen from there:
    ``sphere``, ``convex`` and ``everywhere``; ``at`` [um], ``weights`` [n, 3]: wavelengths; ``size`` [m] of the view;
    ``along``: nodes along the coherence radius.
    """
    n = pixels * per_pixel
    step = ((np.arange(n) + 0.5) / n - 0.5) * size
    x, y = np.meshgrid(step, -step)
    point, normal, face = _hit(patch, x.ravel(), y.ravel())
    total = np.zeros((n * n, 3))
    lit = light, at, weights, sigma, along
    for f in range(len(patch.corners)):
        mine = np.flatnonzero(face == f)
        if len(mine) == 0:
            continue
        edges = (patch.corners[f][1:] - patch.corners[f][0]).T
        bend = (patch.normals[f][1:] - patch.normals[f][0]).T @ np.linalg.pinv(edges)
        for line in lines:
            piece = _clipped(line, patch.uvs[f], patch.corners[f])
            if piece is None:
                continue
            total[mine] += _strand(point[mine], normal[mine], bend, *piece, *line[4:6], *lit)
        # the Gaussian of scratches on neighbouring triangles reaches over the edge
        for line in lines:
            for other in range(len(patch.corners)):
                if other != f:
                    piece = _clipped(line, patch.uvs[other], patch.corners[other])
                    if piece is not None and _near(piece, patch.corners[f], 4.0 * sigma * 1e-6):
                        total[mine] += _strand(point[mine], normal[mine], bend, *piece, *line[4:6], *lit)
    return total.reshape(pixels, per_pixel, pixels, per_pixel, 3).mean((1, 3))


def _near(piece, corners, reach):
    low, high = np.minimum(*piece) - reach, np.maximum(*piece) + reach
    return np.all(high >= corners.min(0)) and np.all(low <= corners.max(0))


def _hit(patch, x, y):
    """First triangle below each (x, y): point, interpolated unit normal, number (-1 none)."""
    point, normal = np.zeros((len(x), 3)), np.zeros((len(x), 3))
    face = np.full(len(x), -1)
    for f, (c, nn) in enumerate(zip(patch.corners, patch.normals, strict=True)):
        m = np.array([c[1, :2] - c[0, :2], c[2, :2] - c[0, :2]]).T
        b = np.linalg.solve(m, np.stack([x, y]) - c[0, :2, None])
        inside = (b >= -1e-12).all(0) & (b.sum(0) <= 1.0 + 1e-12) & (face < 0)
        bary = np.concatenate([1.0 - b.sum(0, keepdims=True), b])[:, inside].T
        face[inside] = f
        point[inside] = bary @ c
        raw = bary @ nn
        normal[inside] = raw / np.linalg.norm(raw, axis=1, keepdims=True)
    return point, normal, face


def _clipped(line, uv, corners):
    """The two ends in space of what of a uv line lies in a triangle, or None."""
    a, b = line[:2], line[2:4]
    m = np.array([uv[1] - uv[0], uv[2] - uv[0]]).T
    pa, pb = np.linalg.solve(m, a - uv[0]), np.linalg.solve(m, b - uv[0])
    low, high = 0.0, 1.0
    for va, vb in ((pa[0], pb[0]), (pa[1], pb[1]), (1.0 - pa.sum(), 1.0 - pb.sum())):
        if va < 0.0 and vb < 0.0:
            return None
        if va < 0.0:
            low = max(low, va / (va - vb))
        elif vb < 0.0:
            high = min(high, va / (va - vb))
    if low >= high:
        return None
    ends = pa + np.array([low, high])[:, None] * (pb - pa)
    return tuple(corners[0] + ends @ (corners[1:] - corners[0]))


def _strand(points, normals, bend, start, end, width, depth, light, at, weights, sigma, along):
    """Radiance [n, 3] at points of one piece of a scratch. ``bend``: change of the normal by metres.

    The surface curves over the coherence radius, so that the field along the scratch has a phase that is a parabola:
    its intensity is the mean of those of flat surfaces along it, weighted by e^{-x^2 / sigma^2} (Wigner's
    distribution of a Gaussian, exact for parabolas).
    """
    out = np.zeros((len(points), 3))
    t = (end - start) / np.linalg.norm(end - start)
    v = np.cross(normals, t)
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    u = np.cross(v, normals)
    s_b = ((start - points) * v).sum(1) * 1e6
    # nodes even in the Gaussian's mass between the ends
    m0, m1 = (erf(((e - points) * u).sum(1) * 1e6 / sigma) for e in (start, end))
    across = np.exp(-((s_b / sigma) ** 2))
    k = 2.0 * np.pi / at
    depth2 = 4.0 * np.sin(k * depth) ** 2
    for x, w in zip(*np.polynomial.legendre.leggauss(along), strict=True):
        h = erfinv(0.5 * (m0 + m1) + 0.5 * (m1 - m0) * x)
        weight = across * 0.25 * (m1 - m0) * w
        seen = np.flatnonzero(weight > 1e-7)
        if len(seen) == 0:
            continue
        step = np.clip(1e-6 * sigma * h[seen, None], -1e-3, 1e-3) * u[seen]
        n = normals[seen] + step @ bend.T
        n /= np.linalg.norm(n, axis=1, keepdims=True)
        aside = np.cross(n, t)
        aside /= np.linalg.norm(aside, axis=1, keepdims=True)
        frame = np.stack([np.cross(aside, n), aside, n], axis=1)
        value = np.zeros((len(seen), len(at)))
        for seen_light in light(points[seen] + step, frame):
            value += _integral(seen_light, frame[:, :, 2], width, sigma, k, at)  # the viewer is above
        out[seen] += (value * 2.0 * (width / at) ** 2 * depth2 * weight[seen, None]) @ weights
    return out


def _integral(light, wo, width, sigma, k, at):
    """Integral over xi of sinc^2 e^{-(sigma k xi_1)^2}, [points, wavelengths]."""
    total = np.zeros((len(wo), len(at)))
    low, high, spans, nodes = light
    x2, w2 = np.polynomial.legendre.leggauss(nodes)
    for j, kk in enumerate(k):
        reach = 5.0 / (sigma * kk)
        a, b = np.maximum(low, -wo[:, 0] - reach), np.minimum(high, -wo[:, 0] + reach)
        covered = (a <= -wo[:, 0] - 0.8 * reach) & (b >= -wo[:, 0] + 0.8 * reach)
        for whole in (True, False):
            lit = np.flatnonzero((a < b) & (wo[:, 2] > 0.0) & (covered == whole))
            if len(lit) == 0:
                continue
            if whole:
                u = -wo[lit, :1] + X0 / (sigma * kk)
                wu = np.broadcast_to(W0 / (sigma * kk), u.shape)
            else:
                # cos tau takes the square roots out of round ends
                tau = 0.5 * np.pi * (X1 + 1.0)
                half, middle = 0.5 * (b - a)[lit, None], 0.5 * (a + b)[lit, None]
                u = middle - half * np.cos(tau)
                wu = W1 * 0.5 * np.pi * np.sin(tau) * half * np.exp(-((sigma * kk * (u + wo[lit, :1])) ** 2))
            psi0, psi1 = spans(lit, u)
            psi1 = np.maximum(psi0, psi1)
            s = np.sqrt(np.maximum(1.0 - u * u, 0.0))[..., None]
            psi = 0.5 * (psi0 + psi1)[..., None] + 0.5 * (psi1 - psi0)[..., None] * x2
            xi2 = wo[lit, 1][:, None, None] + s * np.sin(psi)
            across = (np.sinc(width * xi2 / at[j]) ** 2 * s * np.cos(psi)) @ w2 * 0.5 * (psi1 - psi0)
            total[lit, j] = (wu * across).sum(1)
    return total


def sphere(center, radius):
    """A sphere of radiance 1 for ``image``."""

    def seen(points, frame):
        d = np.einsum("nij,nj->ni", frame, center - points)
        distance = np.linalg.norm(d, axis=1)
        p, a = d / distance[:, None], np.arcsin(radius / distance)
        from_u = np.arccos(p[:, 0])

        def spans(rows, u):
            level = (np.cos(a[rows])[:, None] - u * p[rows, :1]) / (
                np.sqrt(1.0 - u * u) * np.hypot(p[rows, 1], p[rows, 2])[:, None]
            )
            half = np.arccos(np.clip(level, -1.0, 1.0))
            middle = np.arctan2(p[rows, 1], p[rows, 2])[:, None]
            return np.maximum(middle - half, -0.5 * np.pi), np.minimum(middle + half, 0.5 * np.pi)

        return [(np.cos(from_u + a), np.cos(from_u - a), spans, 8)]

    return seen


def convex(polygons, nodes):
    """Convex polygons [k, 3] each, of radiance 1 on both sides, all above the horizon, less than half the sky."""

    def seen(points, frame):
        made = []
        for polygon in polygons:
            w = np.einsum("nij,nkj->nki", frame, np.asarray(polygon)[None] - points[:, None])
            w /= np.linalg.norm(w, axis=2, keepdims=True)
            m = np.cross(w, np.roll(w, -1, axis=1))
            m /= np.linalg.norm(m, axis=2, keepdims=True)
            m *= np.sign(np.einsum("nki,ni->nk", m, w.sum(1)))[..., None]
            # edges bulge in u: their great circles turn where the slice is tangent
            turn = np.hypot(m[..., 1], m[..., 2])
            low, high = w[..., 0].min(1), w[..., 0].max(1)
            top = np.stack([turn, -m[..., 0] * m[..., 1] / turn, -m[..., 0] * m[..., 2] / turn], axis=-1)
            for sign in (1.0, -1.0):
                inside = np.einsum("nki,nji->nkj", sign * top, m).min(2) >= -1e-9
                reached = np.where(inside, sign * turn, 0.5 * (low + high)[:, None])
                low, high = np.minimum(low, reached.min(1)), np.maximum(high, reached.max(1))

            def spans(rows, u, m=m):
                a = np.full(u.shape, -0.5 * np.pi)
                b = np.full(u.shape, 0.5 * np.pi)
                s = np.sqrt(np.maximum(1.0 - u * u, 0.0))
                for e in range(m.shape[1]):
                    n = m[rows, e]
                    rho = np.hypot(n[:, 1], n[:, 2])[:, None]
                    kappa = -u * n[:, :1] / (s * rho)
                    half = np.arccos(np.clip(kappa, -1.0, 1.0))
                    middle = np.arctan2(n[:, 1], n[:, 2])[:, None]
                    # of arcs wider than half a turn the gap cuts off one end
                    lo, hi = middle - half, middle + half
                    lo, hi = (np.where(lo > 0.5 * np.pi, x - 2 * np.pi, x) for x in (lo, hi))
                    lo, hi = (np.where(hi < -0.5 * np.pi, x + 2 * np.pi, x) for x in (lo, hi))
                    a, b = np.maximum(a, lo), np.minimum(b, hi)
                return a, b

            made.append((low, high, spans, nodes))
        return made

    return seen


def everywhere(nodes=64):
    """An even dome of radiance 1."""

    def seen(points, frame):
        one = np.ones(len(points))
        half = 0.5 * np.pi

        def spans(rows, u):
            return np.full(u.shape, -half), np.full(u.shape, half)

        return [(-one, one, spans, nodes)]

    return seen
