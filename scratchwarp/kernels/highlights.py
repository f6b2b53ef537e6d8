"""Where the lights of a scene are mirrored in polished surfaces in spots smaller than a pixel of its camera: for each
pixel the places that its samples are drawn near, too (``highlights_device``)."""

from typing import Any

import numpy as np
import warp as wp

from ..plan import EffectPlan
from ..plan.effects import LEAST_FILTER, MOST_SMOOTH
from .geometry import PackedGeometry
from .highlight_search import LARGEST, WIDEST, Array, Found, Lamp, View, find, joined
from .highlights_device import ROW, Highlight, HighlightArrays, promising, unhidden
from .material import KINDS

NEAR = 0.25
"""Pixels that begin so far from a highlight [pixels] see it as wide as themselves."""
MOST = 24
"""Highlights of one pixel; the brightest are kept."""


def lamps(kinds: tuple[str, ...], table: Array, starts: Array, triangles: Array) -> list[Lamp]:
    """The lights but domes, as the kernel has them."""
    found = []
    for k, kind in enumerate(kinds):
        for row in table[starts[k] : starts[k + 1]] if kind != "dome" else ():
            center, radius = np.asarray(row["center"], np.float64), float(row["radius"])
            ex, ey = (float(np.linalg.norm(row[name])) for name in ("ex", "ey"))
            if kind == "distant":
                center, radius = center / max(float(np.linalg.norm(center)), 1e-30), float(row["half_angle"])
            elif kind == "rect":
                radius = float(np.hypot(ex, ey))
            elif kind == "disk":
                radius = max(ex, ey)
            elif kind == "cylinder":
                radius = float(np.hypot(radius, row["half_length"]))
            elif kind == "mesh":
                own = triangles[3 * row["first"] : 3 * (row["first"] + row["count"])].astype(np.float64)
                if not len(own):
                    continue
                center = 0.5 * (own.min(0) + own.max(0))
                radius = float(np.linalg.norm(own - center, axis=1).max())
            point = bool(row["delta"])
            if radius <= 0.0 and not point:  # no light comes from what has no size
                continue
            power = float(np.asarray(row["radiance"], np.float64) @ (0.2126, 0.7152, 0.0722)) * float(row["specular"])
            found.append(Lamp(center, 0.0 if point else radius, kind == "distant", point, power))
    return found


def smoothness(materials: Array) -> Array:
    """GGX alpha of the smoothest specular lobe of each packed material; infinite where there is none to rely on."""
    alpha = np.full(len(materials), np.inf)
    for n, m in enumerate(materials):
        if m["response"] >= 0 or m["normal_read"] >= 0:
            continue
        if KINDS[m["kind"]] == "preview":
            if m["roughness_read"] < 0:
                alpha[n] = m["roughness"] ** 2
            if m["clearcoat"] > 0.0 and m["clearcoat_read"] < 0 and m["clearcoat_roughness_read"] < 0:
                alpha[n] = min(alpha[n], m["clearcoat_roughness"] ** 2)
        elif KINDS[m["kind"]] != "diffuse":
            alpha[n] = np.sqrt(max(m["alpha_x"] * m["alpha_y"], 0.0))
    return alpha


def pack(
    view: View,
    plan: EffectPlan,
    shape: PackedGeometry,
    materials: Any,
    lights: list[Lamp],
    device: str,
) -> tuple[HighlightArrays, int]:
    """(Highlights of the whole image by pixel, how many)."""
    alpha = smoothness(materials.numpy())
    g = shape.arrays
    parts: list[Found] = []
    if shape.triangles and np.isfinite(alpha).any():
        face = np.where(g.light.numpy() < 0, alpha[g.material.numpy()], np.inf)
        face = np.where(face <= MOST_SMOOTH, face, 1e6).astype(np.float32)
        smooth: Any = wp.array(face, dtype=float, device=device)
        corners: Any = None
        normals: Any = None
        for lamp in lights:
            kept: Any = wp.zeros(len(face), dtype=int, device=device)
            where = (wp.vec3(*lamp.center.tolist()), lamp.radius, int(lamp.distant), view.c, int(view.orthographic))
            limits = (wp.vec2(*map(float, plan.size)), WIDEST, LARGEST)
            inputs = [g.points, g.normals, smooth, *where, *limits]
            if lamp.power > 0.0:
                wp.launch(promising, dim=len(face), inputs=inputs, outputs=[kept], device=device)
            chosen = np.flatnonzero(kept.numpy())
            if len(chosen):
                if corners is None:
                    corners, normals = (v.numpy().reshape(-1, 3, 3) for v in (g.points, g.normals))
                part = find(corners[chosen], normals[chosen], face[chosen], lamp, view)
                parts.append(_unhidden(part, shape, device))
    found = [part for part in parts if len(part.at)]
    width = plan.settings.filter_width or 0.0
    if not found or width < LEAST_FILTER:
        return _packed(np.zeros(0, np.int64), np.zeros(1, np.int32), [], device), 0
    whole = joined(found)
    return by_pixel(whole, width, plan.size, device), len(whole.at)


