"""A ``Profile`` made ready for the kernels: scaled to period 1, with normals, horizons and a look-up of entry
facets."""

from functools import lru_cache
from typing import Any

import numpy as np
import warp as wp

from scratchwarp.profiles.profile import Profile, normalised
from scratchwarp.profiles.tracer_device import Outline

_CELLS = 256


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
    following = np.concatenate((edge, edge[:1]))
    before = np.concatenate((edge[-1:], edge))
    concave = before[:, 0] * following[:, 1] - before[:, 1] * following[:, 0] > 0.0

    group = 2 ** max(2, round(np.log2(len(edge)) / 2))
    o = Outline()
    o.vertex = _device(vertices, wp.vec2)
    o.rise = _device(rise, wp.vec2)
    o.bend = _device(bend, wp.vec2)
    o.turn = wp.array(kinds, dtype=int, device="cpu")
    o.normal = _device(np.stack((-edge[:, 1], edge[:, 0]), axis=1) / size[:, None], wp.vec2)
    o.box = _device(_boxes(vertices, start + np.where(kinds[:, None] < 0, rise, 0.0), group), wp.vec3)
    o.group = group
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


def _boxes(vertices: np.ndarray, peaks: np.ndarray, group: int) -> np.ndarray:
    """Left, right and top of each run of ``group`` facets; ``peaks`` are points that the facets stay below beside
    their ends."""
    heights = np.maximum(np.maximum(vertices[:-1, 1], vertices[1:, 1]), peaks[:, 1])
    starts = np.arange(0, len(heights), group)
    ends = np.minimum(starts + group, len(heights))
    return np.stack((vertices[starts, 0], vertices[ends, 0], np.maximum.reduceat(heights, starts)), axis=1)
