"""A ``Profile`` made ready for the kernels: scaled to period 1, with normals, horizons and a look-up of entry
facets."""

from functools import lru_cache
from typing import Any

import numpy as np
import warp as wp

from scratchwarp.profiles.profile import Profile, normalised
from scratchwarp.profiles.tracer_device import Outline

_CELLS = 256
_HORIZON_FACETS = 1024
_STEEP = 1e30


@lru_cache(maxsize=32)
def outline(profile: Profile) -> Any:
    """The ``Outline`` struct of a profile, on the CPU. Computed in float64, stored in float32."""
    vertices, controls = normalised(profile)
    start, edge = vertices[:-1], np.diff(vertices, axis=0)
    rise, bend = controls - start, start - 2.0 * controls + vertices[1:]
    size = np.linalg.norm(edge, axis=1)
    turn = rise[:, 0] * bend[:, 1] - rise[:, 1] * bend[:, 0]
    # an arc that leaves its chord by less than float32 can tell is a flat facet
    turn = np.where(np.abs(turn) < 1e-7 * size**2, 0.0, turn)
    kinds = np.sign(turn).astype(np.int32)
    rise = np.where(kinds[:, None] == 0, 0.5 * edge, rise)
    bend = np.where(kinds[:, None] == 0, 0.0, bend)
    height_field = not profile.overhangs
    horizon = np.full((len(edge), 2), _STEEP)
    if height_field and len(edge) <= _HORIZON_FACETS:
        horizon = _horizons(vertices, rise, kinds)
    following = np.concatenate((edge, edge[:1]))
    before = np.concatenate((edge[-1:], edge))
    concave = before[:, 0] * following[:, 1] - before[:, 1] * following[:, 0] > 0.0

    o = Outline()
    o.vertex = _device(vertices, wp.vec2)
    o.rise = _device(rise, wp.vec2)
    o.bend = _device(bend, wp.vec2)
    o.turn = wp.array(kinds, dtype=int, device="cpu")
    o.normal = _device(np.stack((-edge[:, 1], edge[:, 0]), axis=1) / size[:, None], wp.vec2)
    o.horizon = _device(horizon, wp.vec2)
    o.concave = wp.array(concave.astype(np.int32), dtype=int, device="cpu")
    places = (
        np.searchsorted(vertices[:, 0], np.arange(_CELLS) / _CELLS, side="right") - 1
        if height_field
        else np.zeros(_CELLS)
    )
    o.start = wp.array(np.clip(places, 0, len(edge) - 1).astype(np.int32), dtype=int, device="cpu")
    o.ground = -profile.top / profile.period
    o.isolated = int(profile.isolated)
    o.height_field = int(height_field)
    return o


def _device(values: np.ndarray, dtype: Any) -> wp.array:
    return wp.array(np.ascontiguousarray(values, np.float32), dtype=dtype, device="cpu")


def _horizons(vertices: np.ndarray, rise: np.ndarray, kinds: np.ndarray) -> np.ndarray:
    """For each facet the slopes above which a ray from anywhere on it passes over everything to its left and right.

    The slope from a point on the facet to a fixed point beyond it is largest at one of the facet's ends (of its
    control polygon for an arc), and humps are below their control points. Beyond the next period nothing rises above
    the line to the base line.
    """
    count = len(kinds)
    peaks = np.where(kinds < 0, 1, 0)[:, None] * rise + vertices[:-1]  # a hump's control point, else the start again
    result = np.empty((count, 2))
    for side, flip in ((1, 1.0), (0, -1.0)):
        v = vertices * (flip, 1.0)
        tops = peaks * (flip, 1.0)
        if flip < 0:
            v, tops = v[::-1], tops[::-1]
        shift = np.array((1.0, 0.0))
        targets = np.concatenate((v[1:], v[1:] + shift))
        humps = np.concatenate((tops, tops + shift))
        slopes = _largest_slopes(v, targets, humps, count)
        beyond = np.maximum(-v[:-1, 1], -v[1:, 1])
        slopes = np.maximum(slopes, beyond)
        result[:, side] = slopes if flip > 0 else slopes[::-1]
    return result


def _largest_slopes(v: np.ndarray, targets: np.ndarray, humps: np.ndarray, count: int) -> np.ndarray:
    """Largest slope from either end of facet k to anything from facet k on."""
    index = np.arange(2 * count)[None, :]
    facet = np.arange(count)[:, None]
    best = np.full(count, -_STEEP)
    for source in (v[:-1], v[1:]):
        for points in (targets, humps):
            run = points[None, :, 0] - source[:, None, 0]
            climb = points[None, :, 1] - source[:, None, 1]
            steep = np.where(climb > 0.0, _STEEP, -_STEEP)
            slope = np.where(run > 0.0, climb / np.where(run > 0.0, run, 1.0), steep)
            best = np.maximum(best, np.where(index >= facet, slope, -_STEEP).max(axis=1))
    return best