def _unhidden(found: Found, shape: PackedGeometry, device: str) -> Found:
    if not len(found.at) or shape.mesh is None:
        return found
    seen = wp.zeros(len(found.at), dtype=int, device=device)
    places = (found.point, found.eye, found.lamp)
    ends: list[Any] = [wp.array(v.astype(np.float32), dtype=wp.vec3, device=device) for v in places]
    wp.launch(unhidden, dim=len(found.at), inputs=[shape.mesh.id, *ends], outputs=[seen], device=device)
    return found.chosen(seen.numpy() == 1)


def by_pixel(found: Found, width: float, size: tuple[int, int], device: str) -> HighlightArrays:
    """Highlights by the pixels whose filter of full ``width`` sees them, or what is near them."""
    # no smaller than float32 tells places in the image apart
    least = 1e-6 * max(size)
    thin, long = (np.linalg.norm(v, axis=1) for v in (found.a, found.b))
    a, b = (v * np.maximum(least / length, 1.0)[:, None] for v, length in ((found.a, thin), (found.b, long)))
    area = np.abs(_cross(a, b))
    pairs: list[tuple[Array, ...]] = []
    reach = int(np.ceil(0.5 * width + NEAR))
    for dy in range(-reach, reach + 1):
        for dx in range(-reach, reach + 1):
            px = np.floor(found.at).astype(np.int64) + (dx, dy)
            off = found.at - (px + 0.5)
            # from the highlight to the nearest place in the filter
            way = np.clip(off, -0.5 * width, 0.5 * width) - off
            r = np.hypot(_cross(way, b), _cross(a, way)) / area
            # what of its ridge in the triangle lies in the filter
            slabs = np.stack([(side * 0.5 * width - off) / np.where(b != 0.0, b, 1e-30) for side in (-1.0, 1.0)])
            low = np.maximum(slabs.min(axis=0).max(axis=1), found.span[:, 0])
            high = np.minimum(slabs.max(axis=0).min(axis=1), found.span[:, 1])
            part = np.where(low < high, np.clip(0.5 * (high - low), 1e-3, 1.0), 1.0)
            at = np.where(low < high, np.clip(0.0, low + part, np.maximum(high - part, low + part)), 0.0)
            met = (np.abs(way).max(axis=1) < NEAR) & (np.where(low < high, np.abs(at), r) < found.reach)
            n = np.flatnonzero(met & ((px >= 0) & (px < size)).all(axis=1))
            fall = 1.0 + at[n] ** 2
            pairs.append((
                px[n, 1] * ROW + px[n, 0],
                off[n] + at[n, None] * b[n],
                np.sqrt(fall)[:, None] * a[n],
                part[n, None] * b[n],
                found.flux[n] * part[n] / fall**1.5,
            ))  # fmt: skip
    number, center, a, b, flux = (np.concatenate(values) for values in zip(*pairs, strict=True))
    order = np.lexsort((-flux, number))
    number, center, a, b, flux = (v[order] for v in (number, center, a, b, flux))
    area = np.abs(_cross(a, b))
    numbers, firsts = np.unique(number, return_index=True)
    records: list[Highlight] = []
    starts = [0]
    ends = np.append(firsts, len(number))[1:]
    for first, end in zip(firsts.tolist(), ends.tolist(), strict=True):
        own: list[int] = []
        for k in range(first, end):
            # triangles next to one another find one highlight each
            d = center[own] - center[k]
            alike = np.hypot(_cross(d, b[k]), _cross(a[k], d)) < 0.5 * area[k]
            if not alike.any() and len(own) < MOST:
                own.append(k)
        share = _shares(flux[own])
        for k, fraction in zip(own, share.tolist(), strict=True):
            one: Any = Highlight()
            one.center, one.a, one.b = (wp.vec2(*v[k].tolist()) for v in (center, a, b))
            one.share, one.top = fraction, fraction / (np.pi * float(area[k]))
            records.append(one)
        starts.append(len(records))
    return _packed(numbers, np.array(starts, np.int32), records, device)


def _shares(flux: Array) -> Array:
    """Half by what they send, half alike; all alike where that cannot be told."""
    whole = float(flux.sum())
    alike = np.full(len(flux), 1.0 / len(flux))
    return 0.5 * flux / whole + 0.5 * alike if 0.0 < whole < np.inf else alike


def _cross(a: Array, b: Array) -> Array:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _packed(pixels: Array, starts: Array, records: list[Highlight], device: str) -> HighlightArrays:
    h = HighlightArrays()
    h.pixels = wp.array(pixels, dtype=wp.int64, device=device)
    h.starts = wp.array(starts, dtype=int, device=device)
    h.highlights = wp.array(records or [Highlight()], dtype=Highlight, device=device)
    return h
