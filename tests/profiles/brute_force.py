"""A second tracer in float64 NumPy, sharing no code with the library: every ray against every facet, nearest front
hit, no acceleration."""

import numpy as np


def trace(points, phi_i, x, max_bounces=400, periods=3, isolated=False):
    """Rays that enter the base line at ``x`` from ``phi_i`` (equal shapes): (phi_o, bounces, list of cosines a
    bounce, nan once out).

    The outline is repeated ``periods`` times on either side, or extended by flat ground when ``isolated``.
    """
    points = np.asarray(points, float)
    width = points[-1, 0] - points[0, 0]
    top = max(points[:, 1].max(), 0.0) if isolated else points[:, 1].max()
    if isolated:
        far = 1e4 * width
        outline = np.concatenate(
            (
                [[points[0, 0] - far, 0.0], [points[0, 0], 0.0]],
                points,
                [[points[-1, 0], 0.0], [points[-1, 0] + far, 0.0]],
            )
        )
    else:
        shifts = np.arange(-periods, periods + 1) * width
        outline = np.concatenate([points + (s, 0.0) for s in shifts])
    start, edge = outline[:-1], np.diff(outline, axis=0)
    length = np.hypot(*edge.T)
    start, edge, length = start[length > 0], edge[length > 0], length[length > 0]
    normal = np.stack((-edge[:, 1], edge[:, 0]), axis=1) / length[:, None]
    o = np.stack((x, np.full_like(x, top)), axis=1)
    d = np.stack((-np.sin(phi_i), -np.cos(phi_i)), axis=1)
    last = np.full(len(x), -1)
    bounces = np.zeros(len(x), int)
    cosines = []
    live = np.ones(len(x), bool)
    for _ in range(max_bounces):
        ids = np.flatnonzero(live)
        if len(ids) == 0:
            break
        oo, dd = o[ids], d[ids]
        delta = start[None] - oo[:, None]
        den = dd[:, None, 0] * edge[None, :, 1] - dd[:, None, 1] * edge[None, :, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = (delta[..., 0] * edge[None, :, 1] - delta[..., 1] * edge[None, :, 0]) / den
            along = (delta[..., 0] * dd[:, None, 1] - delta[..., 1] * dd[:, None, 0]) / den
        front = den > 0.0
        slack = 1e-12 * width
        ok = front & (distance >= -slack) & (along >= -1e-12) & (along <= 1 + 1e-12)
        ok[np.arange(len(ids)), last[ids]] &= last[ids] < 0
        distance = np.where(ok, distance, np.inf)
        best = distance.argmin(axis=1)
        near = distance[np.arange(len(ids)), best]
        hit = np.isfinite(near)
        live[ids[~hit]] = False
        ids, best, near = ids[hit], best[hit], near[hit]
        n = normal[best]
        cosine = -(d[ids] * n).sum(axis=1)
        o[ids] += near[:, None] * d[ids]
        d[ids] += 2 * cosine[:, None] * n
        last[ids] = best
        bounces[ids] += 1
        row = np.full(len(x), np.nan)
        row[ids] = cosine
        cosines.append(row)
    return np.arctan2(d[:, 0], d[:, 1]), np.where(live, -1, bounces), cosines


def table(points, resolution, rays, fresnel=None, seed=0, incidence="cell", theta=0.0, isolated=False, columns=None):
    """rho [phi_o, phi_i] by random rays, and the number of lost ones; only ``columns`` of phi_i when given."""
    rng = np.random.default_rng(seed)
    width = np.pi / resolution
    points = np.asarray(points, float)
    weights = 2 * np.sin(width / 2) * np.cos((np.arange(resolution) + 0.5) * width - np.pi / 2)
    columns = np.arange(resolution) if columns is None else np.asarray(columns)
    result = np.zeros((resolution, len(columns)))
    lost = 0
    for place, i in enumerate(columns):
        low, high = np.sin(i * width - np.pi / 2), np.sin((i + 1) * width - np.pi / 2)
        phi = (
            np.arcsin(low + (high - low) * rng.random(rays))
            if incidence == "cell"
            else np.full(rays, (i + 0.5) * width - np.pi / 2)
        )
        x = points[0, 0] + (points[-1, 0] - points[0, 0]) * (np.arange(rays) + rng.random(rays)) / rays
        phi_o, bounces, cosines = trace(points, phi, x, isolated=isolated)
        energy = np.ones(rays)
        if fresnel is not None:
            for row in cosines:
                there = np.isfinite(row)
                energy[there] *= fresnel(np.clip(row[there], 0, 1) * np.cos(theta))
        lost += int((bounces < 0).sum())
        j = np.clip(((phi_o + np.pi / 2) / width).astype(int), 0, resolution - 1)
        good = bounces >= 0
        result[:, place] = np.bincount(j[good], energy[good], resolution) / rays / weights
    return result, lost
