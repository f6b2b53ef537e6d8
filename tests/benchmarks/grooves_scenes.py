"""The sheets of ``grooves.py``: the same V grooves as grooves of ours, and as triangles for Mitsuba 3.

Straight grooves along x and along y, each of its own width and place, as deep as a quarter of their width. Where both
digs, the lower counts. Lengths in micrometres; the sheet lies about the origin in z = 0.
"""

from dataclasses import dataclass

import numpy as np

import scratchwarp as sw
from scratchwarp.scene import Camera, Curves, DistantLight, ScratchSurface

from ..render import scenes

VIEW = np.array([0.35, -0.45, 0.82]) / np.linalg.norm([0.35, -0.45, 0.82])
TO_LIGHT = np.array([-0.3, 0.5, 0.81]) / np.linalg.norm([-0.3, 0.5, 0.81])
ETA, K, ROUGHNESS = 2.9, 3.1, 0.3
ASPECT = 0.25  # depth over width
MARGIN = 1.35  # edge of the sheet in edges of what is seen
EFFECTS = {"grooves.interreflection": False}


@dataclass(frozen=True, eq=False)
class Sheet:
    """``x``, ``y``: middles of the grooves that x or y is constant along; ``wide_x``, ``wide_y``: their widths;
    ``side``: edge of the sheet; ``pitch``: of regular lines along x alone, else 0."""

    x: np.ndarray
    y: np.ndarray
    wide_x: np.ndarray
    wide_y: np.ndarray
    side: float
    pitch: float = 0.0

    @property
    def seen(self):
        """Edge of the square window that is seen."""
        return self.side / MARGIN


def parallel(count):
    """``count`` equal grooves, as far apart as they are wide."""
    pitch = 200.0
    y = pitch * (np.arange(count) - 0.5 * (count - 1))
    return Sheet(np.zeros(0), y, np.zeros(0), np.full(count, 100.0), pitch * count, pitch)


def crossing(count):
    """``count`` scratches either way, of widths from 20 to 160, most of them narrow, with gaps as unlike."""
    rng = np.random.default_rng(2008)
    sets = []
    for _ in range(2):
        wide = np.round(20.0 * 8.0 ** (rng.uniform(0.0, 1.0, count) ** 2.0))
        gap = rng.uniform(20.0, 160.0, count)
        at = np.cumsum(wide + gap) - 0.5 * wide
        sets.append((at, wide))
    side = max(at[-1] + wide[-1] for at, wide in sets)
    (x, wide_x), (y, wide_y) = ((np.round(at - 0.5 * side, 2), wide) for at, wide in sets)
    return Sheet(x, y, wide_x, wide_y, side)


def ours(sheet):
    """Our scene: one layer; lines that repeat, or explicit curves."""
    half = 0.5e-6 * sheet.seen
    cam = Camera(
        path="/cam", transform=looking(VIEW, 1.0), projection="orthographic", horizontal_aperture=2 * half,
        vertical_aperture=2 * half,
    )  # fmt: skip
    light = DistantLight(path="/sun", radiance=np.ones(3), direction=-TO_LIGHT, angle=0.0)
    metal = ScratchSurface(metal="custom", eta=(ETA,) * 3, k=(K,) * 3, roughness=ROUGHNESS)
    fields = {"width": 100.0, "depth": 100.0 * ASPECT, "model": "groove", "fresnel": "exact"}
    more = {}
    if sheet.pitch:
        fields |= {"distribution": "linear", "pitch": sheet.pitch, "offset": (0.0, -0.25)}
    else:
        ends = 0.5 + np.array([-1.0, 1.0])
        lines = [np.array([(0.5 + x / sheet.side, v, 0.0) for v in ends]) for x in sheet.x]
        lines += [np.array([(u, 0.5 + y / sheet.side, 0.0) for u in ends]) for y in sheet.y]
        wide = np.repeat(np.concatenate([sheet.wide_x, sheet.wide_y]), 2)
        counts = np.full(len(lines), 2)
        more = {"curves": (Curves("/c", np.concatenate(lines), counts, wide, ASPECT * wide, space="uv"),)}
        fields |= {"distribution": "curves", "curves": (0,)}
    floor = scenes.plane(1e-6 * sheet.side)
    return scenes.scene([floor], [scenes.scratched(metal, **fields)], [light], [scenes.place()], cam, **more)


def settings(pixels, spp=1, knobs=None, effects=None):
    """One sample in the middle of each pixel, whose footprint is as large as the pixel."""
    return sw.Settings(
        width=pixels, height=pixels, spp=spp, filter="box", filter_width=1e-6, integrator="direct", knobs=knobs or {},
        effects=EFFECTS if effects is None else effects,
    )  # fmt: skip


def looking(omega, distance):
    """Camera along ``omega``, as a 4 x 4 matrix."""
    right = np.cross([0.0, 1.0, 0.0], omega)
    right /= np.linalg.norm(right)
    m = np.eye(4)
    m[:3] = np.stack([right, np.cross(omega, right), omega, distance * omega], 1)
    return m


def triangles(sheet):
    """(points [n, 3], faces [m, 3]): every facet whole where nothing crosses it, cut along every crease."""
    half = 0.5 * sheet.side
    cuts_x, fall_x = _profile(sheet.x, sheet.wide_x, half)
    cuts_y, fall_y = _profile(sheet.y, sheet.wide_y, half)
    polygons = []
    for i in range(len(cuts_x) - 1):
        fa = fall_x[i : i + 2]
        for j in range(len(cuts_y) - 1):
            ga = fall_y[j : j + 2]
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            p = np.array([(cuts_x[a], cuts_y[b], fall_x[a], fall_y[b]) for a, b in corners])
            lower = p[:, 2] - p[:, 3]
            if not fa.any() or not ga.any() or (lower >= 0).all() or (lower <= 0).all():
                polygons.append(np.column_stack([p[:, :2], np.minimum(p[:, 2], p[:, 3])]))
            else:
                for sign in (1.0, -1.0):
                    part = _clipped(p, sign * lower)
                    polygons.append(np.column_stack([part[:, :2], np.minimum(part[:, 2], part[:, 3])]))
    corners = np.concatenate(polygons)
    points, place = np.unique(np.round(corners, 6), axis=0, return_inverse=True)
    faces, first = [], 0
    for polygon in polygons:
        own = place[first : first + len(polygon)]
        faces += [(own[0], own[k], own[k + 1]) for k in range(1, len(own) - 1)]
        first += len(polygon)
    return points, np.array(faces)


def _profile(middle, wide, half):
    """Where a profile bends, and its height there."""
    if not len(middle):
        return np.array([-half, half]), np.zeros(2)
    at = np.stack([middle - 0.5 * wide, middle, middle + 0.5 * wide], 1).ravel()
    fall = np.stack([0.0 * wide, -ASPECT * wide, 0.0 * wide], 1).ravel()
    return np.concatenate([[-half], at, [half]]), np.concatenate([[0.0], fall, [0.0]])


def _clipped(polygon, over):
    """The part of a convex polygon where ``over``, given at its corners, is positive."""
    kept = []
    for k in range(len(polygon)):
        j = (k + 1) % len(polygon)
        if over[k] >= 0.0:
            kept.append(polygon[k])
        if over[k] * over[j] < 0.0:
            kept.append(polygon[k] + over[k] / (over[k] - over[j]) * (polygon[j] - polygon[k]))
    return np.array(kept)
